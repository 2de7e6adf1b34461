"""Place estimated parts and joints on the body, where the sensors' positions are known."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Optional, Union

import numpy as np

from . import _bodyschema
from ._arguments import jobs_of, matrix_of, path_of
from ._estimate import Estimate
from ._reading import RecordingWarning, touch_of


@dataclass(frozen=True, eq=False, repr=False)
class Placement:
    """Where the parts and joints of a body are; what `place_joints` returns. K parts, K − 1 joints, lengths in m.

    Attributes
    ----------
    labels : ndarray of shape (K,), int64
        The labels of the parts, rising.
    centres, sides : ndarray of shape (K, 3), float64
        Centre and sides of a box around the sensors of each part, in the frame of its sensors.
    rotations : ndarray of shape (K, 3, 3), float64
        The rotation of each box, from its axes to those of the frame.
    explained : ndarray of shape (K,), float64
        The share of what the sensors of a part feel that a rigid motion of the given positions and normals explains, at most 1. If
        it is low, positions or normals are likely to be wrong.
    tree : ndarray of shape (K − 1, 2), int64
        The joints, as (child, parent).
    known : ndarray of shape (K − 1,), bool
        Whether touch tells the place of a joint. Otherwise it is the middle between the nearest sensors of both parts, or a guess if
        these are in different frames.
    in_parent, in_child : ndarray of shape (K − 1, 3), float64
        The place of each joint in the frame of the parent, and in that of the child.
    joint_rotations : ndarray of shape (K − 1, 3, 3), float64
        The rotation from the child's frame to the parent's: none if all sensors are in one frame, at rest.
    standard_error : ndarray of shape (K − 1,), float64
        Standard error of each place, by the jackknife over ten blocks of time, of random errors only; in different frames the larger of
        both. NaN where the place is not known.
    mismatch : ndarray of shape (K − 1,), float64
        How much the speed of a joint differs between its two parts: mean square of the difference, as a share of both mean squares;
        NaN where both motions are known at too few samples.
    notes : list of str
        What is to be known about the places.
    urdf : str
        The body as URDF: boxes, and each joint as three hinges at its place. `to_urdf` writes it.
    """

    labels: np.ndarray
    centres: np.ndarray
    sides: np.ndarray
    rotations: np.ndarray
    explained: np.ndarray
    tree: np.ndarray
    known: np.ndarray
    in_parent: np.ndarray
    in_child: np.ndarray
    joint_rotations: np.ndarray
    standard_error: np.ndarray
    mismatch: np.ndarray
    notes: list[str]
    urdf: str = field(repr=False)

    def __repr__(self) -> str:
        return f"<Placement: {len(self.labels)} parts, {int(self.known.sum())} of {len(self.tree)} joints placed by touch>"

    def to_urdf(self, path: Union[str, os.PathLike[str]]) -> Path:
        """Write the body as URDF, which RViz, MuJoCo and `import_body` read.

        Parameters
        ----------
        path : str or path
            The file to write.

        Returns
        -------
        pathlib.Path
            The file.
        """
        file = Path(path_of(path, "path"))
        file.write_text(self.urdf, encoding="utf-8")
        return file


def place_joints(
    touch: Any,
    found: Estimate,
    positions: Any,
    normals: Any,
    frames: Any = None,
    *,
    n_jobs: Optional[int] = -1,
) -> Placement:
    """Place the joints of an estimate on the body, where the position and the normal of each sensor are known.

    Parameters
    ----------
    touch : array-like of shape (T, M), or the path of a file
        The recording that was estimated.
    found : Estimate
        What `estimate` found in it.
    positions, normals : array-like of shape (M, 3)
        Position of each sensor, m, and its outward normal, of any length.
    frames : array-like of shape (M,), int, optional
        The frame that each sensor is in, such as the number of its link. By default all are in one frame, of the body at rest.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one. The result does not depend on it.

    Returns
    -------
    Placement
        A box for each part, a place for each joint with its standard error, and the body as URDF.

    Raises
    ------
    ValueError
        If there is no tree, an array has a wrong shape or holds a number that is not finite, or a normal is 0.

    Warns
    -----
    RecordingWarning
        If positions and normals do not explain what a part feels, or touch does not tell the place of a joint.

    Notes
    -----
    With position l and normal n of its sensors, the velocity v and the angular velocity ω of a part follow from the pressures by
    censored least squares. A joint is where both of its parts have the same speed. It is `bodyschema estimate --sensors` of the command
    line; docs/own-data.md has the limits.

    Examples
    --------
    >>> import bodyschema
    >>> import numpy as np
    >>> moved = bodyschema.simulate("star", duration=300, coordination=0.5, random_state=3)
    >>> found = bodyschema.estimate(moved.touch)
    >>> bodyschema.place_joints(moved.touch, found, moved.positions, moved.normals, moved.solids)
    <Placement: 5 parts, 4 of 4 joints placed by touch>
    """
    if not isinstance(found, Estimate):
        raise ValueError(f"found must be what bodyschema.estimate returns, but is {type(found).__name__}")
    if not found.shows_tree:
        raise ValueError(f"there is no tree, since rigid parts do not explain the recording ({found.fit}); force=True makes one")
    array, _ = touch_of(touch)
    count = array.shape[1]
    if len(found.parts) != count:
        raise ValueError(f"touch has {count} sensors, but found is of {len(found.parts)}")
    places, ways = (_vectors(values, name, count) for values, name in ((positions, "positions"), (normals, "normals")))
    own = np.zeros(count, dtype=np.int64) if frames is None else np.asarray(frames)
    if own.shape != (count,) or own.dtype.kind not in "iu" or own.min() < 0:
        raise ValueError(f"frames must be whole numbers of at least 0, one for each of {count} sensors")
    sites = list(zip(places.tolist(), ways.tolist()))
    tree = [(int(child), int(parent)) for child, parent in found.tree]
    facts = _bodyschema.place(array, found.parts.tolist(), tree, sites, own.tolist(), found.given_signed, found.keep_saturated, jobs_of(n_jobs))
    for note in facts["notes"]:
        warnings.warn(note, RecordingWarning, stacklevel=2)
    for name in ("rotations", "joint_rotations"):
        facts[name] = facts[name].reshape(-1, 3, 3)
    return Placement(**facts)


def _vectors(values: Any, name: str, count: int) -> np.ndarray:
    array = matrix_of(values, name, "a row x, y, z for each sensor").astype(np.float64)
    if array.shape != (count, 3):
        raise ValueError(f"{name} must have a row x, y, z for each of {count} sensors, but its shape is {array.shape}")
    if not np.all(np.isfinite(array)):
        raise ValueError(f"{name} must be finite, but row {int(np.argmin(np.isfinite(array).all(axis=1)))} is not")
    return array
