"""Signals over time with their units, from a file or from a run."""

import re
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.units import Unit, convertible, spelled
from motionfmu.records import resampling
from motionfmu.records.quantities import fmi_name, quantity, si_name
from motionfmu.records.resampling import LINEAR, ResamplingError
from motionfmu.records.writers import RecordColumns, write

Array = NDArray[Any]
# Two samples that are farther apart than so many usual ones have a gap between them.
GAP = 1.5
# Samples are even if none is farther than this from its place, of a step: clocks of drives jitter.
EVEN = 0.01
_ELEMENT = re.compile(r"^(.*\S)\[([0-9]+)\]$", re.DOTALL)


@dataclass(frozen=True, eq=False, repr=False)
class Record(Mapping[str, Array]):
    """Signals over time, measured or simulated.

    ``record["position"]`` is a column, (n,) or (n, k), ``record["position[1]"]`` an element of it.
    What has no value there is NaN.

    Attributes
    ----------
    name : str
        Of the file, or of the run.
    ns : ndarray of int64, shape (n,)
        Times [ns], increasing.
    columns : mapping
        By name, (n,) or (n, k).
    units : mapping
        By name, in FMI's spelling; a text that is no unit, such as ``inc``; None if unknown.
    lines : ndarray or None
        Line of the file on which each sample stands.
    notes : tuple of str
        What was taken for granted, left out or mended when the file was read.
    resampled : mapping
        Of a record on new instants: how far off each column may be, in its unit here.
    """

    name: str
    ns: Array
    columns: Mapping[str, Array]
    units: Mapping[str, str | None]
    lines: Array | None = None
    notes: tuple[str, ...] = ()
    resampled: Mapping[str, ResamplingError] = field(default_factory=dict)

    __eq__ = object.__eq__
    __hash__ = object.__hash__

    def __getitem__(self, name: str) -> Array:
        return self._found(name)[1]

    def __iter__(self) -> Iterator[str]:
        return iter(self.columns)

    def __len__(self) -> int:
        return len(self.columns)

    def __bool__(self) -> bool:
        return True

    def __repr__(self) -> str:
        span = f"{self.time[0]:.9g} .. {self.time[-1]:.9g} s"
        rate = f"{self.rate:.6g} Hz" if self.rate else "uneven"
        shown = ", ".join(
            f"{n} [{spelled(u) or '1'}]" if (u := self.units.get(n)) else n for n in self
        )
        return f"<Record {self.name}: {len(self.ns)} samples, {span}, {rate}: {shown}>"

    def _found(self, name: str) -> tuple[str, Array]:
        """The column of a name, or of an element's name, and its values."""
        if name in self.columns:
            return name, self.columns[name]
        element = _ELEMENT.match(name) if isinstance(name, str) else None
        if element and element[1] in self.columns:
            whole = self.columns[element[1]]
            count = whole.shape[1] if whole.ndim == 2 else 0
            if 1 <= int(element[2]) <= count:
                return element[1], whole[:, int(element[2]) - 1]
            has = f"elements 1 to {count}" if count else "a single value"
            raise InputError(f"{self.name}: no column {name!r}: {element[1]} has {has}")
        told = suggestion(str(name), self.columns) or f" (there are: {', '.join(self.columns)})"
        raise InputError(f"{self.name}: no column {name!r}{told}")

    def __contains__(self, name: object) -> bool:
        try:
            self._found(str(name))
        except InputError:
            return False
        return True

    @cached_property
    def time(self) -> NDArray[np.float64]:
        """Times [s]."""
        return np.asarray(self.ns / 1e9)

    @cached_property
    def step_ns(self) -> float:
        """Median time between two samples [ns]."""
        return float(np.median(np.diff(self.ns))) if len(self.ns) > 1 else 0.0

    @cached_property
    def even(self) -> bool:
        """Whether the samples are even, but for jitter."""
        if len(self.ns) < 2:
            return False
        step = (int(self.ns[-1]) - int(self.ns[0])) / (len(self.ns) - 1)
        off = (self.ns - self.ns[0]) - step * np.arange(len(self.ns))
        return bool(np.abs(off).max() <= max(1.0, EVEN * step))

    @property
    def rate(self) -> float | None:
        """Samples a second [Hz]; None if they are uneven."""
        if not self.even:
            return None
        return 1e9 * (len(self.ns) - 1) / float(self.ns[-1] - self.ns[0])

    @cached_property
    def gaps(self) -> list[tuple[int, int]]:
        """The samples before and behind each gap."""
        wide = np.flatnonzero(np.diff(self.ns) > GAP * self.step_ns)
        return [(int(k), int(k) + 1) for k in wide]

    def missing(self, name: str) -> NDArray[np.bool_]:
        """Samples that have no value.

        Parameters
        ----------
        name : str
            Of a column, or of an element.

        Returns
        -------
        ndarray of bool, shape (n,)
        """
        data = self[name]
        if not np.issubdtype(data.dtype, np.floating):
            return np.zeros(len(data), dtype=bool)
        return np.asarray(np.isnan(data).reshape(len(data), -1).any(axis=1))

    def unit(self, name: str) -> Unit | None:
        """The unit of a column; None if it is unknown or none.

        Parameters
        ----------
        name : str
        """
        written = self.units.get(self._found(name)[0])
        try:
            return None if written is None else quantity(written)
        except ValueError:
            return None

    def in_unit(self, name: str, unit: str | None = None) -> NDArray[np.float64]:
        """A column in another unit.

        Parameters
        ----------
        name : str
            Of a column, or of an element.
        unit : str, optional
            As drives or FMUs write it; that of the SI if none.

        Returns
        -------
        ndarray
            Numbers of its own, (n,) or (n, k).

        Raises
        ------
        InputError
            There is no such column, or it has no unit, or one of another quantity.
        """
        data = np.array(self[name], dtype=np.float64)
        own = self.unit(name)
        if own is None:
            written = self.units.get(self._found(name)[0])
            told = "has no unit" if written is None else f"is in {written!r}, which is no unit"
            ask = f"[{spelled(fmi_name(unit))}] wanted" if unit else "a unit is wanted"
            raise InputError(f"{self.name}: {name} {told}; {ask}: say its unit, and scale")
        if unit is None:
            return data * own.factor
        try:
            wanted = quantity(unit)
        except ValueError as error:
            raise InputError(str(error)) from None
        if wanted.exponents != own.exponents:
            units = (f"[{spelled(u.name) or '1'}]" for u in (own, wanted))
            raise InputError(f"{self.name}: {name} is in {next(units)}, {next(units)} wanted")
        same = own.name == wanted.name or convertible_units(own, wanted)
        return data if same else data * (own.factor / wanted.factor)

    def si_unit(self, name: str) -> str | None:
        """The unit of `in_unit` without a unit, in FMI's spelling.

        Parameters
        ----------
        name : str
        """
        own = self.unit(name)
        return None if own is None else si_name(own.exponents)

    def part(self, start: float, stop: float) -> "Record":
        """The samples from one time to another.

        Parameters
        ----------
        start, stop : float
            [s], both included.

        Raises
        ------
        InputError
            There are less than two.
        """
        keep = (self.ns >= round(start * 1e9)) & (self.ns <= round(stop * 1e9))
        if keep.sum() < 2:
            raise InputError(f"{self.name}: less than two samples from {start:g} to {stop:g} s")
        return self._of(self.ns[keep], {n: x[keep] for n, x in self.columns.items()}, keep)

    def _of(self, ns: Array, columns: Mapping[str, Array], keep: Any = None) -> "Record":
        lines = None if self.lines is None or keep is None else self.lines[keep]
        return Record(self.name, ns, columns, dict(self.units), lines, self.notes)

    def shifted(self, seconds: float) -> "Record":
        """The same samples later.

        Parameters
        ----------
        seconds : float
            Added to all times [s].
        """
        return self._of(self.ns + round(seconds * 1e9), self.columns, slice(None))

    def place(self, row: int) -> str:
        """Where a sample stands, for messages.

        Parameters
        ----------
        row : int
            Number of the sample, from 0.
        """
        if self.lines is not None:
            return f"{self.name}:{int(self.lines[row])}"
        return f"{self.name}: sample {row + 1}"

    def at(self, ns: Array, name: str, how: str = LINEAR) -> Array:
        """Values of a column at other times.

        Parameters
        ----------
        ns : ndarray of int64, shape (m,)
            [ns], within the record.
        name : str
        how : str
            ``linear``, on straight lines between samples, or ``hold``, the sample before.

        Returns
        -------
        ndarray
            In the column's unit; at a sample's own time the sample's own value.

        Raises
        ------
        InputError
            A time lies outside the record.
        """
        resampling.check(how)
        wanted = np.asarray(ns, dtype=np.int64)
        if len(wanted) and not (self.ns[0] <= wanted.min() and wanted.max() <= self.ns[-1]):
            low, high = (f"{x / 1e9:.9g}" for x in (wanted.min(), wanted.max()))
            own = f"{self.time[0]:.9g} .. {self.time[-1]:.9g} s"
            raise InputError(f"{self.name}: {low} .. {high} s wanted, the record has {own}")
        return resampling.at(self.ns, self[name], wanted, how)

    def uniform(self, rate: float | None = None, how: str = LINEAR) -> "Record":
        """The record in units of the SI at even times.

        Parameters
        ----------
        rate : float, optional
            Samples a second [Hz]; the record's own, or that of its median step, if none.
        how : str
            ``linear`` or ``hold``, what lies between samples; whole numbers are held.

        Returns
        -------
        Record
            Float64 columns; one without a unit keeps its numbers. Nothing is filtered: what a
            coarser grid does not show is told by `resampled`, as is the error between samples.

        Raises
        ------
        InputError
            The rate gives less than two samples, or no whole numbers of ns.
        """
        resampling.check(how)
        step = self.step_ns if rate is None else 1e9 / rate if rate > 0 else 0.0
        if rate is None and self.rate:
            step = 1e9 / self.rate
        count = int((self.ns[-1] - self.ns[0]) / step + 1e-6) + 1 if step >= 1.0 else 0
        if count < 2:
            raise InputError(f"{self.name}: rate = {rate!r} Hz gives less than two samples")
        ns = self.ns[0] + np.round(step * np.arange(count)).astype(np.int64)
        ns = np.minimum(ns, self.ns[-1])
        columns: dict[str, Array] = {}
        units: dict[str, str | None] = {}
        errors: dict[str, ResamplingError] = {}
        for name, data in self.columns.items():
            own = self.unit(name)
            factor = 1.0 if own is None else own.factor
            found = resampling.at(self.ns, data, ns, how).astype(np.float64)
            columns[name] = found if factor == 1.0 else found * factor
            units[name] = self.units.get(name) if own is None else si_name(own.exponents)
            off = resampling.error(self.ns, data, ns, how)
            errors[name] = ResamplingError(off.between * factor, off.lost * factor)
        return Record(self.name, ns, columns, units, None, self.notes, errors)

    def save(self, file: str | Path) -> Path:
        """Write the record so that it is read back to the bit.

        Parameters
        ----------
        file : str or Path
            ``.csv`` or ``.parquet`` (`pip install "...[study]"`). In a CSV whole numbers and
            Booleans become real numbers.

        Returns
        -------
        Path

        Raises
        ------
        InputError
            Another ending, or the file cannot be written.
        """
        return write(RecordColumns(self.ns, self.columns, self.units), Path(file))


