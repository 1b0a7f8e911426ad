"""A record of one axis as numbers: time and columns."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.records import Record

Array = NDArray[np.float64]
# Share of the sampling interval by which instants may lie off an even grid.
_UNEVEN = 1e-3
_FEWEST = 20


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


def of_record(record: Record) -> AxisRecord:
    """A measured record's single columns, which are numbers at even instants."""
    columns = {name: np.asarray(record[name], np.float64) for name in record.columns}
    single = {name: values for name, values in columns.items() if values.ndim == 1}
    units = {name: record.units.get(name) or "" for name in single}
    return AxisRecord(record.time, single, units, record.name)
