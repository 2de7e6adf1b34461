"""Read a recording from a file as people have it, and say what becomes of it."""

from __future__ import annotations

import errno
import numbers
import os
import warnings
from collections.abc import Mapping, Sequence
from typing import Any, Optional, Union

import numpy as np

from . import _bodyschema
from ._arguments import jobs_of, matrix_of, path_of

SHAPE = "a row for each sample in time, a column for each sensor"
# Samples over which no sensor only rises.
MONOTONE = 20


class RecordingWarning(UserWarning):
    """Something about a recording that its owner should know: what was left out, or that the method does not fit it."""


def read_touch(
    path: Union[str, os.PathLike[str]],
    *,
    separator: Optional[str] = None,
    decimal: Optional[str] = None,
    header: Optional[bool] = None,
    time: Union[None, bool, int, str] = None,
    leave_out: Sequence[Union[int, str]] = (),
    array: Optional[str] = None,
) -> np.ndarray:
    """Read a recording from a file, as the command line does. What is not said is guessed, and a warning says what was.

    Parameters
    ----------
    path : str or path
        A table in text, a `.npy` file or an `.npz` archive: a row for each sample in time, a column for each sensor. A column of
        times is left out.
    separator : {",", ";", "\\t", " "}, optional
        What is between the cells of a table; a blank stands for one or more.
    decimal : {".", ","}, optional
        What the decimals of a table begin with.
    header : bool, optional
        Whether the first row of a table has names.
    time : str, int or False, optional
        The column that holds the time: its name, or its number from 1 on. False: none, all columns are sensors.
    leave_out : sequence of str and int, default ()
        Columns that are no sensors: their names, or their numbers from 1 on.
    array : str, optional
        The name of the array in an `.npz` archive that has several.

    Returns
    -------
    ndarray of shape (T, M), float32
        The pressures; NaN where there is no value.

    Raises
    ------
    FileNotFoundError
        If there is no such file.
    ValueError
        If it is no table of numbers; the message names the row and the column, and the argument that helps.

    Warns
    -----
    RecordingWarning
        What was guessed of the file, such as its separator and which column is the time, and the argument that says otherwise.

    Examples
    --------
    >>> import bodyschema
    >>> touch = bodyschema.read_touch("recording.csv", separator=";", decimal=",", leave_out=["battery"])  # doctest: +SKIP
    """
    for name, value, known in [("separator", separator, (",", ";", "\t", " ")), ("decimal", decimal, (".", ","))]:
        if value is not None and value not in known:
            raise ValueError(f"{name} must be one of {', '.join(map(repr, known))}, but is {value!r}")
    if header not in (None, True, False):
        raise ValueError(f"header must be True, False or None, but is {header!r}")
    if array is not None and not isinstance(array, str):
        raise ValueError(f"array must be the name of an array, but is {array!r}")
    if isinstance(leave_out, (str, bytes)) or not isinstance(leave_out, Sequence):
        raise ValueError(f"leave_out must be a sequence of names or numbers of columns, but is {leave_out!r}")
    reading = {
        "separator": separator,
        "decimal": decimal,
        "header": None if header is None else bool(header),
        "time": None if time is None else [] if time is False else [_column(time, "time")],
        "leave_out": [_column(column, "leave_out") for column in leave_out],
        "array": array,
    }
    return _read(path, reading, 3)[0]


# A file of which nothing is said.
_GUESS: dict[str, Any] = {"separator": None, "decimal": None, "header": None, "time": None, "leave_out": [], "array": None}


def _column(column: Any, name: str) -> Union[int, str]:
    """A column by its name, or by its number from 1 on."""
    if isinstance(column, str):
        return column
    if not isinstance(column, numbers.Integral) or isinstance(column, bool) or column < 1:
        raise ValueError(f"{name}: a column must be a name or a number from 1 on, but is {column!r}")
    return int(column)


def _read(path: Union[str, os.PathLike[str]], reading: dict[str, Any], level: int) -> tuple[np.ndarray, Optional[float]]:
    """A recording from a file, and the time between two samples, s, if the file tells it. Warns at the caller so many calls above."""
    path = path_of(path, "path")
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
    # On the command line a single - is standard input.
    array, interval, guesses = _bodyschema.read_touch("./-" if path == "-" else path, reading, jobs_of(-1))
    for guess in guesses:
        warnings.warn(f"{path}: {guess}", RecordingWarning, stacklevel=level)
    return array, interval


def touch_of(touch: Any) -> tuple[np.ndarray, Optional[float]]:
    """A recording, T × M float32 or float64, from a file or anything that NumPy takes for an array; and its interval, if known."""
    if isinstance(touch, (str, os.PathLike)):
        return _read(touch, _GUESS, 4)
    array = matrix_of(touch, "touch", SHAPE)
    if array.shape[0] > MONOTONE and array.shape[1] > 0 and bool(np.all(array[1:, 0] > array[:-1, 0])):
        raise ValueError("column 0 of touch rises with every row, as a time does and no sensor: leave it out, touch[:, 1:]")
    return array, None


def said_of(signed: Any, keep_saturated: Any) -> tuple[Optional[bool], bool]:
    """What is said of a recording, so that the data do not tell it."""
    if signed not in (None, True, False):
        raise ValueError(f"signed must be True, False or None, but is {signed!r}")
    if keep_saturated not in (True, False):
        raise ValueError(f"keep_saturated must be True or False, but is {keep_saturated!r}")
    return None if signed is None else bool(signed), bool(keep_saturated)


def warn_of_cleaning(facts: Mapping[str, Any], sensors: int) -> None:
    """Says what cleaning changed, at the caller of the caller."""

    def warn(message: str) -> None:
        warnings.warn(message, RecordingWarning, stacklevel=4)

    if facts["lost_samples"] > 0:
        warn(f"{facts['lost_samples']} samples are left out, because most sensors have no value there")
    if facts["saturated"] > 0:
        warn(
            f"{facts['saturated']} values are at the end of the range of their sensor for three samples or more, and count as missing; "
            "keep_saturated=True uses them"
        )
    if facts["infinite"] > 0:
        warn(f"{facts['infinite']} values are infinite, and count as missing")
    if facts["missing"] > 0:
        warn(f"{facts['missing']} values are missing of the sensors that are used; they are not interpolated")
    if facts["noisy"] > 0:
        warn(
            f"{facts['noisy']} of {len(facts['sensors'])} sensors are noisy; they are smoothed, and pressures within the noise count as "
            "no touch"
        )
    if facts["dropped"]:
        first, fault = facts["dropped"][0]
        warn(f"{len(facts['dropped'])} of {sensors} sensors are left out (the first, {first}, is {fault}); see dropped")
