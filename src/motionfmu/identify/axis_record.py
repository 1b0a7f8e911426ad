"""A record of one axis as numbers: time and columns."""

import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError

Array = NDArray[np.float64]
# Share of the sampling interval by which instants may lie off an even grid.
_UNEVEN = 1e-3
_FEWEST = 20
_HEAD = re.compile(r"([^\[\]]+?)\s*(?:\[([^\[\]]*)\])?")


@dataclass(frozen=True)
class AxisRecord:
    """Signals at even instants.

    Parameters
    ----------
    time : array of shape (n,)
        Instants [s].
    columns : mapping
        Values of shape (n,) by name.
    units : mapping
        Unit of each column, empty where it has none.
    name : str
        For messages and reports.

    Raises
    ------
    InputError
        Instants are not even, or a value is no number.
    """

    time: Array
    columns: Mapping[str, Array]
    units: Mapping[str, str]
    name: str = "record"

    def __post_init__(self) -> None:
        """Refuse what no grid of instants is."""
        if self.time.ndim != 1 or len(self.time) < _FEWEST:
            raise InputError(f"{self.name}: {self.time.size} samples, {_FEWEST} at least wanted")
        steps = np.diff(self.time)
        if not np.isfinite(self.time).all() or steps.min() <= 0.0:
            k = int(np.argmin(np.where(np.isfinite(steps), steps, -np.inf)))
            raise InputError(f"{self.name}: time does not rise at sample {k + 1}")
        away = np.abs(self.time - self.time[0] - self.interval * np.arange(len(self.time)))
        if away.max() > _UNEVEN * self.interval * max(1.0, 1e-3 * len(self.time)):
            k = int(np.argmax(np.abs(steps - self.interval)))
            raise InputError(
                f"{self.name}: samples are {steps[k]:g} s apart at {self.time[k]:g} s,"
                f" {self.interval:g} s elsewhere: even instants wanted"
            )
        for name, values in self.columns.items():
            if values.shape != self.time.shape or not np.isfinite(values).all():
                raise InputError(f"{self.name}: column {name}: not a number at every instant")

    @property
    def interval(self) -> float:
        """Time between two samples [s]."""
        return float((self.time[-1] - self.time[0]) / (len(self.time) - 1))


# CCN 19: each thing that may be wrong in a line has its own message.
def read_csv(path: Path) -> AxisRecord:
    """Read commas under one line of names with units in brackets; the column of seconds is time."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path}: {getattr(error, 'strerror', None) or error}") from None
    if not lines:
        raise InputError(f"{path}: the file is empty")
    heads = [_HEAD.fullmatch(cell.strip()) for cell in lines[0].split(",")]
    names = [h[1].strip() if h else "" for h in heads]
    units = [(h[2] or "") if h else "" for h in heads]
    rows = []
    for number, line in enumerate(lines[1:], 2):
        cells = line.split(",")
        if not line.strip():
            continue
        if len(cells) != len(names):
            raise InputError(f"{path}:{number}: {len(cells)} values, {len(names)} columns wanted")
        for name, cell in zip(names, cells, strict=True):
            try:
                float(cell)
            except ValueError:
                raise InputError(f"{path}:{number}: {name} = {cell.strip()!r}: no number") from None
        rows.append([float(c) for c in cells])
    if "time" not in names:
        raise InputError(f"{path}:1: no column time; there are: {', '.join(names)}")
    table = np.array(rows, dtype=np.float64).reshape(-1, len(names)).T
    every = dict(zip(names, table, strict=True))
    time = every.pop("time")
    of = {n: u for n, u in zip(names, units, strict=True) if n != "time"}
    return AxisRecord(time, every, of, path.name)
