"""Estimate parts and tree of one's own recording."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional

import numpy as np

from . import _bodyschema, _picture
from ._arguments import Changed, Progress, RandomState, changed_of, count_of, jobs_of, number_of, progress_of, seed_of
from ._joints import Joints, joints_of
from ._reading import RecordingWarning, said_of, touch_of, warn_of_cleaning


@dataclass(frozen=True)
class Fit:
    """How well rigid parts explain a recording. Look at it before anything else.

    Attributes
    ----------
    verdict : {"good", "doubtful", "does not fit"}
        Whether they do. If it is "does not fit", parts and tree mean nothing: too few sensors are explained, few sensors feel something
        at a time, the movement repeats itself in one rhythm, or sensors do not read 0 at rest.
    explained : float
        The share of sensors that the motion of a part explains, 0 to 1. From 0.9 on the verdict is good, from 0.8 on doubtful. Below
        1,000 samples, with one part, or with a part of fewer than 16 sensors, it is doubtful at best.
    novelty : float
        The share of what is felt at a sample that the most similar other state leaves, 0 to 1, the median over samples. Below 0.001 the
        movement repeats itself; if it also consists of few motions, as one rhythm does, the verdict is "does not fit".
        With as few motions, it is doubtful at best below 0.1; a movement that repeats itself always is.
    cause : str or None
        What is likely to be the matter, unless the verdict is good.
    """

    verdict: str
    explained: float
    novelty: float
    cause: Optional[str]

    def __str__(self) -> str:
        cause = f"; likely cause: {self.cause}" if self.cause else ""
        return f"fit: {self.verdict}: rigid motions explain {100 * self.explained:.0f} % of the sensors{cause}"


@dataclass(frozen=True, eq=False, repr=False)
class Estimate(Joints):
    """The estimated parts and tree of a recording of M sensors; what `estimate` returns.

    `print(found)` shows it as text, and a notebook shows a picture. It has what `Joints` has, and what follows.

    Attributes
    ----------
    fit : Fit
        How well rigid parts explain the recording.
    parts : ndarray of shape (M,), int64
        The part of each sensor, 0 to K − 1; −1 for one that was left out.
    residuals : ndarray of shape (M,), float64
        The share of its residual variance that the motion of its part does not explain, 0 to 1; NaN for a sensor that was left out.
    next_parts, next_residuals : ndarray of shape (M,), int64 and float64
        The next best part, and its residual; −1 and NaN where there is none. Where both residuals are near to each other, the
        part of the sensor is uncertain.
    samples : ndarray of shape (T,), int64
        Samples that were used, as the recording counts them. A sample at which most sensors have no value is left out.
    noisy : int
        How many sensors are noisy, and were smoothed.
    signed : bool
        Whether negative values count.
    given_signed : bool or None
        What `estimate` was told of negative values.
    keep_saturated : bool
        Whether values at the end of a sensor's range count.
    interval : float or None
        Time between two samples, s.
    seed : int
        Seed of the bootstrap.
    parameters : dict of str to float
        Parameters of the method that were changed.
    repeats : int
        How many times parts and tree were estimated again, from resampled times; 0 where there is no tree.
    repeated : ndarray of shape (M,), float64, or None
        The share of these repeats that have the part of a sensor, and the sensor on it, 0 to 1; NaN for one that was left out. None
        without repeats.
    repeated_parts : ndarray of shape (K,), float64, or None
        The share of repeats that have a part: its counterpart and it have more than half of their sensors in common.
    repeated_joints : ndarray of shape (K − 1,), float64, or None
        The share of repeats that have both parts of a joint, and join them.
    mapped : ndarray of shape (N,), int64
        Sensors that have distances, at most 800, spread over all.
    distances : ndarray of shape (N, N), float64
        The information metric between them, bits; `body_map` takes it.
    shows_tree : bool
        Whether there is a tree: rigid parts explain the recording, or it was forced. Otherwise `tree` and `support` are empty.
    doubts : list of str
        What the estimate leaves open, and what recording would tell, a sentence each: joints with a support below 95 %, parts that may turn
        about one place, parts of fewer than 16 sensors, and sensors that may be on another part. Empty where rigid parts do not fit.
    """

    fit: Fit
    parts: np.ndarray
    residuals: np.ndarray
    next_parts: np.ndarray
    next_residuals: np.ndarray
    samples: np.ndarray
    noisy: int
    signed: bool
    given_signed: Optional[bool]
    keep_saturated: bool
    interval: Optional[float]
    seed: int
    parameters: dict[str, float]
    repeats: int
    repeated: Optional[np.ndarray]
    repeated_parts: Optional[np.ndarray]
    repeated_joints: Optional[np.ndarray]
    mapped: np.ndarray
    distances: np.ndarray
    shows_tree: bool
    doubts: list[str]

    def sensors_of(self, part: int) -> np.ndarray:
        """The sensors on a part, rising."""
        return np.flatnonzero(self.parts == part)

    def __repr__(self) -> str:
        sensors = int((self.parts >= 0).sum())
        return f"<Estimate: {len(self.labels)} parts of {sensors} sensors, fit: {self.fit.verdict}>"

    def __str__(self) -> str:
        sensors = int((self.parts >= 0).sum())
        time = "" if self.interval is None else f" ({len(self.samples) * self.interval:g} s)"
        lines = [str(self.fit), f"{len(self.labels)} parts of {sensors} sensors over {len(self.samples)} samples{time}"]
        if not self.shows_tree:
            lines.append("no tree is shown; estimate(..., force=True) has it")
            return "\n".join(lines)
        if len(self.tree) > 0:
            lines.append("tree, with the bootstrap support of each joint (given the parts):")
        names = {
            part: f"part {part} ({len(node['sensors'])} sensors, motion of rank {node['rank']})"
            for part, node in self._nodes().items()
        }
        lines.extend(_picture.text_tree(names, self.tree, self.support))
        lines.extend(self.doubts)
        lines.extend(self._again())
        return "\n".join(lines)

    def _again(self) -> list[str]:
        """What repeats say, if there were any."""
        if self.repeated_parts is None or self.repeated_joints is None:
            return []
        names = [f"part {part}" for part in self.labels.tolist()] + [f"joint {child}–{parent}" for child, parent in self.tree.tolist()]
        times = np.rint(self.repeats * np.concatenate([self.repeated_parts, self.repeated_joints])).astype(int).tolist()
        seldom = [f"{name} ({found} of {self.repeats})" for name, found in zip(names, times) if found < self.repeats]
        but = f", except {', '.join(seldom)}" if seldom else ""
        return [f"estimated again {self.repeats} times from resampled times: all parts and joints were found every time{but}"]

    def _nodes(self) -> dict[int, dict[str, Any]]:
        nodes = super()._nodes()
        for part, node in nodes.items():
            sensors = self.sensors_of(part)
            node["sensors"] = sensors.tolist()
            node["residual"] = float(np.median(self.residuals[sensors])) if len(sensors) > 0 else float("nan")
        return nodes

    def to_networkx(self) -> Any:
        if not self.shows_tree:
            raise ValueError(f"there is no tree, since rigid parts do not explain the recording ({self.fit}); force=True makes one")
        return super().to_networkx()

    to_networkx.__doc__ = Joints.to_networkx.__doc__

    def _repr_html_(self) -> str:
        return _picture.page(self)


def estimate(
    touch: Any,
    interval: Optional[float] = None,
    signed: Optional[bool] = None,
    *,
    keep_saturated: bool = False,
    force: bool = False,
    repeats: int = 0,
    parameters: Changed = None,
    random_state: RandomState = None,
    n_jobs: Optional[int] = -1,
    progress: Progress = None,
) -> Estimate:
    """Estimate the rigid parts of a body, the part of each sensor, and the tree of joints, from touch alone.

    The method assumes rigid parts, and sensors that feel how fast they move outward through a fluid or air: their pressure grows with
    the square of that speed. Contact does not fit. `Estimate.fit` says whether a recording fits; look at it first.

    Parameters
    ----------
    touch : array-like of shape (T, M), or the path of a file
        Pressures of M sensors at T samples, in any unit; 12 to 20,000 sensors. NaN where there is no value. The path of a
        table, a `.npy` file or an `.npz` archive will do; `read_touch` takes what is not to be guessed of it. A float32 or float64 array is read where it is, in any order of memory,
        and is not changed.
    interval : float, optional
        Time between two samples, s. It only labels the time. By default that of the column of times of a file.
    signed : bool, optional
        Whether negative values count. By default they do if they are more than 1 % of the sum of all absolute values. False takes
        each negative value for 0.
    keep_saturated : bool, default False
        Use values at the end of the range of their sensor, which otherwise count as missing.
    force : bool, default False
        Give the tree even if rigid parts do not explain the recording.
    repeats : int, default 0
        Estimate again so many times, at most 1,000, from resampled blocks of time, and count how often sensors, parts and joints are
        found again. Each repeat takes about as long as the estimate. Support takes the parts as given; this does not.
    parameters : mapping of str to float, optional
        Parameters of the method that are not to be the default, such as ``{"min_saving": 0.6}``. docs/shown/parameters lists all of them.
    random_state : int, NumPy generator or None
        Seed of the bootstrap, from 0 to 2**64 − 1. None is `bodyschema.SEED`, as on the command line.
    n_jobs : int or None, default -1
        Number of threads; -1: all processors, None: one. The result does not depend on it.
    progress : bool, callable or None
        True shows a progress bar if tqdm is installed, and None does so on a terminal or in a notebook. A function is called with the
        number of steps that are done, and of all.

    Returns
    -------
    Estimate
        Parts, tree, bootstrap support, residuals and fit.

    Raises
    ------
    ValueError
        If `touch` is no table of numbers, or fewer than 12 of its sensors feel anything usable.
    FileNotFoundError
        If it is a path that leads nowhere.

    Warns
    -----
    RecordingWarning
        If sensors or samples were left out, sensors are noisy, or rigid parts do not explain the recording.

    Notes
    -----
    Sensors are clustered by the motion subspaces of rigid parts, in the way of motion segmentation (Costeira and Kanade 1998). Parts
    are joined by the tree of most information between them (Chow and Liu 1968), above all of the speeds of joints; support is that of
    Felsenstein's bootstrap (1985). docs/estimate.md has the theory and how often the result is right. This is an extension: it is not
    in the paper.

    Examples
    --------
    >>> import bodyschema
    >>> moved = bodyschema.simulate("chain-3", duration=100, coordination=0.0, random_state=1)
    >>> found = bodyschema.estimate(moved.touch, interval=moved.interval)
    >>> found.fit.verdict
    'good'
    >>> found.parts.shape == (moved.touch.shape[1],)
    True
    """
    if interval is not None and number_of(interval, "interval") <= 0:
        raise ValueError(f"interval must be a time above 0, in s, but is {interval!r}")
    said = said_of(signed, keep_saturated)
    seed, jobs, changed = seed_of(random_state), jobs_of(n_jobs), changed_of(parameters)
    array, read_interval = touch_of(touch)
    interval = read_interval if interval is None else interval
    count = count_of(repeats, "repeats", 0)
    if count > 1000:
        raise ValueError(f"repeats must be at most 1000, but is {count}")
    with progress_of(progress, 3 + count, "estimate") as tell:
        facts = _bodyschema.estimate(array, said, (seed, changed), (count, force), jobs, tell)
    verdict, sensors, all_sensors = facts["verdict"], facts["sensors"], array.shape[1]
    fit = Fit(verdict, facts["explained"], facts["novelty"], facts["cause"])
    warn_of_cleaning(facts, all_sensors)
    shows_tree = force or facts["fits"]
    count = count if shows_tree else 0
    if not facts["fits"]:
        note = "parts and tree mean nothing" if shows_tree else "parts mean nothing, and no tree is given (force=True does)"
        warnings.warn(f"{fit}; {note}", RecordingWarning, stacklevel=2)

    def of_all(values: np.ndarray, missing: float) -> np.ndarray:
        all_values = np.full(all_sensors, missing, dtype=values.dtype)
        all_values[sensors] = values
        return all_values

    return Estimate(
        **joints_of(facts, shows_tree),
        fit=fit,
        parts=of_all(facts["parts"], -1),
        residuals=of_all(facts["residuals"], np.nan),
        next_parts=of_all(facts["next_parts"], -1),
        next_residuals=of_all(facts["next_residuals"], np.nan),
        samples=facts["samples"],
        noisy=facts["noisy"],
        signed=facts["signed"],
        given_signed=said[0],
        keep_saturated=said[1],
        interval=None if interval is None else float(interval),
        seed=seed,
        parameters=changed,
        repeats=count,
        repeated=of_all(facts["repeated"], np.nan) if count > 0 else None,
        repeated_parts=facts["repeated_parts"] if count > 0 else None,
        repeated_joints=facts["repeated_joints"] if count > 0 else None,
        mapped=facts["mapped"],
        distances=facts["distances"],
        shows_tree=shows_tree,
        doubts=facts["doubts"],
    )
