"""Estimate how known parts are joined."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _bodyschema, _picture
from ._arguments import RandomState, count_of, jobs_of, labels_of, seed_of
from ._reading import said_of, touch_of, warn_of_cleaning


@dataclass(frozen=True, eq=False, repr=False)
class Joints:
    """How known parts are joined: K parts, K − 1 joints.

    Attributes
    ----------
    labels : ndarray of shape (K,), int64
        The labels of the parts, rising.
    ranks : ndarray of shape (K,), int64
        Rank of the motion subspace of each part: how many of the six numbers of its velocity and angular velocity it feels. Above
        six where a face brings a motion of its own.
    tree : ndarray of shape (K − 1, 2), int64
        The joints, as (child, parent). Touch does not tell which part is the root.
    support : ndarray of shape (K − 1,), float64
        Bootstrap support of each joint, 0 to 1, given the parts.
    pairs : ndarray of shape (K (K − 1) / 2, 2), int64
        All pairs of parts.
    pair_correlation : ndarray of shape (K (K − 1) / 2,), float64
        Canonical correlation of the speed of a joint between the two parts, 0 to 1.
    pair_information : ndarray of shape (K (K − 1) / 2,), float64
        Information of a joint between the two parts, in nats. Of all trees, the estimate has the largest sum.
    pair_support : ndarray of shape (K (K − 1) / 2,), float64
        Bootstrap support of that joint, 0 to 1, given the parts.
    dropped : dict of int to str
        Sensors that were left out, and why.
    """

    labels: np.ndarray
    ranks: np.ndarray
    tree: np.ndarray
    support: np.ndarray
    pairs: np.ndarray
    pair_correlation: np.ndarray
    pair_information: np.ndarray
    pair_support: np.ndarray
    dropped: Mapping[int, str]

    def __repr__(self) -> str:
        return f"<{type(self).__name__}: {len(self.labels)} parts, {len(self.tree)} joints>"

    def __str__(self) -> str:
        names = {part: f"part {part} (motion of rank {node['rank']})" for part, node in self._nodes().items()}
        return "\n".join(_picture.text_tree(names, self.tree, self.support))

    def _nodes(self) -> dict[int, dict[str, Any]]:
        return {part: {"rank": rank} for part, rank in zip(self.labels.tolist(), self.ranks.tolist())}

    def to_networkx(self) -> Any:
        """The tree as an undirected `networkx.Graph`.

        Returns
        -------
        networkx.Graph
            A node for each part, with `rank`, and of an `Estimate` with `sensors` (list of int) and `residual` (median); an edge
            for each joint, with `support`, `correlation` and `information`.

        Raises
        ------
        ImportError
            If networkx is not installed.
        """
        try:
            import networkx
        except ImportError:
            raise ImportError("to_networkx needs networkx: pip install networkx") from None
        graph = networkx.Graph()
        graph.add_nodes_from(self._nodes().items())
        places = {frozenset(pair): at for at, pair in enumerate(self.pairs.tolist())}
        for (child, parent), support in zip(self.tree.tolist(), self.support.tolist()):
            at = places[frozenset((child, parent))]
            correlation, information = float(self.pair_correlation[at]), float(self.pair_information[at])
            graph.add_edge(child, parent, support=support, correlation=correlation, information=information)
        return graph


def estimate_tree(
    touch: Any,
    parts: Any,
    *,
    rank: Optional[int] = None,
    signed: Optional[bool] = None,
    keep_saturated: bool = False,
    random_state: RandomState = None,
    n_jobs: Optional[int] = -1,
) -> Joints:
    """Estimate how known parts are joined. Where the parts are known, prefer it to `estimate`, which may get them wrong.

    Parameters
    ----------
    touch : array-like of shape (T, M), or the path of a file
        Pressures, as for `estimate`.
    parts : array-like of shape (M,), int
        The part of each sensor, any whole number; −1 leaves a sensor out.
    rank : int, optional
        Rank of the motion subspace of each part, 1 to 6. By default the data choose one for each.
    signed, keep_saturated, random_state, n_jobs
        As for `estimate`.

    Returns
    -------
    Joints
        The tree and its bootstrap support.

    Raises
    ------
    ValueError
        If `touch` is no table of numbers, there is not a part for each sensor, or no sensor that has one feels anything.

    Notes
    -----
    It is `bodyschema tree` of the command line; docs/estimate.md has the theory.
    """
    seed, jobs = seed_of(random_state), jobs_of(n_jobs)
    array, _ = touch_of(touch)
    labels = labels_of(parts, "parts", -1)
    given = None if rank is None else count_of(rank, "rank")
    facts = _bodyschema.tree(array, labels.tolist(), given, said_of(signed, keep_saturated), seed, jobs)
    warn_of_cleaning(facts, array.shape[1])
    return Joints(**joints_of(facts, True))


def joints_of(facts: Mapping[str, Any], shows_tree: bool) -> dict[str, Any]:
    """The attributes of `Joints`, by name; without the tree, if that is not shown."""
    names = ["labels", "ranks", "pairs", "pair_correlation", "pair_information", "pair_support"]
    joints = {name: facts[name] for name in names}
    joints["tree"] = facts["tree"] if shows_tree else np.empty((0, 2), dtype=np.int64)
    joints["support"] = facts["support"] if shows_tree else np.empty(0)
    joints["dropped"] = dict(facts["dropped"])
    return joints
