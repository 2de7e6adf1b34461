# %% [markdown]
"""
# A recorded walk, felt and understood

Motion capture has recorded a person who walks. What would the person's skin feel, and does that alone tell how the person is built? The
skeleton of the recording becomes a body with skin, the body walks as it was recorded, and parts and tree are estimated from what the skin
feels. The skeleton is the truth, with which they are compared.

The file `walk.bvh` is subject 12, trial 1 of the [CMU Graphics Lab Motion Capture Database](http://mocap.cs.cmu.edu), which was created
with funding from NSF EIA-0196217. Call this script with another `.bvh` file to try your own: `python recorded_walk.py dance.bvh`.
"""

# %%
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np

import bodyschema

# A notebook has no arguments, and is in the folder of the recording.
is_script = "__file__" in globals()
walk = Path(sys.argv[1]) if is_script and len(sys.argv) > 1 else (Path(__file__).parent if is_script else Path()) / "walk.bvh"

# %% [markdown]
# ## A body
#
# Each bone from 15 cm on becomes a part of its own, with 40 sensors. Shorter ones, such as those of the fingers, get no skin. What the body
# has in another way than the file is said in warnings.

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
# The picture shows the swing of each leg, and the even speed of trunk and arms. The person walks forward: sensors at the back of the trunk
# hardly ever move backward, and many of them feel nothing. This walk tells nothing of them.

# %%
figure, axes = plt.subplots(figsize=(7, 4.5), layout="constrained")
picture = axes.imshow(
    np.sqrt(moved.touch[::4].T), aspect="auto", cmap="magma", interpolation="nearest", extent=[0, samples * moved.interval, sensors, 0]
)
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

# %% [markdown]
# The verdict on the fit is doubtful for one reason alone: the recording has fewer than 1,000 samples. On the body map of so short a
# recording, parts are no clusters. `estimate` finds them by their motion, and draws the map only for the picture.

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
# **Bones that never move against each other.** This skeleton has two bones for the hips, and two for the shoulders, but the recording has
# no movement between them. To touch they are one part, and so they are in the truth.

# %%
for bone in np.unique(moved.parts):
    if " + " in moved.names[bone]:
        print(moved.names[bone])

# %% [markdown]
# **Sensors that feel too little.** A few sensors are on a wrong part. They feel something at a few samples only. So few
# numbers do not tell which part's motion made them: several explain them well, or none does.

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
names = [moved.names[bone_of[part]].replace(" + ", " +\n") for part in found.labels]
axes.set_xticks(found.labels, names, rotation=45, ha="right", fontsize="small")
axes.legend()
plt.show()

# %% [markdown]
# The remedy is a longer and more varied movement, in which each sensor moves outward often.
#
# One walk is no test of the method, which was developed on this recording, among others.
# [Recordings that were held out](../../docs/own-data.md#recorded-movements) show how often the tree is right.
