"""The stages of the paper between touch and the mixture: symbols, distances, body maps; and the comparison with the truth."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _bodyschema
from ._arguments import RandomState, Settings, count_of, edges_of, jobs_of, labels_of, matrix_of, number_of, seed_of, toml_of


def quantise(touch: Any, levels: int = 8, scheme: str = "pooled", *, n_jobs: Optional[int] = -1) -> np.ndarray:
    """Turn pressures into symbols (stage 3; section 4.1 of the paper).

    Parameters
    ----------
    touch : array-like of shape (T, M)
        Pressures of M sensors at T samples, any unit; finite and not negative.
    levels : int, default 8
        N, the number of levels, 2 to 256. Level 0 is no pressure.
    scheme : {"pooled", "per-sensor", "equal-width"}, default "pooled"
        "pooled" and "per-sensor" put equally many positive values into each level, over all sensors or for each by itself;
        "equal-width" makes all levels equally wide.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one.

    Returns
    -------
    ndarray of shape (T, M), uint8
        Symbols, 0 to N − 1.

    Raises
    ------
    ValueError
        If a pressure is negative or not finite, or an argument is out of range.

    Examples
    --------
    >>> import bodyschema
    >>> bodyschema.quantise([[0.0], [1.0], [2.0], [3.0]], levels=4).ravel()
    array([0, 1, 2, 3], dtype=uint8)
    """
    array = matrix_of(touch, "touch", "a row for each sample, a column for each sensor")
    changes = toml_of({"quantise": {"levels": count_of(levels, "levels", 2), "scheme": scheme}})
    return _bodyschema.quantise(array, changes, jobs_of(n_jobs))


def information_metric(symbols: Any, *, n_jobs: Optional[int] = -1) -> np.ndarray:
    """The information metric between all pairs of sensors (stage 4; equations 23 to 26 of the paper).

    Parameters
    ----------
    symbols : array-like of shape (T, M)
        Symbols of M sensors at T samples, whole numbers from 0 to 255, such as those of `quantise`.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one.

    Returns
    -------
    ndarray of shape (M, M), float64
        D(X, Y) = H(X|Y) + H(Y|X), bits; symmetric, with 0 on the diagonal.

    Raises
    ------
    ValueError
        If a symbol is no whole number from 0 to 255.

    Examples
    --------
    >>> import bodyschema
    >>> bodyschema.information_metric([[0, 0], [0, 1], [1, 0], [1, 1]])
    array([[0., 2.],
           [2., 0.]])
    """
    array = np.asarray(symbols)
    if array.dtype != np.uint8:
        array = matrix_of(symbols, "symbols", "a row for each sample, a column for each sensor")
        with np.errstate(invalid="ignore"):
            whole = array.astype(np.uint8)
        if not np.array_equal(whole, array):
            raise ValueError("symbols must be whole numbers from 0 to 255; of pressures, quantise makes them")
        array = whole
    if array.ndim != 2:
        raise ValueError(f"symbols must have two dimensions (samples, sensors), but the shape is {array.shape}")
    return _bodyschema.information_metric(np.require(array, requirements="A"), jobs_of(n_jobs))


def body_map(
    distances: Any,
    n_components: int = 14,
    *,
    method: str = "classical",
    settings: Settings = None,
    random_state: RandomState = None,
    n_jobs: Optional[int] = -1,
) -> np.ndarray:
    """Embed the sensors in d dimensions by multidimensional scaling (stage 5; section 4.1 of the paper).

    Parameters
    ----------
    distances : array-like of shape (M, M)
        Distances between sensors, any unit: finite, not negative, symmetric, with 0 on the diagonal.
    n_components : int, default 14
        d, the number of dimensions.
    method : {"classical", "smacof", "smacof-random", "nonmetric"}, default "classical"
        Torgerson's classical scaling, metric scaling by SMACOF from the classical map or from random ones, or nonmetric scaling.
    settings : mapping of mappings, optional
        Other settings, in the section "map" of reproduce/paper.toml. `method` counts more.
    random_state : int, NumPy generator or None
        Seed of the random starts of "smacof-random". None is `bodyschema.SEED`.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one.

    Returns
    -------
    ndarray of shape (M, d), float64
        Coordinates, in the unit of the distances. Columns of a classical map are ordered by descending eigenvalue.

    Raises
    ------
    ValueError
        If `distances` are none, or span fewer than d dimensions.

    Examples
    --------
    >>> import bodyschema
    >>> abs(bodyschema.body_map([[0.0, 2.0], [2.0, 0.0]], 1)).ravel()
    array([1., 1.])
    """
    array = matrix_of(distances, "distances", "a row and a column for each sensor").astype(np.float64, copy=False)
    changes = toml_of(settings, {"map": {"method": method}})
    return _bodyschema.body_map(array, count_of(n_components, "n_components"), changes, seed_of(random_state), jobs_of(n_jobs))


@dataclass(frozen=True)
class Score:
    """How good estimated parts and their tree are.

    Attributes
    ----------
    ari : float
        Adjusted Rand index of the parts, at most 1.
    eligible : bool
        Whether the parts are right, so that the tree counts for the tree accuracy.
    tree_correct : bool
        Whether the tree is the true one, each estimated part being the true part of most of its sensors.
    """

    ari: float
    eligible: bool
    tree_correct: bool


def score(labels: Any, tree: Any, true_labels: Any, true_tree: Any, *, eligible_ari: float = 1.0) -> Score:
    """Compare estimated parts and their tree with the truth (stage 7; section 5.2 of the paper).

    Parameters
    ----------
    labels, true_labels : array-like of shape (M,), int
        The estimated and the true part of each sensor, at least 0.
    tree, true_tree : array-like of shape (edges, 2), int
        The estimated and the true joints, as pairs of parts in any order.
    eligible_ari : float, default 1.0
        Least adjusted Rand index of an eligible estimate.

    Returns
    -------
    Score

    Raises
    ------
    ValueError
        If there is not one label for each sensor.

    Examples
    --------
    >>> import bodyschema
    >>> bodyschema.score([5, 5, 7, 7], [(5, 7)], [0, 0, 1, 1], [(1, 0)])
    Score(ari=1.0, eligible=True, tree_correct=True)
    """
    own, true = labels_of(labels, "labels", 0), labels_of(true_labels, "true_labels", 0)
    edges = edges_of(tree, "tree"), edges_of(true_tree, "true_tree")
    return Score(*_bodyschema.score(own.tolist(), edges[0], true.tolist(), edges[1], number_of(eligible_ari, "eligible_ari")))
