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


def omega_squared(levels, y, source):
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
    error = with_it / (len(y) - rank)
    return max((without - with_it - (rank - rank_without) * error) / (total + error), 0.0)


def main():
    rng = np.random.default_rng(15)
    n, counts = 120, [3, 2, 4]
    levels = [rng.integers(0, k, n).tolist() for k in counts]
    a, b, c = (np.array(one) for one in levels)
    y = 0.5 * a + np.where(b == 1, 1.0, 0.0) * np.where(c == 2, 1.5, 0.0) + rng.normal(size=n)
    clusters = (np.arange(n) // 10).tolist()
    sources = [[0], [1], [2], [0, 1], [0, 2], [1, 2]]
    shares = []
    for source in sources:
        value = omega_squared(levels, y, source)
        out = []
        for cluster in sorted(set(clusters)):
            keep = np.array(clusters) != cluster
            out.append(omega_squared([np.array(one)[keep].tolist() for one in levels], y[keep], source))
        out = np.array(out)
        m = len(out)
        half = 1.96 * np.sqrt((m - 1) / m * ((out - out.mean()) ** 2).sum())
        shares.append([value, max(value - half, 0.0), min(value + half, 1.0)])
    table = {"values": y.tolist(), "clusters": clusters, "levels": levels, "shares": shares}
    path = os.path.join(os.path.dirname(os.path.abspath(__file__)), "variance.json")
    with open(path, "w") as file:
        json.dump(table, file)


if __name__ == "__main__":
    main()
