"""The commanded motion of a whole program, by the controller of a scenario without its machine."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.columns import forget
from motionfmu.base.motion_rows import CAUSES, NUMBER_OF
from motionfmu.run import Scenario
from motionfmu.run.controller_plan import plan_rows
from motionfmu.run.program_translation import motion_file

DWELL = NUMBER_OF["dwell"]
SLOWEST = 10


@dataclass(frozen=True)
class Share:
    """Time for which one limit counts.

    Attributes
    ----------
    cause : str
        A value of `CAUSES`.
    axis : str
        The axis whose limit it is; empty for one of the path.
    time : float
        [s]
    """

    cause: str
    axis: str
    time: float


@dataclass(frozen=True)
class Block:
    """A line of the program.

    Attributes
    ----------
    line : int
    time : float
        [s] while it moves or dwells.
    lost : float
        [s] beyond the time at its programmed feed, or of a rapid at its highest speed; a dwell
        loses none.
    shares : list of Share
        The longest first.
    """

    line: int
    time: float
    lost: float
    shares: list[Share]


@dataclass(frozen=True)
class CommandedMotion:
    """The commanded motion of a program.

    Attributes
    ----------
    frame : float
        [s] between two rows.
    rows : (n,) structured ndarray
        ``time`` [s], ``place`` (6,) [mm], ``speed`` and programmed ``feed`` along the path [mm/s],
        ``line``, ``command``, ``cause`` (a key of `CAUSES`), ``axis`` (from 1; 0 of the path).
    axes : tuple of str
        Names of the six axes.
    driven : bool
        Of a run, with its waits; else planned.
    """

    frame: float
    rows: NDArray[Any]
    axes: tuple[str, ...]
    driven: bool = False

    @property
    def time(self) -> float:
        """Cycle time [s]."""
        return len(self.rows) * self.frame

    def shares(self, rows: NDArray[Any] | None = None) -> list[Share]:
        """Time of each limit, the longest first, of all rows or of some.

        Parameters
        ----------
        rows : structured ndarray, optional
            Some of `rows`.
        """
        found = self.rows if rows is None else rows
        keys, counts = np.unique(found["cause"] * 8 + found["axis"], return_counts=True)
        forget(found)
        shares = [
            Share(CAUSES[int(k) // 8], self._name(int(k % 8)), int(n) * self.frame)
            for k, n in zip(keys, counts, strict=True)
        ]
        return sorted(shares, key=lambda s: -s.time)

    def _name(self, axis: int) -> str:
        """Name of an axis from 1; 0 is none, one beyond the machine's is outside the arm."""
        names = ("", *self.axes)
        return names[axis] if axis < len(names) else "external"

    def blocks(self, most: int | None = None) -> list[Block]:
        """Lines of the program, those that lose most first.

        Parameters
        ----------
        most : int, optional
            So many at most.
        """
        rows = self.rows
        driven = np.divide(
            rows["speed"], rows["feed"], out=np.zeros(len(rows)), where=rows["feed"] > 0.0
        )
        lost = np.where(rows["cause"] == DWELL, 0.0, (1.0 - driven) * self.frame)
        lines, of = np.unique(rows["line"], return_inverse=True)
        total, missed = np.bincount(of) * self.frame, np.bincount(of, lost)
        forget(rows)
        order = np.argsort(-missed, kind="stable")[:most]
        return [
            Block(int(lines[k]), float(total[k]), float(missed[k]), self.shares(rows[of == k]))
            for k in order
        ]

    @cached_property
    def slowest(self) -> list[Block]:
        """The lines that lose most, ten at most."""
        return self.blocks(SLOWEST)

    def numbers(self) -> dict[str, Any]:
        """Cycle time, where it goes, the ten slowest lines, for JSON."""

        def listed(shares: Sequence[Share]) -> list[dict[str, Any]]:
            return [{"cause": s.cause, "axis": s.axis, "time": s.time} for s in shares]

        blocks = [
            {"line": b.line, "time": b.time, "lost": b.lost, "where": listed(b.shares)}
            for b in self.slowest
        ]
        return {"time": self.time, "where": listed(self.shares()), "blocks": blocks}


def planned(scenario: Scenario, set: Mapping[str, Any] | None = None) -> CommandedMotion:
    """Plan a program as the scenario's controller will command it.

    Waits for an operator, an input, a probe or an axis' position take no time.

    Parameters
    ----------
    scenario : Scenario
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.

    Returns
    -------
    CommandedMotion

    Raises
    ------
    InputError
        No controller of the scenario plans programs, or it refuses one.
    """
    rows = _rows_of_job(scenario, set or {})
    if rows is None:
        rows = plan_rows(scenario, set or {})
    axes = tuple(axis.name for axis in scenario.document.controller_axes)
    return CommandedMotion(float(rows["time"][0]) if len(rows) else 0.0, rows, axes)


def _rows_of_job(scenario: Scenario, set: Mapping[str, Any]) -> NDArray[Any] | None:
    """What the planner of a network card's job has left beside it; None of any other."""
    body = scenario.document.body
    job = str(set.get(str(body.signals.program), body.set.get(str(body.signals.program), "")))
    if body.signals.config is None or not job or not motion_file(job).is_file():
        return None
    rows: NDArray[Any] = np.load(motion_file(job))
    return rows
