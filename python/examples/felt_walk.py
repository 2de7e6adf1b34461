# %% [markdown]
"""
# A walk, felt and understood

A person walks. What would the person's skin feel, and does that alone tell how the person is built? The skeleton becomes a body with
skin, the body walks, and parts and tree are estimated from what the skin feels. The skeleton is the truth, with which they are compared.

This walk is made, not recorded: [reproduce/walk.py](../../reproduce/walk.py) writes the file `walk.bvh`. Its angles are the waves of a
gait, and slower waves of random frequencies, so that no step is like another. Any BVH file of motion capture will do in its place:
`python felt_walk.py dance.bvh`. [How often the trees of real recordings are right](../../docs/own-data.md#recorded-movements)
is counted, too.
"""

# %%
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import bodyschema

# A notebook has no arguments, and is in the folder of the walk.
is_script = "__file__" in globals()
walk = Path(sys.argv[1]) if is_script and len(sys.argv) > 1 else (Path(__file__).parent if is_script else Path()) / "walk.bvh"

# %% [markdown]
# ## A body
#
# Each bone from 15 cm on gets 40 sensors. Shorter ones, here those from the hips to the legs, get no skin. What the body has in another way
# than the file is said in warnings.

# %%
body = bodyschema.import_body(walk, Path(tempfile.mkdtemp()) / "walk.toml", min_length=0.15)

# %% [markdown]
# ## What the skin feels
#
# A sensor that moves outward through the fluid feels a pressure, which grows with the square of its speed. A sensor that moves inward feels
# nothing.

# %%
moved = bodyschema.simulate(body, movement=walk)
samples, sensors = moved.touch.shape
times_felt = np.count_nonzero(moved.touch, axis=0)
print(f"{samples} samples of {sensors} sensors, {samples * moved.interval:.1f} s")
print(f"{np.count_nonzero(times_felt == 0)} sensors feel nothing")

# %% [markdown]
# The picture of the first ten seconds shows the swing of legs and arms, and the even speed of the trunk. The person walks forward: sensors
# at the back of trunk and thighs hardly ever move backward, and many of them feel nothing. This walk tells nothing of them.

# %%
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
begin = moved.touch[: round(10 / moved.interval)]
extent = [0, len(begin) * moved.interval, sensors, 0]
picture = axes.imshow(np.sqrt(begin.T), aspect="auto", cmap="magma", interpolation="nearest", extent=extent)
bones, first = np.unique(moved.parts, return_index=True)
order = np.argsort(first)
axes.set(xlabel="time (s)", title="What the skin of a walking person feels")
axes.set_yticks(first[order], [moved.names[bone] for bone in bones[order]], fontsize="small", va="top")
figure.colorbar(picture, label="square root of pressure (√Pa)")
plt.show()

# %% [markdown]
# ## Parts and tree

# %%
found = bodyschema.estimate(moved.touch, interval=moved.interval)
print(found)

# %%
found

# %% [markdown]
# ## Comparison with the skeleton
#
# Sensors that were left out have no part, and are not compared.

# %%
felt = found.parts >= 0
score = bodyschema.score(found.parts[felt], found.tree, moved.parts[felt], moved.tree)
print(f"adjusted Rand index {score.ari:.3f}, tree {'right' if score.tree_correct else 'wrong'}")

bone_of = {}
for part in found.labels:
    bones, counts = np.unique(moved.parts[found.sensors_of(part)], return_counts=True)
    bone_of[part] = bones[counts.argmax()]
    print(f"part {part}: " + ", ".join(f"{count} of {moved.names[bone]}" for bone, count in zip(bones, counts)))

# %% [markdown]
# ## What touch cannot tell apart
#
# **Bones that never move against each other.** The wrists of this walk never turn, so hand and forearm are one part to touch. The same
# holds for several bones of one joint, such as the ways from the chest to the head and to each arm. They are one in the truth, too.

# %%
for bone in np.unique(moved.parts):
    if " + " in moved.names[bone]:
        print(moved.names[bone])

# %% [markdown]
# **Sensors on a wrong part.** A sensor that feels something at a few samples only hardly tells which part's motion made them. And the motions
# of two parts can explain a sensor alike.

# %%
wrong = [sensor for sensor in np.flatnonzero(felt) if bone_of[found.parts[sensor]] != moved.parts[sensor]]
for sensor in wrong:
    print(
        f"sensor {sensor} of {moved.names[moved.parts[sensor]]} is taken for one of {moved.names[bone_of[found.parts[sensor]]]}: "
        f"it feels something at {times_felt[sensor]} of {samples} samples"
    )
right = np.setdiff1d(np.flatnonzero(felt), wrong)
print(f"the other {len(right)} feel something at {np.median(times_felt[right]):.0f} samples (median)")

# %%
figure, axes = plt.subplots(figsize=(7, 3.5), layout="constrained")
for some, marker, label in [(right, "o", "right part"), (wrong, "x", "wrong part")]:
    axes.scatter(found.parts[some], np.maximum(found.residuals[some], 1e-14), s=14, marker=marker, label=label)
axes.set(yscale="log", ylabel="residual", title="Residual of each sensor, by estimated part")
# Of several bones of one joint, such as Hips and Hips/2, the first is enough here.
names = [" +\n".join(name for name in moved.names[bone_of[part]].split(" + ") if "/" not in name) for part in found.labels]
axes.set_xticks(found.labels, names, rotation=45, ha="right", fontsize="small")
axes.legend()
plt.show()

# %% [markdown]
# The remedy is a longer and more varied movement, in which each sensor moves outward often.
#
# This walk is no test of the method: we made three of a minute, and show 40 s of the one whose tree is right. In the other two, most angles
# wandered about half to two thirds as far. With an earlier search, one foot of the first was taken for two parts, and the legs for parts on
# the chest. In the second, the person also stepped back at times, and 51 sensors of chest and hips came out as a part of their own.
# [Recordings that were held out](../../docs/own-data.md#recorded-movements) are a test.
