"""Simulate a body that moves in a fluid, at random or as it was recorded, and the pressures on its sensors."""

from __future__ import annotations

import os
import warnings
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, Optional, Union

import numpy as np

from . import _bodyschema
from ._arguments import Progress, RandomState, Settings, number_of, path_of, progress_of, seed_of, toml_of
from ._bodies import warn_of


@dataclass(frozen=True, eq=False, repr=False)
class Simulation:
    """What a simulated body felt, and its true parts and tree; what `simulate` returns.

    Attributes
    ----------
    touch : ndarray of shape (T, M), float32
        Pressures on M sensors at T samples, Pa; at least 0. In Fortran order: one sensor's series after the other.
    parts : ndarray of shape (M,), int64
        The true part of each sensor.
    tree : ndarray of shape (K − 1, 2), int64
        The true joints, as (child, parent).
    positions, normals : ndarray of shape (M, 3), float64
        Position of each sensor, m, and its outward unit normal, in the frame of its solid.
    solids : ndarray of shape (M,), int64
        The solid of each sensor. Solids that are fixed to each other are one part.
    names : list of str or None
        The names of the parts; None for the body of the settings.
    interval : float
        Time between two samples, s.
    seed : int or None
        Master seed of the movement; None of a recorded one.
    """

    touch: np.ndarray
    parts: np.ndarray
    tree: np.ndarray
    positions: np.ndarray
    normals: np.ndarray
    solids: np.ndarray
    names: Optional[list[str]]
    interval: float
    seed: Optional[int]

    def __repr__(self) -> str:
        samples, sensors = self.touch.shape
        return f"<Simulation: {samples} samples of {sensors} sensors on {len(self.tree) + 1} parts>"


def simulate(
    body: Union[None, str, os.PathLike[str]] = None,
    *,
    movement: Union[None, str, os.PathLike[str]] = None,
    scale: Optional[float] = None,
    keep_jumps: bool = False,
    duration: Optional[float] = None,
    coordination: Optional[float] = None,
    settings: Settings = None,
    random_state: RandomState = None,
    progress: Progress = None,
) -> Simulation:
    """Simulate a body that moves in a fluid, at random or as it was recorded, and the pressures on its sensors (stages 1 and 2).

    Parameters
    ----------
    body : str or path, optional
        The name of a body in `bodyschema.BODIES`, such as "star", or the path of a body file (docs/reference.md). By default it is
        the body of the paper, five cylinders with 840 sensors; of a recorded movement, it is the skeleton of the recording.
    movement : str or path, optional
        A recorded movement that the body makes instead of one at random: a BVH file. `import_body` makes a body that fits. Samples are
        at the frames of the recording, unless `settings` has ``{"sense": {"interval": ...}}``. No physics engine is asked.
    scale : float, optional
        Length of a unit of the recorded movement, m. By default it is as in the body; without `body` it is guessed.
    keep_jumps : bool, default False
        Play all frames of the recorded movement, and not the longest stretch without a jump.
    duration : float, optional
        Time that is simulated, s; 10,000 by default. Of a recorded movement it is at most the length of the recording.
    coordination : float, optional
        p, the probability that a joint stays locked for an epoch of 5 s, 0 to 1; 0.9 by default. With 1 nothing moves. It is not for a
        recorded movement.
    settings : mapping of mappings, optional
        Other settings by section and name, such as ``{"motion": {"epoch": 200}}``; reproduce/paper.toml explains all of them.
        `duration` and `coordination` count more.
    random_state : int, NumPy generator or None
        Master seed, from 0 to 2**64 − 1. None is `bodyschema.SEED`. A recorded movement takes none.
    progress : bool, callable or None
        As for `estimate`; the steps are samples.

    Returns
    -------
    Simulation
        The pressures, and the true parts and tree.

    Raises
    ------
    ValueError
        If a setting is unknown or out of range, a body file is wrong, the simulation becomes unstable, or the recorded movement cannot
        be read, does not fit the body, or has no two frames.

    Warns
    -----
    UserWarning
        If the time step is too long for the movement.
    BodyWarning
        What body and movement have in another way than the recorded movement.

    Notes
    -----
    A sensor that moves outward at v · n feels the pressure ρ (v · n)² (equation 27 of the paper). The body moves in the Open Dynamics
    Engine. It is `bodyschema simulate` of the command line, with `movement` that of ``--movement``, which is not in the paper.

    Examples
    --------
    >>> import bodyschema
    >>> bodyschema.simulate("star", duration=10, random_state=1)
    <Simulation: 100 samples of 200 sensors on 5 parts>
    """
    changes: dict[str, dict[str, float]] = {}
    if duration is not None:
        changes["physics"] = {"duration": number_of(duration, "duration")}
    if coordination is not None:
        changes["motion"] = {"coordination": number_of(coordination, "coordination")}
    seed, name = seed_of(random_state), _body(body)
    if movement is not None:
        if coordination is not None:
            raise ValueError("coordination is for movements at random, and this one is recorded; leave it out")
        recording = {
            "movement": path_of(movement, "movement"),
            "scale": None if scale is None else number_of(scale, "scale"),
            "keep_jumps": bool(keep_jumps),
            "duration": changes.get("physics", {}).get("duration"),
            "has_interval": "interval" in ((settings or {}).get("sense") or {}),
        }
        facts = _bodyschema.play(name, toml_of(settings), recording, 1)
        # Whoever gives the duration knows that it is not all.
        warn_of(facts["notes"] + ([facts["cut"]] if facts["cut"] and duration is None else []), 2)
        return _simulation(facts, None)
    for argument, value in [("scale", scale is not None), ("keep_jumps", keep_jumps)]:
        if value:
            raise ValueError(f"{argument} is for recorded movements; give one (movement), or leave it out")
    total = _samples(settings, changes)
    with progress_of(progress, total, "simulate") as tell:
        facts = _bodyschema.simulate(name, toml_of(settings, changes), seed, 1, tell)
    if not facts["resolved"]:
        warnings.warn(facts["resolution"], UserWarning, stacklevel=2)
    return _simulation(facts, seed)


def _simulation(facts: Mapping[str, Any], seed: Optional[int]) -> Simulation:
    sites = (facts["positions"], facts["normals"], facts["solids"])
    return Simulation(facts["touch"], facts["labels"], facts["tree"], *sites, facts["names"], facts["interval"], seed)


def _body(body: Union[None, str, os.PathLike[str]]) -> Optional[str]:
    """The name or path of a body, which must be there."""
    if body is not None and not isinstance(body, (str, os.PathLike)):
        raise ValueError(f"body must be a name of bodyschema.BODIES or a path, but is {body!r}")
    name = None if body is None else os.fspath(body)
    if isinstance(body, os.PathLike) and name in _bodyschema.BODIES:
        name = os.path.join(".", name)
    if name is not None and name not in _bodyschema.BODIES and not os.path.exists(name):
        raise ValueError(f"body {name!r} is neither a file nor one of {', '.join(_bodyschema.BODIES)}")
    return name


def _samples(*layers: Settings) -> int:
    """About how many samples there will be, for the bar; wrong settings are refused elsewhere."""
    duration, interval = 10_000.0, 0.1
    for layer in layers:
        duration = (layer or {}).get("physics", {}).get("duration", duration)
        interval = (layer or {}).get("sense", {}).get("interval", interval)
    try:
        return round(duration / interval) + 1
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        return 0
