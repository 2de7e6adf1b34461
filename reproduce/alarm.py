#!/usr/bin/env python3
"""Does `estimate` say so where rigid parts do not fit? reproduce/alarm.py [--out FOLDER]

Moves ten random robots of boxes (boxes.py), each for 1,000 s. Makes recordings of each movement. Rigid parts fit some of them, and not the
others: noise alone, samples in an order of their own for each sensor, sensors read at different times, strokes of a finger, contact pads,
soft skin, a reading at rest that is not 0, and a movement that repeats itself. One rigid part alone has no joint. Counts the verdicts of
`estimate`. Writes alarm.csv and README.md into the folder of --out, which is docs/shown/alarm. A run that was stopped continues. Needs
Python 3.11 and NumPy. Takes about half an hour on two cores. Status: 0, or 2 on an error.
"""

import argparse
import functools
import json
import pathlib
import random
import sys
import tempfile

try:
    import numpy as np
except ModuleNotFoundError:
    sys.exit("alarm: needs NumPy")

import boxes
from estimated import ROOT, fail, interval, is_alarm, noisy, read, resumed, revision, revisions, run, tried

SEED, SECONDS, INTERVAL = 4990000, 1000, 0.1  # s
SETTINGS = "physics.step = 0.02\nmotion = { coordination = 0.5, epoch = 250 }\n"
# Robots that were not drawn before. Bundled bodies have served to choose the method's numbers.
ROBOTS = range(SEED + 1, SEED + 11)
COLUMNS = ["kind", "truth", "body", "revision", "samples", "sensors", "fit", "explained", "parts"]
REACH = 0.05  # m, standard deviation of what a finger presses on
STROKE, LATEST, PERIOD = 20, 20, 100  # samples of a stroke, largest delay of a sensor, and samples after which all repeats

# What is made of a recording, by the name of the function that makes it; what the page says of it; and the verdict that is right.
FIT, OTHER, ONE = "fits", "does not fit", "one part"
KINDS = {
    "exact": ("as it is felt", FIT),
    "short": ("its first 1,000 samples", FIT),
    "slightly_noisy": ("with Gaussian noise of 1 % of the root mean square of each sensor", FIT),
    "strongly_noisy": ("with Gaussian noise of 10 %", FIT),
    "noise": ("noise alone: the size of a Gaussian variable at each sample of each sensor", OTHER),
    "shuffled": ("the samples of each sensor in a random order of its own", OTHER),
    "delayed": (f"each sensor read up to {LATEST * INTERVAL:.0f} s late", OTHER),
    "stroked": (f"a body at rest, over which a finger strokes, {STROKE * INTERVAL:.0f} s each time", OTHER),
    "pads": ("the same, felt by pads as 0 or 1", OTHER),
    "soft": ("skin, each spot of which moves by itself as fast as with its part", OTHER),
    "offset": ("with a reading at rest of 10 % of the root mean square", OTHER),
    "repeated": (f"its first {PERIOD * INTERVAL:.0f} s again and again", OTHER),
    "one_part": ("the sensors of one part alone", ONE),
}


