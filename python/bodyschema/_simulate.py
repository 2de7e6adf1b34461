"""Simulate a body that moves at random in a fluid, and the pressures on its sensors."""

from __future__ import annotations

import os
import warnings
from dataclasses import dataclass
from typing import Optional, Union

import numpy as np

from . import _bodyschema
from ._arguments import Progress, RandomState, Settings, number_of, progress_of, seed_of, toml_of


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
    names : list of str or None
        The names of the parts; None for the body of the settings.
    interval : float
        Time between two samples, s.
    seed : int
        Master seed of the movement.
    """

    touch: np.ndarray
    parts: np.ndarray
    tree: np.ndarray
    names: Optional[list[str]]
    interval: float
    seed: int

    def __repr__(self) -> str:
        samples, sensors = self.touch.shape
        return f"<Simulation: {samples} samples of {sensors} sensors on {len(self.tree) + 1} parts>"


def simulate(
    body: Union[None, str, os.PathLike[str]] = None,
    *,
    duration: Optional[float] = None,
    coordination: Optional[float] = None,
    settings: Settings = None,
    random_state: RandomState = None,
    progress: Progress = None,
) -> Simulation:
    """Simulate a body that moves at random in a fluid, and the pressures on its sensors (stages 1 and 2).

    Parameters
    ----------
    body : str or path, optional
        The name of a body in `bodyschema.BODIES`, such as "star", or the path of a body file (docs/reference.md). By default it is
        the body of the paper, five cylinders with 840 sensors.
    duration : float, optional
        Time that is simulated, s; 10,000 by default.
    coordination : float, optional
        p, the probability that a joint stays locked for an epoch of 5 s, 0 to 1; 0.9 by default. With 1 nothing moves.
    settings : mapping of mappings, optional
        Other settings by section and name, such as ``{"motion": {"epoch": 200}}``; reproduce/paper.toml explains all of them.
        `duration` and `coordination` count more.
    random_state : int, NumPy generator or None
        Master seed, from 0 to 2**64 − 1. None is `bodyschema.SEED`.
    progress : bool, callable or None
        As for `estimate`; the steps are samples.

    Returns
    -------
    Simulation
        The pressures, and the true parts and tree.

    Raises
    ------
    ValueError
        If a setting is unknown or out of range, a body file is wrong, or the simulation becomes unstable.

    Warns
    -----
    UserWarning
        If the time step is too long for the movement.

    Notes
    -----
    A sensor that moves outward at v · n feels the pressure ρ (v · n)² (equation 27 of the paper). The body moves in the Open Dynamics
    Engine. It is `bodyschema simulate` of the command line.

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
    text, seed = toml_of(settings, changes), seed_of(random_state)
    if body is not None and not isinstance(body, (str, os.PathLike)):
        raise ValueError(f"body must be a name of bodyschema.BODIES or a path, but is {body!r}")
    name = None if body is None else os.fspath(body)
    if isinstance(body, os.PathLike) and name in _bodyschema.BODIES:
        name = os.path.join(".", name)
    if name is not None and name not in _bodyschema.BODIES and not os.path.exists(name):
        raise ValueError(f"body {name!r} is neither a file nor one of {', '.join(_bodyschema.BODIES)}")
    total = _samples(settings, changes)
    with progress_of(progress, total, "simulate") as tell:
        facts = _bodyschema.simulate(name, text, seed, 1, tell)
    if not facts["resolved"]:
        warnings.warn(facts["resolution"], UserWarning, stacklevel=2)
    return Simulation(facts["touch"], facts["labels"], facts["tree"], facts["names"], facts["interval"], seed)


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
