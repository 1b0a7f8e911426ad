"""The outcome of a study: its rows, and the ways in which it can be run."""

from collections import Counter
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, fields
from functools import cached_property
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.shown_by import drawn
from motionfmu.base.units import spelled
from motionfmu.study.study_axes import Normal, Value
from motionfmu.study.study_definition import Study
from motionfmu.study.study_table import TableRows
from motionfmu.study.worker import OK, Row

EDGE = 0.02  # part of an axis that counts as its end, where points are drawn at random
MESSAGES = 1000  # different ones that are counted; of the others it is known how many rows they are


@dataclass(frozen=True)
class Ways:
    """How a study is run; its rows are the same in all ways.

    Attributes
    ----------
    workers : int or None
        Processes on this machine; None for one per core.
    scheduler : str or None
        Address of a dask.distributed scheduler, instead of processes here.
    fresh : bool
        Begin again instead of resuming.
    progress : callable
        Called with the number of rows done and, among them, of those with an error.
    """

    workers: int | None = None
    scheduler: str | None = None
    fresh: bool = False
    progress: Callable[[int, int], None] = lambda done, errors: None

    def __new__(cls, *_: Any, **given: Any) -> Self:
        """Refuse an option that does not exist, and suggest one that does."""
        known = [f.name for f in fields(cls)]
        for name in given:
            if name not in known:
                raise InputError(f"Ways: no option {name!r}{suggestion(name, known)}")
        return super().__new__(cls)


class Told:
    """The messages of some rows: how often each comes, and in which run first."""

    def __init__(self) -> None:
        self.times: Counter[str] = Counter()
        self.first: dict[str, int] = {}
        self.others = 0  # rows with messages beyond MESSAGES different ones

    def add(self, run: int, message: str) -> None:
        """Count the message of a row."""
        if message in self.first or len(self.first) < MESSAGES:
            self.first.setdefault(message, run)
            self.times[message] += 1
        else:
            self.others += 1


class RowCounts:
    """What is counted in one pass over the rows of a study."""

    def __init__(self, rows: Sequence[Row]) -> None:
        self.ok = np.zeros(len(rows), dtype=bool)  # one per row
        self.held = self.judged = 0  # rows whose checks hold, that have any
        self.missing, self.wrong = Told(), Told()  # messages of rows that are ok, of the others
        own = rows.own() if isinstance(rows, TableRows) else map(_own, rows)
        for place, (run, status, message, checks) in enumerate(own):
            self.ok[place] = status == OK
            self.held += checks is True
            self.judged += checks is not None
            if message:
                (self.missing if status == OK else self.wrong).add(run, message)


def _own(row: Row) -> tuple[int, str, str, bool | None]:
    return row.run, row.status, row.message, row.checks


@dataclass(frozen=True)
class Outcome:
    """A study that has ended.

    Attributes
    ----------
    study : Study
    rows : sequence of Row
        One per point, in order; those of a study that was run are read from its table.
    folder : Path
        Holds sweep.parquet and the report.
    resumed : int
        Rows that were there before.
    """

    study: Study
    rows: Sequence[Row] = field(repr=False)
    folder: Path
    resumed: int

    def __repr__(self) -> str:
        return "\n  ".join(
            (f"Study {self.study.name}", *self.summary, f"rows and report in {self.folder}")
        )

    def _repr_html_(self) -> str:
        return str(drawn("studies.sweep_view").sweep_html(self))

    @property
    def summary(self) -> list[str]:
        """Runs, checks, and the best run with its cost, in words."""
        rows, study, best = self.rows, self.study, self.best
        how = study.sampling if study.sampling == "grid" else f"{study.sampling}, seed {study.seed}"
        lines = [f"{len(rows)} runs ({how}), {self.errors} with an error"]
        if self.counts.judged:
            lines.append(f"checks hold in {self.counts.held} of {len(rows)} runs")
        if best is not None:
            units = {c.name: spelled(c.unit) for c in study.columns}
            value = f"{self.cost[best]:.6g} {units[study.shown]}".strip()
            at = zip(study.axes, study.points[best], strict=True)
            texts = (f"{x.name} = {_shown(v)} {spelled(x.unit)}".rstrip() for x, v in at)
            lines += [f"smallest {study.shown}: {value} in run {best}", f"at {', '.join(texts)}"]
            if edge := self.at_the_edge:
                lines.append(f"at the edge of the study: {'; '.join(edge)}")
        return lines

    def axis(self, name: str) -> list[Value]:
        """Values of an axis.

        Parameters
        ----------
        name : str

        Returns
        -------
        list
            One per row, in the variable's unit.
        """
        rows, i = self.rows, self.study.job.axes.index(name)
        if isinstance(rows, TableRows):
            return self.study.points.column(i, rows.numbers("run").astype(np.int64))
        return self.study.points.column(i, [row.run for row in rows])

    def column(self, name: str) -> NDArray[np.float64]:
        """Values of a result.

        Parameters
        ----------
        name : str

        Returns
        -------
        ndarray, shape (n,)
            NaN where a run gave none.
        """
        i = self.study.job.columns.index(name)
        if isinstance(self.rows, TableRows):
            return self.rows.numbers(name)
        values = (row.values[i] for row in self.rows)
        return np.array([np.nan if v is None else v for v in values], dtype=np.float64)

    @cached_property
    def cost(self) -> NDArray[np.float64]:
        """The cost, or the first result, shape (n,); NaN for none."""
        return self.column(self.study.shown)

    @cached_property
    def counts(self) -> RowCounts:
        """Rows without an error, checks that hold, messages."""
        return RowCounts(self.rows)

    @cached_property
    def best(self) -> int | None:
        """Run of the smallest cost without an error, or None."""
        # It is None as well if the study has no cost.
        if not self.study.cost:
            return None
        cost = np.where(self.counts.ok, self.cost, np.nan)
        return None if np.isnan(cost).all() else self.rows[int(np.nanargmin(cost))].run

    @cached_property
    def least(self) -> float | None:
        """Cost of the best run, or None."""
        return None if self.best is None else float(np.nanmin(self.cost[self.counts.ok]))

    @cached_property
    def at_the_edge(self) -> list[str]:
        """In words, the axes at one of whose ends the best run lies."""
        # Beyond such an end the cost may be smaller.
        if (best := self.best) is None:
            return []
        points = self.study.points
        ties = [self.rows[int(place)].run for place in np.flatnonzero(self.cost == self.least)]
        found = []
        for i, axis in enumerate(self.study.axes):
            if axis.end.port.type not in ("Float64", "Int32") or isinstance(axis.source, Normal):
                continue
            ends = np.array([points.different(i)[k] for k in (0, -1)], dtype=np.float64)
            tied = np.array(points.column(i, ties), dtype=np.float64)
            place = axis.place(np.concatenate([ends, tied]))[2:]
            for end, name in ((place <= EDGE, "smallest"), (place >= 1.0 - EDGE, "largest")):
                if end.all():
                    value = f"{points[best][i]:.6g} {spelled(axis.unit)}".strip()
                    found.append(f"{axis.name} = {value}, the {name} of the study")
        return found

    @property
    def errors(self) -> int:
        """Number of rows that are not ok."""
        return int((~self.counts.ok).sum())


def _shown(value: Value) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