def main():
    parser = argparse.ArgumentParser(description="Count the verdicts of `estimate` on what fits and what does not.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "alarm", help="folder to write to")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    current = revision()
    jobs = [{"body": body, "revision": current} for body in ROBOTS]
    order = lambda row: (list(KINDS).index(row["kind"]), row["body"])
    rows = resumed(out / "alarm.csv", COLUMNS, jobs, measured, order=order)
    (out / "README.md").write_text(page(rows))
    return 0


def measured(body, revision):
    """The verdict on each kind of recording of a body."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "settings.toml").write_text(SETTINGS)
        file = folder / "body.toml"
        file.write_text(boxes.drawn(random.Random(body)))
        words = ["--settings", folder / "settings.toml", "--duration", SECONDS, "--seed", SEED, "--out", folder / "felt"]
        run("simulate", "--body", file, *words)
        moved = Moved(folder / "felt", np.random.default_rng([SEED, body]))
        for kind in KINDS:
            touch = getattr(moved, kind)()
            np.save(folder / "touch.npy", touch.astype(np.float32))
            yield {"kind": kind, "truth": KINDS[kind][1], "body": body, "revision": revision, "samples": len(touch), "sensors": touch.shape[1],
                   **verdict(folder / "touch.npy", folder / f"found-{kind}")}


def verdict(touch, found):
    """What `estimate` says of a recording: its verdict, the share of sensors that rigid motions explain, and the number of parts."""
    done = tried("estimate", touch, "--seed", SEED, "--out", found)
    if done.returncode == 2:
        return {"fit": "refused"}
    if done.returncode not in (0, 1):
        fail(f"estimate failed: {done.stderr.strip()}")
    summary = json.loads((found / "summary.json").read_text())
    return {"fit": summary["fit"], "explained": f"{summary['explained']:.3f}", "parts": summary["parts"]}


class Moved:
    """What a body felt, and what else its sensors could have felt: of each kind T × M values."""

    def __init__(self, felt, random):
        self.random, self.touch = random, np.load(felt / "tactile.npy").astype(float)
        rows = read(felt / "sensors.csv")
        self.solid = np.array([int(row["solid"]) for row in rows])
        self.place, self.normal = (np.array([[float(row[name + axis]) for axis in axes] for row in rows])
                                   for name, axes in (("", ["x_m", "y_m", "z_m"]), ("normal_", "xyz")))
        poses = np.load(felt / "poses.npy").astype(float)
        self.poses = poses.reshape(len(poses), -1, 7)

    def exact(self):
        return self.touch

    def short(self):
        return self.touch[:1000]

    def slightly_noisy(self):
        return noisy(self.touch, 0.01, self.random)

    def strongly_noisy(self):
        return noisy(self.touch, 0.1, self.random)

    def noise(self):
        return np.abs(self.random.standard_normal(self.touch.shape))

    def shuffled(self):
        return self.random.permuted(self.touch, axis=0)

    def delayed(self):
        late = self.random.integers(0, LATEST + 1, self.touch.shape[1])
        return np.stack([np.roll(series, delay) for series, delay in zip(self.touch.T, late)], axis=1)[LATEST:]

    @functools.cached_property
    def strokes(self):
        """A finger moves evenly from one sensor of a part to another, while the body lies still."""
        touch = np.zeros_like(self.touch)
        for first in range(0, len(touch), STROKE):
            on = np.flatnonzero(self.solid == self.random.choice(self.solid))
            start, end = self.place[self.random.choice(on, 2)]
            finger = start + np.linspace(0, 1, len(touch[first : first + STROKE]))[:, None] * (end - start)
            far = ((finger[:, None] - self.place[on]) ** 2).sum(2)
            touch[first : first + STROKE, on] = np.exp(-far / (2 * REACH**2))
        return touch

    def stroked(self):
        return self.strokes

    def pads(self):
        return self.strokes > 0.5

    def soft(self):
        """The speed along the normal is that of the part, and one of its own, smooth over a second."""
        frames = rotations(self.poses[:, :, 3:])
        place = self.poses[:, self.solid, :3] + np.einsum("tmij,mj->tmi", frames[:, self.solid], self.place)
        normal = np.einsum("tmij,mj->tmi", frames[1:, self.solid], self.normal)
        speed = (np.diff(place, axis=0) / INTERVAL * normal).sum(2)
        own = self.random.standard_normal((len(speed) + 10, speed.shape[1]))
        own = np.cumsum(own, axis=0)
        own = own[10:] - own[:-10]
        own *= (speed**2).mean(0) ** 0.5 / (own**2).mean(0) ** 0.5
        return np.maximum(speed + own, 0) ** 2

    def offset(self):
        return self.touch + 0.1 * (self.touch**2).mean(0) ** 0.5

    def repeated(self):
        return np.tile(self.touch[:PERIOD], (len(self.touch) // PERIOD, 1))

    def one_part(self):
        return self.touch[:, self.solid == self.solid[0]]


def rotations(quaternions):
    """The matrices of rotations w, x, y, z."""
    w, x, y, z = np.moveaxis(quaternions, -1, 0)
    rows = [[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
            [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
            [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]]
    return np.moveaxis(np.array(rows), [0, 1], [-2, -1])


def page(rows):
    of = lambda right: [row for row in rows if row["truth"] == right]
    false, missed = of(FIT), of(OTHER)
    lines = [
        "# Is it said where rigid parts do not fit?",
        "",
        f"Of recordings that rigid parts fit, `bodyschema estimate` says that they do not in {interval(sum(map(is_alarm, false)), len(false))}.",
        f"Of those that they do not fit, it says so in {interval(sum(map(is_alarm, missed)), len(missed))} (95 % intervals, Wilson).",
        "",
        f"{len(ROBOTS)} random robots of boxes ({ROBOTS[0]} to {ROBOTS[-1]}), drawn like [those of the study](../boxes/README.md), each moved for "
        f"{SECONDS:,} s at p = 0.5 (seed {SEED}); revision {revisions(rows)}. None had been drawn before. [alarm.csv](alarm.csv) has each recording. "
        "Made by `reproduce/alarm.py`.",
        "",
        "| recording | n | does not fit | doubtful | good |",
        "|---|---|---|---|---|",
    ]
    for right, title in ((FIT, "rigid parts fit"), (OTHER, "they do not")):
        lines.append(f"| **{title}** | | | | |")
        lines += [counted(kind, rows) for kind in KINDS if KINDS[kind][1] == right]
    one = of(ONE)
    found = sum(row["parts"] == "1" for row in one)
    lines += [f"| **one part** | | | | |", counted("one_part", rows), "",
              f"Of the recordings of one part, {interval(found, len(one))} came out as one part, which shows no joint."]
    return "\n".join(lines) + "\n"


def counted(kind, rows):
    own = [row for row in rows if row["kind"] == kind]
    cells = [sum(map(is_alarm, own)), *(sum(row["fit"] == fit for row in own) for fit in ("doubtful", "good"))]
    return f"| {KINDS[kind][0]} | {len(own)} | {' | '.join(map(str, cells))} |"


if __name__ == "__main__":
    sys.exit(main())
