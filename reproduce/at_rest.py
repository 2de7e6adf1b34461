#!/usr/bin/env python3
"""Measure spurious touch: what a body feels while all of its joints are locked. Usage: reproduce/at_rest.py FOLDER...

Each FOLDER is one that `bodyschema simulate --out FOLDER` wrote. With one-way fluid coupling, no force acts on the body from
outside. It starts at rest, and with all joints locked it should stay at rest and feel nothing; what it does feel comes from the
engine's angular drift. With two-way coupling, it glides on. Prints a line of CSV for each folder:

- locked: share of the samples at which no joint rotates faster than 0.001 rad/s;
- turn_locked, turn_else: median angular speed of part 0, rad/s, at those samples and at all others;
- touch_locked, touch_else: median over samples of the mean square root of the pressures, √Pa;
- change: relative difference of the square roots of all pressures from those of the first folder, as the median over samples.
  It shows whether two ways to compute one movement agree.

Needs NumPy.
"""

import pathlib
import sys

import numpy

STILL = 1e-3  # rad/s


def main(folders):
    if not folders:
        sys.exit(__doc__.strip())
    print("folder,locked,turn_locked,turn_else,touch_locked,touch_else,change")
    first = roots(folders[0])
    for folder in folders:
        numbers = [*at_rest(pathlib.Path(folder)), change(first, roots(folder))]
        print(",".join([folder, *("" if number is None else f"{number:.3g}" for number in numbers)]))


def roots(folder):
    return numpy.sqrt(numpy.load(pathlib.Path(folder) / "tactile.npy"))


def change(first, other):
    """None if they do not have the same samples and sensors."""
    if first.shape != other.shape:
        return None
    felt = first.sum(axis=1)
    return numpy.median(numpy.abs(first - other).sum(axis=1)[felt > 0] / felt[felt > 0]) if felt.any() else None


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
    touch = roots(folder).mean(axis=1)
    median = lambda series, where: numpy.median(series[where]) if where.any() else None
    return [locked.mean(), *(median(series, where) for series in (turn, touch) for where in (locked, ~locked))]


if __name__ == "__main__":
    main(sys.argv[1:])
