"""The clusterings of the paper as estimators of scikit-learn, which must be installed: ``pip install 'bodyschema[sklearn]'``.

`DPGMMLJ` finds the number of clusters and the tree between them, `DPGMM` the number of clusters. `Ward`, `KMeans` and
`GaussianMixture` are the methods that the paper compares them with, and are given the number. Each has `fit`, `fit_predict` and
`labels_`, can be cloned and pickled, and passes scikit-learn's `check_estimator`.
"""

from __future__ import annotations

from typing import Any, Optional

import numpy as np

from . import _bodyschema
from ._arguments import RandomState, Settings, count_of, jobs_of, seed_of
from ._schema import _infer

try:
    from sklearn.base import BaseEstimator, ClusterMixin
except ImportError:
    raise ImportError("bodyschema.cluster needs scikit-learn: pip install 'bodyschema[sklearn]'") from None

__all__ = ["DPGMM", "DPGMMLJ", "GaussianMixture", "KMeans", "Ward"]


class _Clustering(ClusterMixin, BaseEstimator):
    """What all have in common."""

    def _points(self, X: Any) -> np.ndarray:
        try:
            from sklearn.utils.validation import validate_data
        except ImportError:  # before scikit-learn 1.6
            validate_data = type(self)._validate_data
        points: np.ndarray = validate_data(self, X, dtype=np.float64, ensure_min_samples=2)
        return points


class _Mixture(_Clustering):
    _latent_joints = True

    def __init__(
        self,
        n_components: int = 10,
        *,
        n_chains: int = 100,
        n_sweeps: int = 300,
        settings: Settings = None,
        random_state: RandomState = None,
        n_jobs: Optional[int] = -1,
    ) -> None:
        self.n_components = n_components
        self.n_chains = n_chains
        self.n_sweeps = n_sweeps
        self.settings = settings
        self.random_state = random_state
        self.n_jobs = n_jobs

    def fit(self, X: Any, y: Any = None) -> _Mixture:
        """Sample parts and trees, and keep the sample of highest log posterior.

        Parameters
        ----------
        X : array-like of shape (n, d)
            Coordinates of n sensors on a body map; n > d.
        y : None
            Not used.

        Returns
        -------
        self
        """
        points = self._points(X)
        posterior = _infer(
            points,
            self._latent_joints,
            self.n_components,
            self.n_chains,
            self.n_sweeps,
            self.settings,
            self.random_state,
            self.n_jobs,
            False,
        )
        at = posterior.best
        names, self.labels_ = _by_appearance(posterior.labels[at])
        self.tree_ = np.array([[names[end] for end in edge] for edge in posterior.trees[at].tolist()], dtype=np.int64).reshape(-1, 2)
        self.joints_ = posterior.joints[at]
        self.log_posterior_ = float(posterior.log_posterior[at])
        self.posterior_ = posterior
        return self


class DPGMMLJ(_Mixture):
    """Dirichlet process Gaussian mixture with latent joints, by Gibbs sampling: clusters, and the tree between them.

    Parameters
    ----------
    n_components : int, default 10
        K, the number of components of the weak-limit approximation: the most clusters that are found.
    n_chains : int, default 100
        Independent chains.
    n_sweeps : int, default 300
        Gibbs sweeps of each chain.
    settings : mapping of mappings, optional
        Other settings, as for `bodyschema.dpgmm_lj`.
    random_state : int, NumPy generator or None
        Seed. None is `bodyschema.SEED`, so that results are always the same.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one. The result does not depend on it.

    Attributes
    ----------
    labels_ : ndarray of shape (n,), int64
        Cluster of each point in the sample of highest log posterior, 0, 1, … in order of appearance.
    tree_ : ndarray of shape (edges, 2), int64
        The tree of that sample, as (child, parent) clusters. Clusters of a single point are in no tree.
    joints_ : ndarray of shape (edges, d), float64
        Where its joints are.
    log_posterior_ : float
        Its log posterior.
    posterior_ : Posterior
        All samples.
    n_features_in_ : int
        d.

    Notes
    -----
    Mimura, Hagiwara, Taniguchi and Inamura (2017), section 3; docs/method.md has the equations.

    Examples
    --------
    >>> import numpy as np
    >>> from bodyschema.cluster import DPGMMLJ
    >>> points = np.random.default_rng(0).normal(size=(20, 2)) + np.repeat([[0, 0], [9, 9]], 10, axis=0)
    >>> DPGMMLJ(n_chains=4, n_sweeps=50).fit(points).tree_
    array([[0, 1]])
    """


