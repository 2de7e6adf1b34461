# %% [markdown]
"""
# One's own robot: from a ROS recording to parts and tree

You have recorded the skin of a robot, and want to know which rigid parts the robot has, which sensor sits on which part, and which parts
are joined. Call this script with your recording: the folder of a ROS 2 bag, a `.mcap` or `.bag` file, or a table such as a `.csv` file.
Names of topics may follow. In a clone of this repository, with Python 3.10 or newer:

    pip install ".[examples]"
    python python/examples/own_robot.py recording /skin/left /skin/right

Without a recording, a simulated body stands in for the robot, and is recorded in a bag. ROS need not be installed: the package `rosbags`
reads and writes bags without it.
"""

# %%
import sys
import tempfile
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
from rosbags.highlevel import AnyReader
from rosbags.rosbag2 import Writer
from rosbags.typesys import Stores, get_typestore

import bodyschema

# A notebook has no arguments.
arguments = sys.argv[1:] if "__file__" in globals() else []

# %% [markdown]
# ## Read a bag
#
# Two kinds of topics are read. A message of `std_msgs/msg/Float32MultiArray` has the pressures of many sensors. One of
# `sensor_msgs/msg/FluidPressure` has that of a single sensor, and the stamp says when it was measured. A message without a
# stamp was measured when it was received.

# %%
types = get_typestore(Stores.ROS2_HUMBLE)
KINDS = ["std_msgs/msg/Float32MultiArray", "std_msgs/msg/Float64MultiArray", "sensor_msgs/msg/FluidPressure"]


def topics_of(path, names=()):
    """Times in s, and pressures with a row for each message, of each topic of a bag."""
    times, pressures = {}, {}
    with AnyReader([Path(path)], default_typestore=types) as bag:
        chosen = [topic for topic in bag.connections if (topic.topic in names if names else topic.msgtype in KINDS)]
        if not chosen:
            sys.exit(f"{path}: none of these topics can be read: {', '.join(sorted(bag.topics))}")
        for topic, received, data in bag.messages(connections=chosen):
            message = bag.deserialize(data, topic.msgtype)
            stamp = message.header.stamp if hasattr(message, "header") else None
            times.setdefault(topic.topic, []).append(received / 1e9 if stamp is None else stamp.sec + stamp.nanosec / 1e9)
            pressures.setdefault(topic.topic, []).append(message.data if hasattr(message, "data") else [message.fluid_pressure])
    return {name: (np.array(times[name]), np.array(pressures[name])) for name in sorted(times)}


# %% [markdown]
# ## One row for each time
#
# Topics have times of their own, and messages get lost. The topic with the fewest messages is the clock. Of each other topic, the message
# that is nearest in time is taken, if it is at most half an interval away. Otherwise there is no value: NaN.


# %%
def in_rows(topics):
    """Pressures with a row for each time and a column for each sensor, and the times, s."""
    clock = np.sort(min((times for times, _ in topics.values()), key=len))
    tolerance = np.median(np.diff(clock)) / 2
    blocks = []
    for times, pressures in topics.values():
        order = np.argsort(times)
        nearest = order[np.searchsorted((times[order][1:] + times[order][:-1]) / 2, clock)]
        near = np.abs(times[nearest] - clock) <= tolerance
        blocks.append(np.where(near[:, None], pressures[nearest], np.nan))
    return np.hstack(blocks), clock - clock[0]


# %% [markdown]
# ## A recording
#
# Record at least 10,000 samples, in which each joint makes about 100 movements; this example has half of both. Drive joints at random, one
# against the other. Sensors must feel a fluid or air: contact does not fit.
#
# The simulated robot has a body with four arms. Its 200 sensors are wired in no order: 96 to each of two boards, and eight barometers with
# topics of their own. Times are uneven by about a millisecond, one message in a hundred is lost, and barometers read the pressure
# of the air, too.


