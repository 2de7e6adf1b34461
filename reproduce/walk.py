#!/usr/bin/env python3
"""Write a made walk as a BVH file: python3 reproduce/walk.py [FILE]

A person walks for 40 seconds, at 25 frames a second. Legs, arms and trunk follow the harmonics of a gait. Each angle wanders slowly, too, so
no step is like another. Nothing is measured: angles are of the size that textbooks of gait show. Wrists never move. Lengths are in cm,
angles in degrees; x points to the left, y up, and z forward. Without FILE, this writes python/examples/walk.bvh, the same at each call.
"""

import math
import pathlib
import random
import sys

FRAMES, RATE = 1001, 25
HERE = pathlib.Path(__file__).resolve().parent
# What carries each joint, its place on that, and the end of its last bone. The order is that of the file.
SIDED = [
    ("UpLeg", "Hips", (9, -4, 0), None),
    ("Leg", "UpLeg", (0, -42, 0), None),
    ("Foot", "Leg", (0, -41, 0), (0, -7, 19)),
    ("Arm", "Chest", (18, 27, 0), None),
    ("ForeArm", "Arm", (0, -30, 0), None),
    ("Hand", "ForeArm", (0, -25, 0), (0, -18, 0)),
]
JOINTS = {"Hips": (None, (0, 0, 0), None), "Chest": ("Hips", (0, 18, 0), None), "Head": ("Chest", (0, 34, 0), (0, 26, 2))}
for side, sign in [("Left", 1), ("Right", -1)]:
    for name, parent, (x, y, z), end in SIDED:
        JOINTS[side + name] = (parent if parent in JOINTS else side + parent, (sign * x, y, z), end)


def hierarchy(joint="Hips", indent=""):
    """The lines of a joint and of all that it carries."""
    parent, offset, end = JOINTS[joint]
    places = "" if parent else "Xposition Yposition Zposition "
    yield from [f"{indent}{'JOINT' if parent else 'ROOT'} {joint}", indent + "{", f"{indent}\tOFFSET {offset[0]} {offset[1]} {offset[2]}"]
    yield f"{indent}\tCHANNELS {3 if parent else 6} {places}Yrotation Xrotation Zrotation"
    for carried in order_of(joint)[1:]:
        if JOINTS[carried][0] == joint:
            yield from hierarchy(carried, indent + "\t")
    if end:
        yield from [f"{indent}\tEnd Site", indent + "\t{", f"{indent}\t\tOFFSET {end[0]} {end[1]} {end[2]}", indent + "\t}"]
    yield indent + "}"


def order_of(joint="Hips"):
    """A joint and all that it carries, in the order of the file."""
    return [joint] + [name for child in JOINTS if JOINTS[child][0] == joint for name in order_of(child)]


def wandering(chance, size, slowest=0.05, fastest=0.7):
    """A function of the time that wanders about 0: a sum of waves whose frequencies (Hz) share no period."""
    waves = [(chance.uniform(slowest, fastest), chance.uniform(0, math.tau), chance.uniform(0.5, 1)) for _ in range(5)]
    return lambda time: size / 2 * sum(part * math.sin(math.tau * often * time + phase) for often, phase, part in waves)


def gait(phase):
    """Turns about y, x and z at a phase of the cycle, which begins when the left heel meets the ground."""
    turns = {
        "Hips": (-5 * math.cos(phase), 3, 3 * math.sin(phase)),
        "Chest": (10 * math.cos(phase), 3 + math.cos(2 * phase), -4 * math.sin(phase)),
        "Head": (-5 * math.cos(phase), -4 - math.cos(2 * phase), math.sin(phase)),
    }
    for side, sign, own in [("Left", 1, phase), ("Right", -1, phase + math.pi)]:
        swing, later = math.cos(own), own - 0.7 * math.tau
        turns[side + "UpLeg"] = (sign * (4 + 5 * swing), -9 - 20 * swing, sign * (2 - 4 * math.sin(own)))
        turns[side + "Leg"] = (sign * 4 * math.sin(own), 24 + 22 * math.cos(later) + 17 * math.cos(2 * later), 0)
        turns[side + "Foot"] = (sign * 6, -6 * math.cos(own - 0.3 * math.tau) - 9 * math.cos(2 * own - 0.76 * math.tau), sign * 3 * swing)
        turns[side + "Arm"] = (sign * 5 * swing, 18 * swing - 3, sign * (8 + 2 * math.cos(2 * own)))
        turns[side + "ForeArm"] = (sign * (-20 + 6 * swing), 12 * swing - 22, 0)
    return turns


def frames():
    """The numbers of each frame: the place of the hips, and the turns of all joints."""
    chance = random.Random(12)
    sizes = {"Head": (30, 12, 9), "Chest": (12, 9, 8), "Hips": (8, 6, 6)}
    moving = [joint for joint in order_of() if not joint.endswith("Hand")]
    drifts = {joint: [wandering(chance, size) for size in sizes.get(joint, (10, 10, 8))] for joint in moving}
    pace, turning = wandering(chance, 0.15, fastest=0.2), wandering(chance, 25, fastest=0.1)
    phase = x = z = heading = 0.0
    for frame in range(FRAMES):
        time = frame / RATE
        turns = gait(phase)
        turns |= {joint: [turn + drift(time) for turn, drift in zip(turns[joint], drifts[joint])] for joint in moving}
        turns["Hips"][0] += heading
        along, sway = math.radians(heading), 2 * math.sin(phase)
        yield [x + sway * math.cos(along), 92 - 2 * math.cos(2 * phase), z - sway * math.sin(along)], turns
        # Steps that are faster are longer, too.
        faster = 1 + pace(time)
        phase += math.tau * 0.95 * faster / RATE
        x, z = (place + 120 * faster**2 / RATE * part for place, part in [(x, math.sin(along)), (z, math.cos(along))])
        heading += turning(time) / RATE


def text():
    """The whole file."""
    lines = ["HIERARCHY", *hierarchy(), "MOTION", f"Frames: {FRAMES}", f"Frame Time: {1 / RATE}"]
    for place, turns in frames():
        numbers = place + [turn for joint in order_of() for turn in turns.get(joint, (0, 0, 0))]
        lines.append(" ".join(f"{number:.4f}" if number else "0" for number in numbers))
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1]) if len(sys.argv) > 1 else HERE.parent / "python" / "examples" / "walk.bvh"
    path.write_bytes(text().encode())
