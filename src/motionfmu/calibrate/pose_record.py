"""Measured poses of a robot's tool, as a laser tracker gives them."""

import re
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.records import Record, readers
from motionfmu.records.raw_table import NoTimes
from motionfmu.virtual.robot import matrix_of

Array = NDArray[np.float64]
JOINT = re.compile(r"^(?:j|joint|q|axis|theta|achse|a)[ _]?([1-9])$")
PLACES, ANGLES, QUATERNION = ("x", "y", "z"), ("a", "b", "c"), ("qw", "qx", "qy", "qz")
FEWEST = 8


@dataclass(frozen=True)
class PoseRecord:
    """Measured poses.

    Attributes
    ----------
    name : str
        Of the file.
    joints : ndarray, shape (n, j)
        As the controller shows them [deg].
    places : ndarray, shape (n, 3)
        In the frame of the instrument [mm].
    attitudes : ndarray, shape (n, 3, 3), optional
        Rotations likewise; None if only places were measured.
    where : tuple of str
        File and line of each pose.
    """

    name: str
    joints: Array
    places: Array
    attitudes: Array | None = None
    where: tuple[str, ...] = field(default=(), repr=False)


def pose_record(
    file: str | Path,
    over: Mapping[str, str] | None = None,
    layout: Mapping[str, Any] | None = None,
) -> PoseRecord:
    """Read measured poses.

    Parameters
    ----------
    file : str or Path
        Columns ``j1`` to ``j6`` [deg], ``X``, ``Y``, ``Z`` [mm]; with an orientation also ``A``,
        ``B``, ``C`` [deg], R = Rz(C) Ry(B) Rx(A), or ``qw``, ``qx``, ``qy``, ``qz``.
    over : mapping, optional
        Columns by these names, where they have others.
    layout : mapping, optional
        As of `motionfmu.record`.

    Returns
    -------
    PoseRecord

    Raises
    ------
    InputError
        What is wrong, with file, line and value.
    """
    path = Path(file)
    found = _opened(path, layout or {})
    columns = _columns(found, over or {})
    joints = _joints(path, columns)
    if lacking := [n for n in PLACES if n not in columns]:
        raise InputError(f"{path}: no column {lacking[0].upper()} of the measured place")
    data = {n: _values(found, c, n) for n, c in columns.items()}
    places = np.column_stack([data[n] for n in PLACES])
    if len(places) < FEWEST:
        raise InputError(f"{path}: {len(places)} poses, {FEWEST} at least wanted")
    angles = np.column_stack([data[n] for n in joints])
    where = tuple(found.place(k) for k in range(len(places)))
    return PoseRecord(str(path), angles, places, _attitudes(found, data), where)


def _joints(path: Path, columns: Mapping[str, str]) -> list[str]:
    """Names of the joints, of which none may be left out."""
    joints = sorted(n for n in columns if n.startswith("j"))
    if not joints or [int(n[1:]) for n in joints] != list(range(1, len(joints) + 1)):
        told = ", ".join(joints) or "none"
        raise InputError(f"{path}: columns of joints j1, j2, ... wanted ({told} found)")
    return joints


def _opened(path: Path, layout: Mapping[str, Any]) -> Record:
    """A file whose rows need no times."""
    try:
        return readers.record(path, **layout)
    except NoTimes:
        return readers.record(path, **{"rate": 1.0, **layout})


def _attitudes(found: Record, data: Mapping[str, Array]) -> Array | None:
    """Rotations of each pose, if they were measured."""
    if all(n in data for n in QUATERNION):
        return _rotations(found, np.column_stack([data[n] for n in QUATERNION]))
    if not all(n in data for n in ANGLES):
        return None
    angles = np.column_stack([data[n] for n in ANGLES])
    return np.asarray(matrix_of(np.hstack([np.zeros_like(angles), angles]))[:, :3, :3])


def is_pose_record(file: Path, layout: Mapping[str, Any]) -> bool:
    """Whether a file has a column of a second joint."""
    names = (JOINT.match(n.lower()) for n in _opened(file, layout))
    return any(m and m[1] == "2" for m in names)


def _columns(found: Record, over: Mapping[str, str]) -> dict[str, str]:
    """Columns by the names that poses have."""
    columns: dict[str, str] = {}
    for name in found:
        small = name.lower()
        if small in (*PLACES, *ANGLES, *QUATERNION):
            columns[small] = name
        elif m := JOINT.match(small):
            columns[f"j{m[1]}"] = name
    for name, column in over.items():
        if column not in found:
            raise InputError(f"{found.name}: no column {column!r} (there are: {', '.join(found)})")
        columns[name.lower()] = column
    return columns


def _values(found: Record, column: str, name: str) -> Array:
    """A column: places in mm, angles in degrees where they have no unit."""
    missing = found.missing(column)
    if missing.any():
        place = found.place(int(missing.argmax()))
        raise InputError(f"{place}: column {column!r}: a value is missing")
    if name in QUATERNION or not found.units.get(column):
        return np.asarray(found[column], float)
    return np.asarray(found.in_unit(column, "mm" if name in PLACES else "°"), float)


def _rotations(found: Record, q: Array) -> Array:
    """Rotations of quaternions w, x, y, z."""
    size = np.linalg.norm(q, axis=1)
    wrong = np.flatnonzero(np.abs(size - 1.0) > 1e-2)
    if len(wrong):
        told = f"quaternion of length {size[wrong[0]]:.4g}"
        raise InputError(f"{found.place(int(wrong[0]))}: {told}, 1 wanted")
    w, x, y, z = (q / size[:, None]).T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    return np.asarray(np.moveaxis(np.array(rows), 2, 0))