def convertible_units(a: Unit, b: Unit) -> bool:
    """Whether numbers of two units are the same."""
    if "%" in (a.name, b.name):
        return a.name == b.name
    return convertible(a.name, b.name)


def grouped(names: Sequence[str], columns: Sequence[Array], units: Sequence[str | None]) -> Any:
    """Columns and units by name, elements ``X[1]``, ``X[2]`` of one unit as one column."""
    parts: dict[str, dict[int, int]] = {}
    for k, name in enumerate(names):
        element = _ELEMENT.match(name)
        if element:
            parts.setdefault(element[1], {})[int(element[2])] = k
    whole = {
        name: [own[i] for i in range(1, len(own) + 1)]
        for name, own in parts.items()
        if sorted(own) == list(range(1, len(own) + 1))
        and len({units[k] for k in own.values()}) == 1
        and name not in names
    }
    inside = {k: name for name, own in whole.items() for k in own}
    found: dict[str, Array] = {}
    told: dict[str, str | None] = {}
    for k, name in enumerate(names):
        if k not in inside:
            found[name], told[name] = columns[k], units[k]
        elif inside[k] not in found:
            own = whole[inside[k]]
            found[inside[k]], told[inside[k]] = np.column_stack([columns[j] for j in own]), units[k]
    return found, told