# %%
def record(moved, path):
    """Write what a simulated robot feels as a ROS 2 bag, and return the sensors in the order of the topics."""
    random = np.random.default_rng(1)
    wired = random.permutation(moved.touch.shape[1])
    topics = {f"/barometer_{at}": wired[at : at + 1] for at in range(8)}
    topics.update({"/skin/board_1": wired[8:104], "/skin/board_2": wired[104:]})
    array, layout, pressure = types.types[KINDS[0]], types.types["std_msgs/msg/MultiArrayLayout"], types.types[KINDS[2]]
    header, time = types.types["std_msgs/msg/Header"], types.types["builtin_interfaces/msg/Time"]
    begin = 1_700_000_000_000_000_000  # ns
    with Writer(path, version=9) as bag:
        for name, sensors in topics.items():
            kind = pressure if len(sensors) == 1 else array
            topic = bag.add_connection(name, kind.__msgtype__, typestore=types)
            for at, row in enumerate(np.ascontiguousarray(moved.touch[:, sensors])):
                now = begin + int(1e9 * (at * moved.interval + random.normal(0, 0.001)))
                if random.random() < 0.01:
                    continue
                if kind is array:
                    message = array(layout([], 0), row)
                else:
                    stamp = time(*divmod(now, 1_000_000_000))
                    message = pressure(header(stamp, name), 101_325.0 + float(row[0]), 0.0)
                bag.write(topic, now, types.serialize_cdr(message, kind.__msgtype__))
    return np.concatenate([topics[name] for name in sorted(topics)])


truth = None
if arguments:
    recording, *names = arguments
else:
    moved = bodyschema.simulate("star", duration=500, coordination=0.5, random_state=5)
    recording, names = Path(tempfile.mkdtemp()) / "recording", []
    order = record(moved, recording)
    truth = moved.parts[order], moved.tree

# %% [markdown]
# Without movement, the pressure must be 0. So hold the robot still for the first 5 s of a bag: what each sensor reads then is taken off. Of a
# table, take it off yourself; an offset makes parts and tree wrong. `estimate` reads a table itself, and the interval from its column of
# times.

# %%
if Path(recording).is_dir() or Path(recording).suffix in (".mcap", ".bag"):
    topics = topics_of(recording, names)
    touch, seconds = in_rows(topics)
    touch -= np.nanmedian(touch[seconds < 5], axis=0)
    steps = np.diff(seconds)
    interval = float(np.median(steps))
    print(f"{len(topics)} topics, {touch.shape[1]} sensors, {touch.shape[0]} samples; {100 * np.isnan(touch).mean():.1f} % have no value")
    print(f"interval {interval:.3f} s, the longest {steps.max():.1f} s")
else:
    touch, interval = recording, None

# %% [markdown]
# ## Parts and tree
#
# One line estimates them, and another shows them.

# %%
found = bodyschema.estimate(touch, interval=interval)
print(found)

# %%
found

# %% [markdown]
# **Look at the fit first.** Rigid parts must explain what the sensors feel. If they do not, parts and tree mean nothing, and the likely
# cause is named.

# %%
if found.fit.verdict != "good":
    print(f"take care: {found.fit.cause}")
print(f"sensors that were left out: {dict(found.dropped) or 'none'}")

# %% [markdown]
# ## Which sensor is on which part
#
# The residual is the share of what a sensor feels that its part's motion does not explain. Where the residual of the next best part is
# near to it, the part of the sensor is uncertain.

# %%
for part in found.labels:
    own = found.sensors_of(part)
    print(f"part {part}: {len(own)} sensors, the first is {own[0]}, median residual {np.median(found.residuals[own]):.3f}")
uncertain = np.flatnonzero(found.residuals > 0.5 * found.next_residuals)
print(f"sensors whose part is uncertain: {uncertain.tolist() or 'none'}")

# %%
figure, axes = plt.subplots(figsize=(6, 3), layout="constrained")
axes.scatter(found.parts, np.maximum(found.residuals, 1e-9), s=10, label="own part")
axes.scatter(found.parts + 0.3, np.maximum(found.next_residuals, 1e-9), s=10, marker="x", label="next best part")
axes.set(yscale="log", xlabel="part", ylabel="residual", xticks=found.labels, title="Residual of each sensor")
axes.legend(loc="center left", bbox_to_anchor=(1, 0.5))
plt.show()

# %% [markdown]
# ## Which parts are joined
#
# The bootstrap support of a joint is given the parts: it does not see that sensors are on a wrong part. `found.to_networkx()` has
# the tree as a graph of networkx.

# %%
for (child, parent), support in zip(found.tree, found.support):
    print(f"parts {child} and {parent} are joined, support {100 * support:.0f} %")

# %% [markdown]
# ## Comparison with the truth
#
# Only a simulation has it.

# %%
if truth is not None:
    score = bodyschema.score(found.parts, found.tree, *truth)
    print(f"adjusted Rand index {score.ari:.3f}, tree {'right' if score.tree_correct else 'wrong'}")
