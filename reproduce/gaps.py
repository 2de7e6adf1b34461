#!/usr/bin/env python3
"""Estimate parts and tree of recordings with gaps, beside the whole recording: reproduce/gaps.py [--out FOLDER]

Simulates bodies for 1,000 s (bodies/*.toml, without noise), takes values away, and compares what `bodyschema estimate` finds with the
truth. Writes gaps.csv and README.md into the folder of --out, which is docs/shown/gaps. Needs Python 3.11 and NumPy. Takes about 40
minutes on two cores; a run that was stopped continues. Status: 0, or 2 on an error.
"""

import argparse
import pathlib
import sys
import tempfile

try:
    import numpy as np
except ModuleNotFoundError:
    sys.exit("gaps: needs NumPy")

from estimated import ROOT, estimated, interval, noisy, resumed, run, trees_right

BODIES, SEEDS = ["star", "tee", "quadruped"], range(4830001, 4830005)
COLUMNS = ["revision", "body", "seed", "gaps", "missing", "sensors_left", "ari", "tree_right"]


def scattered(share):
    return lambda x, labels, random: np.where(random.random(x.shape) < share, np.nan, x)


def stretches(share):
    """Each sensor lacks one stretch, at a time of its own."""
    def take(x, labels, random):
        x, length = x.copy(), int(share * len(x))
        for sensor in range(x.shape[1]):
            begin = random.integers(len(x) - length)
            x[begin:begin + length, sensor] = np.nan
        return x
    return take


def limb(share):
    """All sensors of one part lack the same stretch."""
    def take(x, labels, random):
        x, begin = x.copy(), random.integers(int((1 - share) * len(x)))
        x[begin:begin + int(share * len(x)), labels == random.choice(labels)] = np.nan
        return x
    return take


def saturated(share):
    """The range of each sensor ends so that it cuts this share of the values."""
    return lambda x, labels, random: np.minimum(x, np.quantile(x, 1 - share, axis=0))


def with_noise(then):
    """Noise of a tenth, as the study of all bodies has it."""
    return lambda x, labels, random: then(noisy(x, 0.1, random), labels, random)


CONDITIONS = {
    "none": lambda x, labels, random: x,
    "0.2 % scattered": scattered(0.002),
    "1 % scattered": scattered(0.01),
    "5 % scattered": scattered(0.05),
    "20 % scattered": scattered(0.2),
    "a stretch of 10 % of each sensor": stretches(0.1),
    "a stretch of 20 % of each sensor": stretches(0.2),
    "a stretch of 20 % of one part": limb(0.2),
    "the largest 2 % of each sensor cut": saturated(0.02),
    "noise of 10 %, no gaps": with_noise(lambda x, labels, random: x),
    "noise of 10 %, 20 % scattered": with_noise(scattered(0.2)),
}


def main():
    parser = argparse.ArgumentParser(description="Estimate parts and tree of recordings with gaps.")
    parser.add_argument("--out", type=pathlib.Path, default=ROOT / "docs" / "shown" / "gaps", help="folder to write to")
    out = parser.parse_args().out
    out.mkdir(parents=True, exist_ok=True)
    jobs = [dict(body=body, seed=seed) for body in BODIES for seed in SEEDS]
    rows = resumed(out / "gaps.csv", COLUMNS, jobs, measured)
    (out / "README.md").write_text(page(rows))
    return 0


def measured(body, seed):
    """What `estimate` finds under each condition."""
    with tempfile.TemporaryDirectory() as name:
        folder = pathlib.Path(name)
        (folder / "short.toml").write_text("[physics]\nduration = 1000.0\n")
        run("simulate", "--body", ROOT / "bodies" / f"{body}.toml", "--settings", folder / "short.toml", "--seed", seed,
            "--out", folder / "moved")
        x = np.load(folder / "moved" / "tactile.npy")
        labels = np.genfromtxt(folder / "moved" / "labels.csv", delimiter=",", names=True)["part"].astype(int)
        for at, (condition, take) in enumerate(CONDITIONS.items()):
            random = np.random.default_rng([seed, at if "noise" not in condition else 0])
            np.save(folder / "moved" / "tactile.npy", take(x, labels, random).astype(np.float32))
            summary, truth = estimated(folder / "moved", folder / "found", seed)
            left = summary["sensors"] - summary["dropped"]
            missing = summary["missing"] / (left * summary["samples"])
            row = [summary["revision"], body, seed, condition, f"{missing:.4f}", left, truth["ari"], truth["tree_right"]]
            yield dict(zip(COLUMNS, row))


def page(rows):
    """The table, a row for each condition."""
    lines = [
        "# Recordings with gaps",
        "",
        "How much do missing values cost? Nothing was interpolated. `reproduce/gaps.py` repeats this page; "
        "[gaps.csv](gaps.csv) has each recording.",
        "",
        f"Bodies: {', '.join(BODIES)}; {len(SEEDS)} simulations of each (seeds {SEEDS[0]} to {SEEDS[-1]}), 10,000 samples, joints locked "
        f"with probability 0.9, no noise but where it is named; revision {', '.join(sorted({row['revision'][:7] for row in rows}))}. In brackets after a count: its 95 % "
        "interval (Wilson).",
        "",
        "| gaps | values missing | sensors used | mean adjusted Rand index (lowest) | all sensors on their part | tree right |",
        "|---|---|---|---|---|---|",
    ]
    for condition in CONDITIONS:
        own = [row for row in rows if row["gaps"] == condition]
        mean = lambda column: sum(float(row[column]) for row in own) / len(own)
        aris = [float(row["ari"]) for row in own]
        lines.append(f"| {condition} | {100 * mean('missing'):.1f} % | {mean('sensors_left'):.0f} | {sum(aris) / len(aris):.3f} "
                     f"({min(aris):.3f}) | {interval(sum(ari == 1 for ari in aris), len(own))} | {trees_right(own)} |")
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    sys.exit(main())
