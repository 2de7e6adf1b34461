"""Pressures -> the parts. Who knows their number might write this in NumPy and scikit-learn, in place of `bodyschema estimate`.

Run: pip install -r benches/peers/requirements.txt
     python benches/peers/estimate.py TACTILE.npy LABELS.csv

Prints the adjusted Rand index of what it finds. It does not estimate the tree.
"""

import sys

import numpy as np
import sklearn.cluster
import sklearn.metrics

SEARCHED, ITERATIONS, MOMENTUM = 1500, 150, 0.9


def completed(roots, rank):
    """Coordinates of the sensors in the matrix of low rank whose positive part the roots are: decomposition with the ReLU function (Saul
    2022), by plain iterations with momentum (Seraghiti et al. 2023)."""
    felt = roots > 0
    low = before = roots
    for _ in range(ITERATIONS):
        ahead = low + MOMENTUM * (low - before)
        filled = np.where(felt, roots, np.minimum(ahead, 0))
        # All vectors, in parallel, take less time than the last ones alone by scipy.linalg.eigh.
        right = np.linalg.eigh(filled.T @ filled)[1][:, -rank:]
        before, low = low, filled @ right @ right.T
    return right


def parts(tactile, number):
    """The part of each sensor: spectral clustering of the shape interaction matrix (Costeira and Kanade 1998), of rank 6 for a part."""
    touch = np.load(tactile, mmap_mode="r")
    roots = np.sqrt(touch[:: max(1, len(touch) // SEARCHED)][:SEARCHED].astype(float))
    roots /= np.sqrt((roots**2).mean(axis=0)) + 1e-12
    coordinates = completed(roots, 6 * number)
    coordinates /= np.linalg.norm(coordinates, axis=1, keepdims=True)
    affinity = np.abs(coordinates @ coordinates.T)
    return sklearn.cluster.SpectralClustering(number, affinity="precomputed", random_state=1).fit_predict(affinity)


if __name__ == "__main__":
    truth = np.loadtxt(sys.argv[2], delimiter=",", skiprows=1, dtype=int)[:, 1]
    found = parts(sys.argv[1], len(set(truth)))
    print(f"{sklearn.metrics.adjusted_rand_score(truth, found):.3f}")
