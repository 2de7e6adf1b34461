"""Points of five parts -> the time of one Gibbs sweep in plain NumPy and SciPy, and of one iteration of
scikit-learn's variational mixture, in seconds on one core.

Run: pip install -r benches/peers/requirements.txt
     OMP_NUM_THREADS=1 python benches/peers/schema.py
"""

import time
import warnings

import numpy as np
import scipy.stats
import sklearn.mixture

N, DIMS, K, ACTIVE = 840, 14, 10, 5


def points(seed=1):
    """Parts of 168 points, far enough from each other that five components stay active."""
    rng = np.random.default_rng(seed)
    centres = rng.normal(size=(ACTIVE, DIMS))
    return np.repeat(centres, N // ACTIVE, axis=0) + 0.3 * rng.normal(size=(N, DIMS))


def sweep(x, labels, joints, prior, rng):
    """z, (mu, Sigma), pi, joints and tree, as src/stages/schema has them, written as one writes NumPy."""
    scale0, k0, nu0 = prior
    means, precisions, roots = [], [], []
    for k in range(K):
        own = np.vstack([x[labels == k]] + [q for edge, q in joints if k in edge])
        n = len(own)
        centre = own.mean(axis=0) if n else np.zeros(DIMS)
        scatter = (own - centre).T @ (own - centre)
        weight = k0 + n
        scale = scale0 + scatter + k0 * n / weight * np.outer(centre, centre)
        covariance = scipy.stats.invwishart.rvs(nu0 + n, scale, random_state=rng)
        means.append(rng.multivariate_normal(n * centre / weight, covariance / weight))
        precisions.append(np.linalg.inv(covariance))
        roots.append(np.linalg.cholesky(precisions[-1]))
    counts = np.bincount(labels, minlength=K)
    log_weights = np.log(rng.dirichlet(1 / K + counts) + 1e-300)
    active = [k for k in range(K) if counts[k] > 1]
    weights, drawn = {}, {}
    for i, s in enumerate(active):
        for c in active[:i]:
            precision = precisions[s] + precisions[c]
            mean = np.linalg.solve(precision, precisions[s] @ means[s] + precisions[c] @ means[c])
            q = rng.multivariate_normal(mean, np.linalg.inv(precision))
            cost = sum(
                0.5 * np.sum(((q - means[k]) @ roots[k]) ** 2) - np.log(np.diag(roots[k])).sum() for k in (s, c)
            )
            weights[c, s], drawn[c, s] = cost, q
    tree, inside = [], set(active[:1])
    while len(inside) < len(active):
        edge = min((e for e in weights if len(inside & set(e)) == 1), key=weights.get)
        tree.append((edge, drawn[edge][None]))
        inside |= set(edge)
    logs = np.stack(
        [
            log_weights[k] + np.log(np.diag(roots[k])).sum() - 0.5 * np.sum(((x - means[k]) @ roots[k]) ** 2, axis=1)
            for k in range(K)
        ]
    )
    shares = np.exp(logs - logs.max(axis=0)).cumsum(axis=0)
    labels = (shares < rng.random(N) * shares[-1]).sum(axis=0)
    return labels, tree


def numpy_seconds(sweeps=200):
    """Mean time of a sweep after burn-in."""
    x, rng = points(), np.random.default_rng(2)
    x = x - x.mean(axis=0)
    prior = np.cov(x.T) / K ** (2 / DIMS), 0.01, DIMS + 2
    labels, joints = np.repeat(np.arange(ACTIVE), N // ACTIVE), []
    for at in range(2 * sweeps):
        if at == sweeps:
            start = time.perf_counter()
        labels, joints = sweep(x, labels, joints, prior, rng)
    return (time.perf_counter() - start) / sweeps


def sklearn_seconds(iterations=200):
    """Mean time of an iteration of BayesianGaussianMixture, start and end left out."""
    x = points()

    def fit(count):
        mixture = sklearn.mixture.BayesianGaussianMixture(
            n_components=K, max_iter=count, tol=0, init_params="random", random_state=1
        )
        start = time.perf_counter()
        mixture.fit(x)
        return time.perf_counter() - start

    with warnings.catch_warnings():
        warnings.simplefilter("ignore")  # that it did not converge is meant
        return (fit(2 * iterations) - fit(iterations)) / iterations


if __name__ == "__main__":
    print(f"NumPy and SciPy: {1e3 * numpy_seconds():.2f} ms a sweep")
    print(f"scikit-learn: {1e3 * sklearn_seconds():.2f} ms an iteration")
