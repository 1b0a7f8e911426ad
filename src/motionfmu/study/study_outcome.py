"""The outcome of a study: its rows, and the ways in which it can be run."""

from collections.abc import Callable
from dataclasses import dataclass, field, fields
from pathlib import Path
from typing import Any, Self

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.shown_by import drawn
from motionfmu.base.units import spelled
from motionfmu.study.study_axes import Normal, Value
from motionfmu.study.study_definition import Study
from motionfmu.study.worker import OK, Row

EDGE = 0.02  # part of an axis that counts as its end, where points are drawn at random


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


@dataclass(frozen=True)
class Outcome:
    """A study that has ended.

    Attributes
    ----------
    study : Study
    rows : list of Row
        One per point, in order.
    folder : Path
        Holds sweep.parquet and the report.
    resumed : int
        Rows that were there before.
    """

    study: Study
    rows: list[Row] = field(repr=False)
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
        if any(row.checks is not None for row in rows):
            held = sum(row.checks is True for row in rows)
            lines.append(f"checks hold in {held} of {len(rows)} runs")
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
        i = self.study.job.axes.index(name)
        return [self.study.points[row.run][i] for row in self.rows]

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
        values = (row.values[i] for row in self.rows)
        return np.array([np.nan if v is None else v for v in values], dtype=np.float64)

    @property
    def cost(self) -> NDArray[np.float64]:
        """The cost, or the first result, shape (n,); NaN for none."""
        return self.column(self.study.shown)

    @property
    def best(self) -> int | None:
        """Run of the smallest cost without an error, or None."""
        # It is None as well if the study has no cost.
        if not self.study.cost:
            return None
        good = np.array([row.status == OK for row in self.rows], dtype=bool)
        cost = np.where(good, self.cost, np.nan)
        return None if np.isnan(cost).all() else int(np.nanargmin(cost))

    @property
    def at_the_edge(self) -> list[str]:
        """In words, the axes at one of whose ends the best run lies."""
        # Beyond such an end the cost may be smaller.
        if (best := self.best) is None:
            return []
        ties = np.flatnonzero(self.cost == self.cost[best])
        found = []
        for axis in self.study.axes:
            if axis.end.port.type not in ("Float64", "Int32") or isinstance(axis.source, Normal):
                continue
            place = axis.place(np.array(self.axis(axis.name), dtype=np.float64))[ties]
            for end, name in ((place <= EDGE, "smallest"), (place >= 1.0 - EDGE, "largest")):
                if end.all():
                    value = f"{self.axis(axis.name)[best]:.6g} {spelled(axis.unit)}".strip()
                    found.append(f"{axis.name} = {value}, the {name} of the study")
        return found

    @property
    def errors(self) -> int:
        """Number of rows that are not ok."""
        return sum(row.status != OK for row in self.rows)


def _shown(value: Value) -> str:
    return f"{value:.6g}" if isinstance(value, float) else str(value)
