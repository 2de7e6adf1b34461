"""Check arguments that several functions share, and hand them to the compiled half."""

from __future__ import annotations

import contextlib
import math
import numbers
import os
from collections.abc import Iterator, Mapping, Sequence
from typing import Any, Callable, Optional, Union

import numpy as np

from ._bodyschema import SEED

RandomState = Union[None, int, np.random.RandomState, np.random.Generator]
Progress = Union[None, bool, Callable[[int, int], Any]]
Settings = Optional[Mapping[str, Mapping[str, Any]]]
Changed = Optional[Mapping[str, float]]

MAX_JOBS = 1024


def seed_of(random_state: RandomState) -> int:
    """The master seed: a number itself, or one that a generator draws."""
    if random_state is None:
        return SEED
    if isinstance(random_state, np.random.Generator):
        return int(random_state.integers(2**63))
    if isinstance(random_state, np.random.RandomState):
        return int(random_state.randint(2**31 - 1))
    if isinstance(random_state, numbers.Integral) and not isinstance(random_state, bool):
        if 0 <= int(random_state) < 2**64:
            return int(random_state)
    raise ValueError(
        f"random_state must be a whole number from 0 to 2**64 - 1, a NumPy generator or None, but is {random_state!r}"
    )


def jobs_of(n_jobs: Optional[int]) -> int:
    """The number of threads, counted as scikit-learn does; 0 for as many as the command line takes."""
    if n_jobs is None:
        return 1
    if not isinstance(n_jobs, numbers.Integral) or isinstance(n_jobs, bool) or n_jobs == 0 or n_jobs > MAX_JOBS:
        raise ValueError(f"n_jobs must be None, 1 to {MAX_JOBS}, or negative (-1: all processors), but is {n_jobs!r}")
    if n_jobs > 0:
        return int(n_jobs)
    if n_jobs == -1:
        return 0
    try:
        processors = len(os.sched_getaffinity(0))
    except AttributeError:  # not on Linux
        processors = os.cpu_count() or 1
    return min(max(processors + 1 + int(n_jobs), 1), MAX_JOBS)


def count_of(value: Any, name: str, least: int = 1) -> int:
    """A whole number of at least `least`."""
    if not isinstance(value, numbers.Integral) or isinstance(value, bool) or not least <= int(value) < 2**31:
        raise ValueError(f"{name} must be a whole number of at least {least}, but is {value!r}")
    return int(value)


def number_of(value: Any, name: str) -> float:
    """A finite number."""
    if not isinstance(value, numbers.Real) or isinstance(value, bool) or not math.isfinite(value):
        raise ValueError(f"{name} must be a finite number, but is {value!r}")
    return float(value)


def changed_of(changed: Changed) -> dict[str, float]:
    """Parameters that are not the default, by their names."""
    if not isinstance(changed, (Mapping, type(None))):
        raise ValueError(f"parameters must be a mapping of names to values, but is {changed!r}")
    return {str(name): number_of(value, f"parameters[{name!r}]") for name, value in (changed or {}).items()}


def path_of(value: Any, name: str) -> str:
    """The path of a file."""
    path = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if not isinstance(path, str):
        raise ValueError(f"{name} must be the path of a file, but is {value!r}")
    return path


def matrix_of(values: Any, name: str, shape: str) -> np.ndarray:
    """A float32 or float64 array of two dimensions, without a copy if it is one already."""
    if isinstance(values, np.ma.MaskedArray):
        values = np.ma.filled(values.astype(np.result_type(values.dtype, np.float32)), np.nan)
    try:
        array = np.asarray(values)
    except ValueError as error:  # rows of different lengths
        raise ValueError(f"{name} is not a table of numbers ({shape}): {error}") from None
    if array.ndim != 2:
        raise ValueError(f"{name} must have two dimensions ({shape}), but its shape is {array.shape}")
    kind = array.dtype.kind
    if kind == "O":
        with contextlib.suppress(TypeError, ValueError):
            array, kind = array.astype(np.float64), "f"
    if kind not in "biuf":
        raise ValueError(f"{name} must hold real numbers, but its dtype is {array.dtype}")
    if array.dtype not in (np.float32, np.float64) or not array.dtype.isnative:
        # Integers become float64 first, as those of a file do.
        wanted = np.float32 if kind == "b" or array.dtype.itemsize == 2 and kind == "f" else np.float64
        wanted = np.float32 if kind == "f" and array.dtype.itemsize == 4 else wanted
        array = array.astype(wanted)
    return np.require(array, requirements="A")


