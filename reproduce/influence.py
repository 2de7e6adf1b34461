#!/usr/bin/env python3
"""How much does each parameter of `estimate` matter? reproduce/influence.py [--only NAME] [--files FOLDER] [--keep FOLDER] [--out FOLDER]

Estimates calibration data with each parameter halved and doubled, all others as they are: bodies that move at random, without and with
noise, robots of boxes, and recorded movements. They are few and small, so that this takes some two hours on two cores. Writes
influence.csv into the folder of --out, which is docs/shown/parameters; constants.py shows it. What is felt is kept in the folder of --keep,
and recordings are downloaded into that of --files. A run that was stopped continues. Needs Python 3.11 and NumPy. Status: 0, or 2 on an
error.
"""

import argparse
import concurrent.futures
import os
import pathlib
import re
import sys
import tempfile

try:
    import numpy as np
    import tomllib
except ModuleNotFoundError:
    sys.exit("influence: needs Python 3.11 and NumPy")

import boxes
import constants
import recordings
from estimated import ROOT, TRUTH, downloaded, estimated, noisy, resumed, revision, run

COLUMNS = ["parameter", "value", "data", "recording", *TRUTH, "revision"]
FACTORS = [0.5, 2.0]
# All are calibration data (seeds.toml, recordings.toml). Bodies of seven parts at most move with one seed.
SEED, BODIES = 37, ["arm", "chain-3", "chain-6", "fork", "star", "tee", "y"]
MOVED = "physics = {{ step = 0.02, duration = {duration} }}\nmotion = {{ coordination = {p}, epoch = 250 }}\n"
# Name, p, seconds, noise as a share of the root mean square of each sensor, and bodies.
MOVEMENTS = [
    ("100 s, p = 0", 0.0, 100.0, 0.0, BODIES),
    ("1,000 s, p = 0.5", 0.5, 1000.0, 0.0, BODIES),
    ("1,000 s, p = 0.5, noise of a tenth", 0.5, 1000.0, 0.1, ["arm", "star", "tee"]),
]
ROBOTS, BOXES = "robots of boxes", ["102", "104"]
RECORDED = "recorded movements of people"
RECORDINGS = ["bye-sad-1", "guide-musical-1", "punch-normal-1", "walk-elderly-2", "wave-left-hand-feminine-10"]


def main():
    parser = argparse.ArgumentParser(description="Estimate with each parameter halved and doubled.")
    names = [name for name, _, _ in constants.settable()]
    parser.add_argument("--only", choices=names, help="only this parameter, and the defaults; other rows stay as they are")
    parser.add_argument("--files", type=pathlib.Path, default=ROOT / "results" / "recordings", help="folder of the .bvh files")
    parser.add_argument("--keep", type=pathlib.Path, default=ROOT / "results" / "influence", help="folder of what is felt")
    parser.add_argument("--out", type=pathlib.Path, default=constants.PAGE.parent, help="folder to write to")
    arguments = parser.parse_args()
    arguments.out.mkdir(parents=True, exist_ok=True)
    felt = everything_felt(arguments.files, arguments.keep)
    jobs = [{"parameter": "", "value": ""}]
    for name, value, _ in constants.settable():
        if name == (arguments.only or name):
            jobs += [{"parameter": name, "value": f"{changed(value, factor):g}"} for factor in FACTORS]
    # A recording for each core takes less time than all cores for each.
    os.environ["RAYON_NUM_THREADS"] = "1"
    current = revision()
    jobs = [{**job, "revision": current} for job in jobs]
    stays = lambda row: row["revision"] == current
    order = lambda row: ["", *names].index(row["parameter"])
    resumed(arguments.out / "influence.csv", COLUMNS, jobs, lambda **job: measured(job, felt), stays, order)
    return 0


def changed(value, factor):
    """A value times a factor; a whole number stays one, rounded half up."""
    product = float(value) * factor
    return product if set(value) & set(".e") else int(product + 0.5)


def measured(job, felt):
    """What comes out of each recording, with a parameter changed: a row each."""
    words = [f"--parameter={job['parameter']}={job['value']}"] if job["parameter"] else []

    def row(one):
        data, name, folder = one
        with tempfile.TemporaryDirectory() as found:
            _, truth = estimated(folder, pathlib.Path(found), 1, *words)
        return {**job, "data": data, "recording": name, **truth}

    with concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        return list(pool.map(row, felt))


def everything_felt(files, keep):
    """All recordings: the data that each is of, its name, and its folder. What is not there yet is simulated."""
    design = tomllib.loads((ROOT / "reproduce" / "recordings.toml").read_text())
    sources = {one["name"]: one for one in design["recording"]}
    found = []

    def felt(data, name, made):
        folder = keep / re.sub("[^a-z0-9.]+", "-", data) / name
        if not folder.exists():
            folder.parent.mkdir(parents=True, exist_ok=True)
            made(folder.with_suffix(".toml"), folder.with_suffix(".part"))
            folder.with_suffix(".part").rename(folder)
        found.append((data, name, folder))

    for data, p, duration, noise, bodies in MOVEMENTS:
        for body in bodies:
            def moved(settings, to):
                settings.write_text(MOVED.format(duration=duration, p=p))
                run("simulate", "--body", ROOT / "bodies" / f"{body}.toml", "--settings", settings, "--seed", SEED, "--out", to)
                if noise > 0:
                    touch = noisy(np.load(to / "tactile.npy"), noise, np.random.default_rng(SEED))
                    np.save(to / "tactile.npy", touch.astype(np.float32))
            felt(data, body, moved)
    for seed in BOXES:
        felt(ROBOTS, seed, lambda body, to: boxes.feel(int(seed), body, body.with_suffix(".settings"), to))
    for name in RECORDINGS:
        file = downloaded(files / f"{name}.bvh", sources[name]["url"], sources[name]["sha256"])
        felt(RECORDED, name, lambda body, to: recordings.feel(file, design, body, to))
    return found


if __name__ == "__main__":
    sys.exit(main())
