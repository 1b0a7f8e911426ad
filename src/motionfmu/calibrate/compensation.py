"""Compensation tables of the motion library: pitch error and backlash, as its `comp_file`."""

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import text_of
from motionfmu.calibrate.lead_error import LeadError

Array = NDArray[np.float64]
POINTS, LARGEST = 256, 32767  # of a table; pulses of a correction
HEADS = ("axis,interval,home", "axis,index,forward,backward")
# Points in a period of the wave: a chord is then 2 % of its amplitude beside it.
PER_WAVE = 16


@dataclass(frozen=True)
class CompensationTable:
    """The table of an axis.

    Attributes
    ----------
    axis : int
        From 1.
    interval : int
        Between two points [pulses].
    home : int
        Point at position 0, from 0.
    forward, backward : ndarray of int, shape (n,)
        To be added there [pulses].
    """

    axis: int
    interval: int
    home: int
    forward: NDArray[np.int64]
    backward: NDArray[np.int64]

    def places(self, pulse: float) -> Array:
        """Where its points are [mm].

        Parameters
        ----------
        pulse : float
            Length of a pulse [mm].
        """
        return np.asarray(np.arange(len(self.forward)) - self.home, float) * (self.interval * pulse)

    def at(self, places: Array, pulse: float) -> tuple[Array, Array]:
        """Corrections forward and backward [mm].

        Parameters
        ----------
        places : ndarray
            [mm]
        pulse : float
            Length of a pulse [mm].
        """
        own = self.places(pulse)
        both = (np.interp(places, own, rows * pulse) for rows in (self.forward, self.backward))
        forward, backward = both
        return np.asarray(forward), np.asarray(backward)


def compensation_table(
    error: LeadError, axis: int, pulse: float, before: CompensationTable | None = None
) -> CompensationTable:
    """Make the table that takes a positioning error away.

    Parameters
    ----------
    error : LeadError
    axis : int
        From 1.
    pulse : float
        Length of a pulse [mm].
    before : CompensationTable, optional
        The table that was in force at the test, which this one replaces.

    Returns
    -------
    CompensationTable
        At position 0 approached upwards it corrects nothing, so the origin stays. Beyond the
        targets it goes on with its last values, an interval behind them.

    Raises
    ------
    InputError
        A correction is beyond the table's range.
    """
    x = error.test.targets
    low, high = min(float(x[0]), 0.0), max(float(x[-1]), 0.0)
    step = float(np.median(np.diff(x)))
    if error.amplitude.told:
        step = min(step, error.period.value / PER_WAVE)
    step = max(step, (high - low) / (POINTS - 2))
    interval = max(1, round(step / pulse))
    while _count(low, high, interval * pulse) > POINTS:
        interval += 1
    home = math.ceil(-low / (interval * pulse) - 1e-9)
    count = _count(low, high, interval * pulse)
    grid = np.asarray(np.arange(count) - home, float) * (interval * pulse)
    up, down = (_deviation(error, grid, rows, interval * pulse) for rows in error.test.means)
    zero = float(_deviation(error, np.zeros(1), error.test.means[0], interval * pulse)[0])
    forward, backward = zero - up, zero - down
    if before is not None:
        old = before.at(grid, pulse)
        forward, backward = forward + old[0], backward + old[1]
    pair = [np.rint(c / pulse).astype(np.int64) for c in (forward, backward)]
    worst = max(int(np.abs(c).max()) for c in pair)
    if worst > LARGEST:
        raise InputError(
            f"axis {axis}: a correction of {worst} pulses: {LARGEST} at most in a table"
        )
    return CompensationTable(axis, interval, home, *pair)


def _count(low: float, high: float, step: float) -> int:
    return math.ceil(-low / step - 1e-9) + math.ceil(high / step - 1e-9) + 1


def _deviation(error: LeadError, places: Array, means: Array, beyond: float) -> Array:
    """Deviation of one direction: the fit, and what it leaves at the targets, straight between."""
    # the fit goes on to the first point beyond the targets, or the last piece would be oblique
    x = error.test.targets
    near = np.clip(places, x[0] - beyond, x[-1] + beyond)
    return np.asarray(error.mean(near) + np.interp(near, x, means - error.mean(x)))


def compensation_text(tables: Iterable[CompensationTable], about: str) -> str:
    """Text of a file with tables, as the library reads it.

    Parameters
    ----------
    tables : iterable of CompensationTable
    about : str
        First line.
    """
    listed = list(tables)
    lines = [f"# {about}", HEADS[0]]
    lines += [f"{t.axis},{t.interval},{t.home}" for t in listed]
    lines.append(HEADS[1])
    for t in listed:
        both = zip(t.forward.tolist(), t.backward.tolist(), strict=True)
        lines += [f"{t.axis},{i},{f},{b}" for i, (f, b) in enumerate(both)]
    return "\n".join(lines) + "\n"


def compensation_tables(file: str | Path) -> Mapping[int, CompensationTable]:
    """Read the tables of a file that the library takes, by axis.

    Parameters
    ----------
    file : str or Path

    Raises
    ------
    InputError
        What is wrong, with file and line.
    """
    heads: dict[int, tuple[int, int]] = {}
    rows: dict[int, list[tuple[int, int, int]]] = {}
    width = 0
    for n, line in enumerate(text_of(file).splitlines(), 1):
        if not line or line.startswith("#"):
            continue
        if line in HEADS:
            width = line.count(",") + 1
            continue
        try:
            cells = [int(c) for c in line.split(",")]
        except ValueError:
            cells = []
        if not width or len(cells) != width:
            raise InputError(f"{file}: line {n}: {line!r}: not {width or 3} whole numbers")
        if width == 3:
            heads[cells[0]] = cells[1], cells[2]
        elif cells[0] not in heads:
            raise InputError(f"{file}: line {n}: axis {cells[0]} has no interval yet")
        else:
            rows.setdefault(cells[0], []).append((cells[1], cells[2], cells[3]))
    found = {}
    for axis, (interval, home) in heads.items():
        listed = rows.get(axis)
        if not listed:
            raise InputError(f"{file}: axis {axis} has an interval and no points")
        index, forward, backward = (np.array(c, np.int64) for c in zip(*listed, strict=True))
        found[axis] = CompensationTable(axis, interval, home - int(index[0]), forward, backward)
    return found
