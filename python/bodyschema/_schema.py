"""Sample body schemas from the posterior of the DPGMM-LJ, the paper's method, or of the DPGMM."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _bodyschema
from ._arguments import Progress, RandomState, Settings, count_of, jobs_of, matrix_of, progress_of, seed_of, toml_of

CHAINS = 100


@dataclass(frozen=True, eq=False, repr=False)
class Posterior:
    """Posterior samples of the parts of n sensors and of their tree; what `dpgmm_lj` and `dpgmm` return.

    Attributes
    ----------
    labels : ndarray of shape (samples, n), int32
        The component of each sensor, 0 to K − 1. The numbers mean nothing beyond a sample.
    log_posterior : ndarray of shape (samples,), float64
        log p(x, z) of each sample.
    trees : list of ndarray of shape (edges, 2), int64
        Of each sample, the joints as (child, parent) components. Components of a single sensor are in no tree.
    joints : list of ndarray of shape (edges, d), float64
        Of each sample, where its joints are on the body map; of shape (0, d) for a DPGMM, which has none.
    chain, sweep : ndarray of shape (samples,), int64
        The chain of each sample, from 0, and the sweep after which it was kept, from 1.
    best : int
        The sample of highest log posterior.
    """

    labels: np.ndarray
    log_posterior: np.ndarray
    trees: list[np.ndarray]
    joints: list[np.ndarray]
    chain: np.ndarray
    sweep: np.ndarray
    best: int

    def __repr__(self) -> str:
        return f"<Posterior: {self.labels.shape[0]} samples of {self.labels.shape[1]} sensors>"

    @property
    def n_parts(self) -> np.ndarray:
        """Number of parts of each sample, shape (samples,), int64: components of more than one sensor."""
        return np.array([(np.bincount(labels) > 1).sum() for labels in self.labels], dtype=np.int64)


def dpgmm_lj(
    X: Any,
    *,
    n_components: Optional[int] = None,
    n_chains: Optional[int] = None,
    n_sweeps: Optional[int] = None,
    settings: Settings = None,
    random_state: RandomState = None,
    n_jobs: Optional[int] = -1,
    progress: Progress = None,
) -> Posterior:
    """Sample body schemas from the posterior of a Dirichlet process Gaussian mixture with latent joints (stage 6; section 3).

    Parameters
    ----------
    X : array-like of shape (n, d)
        Coordinates of n sensors on a body map of d dimensions, such as those of `body_map`; n > d.
    n_components : int, optional
        K, the number of components of the weak-limit approximation; 10 by default.
    n_chains : int, optional
        Independent chains; 100 by default, each of which gives one sample.
    n_sweeps : int, optional
        Gibbs sweeps of each chain; 300 by default.
    settings : mapping of mappings, optional
        Other settings, in the section "schema" of reproduce/paper.toml, such as ``{"schema": {"sampler": "authors-code"}}``. The
        arguments above count more.
    random_state : int, NumPy generator or None
        Master seed, from 0 to 2**64 − 1. None is `bodyschema.SEED`.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one. The result does not depend on it.
    progress : bool, callable or None
        As for `estimate`; the steps are chains.

    Returns
    -------
    Posterior
        The samples, ordered by chain and sweep.

    Raises
    ------
    ValueError
        If the points span fewer than d dimensions, or an argument is out of range.

    Notes
    -----
    It is `bodyschema infer --model dpgmm-lj` of the command line. docs/method.md has the equations.

    Examples
    --------
    >>> import numpy as np, bodyschema
    >>> points = np.random.default_rng(0).normal(size=(20, 2)) + np.repeat([[0, 0], [9, 9]], 10, axis=0)
    >>> bodyschema.dpgmm_lj(points, n_chains=4, n_sweeps=20)
    <Posterior: 4 samples of 20 sensors>
    """
    return _infer(X, True, n_components, n_chains, n_sweeps, settings, random_state, n_jobs, progress)


def dpgmm(
    X: Any,
    *,
    n_components: Optional[int] = None,
    n_chains: Optional[int] = None,
    n_sweeps: Optional[int] = None,
    settings: Settings = None,
    random_state: RandomState = None,
    n_jobs: Optional[int] = -1,
    progress: Progress = None,
) -> Posterior:
    """Sample parts from the posterior of a Dirichlet process Gaussian mixture; Prim's algorithm makes a tree afterwards.

    It is the paper's baseline, `bodyschema infer --model dpgmm` of the command line. Parameters, returned value and errors are those
    of `dpgmm_lj`.
    """
    return _infer(X, False, n_components, n_chains, n_sweeps, settings, random_state, n_jobs, progress)


def _infer(
    X: Any,
    latent_joints: bool,
    n_components: Optional[int],
    n_chains: Optional[int],
    n_sweeps: Optional[int],
    settings: Settings,
    random_state: RandomState,
    n_jobs: Optional[int],
    progress: Progress,
) -> Posterior:
    points = matrix_of(X, "X", "a row for each sensor, a column for each dimension").astype(np.float64, copy=False)
    given = {"components": n_components, "chains": n_chains, "sweeps": n_sweeps}
    own = {name: count_of(value, f"n_{name}") for name, value in given.items() if value is not None}
    text = toml_of(settings, {"schema": own})
    chains = own.get("chains", ((settings or {}).get("schema") or {}).get("chains", CHAINS))
    with progress_of(progress, chains if isinstance(chains, int) else 0, "chains") as tell:
        facts = _bodyschema.infer(points, latent_joints, text, seed_of(random_state), jobs_of(n_jobs), tell)
    return Posterior(**facts)
