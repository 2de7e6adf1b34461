#!/usr/bin/env python3
"""Estimate the parts of random robots of boxes: reproduce/boxes.py [--first N] [--bodies N] [--out FOLDER]

Draws bodies of five to ten parts as robots have them: mostly boxes, 5 to 40 cm long, joined by hinges along their edges. Moves each for
2,000 s, and asks `bodyschema estimate` how what it finds compares with the truth. Body N and its movement have seed N. Writes boxes.csv
and README.md into the folder of --out, which is docs/shown/boxes. A run that was stopped continues. Needs Python 3.11, and no packages.
Takes about a minute for each body on one core. Status: 0, or 2 on an error.
"""

import argparse
import pathlib
import random
import sys
import tempfile

from estimated import ROOT, TRUTH, estimated, interval, outcome, resumed, revision, revisions, run, trees_right

SENSORS, DURATION = 40, 2000  # of each part; s
SETTINGS = "physics.step = 0.02\nmotion.epoch = 250\nmotion.coordination = 0.5\n"
COLUMNS = ["body", "revision", "sensors", "fit", *TRUTH]
SHAPES = {"box": 0.7, "cylinder": 0.15, "capsule": 0.15}
JOINTS = {"hinge": 0.85, "universal": 0.1, "ball": 0.05}
GAP = 0.01  # m, from a surface to the anchor of a joint


def main():
    parser = argparse.ArgumentParser(description="Estimate the parts of random robots of boxes.")
    parser.add_argument("--first", type=int, default=4940001, help="the first body; 101 to 130 are calibration")
    parser.add_argument("--bodies", type=int, default=20, help="how many bodies")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "boxes", help="folder to write to")
    arguments = parser.parse_args()
    if arguments.bodies < 1:
        parser.error("--bodies must be at least 1")
    arguments.out.mkdir(parents=True, exist_ok=True)
    current = revision()
    jobs = [{"body": arguments.first + at, "revision": current} for at in range(arguments.bodies)]
    rows = resumed(arguments.out / "boxes.csv", COLUMNS, jobs, measured)
    (arguments.out / "README.md").write_text(page(rows))
    return 0


def measured(body, revision):
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        feel(body, folder / "body.toml", folder / "settings.toml", folder / "felt")
        summary, truth = estimated(folder / "felt", folder / "found", body)
    return [{"body": body, "revision": revision, "sensors": summary["sensors"], "fit": summary["fit"], **truth}]


def feel(number, body, settings, felt):
    """Draw the robot of a number, and feel how it moves."""
    body.write_text(drawn(random.Random(number)))
    settings.write_text(SETTINGS)
    run("simulate", "--body", body, "--settings", settings, "--duration", DURATION, "--seed", number, "--out", felt)


def drawn(draw):
    """A body file. Each part hangs on one of the three before it, and may overlap with others: nothing collides."""
    text, parts = [f"skin = {{ sensors = {SENSORS} }}\n"], []
    for number in range(draw.randint(5, 10)):
        size = [10 ** draw.uniform(-1.3, -0.4) for _ in range(3)]
        centre, joint = ([0.0, 0.0, 0.0], "") if number == 0 else hung(draw, parts, size)
        shape = draw.choices(list(SHAPES), list(SHAPES.values()))[0]
        parts.append((centre, size))
        text.append(f'[[part]]\nname = "p{number}"\n{solid(shape, centre, size)}{joint}')
    return "\n".join(text)


def hung(draw, parts, size):
    """The centre of a part on a side of another, and the lines of its joint."""
    parent = draw.choice(range(max(0, len(parts) - 3), len(parts)))
    middle, length = parts[parent]
    side, sign = draw.randrange(3), draw.choice([-1, 1])
    anchor = [middle[axis] + draw.uniform(-0.3, 0.3) * length[axis] for axis in range(3)]
    anchor[side] = middle[side] + sign * (length[side] / 2 + GAP)
    centre = list(anchor)
    centre[side] += sign * (size[side] / 2 + GAP)
    if draw.choice([False, True]):
        across = (side + 1) % 3
        centre[across] += draw.uniform(-0.3, 0.3) * size[across]
    kind, first = draw.choices(list(JOINTS), list(JOINTS.values()))[0], draw.randrange(3)
    axes = [[float(axis == chosen) for axis in range(3)] for chosen in (first, (first + 1) % 3)]
    along = {"hinge": f"axes = {axes[:1]}\n", "universal": f"axes = {axes}\n", "ball": ""}[kind]
    return centre, f'parent = "p{parent}"\njoint = "{kind}"\nanchor = {anchor}\n{along}'


def solid(shape, centre, size):
    """The lines of a shape about as large as a box."""
    if shape == "box":
        return f'shape = "box"\ncentre = {centre}\nsize = {size}\n'
    along = size.index(max(size))
    radius = (sum(size) - size[along]) / 4
    half = max(size[along] / 2 - radius, GAP) if shape == "capsule" else size[along] / 2
    ends = [[value + sign * half * (axis == along) for axis, value in enumerate(centre)] for sign in (-1, 1)]
    return f'shape = "{shape}"\nfrom = {ends[0]}\nto = {ends[1]}\nradius = {radius}\n'


def page(rows):
    parts = sum(row["parts"] == row["true_parts"] for row in rows)
    mean = sum(float(row["ari"]) for row in rows) / len(rows)
    first, last = rows[0]["body"], rows[-1]["body"]
    lines = [
        "# Random robots of boxes",
        "",
        "How often does `bodyschema estimate` find the tree of a robot that nobody chose? Bodies are drawn as robots are often made: five to",
        "ten parts, mostly boxes, joined mostly by hinges along their edges. Cylinders of the [study of bodies](../bodies/README.md) are",
        f"easier. Each part has {SENSORS} virtual sensors, without noise, and p is 0.5. A movement has {10 * DURATION:,} samples of 0.1 s. Made by",
        f"`reproduce/boxes.py` with revision {revisions(rows)} and seeds {first} to {last}, each of a body and its movement. No number of the",
        "method was chosen on these bodies, but earlier revisions were counted on them, too ([seeds.toml](../../../reproduce/seeds.toml)).",
        "",
        f"The tree was right in {trees_right(rows)}, and the number of parts in {interval(parts, len(rows))}",
        f"(95 % intervals, Wilson). The adjusted Rand index was {mean:.3f} on average. A good fit does not mean a right tree.",
        "",
        "| body | fit | true parts | found | adjusted Rand index | joints right | tree |",
        "|---|---|---|---|---|---|---|",
    ]
    for row in sorted(rows, key=lambda row: float(row["ari"])):
        lines.append(f"| {' | '.join([row['body'], row['fit'], *outcome(row)])} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
