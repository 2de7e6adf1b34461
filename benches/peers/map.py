"""Distances -> the time to a body map, in seconds, of NumPy's full and SciPy's partial decomposition, and of
scikit-learn's majorisation.

Run: pip install numpy==2.4.6 scipy==1.17.1 scikit-learn==1.9.1
     python benches/peers/map.py [sensors]
"""

import statistics
import sys
import time

import numpy as np
import scipy.linalg
import scipy.sparse.linalg
import scipy.spatial.distance

DIMS = 15


def distances(sensors):
    """The same kind of distances as benches/map.rs: city block, between points of 30 dimensions."""
    spread = 1 / (1 + np.arange(30) / 5)
    points = np.random.default_rng(1).uniform(-1, 1, (sensors, 30)) * spread
    return scipy.spatial.distance.squareform(scipy.spatial.distance.pdist(points, "cityblock"))


def centred(distances):
    squares = distances**2
    means = squares.mean(axis=0)
    return -0.5 * (squares - means - means[:, None] + means.mean())


def eigh(distances):
    """All eigenvalues and eigenvectors, of which the map needs the last."""
    start = time.perf_counter()
    values, vectors = np.linalg.eigh(centred(distances))
    vectors[:, : -DIMS - 1 : -1] * np.sqrt(values[: -DIMS - 1 : -1])
    return time.perf_counter() - start


def dsyevr(distances):
    """The largest eigenvalues by LAPACK's dsyevr."""
    start = time.perf_counter()
    ends = [len(distances) - DIMS, len(distances) - 1]
    values, vectors = scipy.linalg.eigh(centred(distances), subset_by_index=ends, driver="evr")
    vectors[:, ::-1] * np.sqrt(values[::-1])
    return time.perf_counter() - start


def eigsh(distances):
    """The largest eigenvalues by ARPACK."""
    start = time.perf_counter()
    values, vectors = scipy.sparse.linalg.eigsh(centred(distances), k=DIMS, which="LA")
    vectors[:, ::-1] * np.sqrt(values[::-1])
    return time.perf_counter() - start


def smacof(distances):
    """300 steps of majorisation from one random start, in 14 dimensions."""
    import sklearn.manifold

    start = time.perf_counter()
    sklearn.manifold.smacof(
        distances, n_components=14, n_init=1, max_iter=300, eps=0, random_state=1, normalized_stress=False, init=None
    )
    return time.perf_counter() - start


def nonmetric(distances):
    """30 nonmetric steps from one random start, in 14 dimensions."""
    import sklearn.manifold

    start = time.perf_counter()
    sklearn.manifold.smacof(
        distances, metric=False, n_components=14, n_init=1, max_iter=30, eps=0, random_state=1, normalized_stress=False,
        init=None,
    )
    return time.perf_counter() - start


if __name__ == "__main__":
    sensors = int(sys.argv[1]) if len(sys.argv) > 1 else 840
    matrix = distances(sensors)
    for peer in [eigh, dsyevr, eigsh] if sensors <= 2_000 else [eigsh]:
        times = [peer(matrix) for _ in range(11 if sensors <= 2_000 else 1)]
        print(f"{peer.__name__}: {1e3 * statistics.median(times):.1f} ms ({sensors} sensors to {DIMS} dimensions)")
    print(f"smacof: {1e3 * smacof(matrix):.1f} ms (300 steps, {sensors} sensors to 14 dimensions)")
