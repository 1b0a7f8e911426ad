"""A record of one axis as numbers: time and columns."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units
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
    """A measured record as numbers at even instants, vectors by element: ``X[1]``."""
    columns: dict[str, Array] = {}
    units: dict[str, str] = {}
    for name in record.columns:
        values = np.asarray(record[name], np.float64)
        parts = {name: values}
        if values.ndim == 2:
            parts = {f"{name}[{k + 1}]": values[:, k] for k in range(values.shape[1])}
        columns |= parts
        units |= dict.fromkeys(parts, record.units.get(name) or "")
    return AxisRecord(record.time, columns, units, record.name)


def column_of(record: AxisRecord, name: str, signal: str) -> Array:
    """A column's values; an InputError says what the record has, and how to name another one."""
    if name in record.columns:
        return record.columns[name]
    told = ", ".join(record.columns)
    raise InputError(
        f"{record.name} has no column {name!r}; it has: {told};"
        f" --column COLUMN={signal} says which one is {signal}"
    )


def scale_of_units(
    record: AxisRecord, name: str, signal: str, unit: str | None
) -> tuple[units.Unit, float]:
    """Unit of a column, and how much of its signal's it is: 0 if it is another quantity."""
    written = record.units.get(name, "")
    if not written and unit not in (None, "", "1"):
        raise no_scale(record, name, signal, unit)  # it may be degrees as well as radians
    try:
        own = units.parse(written or "1")
    except ValueError as error:
        raise InputError(f"{record.name}: column {name}: {error}") from None
    wanted = units.parse(unit or "1")
    return own, own.factor / wanted.factor if own.exponents == wanted.exponents else 0.0


def no_scale(record: AxisRecord, name: str, signal: str, unit: str | None) -> InputError:
    """What to say of a column whose unit is no form of its signal's."""
    own = record.units.get(name, "") or "no unit"
    return InputError(
        f"{record.name}: column {name} [{own}] is no {signal} [{unit or '1'}]: its scale must be"
        f" said: --column '{name}={signal}*SCALE'"
    )
