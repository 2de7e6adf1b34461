"""Make a body file of the description of a robot, or of a recorded skeleton."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Optional, Union

from . import _bodyschema
from ._arguments import count_of, number_of, path_of


class BodyWarning(UserWarning):
    """What a body or its movement has in another way than the description or the recording that it comes from."""


def warn_of(notes: list[str], level: int) -> None:
    """Warns of each note, at the place of the user's code that is so many calls above."""
    for note in notes:
        warnings.warn(note, BodyWarning, stacklevel=level + 1)


def import_body(
    source: Union[str, os.PathLike[str]],
    out: Union[str, os.PathLike[str]],
    *,
    sensors_per_part: Optional[int] = None,
    per_area: Optional[float] = None,
    scale: Optional[float] = None,
    min_length: Optional[float] = None,
    root: Optional[str] = None,
    strict: bool = False,
) -> Path:
    """Write the description of a robot, or the skeleton of a recorded movement, as a body file, for `simulate`.

    Parameters
    ----------
    source : str or path
        The description of a robot, as URDF or MJCF, or a recorded movement, as BVH (a name that ends in ``.bvh``).
    out : str or path
        The body file to write, such as ``"robot.toml"``. A file that is there is replaced.
    sensors_per_part : int, optional
        Sensors on each part; 40 by default.
    per_area : float, optional
        Sensors per square metre of each part, instead of `sensors_per_part`.
    scale : float, optional
        Of a recorded movement: length of a unit of the file, m. By default it is guessed from the size of the skeleton.
    min_length : float, optional
        Of a recorded movement: length of a bone from which on it carries skin, m; 0.05 by default.
    root : str, optional
        Of a robot: the body or link whose tree is imported. By default it is that of the largest tree.
    strict : bool, default False
        Of a robot: refuse what a body cannot have, such as sliding joints, instead of changing it with a warning.

    Returns
    -------
    pathlib.Path
        The file that was written, `out`.

    Raises
    ------
    ValueError
        If the file cannot be read or written or is no body, or an argument is out of range or for another kind of file.

    Warns
    -----
    BodyWarning
        What the body has in another way than the description.

    Notes
    -----
    It is `bodyschema body import` of the command line; docs/reference.md says what is read. The body of a recorded movement can also be
    moved as it was recorded: ``simulate(out, movement=source)``.

    Examples
    --------
    >>> import bodyschema
    >>> body = bodyschema.import_body("robot.urdf", "robot.toml")  # doctest: +SKIP
    >>> moved = bodyschema.simulate(body, duration=10)  # doctest: +SKIP
    """
    if sensors_per_part is not None and per_area is not None:
        raise ValueError("sensors_per_part and per_area are both given; leave one of them out")
    if root is not None and not isinstance(root, str):
        raise ValueError(f"root must be the name of a body or link, but is {root!r}")
    path = path_of(out, "out")
    options = {
        "sensors_per_part": None if sensors_per_part is None else count_of(sensors_per_part, "sensors_per_part"),
        "per_area": None if per_area is None else number_of(per_area, "per_area"),
        "scale": None if scale is None else number_of(scale, "scale"),
        "min_length": None if min_length is None else number_of(min_length, "min_length"),
        "root": root,
        "strict": bool(strict),
    }
    warn_of(_bodyschema.import_body(path_of(source, "source"), path, options), 2)
    return Path(path)