def labels_of(values: Any, name: str, least: int) -> np.ndarray:
    """Labels of sensors as int64, each at least `least`."""
    array = np.asarray(values)
    if array.ndim != 1 or array.dtype.kind not in "iu" and array.size > 0:
        raise ValueError(f"{name} must be whole numbers, one for each sensor, but its shape is {array.shape}, its dtype {array.dtype}")
    if array.size > 0 and (array.min() < least or array.max() >= 2**31):
        raise ValueError(f"{name} must be at least {least} and below 2**31")
    return array.astype(np.int64)


def edges_of(values: Any, name: str) -> list[tuple[int, int]]:
    """Pairs of parts."""
    array = np.asarray(values)
    if array.size == 0:
        return []
    if array.ndim != 2 or array.shape[1] != 2 or array.dtype.kind not in "iu" or array.min() < 0:
        raise ValueError(f"{name} must be pairs of parts, an integer array of shape (edges, 2), but its shape is {array.shape}")
    return [(int(a), int(b)) for a, b in array]


def toml_of(*layers: Settings) -> str:
    """Settings by section, as TOML; later layers count."""
    sections: dict[str, dict[str, Any]] = {}
    for layer in layers:
        for section, entries in (layer or {}).items():
            if section == "experiment":
                raise ValueError("settings of the section experiment are for whole experiments; here random_state is the seed")
            if not isinstance(entries, Mapping):
                raise ValueError(f"settings[{section!r}] must be a mapping of names to values, but is {entries!r}")
            sections.setdefault(str(section), {}).update(entries)
    lines = []
    for section, entries in sections.items():
        lines.append(f"[{_text(section)}]")
        lines.extend(f"{_text(str(name))} = {_value(value, f'{section}.{name}')}" for name, value in entries.items())
    return "\n".join(lines)


def _text(text: str) -> str:
    escaped = text.replace("\\", "\\\\").replace('"', '\\"')
    return '"' + "".join(f"\\u{ord(c):04X}" if ord(c) < 32 or ord(c) == 127 else c for c in escaped) + '"'


def _value(value: Any, name: str) -> str:
    if isinstance(value, (bool, np.bool_)):
        return "true" if value else "false"
    if isinstance(value, str):
        return _text(value)
    if isinstance(value, numbers.Integral) and abs(int(value)) < 2**63:
        return str(int(value))
    if isinstance(value, numbers.Real) and not isinstance(value, numbers.Integral):
        return repr(float(value))
    if isinstance(value, (Sequence, np.ndarray)):
        return "[" + ", ".join(_value(entry, name) for entry in value) + "]"
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{_text(str(key))} = {_value(entry, name)}" for key, entry in value.items()) + "}"
    raise ValueError(f"settings: {name} must be a number, a text, a truth value or a list of them, but is {value!r}")


@contextlib.contextmanager
def progress_of(progress: Progress, total: int, what: str) -> Iterator[Optional[Callable[[int], Any]]]:
    """What the compiled half calls with the number of steps that are done; None if nobody wants to know."""
    if callable(progress):
        yield lambda done: progress(done, total)
        return
    if progress not in (None, True, False):
        raise ValueError(f"progress must be True, False, None or a function of (done, total), but is {progress!r}")
    try:
        if progress is False:
            raise ImportError
        from tqdm.auto import tqdm
    except ImportError:
        yield None
        return
    # Without a wish, a bar is shown where a person looks, and only if there is something to wait for.
    with tqdm(total=total, desc=what, leave=False, disable=None if progress is None else False, delay=0 if progress else 0.5) as bar:
        yield lambda done: bar.update(done - bar.n)
