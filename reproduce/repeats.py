#!/usr/bin/env python3
"""Is what `estimate --repeats` finds again right? reproduce/repeats.py [--out FOLDER]

Simulates each body of bodies/ at p = 0.5, for 100 s without noise and for 1,000 s with some, estimates it with ten repeats, and counts
how often sensors, parts and joints are right, by the share of repeats that found them again. Writes repeats.csv and README.md into the
folder of --out, which is docs/shown/repeats. Needs Python 3.11 and NumPy. Takes one to two hours on two cores; a run that was stopped
continues. Status: 0, or 2 on an error.
"""

import argparse
import collections
import pathlib
import sys
import tempfile

try:
    import numpy as np
except ModuleNotFoundError:
    sys.exit("repeats: needs NumPy")

from estimated import ROOT, estimated, interval, noisy, read, resumed, run

SEED, REPEATS = 4880000, 10
# Seconds, and the noise as a share of the root mean square of each sensor.
RECORDINGS = [(100, 0.0), (1000, 0.1)]
SETTINGS = "physics = {{ step = 0.02, duration = {seconds}.0 }}\nmotion = {{ coordination = 0.5, epoch = 250 }}\n"
COLUMNS = ["revision", "body", "seconds", "noise", "what", "repeated", "count", "right"]
BINS = [(0, 4), (5, 7), (8, 9), (10, 10)]
THINGS = {"sensor": "a sensor is on the true part of most sensors of its part",
          "part": "a part has more than half of all sensors of both in common with a true part",
          "joint": "a joint joins parts that are joined, each taken for the true part of most of its sensors"}


def main():
    parser = argparse.ArgumentParser(description="Count how often what is found again is right.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "repeats", help="folder to write to")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    bodies = sorted(file.stem for file in (ROOT / "bodies").glob("*.toml"))
    jobs = [dict(body=body, seconds=seconds, noise=noise) for seconds, noise in RECORDINGS for body in bodies]
    rows = resumed(out / "repeats.csv", COLUMNS, jobs, measured)
    (out / "README.md").write_text(page(rows))
    return 0


def measured(body, seconds, noise):
    """Of each kind of thing and each number of repeats that found it again: how many there are, and how many are right."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "settings.toml").write_text(SETTINGS.format(seconds=seconds))
        run("simulate", "--body", ROOT / "bodies" / f"{body}.toml", "--settings", folder / "settings.toml", "--seed", SEED,
            "--out", folder / "felt")
        if noise > 0:
            touch = np.load(folder / "felt" / "tactile.npy")
            random = np.random.default_rng([SEED, seconds])
            np.save(folder / "felt" / "tactile.npy", noisy(touch, noise, random).astype(np.float32))
        summary, _ = estimated(folder / "felt", folder / "found", SEED, "--repeats", REPEATS)
        counts = collections.Counter()
        for what, repeated, right in things(folder):
            counts[what, repeated, "count"] += 1
            counts[what, repeated, "right"] += right
    keys = sorted({key[:2] for key in counts})
    return [dict(zip(COLUMNS, [summary["revision"], body, seconds, noise, what, repeated, counts[what, repeated, "count"],
                               counts[what, repeated, "right"]])) for what, repeated in keys]


def things(folder):
    """Each sensor, part and joint of an estimate: the repeats that found it again, and whether it is right."""
    table = lambda file: read(folder / file)
    truth = {int(row["sensor"]): int(row["part"]) for row in table("felt/labels.csv")}
    joined = {frozenset((int(row["child"]), int(row["parent"]))) for row in table("felt/tree.csv")}
    parts = table("found/parts.csv")
    own, of_truth, both = collections.Counter(), collections.Counter(), collections.Counter()
    for row in parts:
        part, true = int(row["part"]), truth[int(row["sensor"])]
        own[part] += 1
        of_truth[true] += 1
        both[part, true] += 1
    stands_for = {part: max(of_truth, key=lambda true: both[part, true]) for part in own}
    times = lambda row: round(REPEATS * float(row["repeated"]))
    for row in parts:
        yield "sensor", times(row), truth[int(row["sensor"])] == stands_for[int(row["part"])]
    for row in table("found/repeats.csv"):
        part, true = int(row["part"]), stands_for[int(row["part"])]
        if not row["joined_to"]:
            yield "part", times(row), 2 * both[part, true] > own[part] + of_truth[true] - both[part, true]
        else:
            ends = frozenset((true, stands_for[int(row["joined_to"])]))
            yield "joint", times(row), len(ends) == 2 and ends in joined


def page(rows):
    """The tables, a row for each number of repeats."""
    bodies = len({row["body"] for row in rows})
    lines = [
        "# Is what is found again right?",
        "",
        f"`estimate --repeats {REPEATS}` tells how often each sensor, part and joint is found again from resampled times. "
        "`reproduce/repeats.py` counts how often they are right; [repeats.csv](repeats.csv) has each recording.",
        "",
        f"{bodies} bodies, one simulation of each (seed {SEED}), joints locked with probability 0.5; revision "
        f"{', '.join(sorted({row['revision'][:7] for row in rows}))}. Intervals are 95 % intervals (Wilson), as if all were alike. Right means: "
        f"{'; '.join(THINGS.values())}.",
    ]
    for what in THINGS:
        lines += ["", f"## Each {what}", "", "| found again, of 10 | " + " | ".join(map(recording, RECORDINGS)) + " |", "|---" * (1 + len(RECORDINGS)) + "|"]
        for low, high in BINS:
            cells = []
            for seconds, noise in RECORDINGS:
                own = [row for row in rows if (row["what"], row["seconds"], row["noise"]) == (what, str(seconds), str(noise))
                       and low <= int(row["repeated"]) <= high]
                count, right = (sum(int(row[key]) for row in own) for key in ("count", "right"))
                cells.append(interval(right, count) if count > 0 else "–")
            lines.append(f"| {low if low == high else f'{low} to {high}'} | " + " | ".join(cells) + " |")
    return "\n".join(lines) + "\n"


def recording(way):
    seconds, noise = way
    return f"{seconds:,} s" + (f", noise {noise}" if noise > 0 else "")


if __name__ == "__main__":
    sys.exit(main())
