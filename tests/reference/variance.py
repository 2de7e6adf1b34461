"""Shares of variance by factor and by pair, for tests of `analysis::variance`: writes variance.json.

Written from the textbook (Hays 1963; type II sums of squares), by least squares with an explicit model matrix, and not from
the Rust code. Needs NumPy.
"""

import json
import os

import numpy as np


def model(levels, factors, pair=None):
    n = len(levels[0])
    columns = [np.ones(n)]

    def dummies(factor):
        codes = np.array(levels[factor])
        return [(codes == level).astype(float) for level in range(1, codes.max() + 1)]

    for factor in factors:
        columns += dummies(factor)
    if pair:
        columns += [a * b for a in dummies(pair[0]) for b in dummies(pair[1])]
    return np.stack(columns, axis=1)


def residual(matrix, y):
    rank = np.linalg.matrix_rank(matrix, tol=1e-8)
    fitted = matrix @ np.linalg.pinv(matrix, rcond=1e-10) @ y
    return ((y - fitted) ** 2).sum(), rank


def chance(levels, units, fitted_residuals, source):
    """Mean square between the units of a source, or None if every number is a unit."""
    own = max((units[f] for f in source), key=lambda one: len(set(one)))
    many = len(set(own))
    if many == len(own):
        return None
    own = np.array(own)
    between = sum(fitted_residuals[own == unit].sum() ** 2 / (own == unit).sum() for unit in sorted(set(own)))
    taken = sum(max(level) for level, unit in zip(levels, units) if len(set(unit)) <= many)
    return between / (many - taken - 1)


def omega_squared(levels, units, y, source):
    everything = range(len(levels))
    if len(source) == 1:
        full = model(levels, everything)
        reduced = model(levels, [f for f in everything if f != source[0]])
    else:
        full = model(levels, everything, source)
        reduced = model(levels, everything)
    total = ((y - y.mean()) ** 2).sum()
    with_it, rank = residual(full, y)
    without, rank_without = residual(reduced, y)
    left = y - full @ np.linalg.pinv(full, rcond=1e-10) @ y
    error = with_it / (len(y) - rank)
    by_chance = chance(levels, units, left, source)
    by_chance = error if by_chance is None else by_chance
    return (without - with_it - (rank - rank_without) * by_chance) / (total + error)


def main():
    rng = np.random.default_rng(15)
    # Twelve movements of two matrices of distances of five numbers each.
    n = 120
    clusters = (np.arange(n) // 10).tolist()
    felt = (np.arange(n) // 5).tolist()
    units = [clusters, felt, list(range(n))]
    levels = [(np.array(clusters) % 3).tolist(), rng.integers(0, 2, 24)[felt].tolist(), rng.integers(0, 4, n).tolist()]
    a, b, c = (np.array(one) for one in levels)
    y = 1.2 * a + 0.8 * b + np.where(b == 1, 1.0, 0.0) * np.where(c == 2, 2.5, 0.0) + rng.normal(size=n)
    y += 0.7 * rng.normal(size=12)[clusters] + 0.3 * rng.normal(size=24)[felt]
    sources = [[0], [1], [2], [0, 1], [0, 2], [1, 2]]
    shares = []
    for source in sources:
        value = omega_squared(levels, units, y, source)
        out = []
        for cluster in sorted(set(clusters)):
            keep = np.array(clusters) != cluster
            some = [[np.array(one)[keep].tolist() for one in all_] for all_ in (levels, units)]
            out.append(omega_squared(*some, y[keep], source))
        out = np.array(out)
        m = len(out)
        half = 1.96 * np.sqrt((m - 1) / m * ((out - out.mean()) ** 2).sum())
        shares.append([max(value, 0.0), np.clip(value - half, 0.0, 1.0), np.clip(value + half, 0.0, 1.0)])
    table = {"values": y.tolist(), "clusters": clusters, "units": units, "levels": levels, "shares": shares}
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "variance.json")
    with open(path, "w") as file:
        json.dump(table, file)


if __name__ == "__main__":
    main()