class DPGMM(_Mixture):
    """Dirichlet process Gaussian mixture, by Gibbs sampling; Prim's algorithm makes a tree afterwards. The paper's baseline.

    Parameters and attributes are those of `DPGMMLJ`, but `joints_` is empty.
    """

    _latent_joints = False


class _Given(_Clustering):
    _method: str

    def _cluster(self, X: Any, restarts: int) -> np.ndarray:
        points = self._points(X)
        clusters = count_of(self.n_clusters, "n_clusters")
        if clusters > len(points):
            raise ValueError(f"n_clusters is {clusters}, but there are n_samples={len(points)} only")
        seed = seed_of(getattr(self, "random_state", None))
        jobs = jobs_of(getattr(self, "n_jobs", 1))
        return _by_appearance(_bodyschema.cluster(points, self._method, clusters, restarts, seed, jobs))[1]


class _Started(_Given):
    def __init__(self, n_clusters: int = 5, *, n_init: int = 10, random_state: RandomState = None, n_jobs: Optional[int] = -1) -> None:
        self.n_clusters = n_clusters
        self.n_init = n_init
        self.random_state = random_state
        self.n_jobs = n_jobs

    def fit(self, X: Any, y: Any = None) -> _Started:
        """Cluster the rows of `X`, an array-like of shape (n, d); `y` is not used."""
        self.labels_ = self._cluster(X, count_of(self.n_init, "n_init"))
        return self


class KMeans(_Started):
    """k-means: the least sum of squares that Lloyd's algorithm finds from k-means++ starts.

    Parameters
    ----------
    n_clusters : int, default 5
        K.
    n_init : int, default 10
        Starts, of which the best is kept.
    random_state : int, NumPy generator or None
        Seed. None is `bodyschema.SEED`, so that results are always the same.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one.

    Attributes
    ----------
    labels_ : ndarray of shape (n,), int64
        Cluster of each point, 0, 1, … in order of appearance. Points that coincide share one.
    n_features_in_ : int
        d.
    """

    _method = "k-means"


class GaussianMixture(_Started):
    """Gaussian mixture with full covariances: the greatest likelihood that expectation–maximisation finds from k-means.

    Parameters and attributes are those of `KMeans`. It may find fewer than `n_clusters` clusters.
    """

    _method = "gmm"


class Ward(_Given):
    """Ward's method: merges the two clusters whose union adds least to the sum of squares.

    Parameters
    ----------
    n_clusters : int, default 5
        K.

    Attributes
    ----------
    labels_ : ndarray of shape (n,), int64
        Cluster of each point, 0, 1, … in order of appearance.
    n_features_in_ : int
        d.
    """

    _method = "ward"

    def __init__(self, n_clusters: int = 5) -> None:
        self.n_clusters = n_clusters

    def fit(self, X: Any, y: Any = None) -> Ward:
        """Cluster the rows of `X`, an array-like of shape (n, d); `y` is not used."""
        self.labels_ = self._cluster(X, 1)
        return self


def _by_appearance(labels: np.ndarray) -> tuple[dict[int, int], np.ndarray]:
    """Labels numbered 0, 1, … in order of appearance, and the new name of each old one."""
    names: dict[int, int] = {}
    new = [names.setdefault(label, len(names)) for label in labels.tolist()]
    return names, np.array(new, dtype=np.int64)
