#!/usr/bin/env python3
"""What a body feels while all of its joints are locked: reproduce/at_rest.py FOLDER...

Each FOLDER is what `bodyschema simulate --out FOLDER` wrote. Nothing acts on the body from outside and it starts at rest, so
with all joints locked it should rest, too, and feel nothing. Prints a line of CSV for each folder:

- locked: share of the samples at which no joint turns by more than 0.001 rad/s;
- turn_locked, turn_else: median rate at which part 0 turns, rad/s, at those samples and at all others;
- touch_locked, touch_else: median over samples of the mean root of the pressures, √Pa.

Needs NumPy.
"""

import pathlib
import sys

import numpy

STILL = 1e-3  # rad/s


def main(folders):
    if not folders:
        sys.exit(__doc__.strip())
    print("folder,locked,turn_locked,turn_else,touch_locked,touch_else")
    for folder in folders:
        print(",".join([folder, *("" if number is None else f"{number:.3g}" for number in at_rest(pathlib.Path(folder)))]))


def at_rest(folder):
    table = numpy.loadtxt(folder / "joint-angles.csv", delimiter=",", skiprows=1)
    interval = table[1, 0] - table[0, 0]
    change = numpy.diff(table[:, 1:], axis=0)
    rates = numpy.abs((change + numpy.pi) % (2 * numpy.pi) - numpy.pi) / interval
    locked = rates.max(axis=1) < STILL
    # Of a quaternion and its negative, which are one rotation, the nearer one counts.
    turned = numpy.load(folder / "poses.npy").astype(float)[:, 3:7]
    steps = [numpy.linalg.norm(turned[1:] - sign * turned[:-1], axis=1) for sign in (1, -1)]
    turn = 2 * numpy.minimum(*steps) / interval
    touch = numpy.sqrt(numpy.load(folder / "tactile.npy")).mean(axis=1)
    median = lambda series, where: numpy.median(series[where]) if where.any() else None
    return [locked.mean(), *(median(series, where) for series in (turn, touch) for where in (locked, ~locked))]


if __name__ == "__main__":
    main(sys.argv[1:])
