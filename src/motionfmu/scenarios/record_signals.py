"""The record of a scenario: which inputs it drives, and which signals it is laid over."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units
from motionfmu.base.errors import Faults, InputError
from motionfmu.base.units import spelled
from motionfmu.scenarios import recording
from motionfmu.scenarios.analyses import RecordFile
from motionfmu.scenarios.port import Port
from motionfmu.scenarios.system import End, Resolver, Setting, Stimulus
from motionfmu.scenarios.values import WHOLE, start_values

if TYPE_CHECKING:
    from motionfmu.records import Record

TABLE = "record_file"
DRIVE, OVER = f"{TABLE}.drive", f"{TABLE}.over"
# Each step at which a driven input changes is a call of the FMU, and takes 200 bytes.
CHANGES_MAX = 2_000_000
Array = NDArray[Any]


@dataclass(frozen=True)
class Overlay:
    """A column of the record over an output, or over an element of one."""

    signal: str
    end: End
    element: int | None  # from 0
    column: str
    values: Array  # (n,) in the output's unit

    @property
    def unit(self) -> str:
        """Unit of both, as FMI spells it."""
        return self.end.port.unit or "1"


def table_of(resolver: Resolver) -> RecordFile | None:
    """The table of the scenario that names a record."""
    return resolver.document.body.record_file


def record_of(resolver: Resolver) -> "Record":
    """The record that the scenario names; it is read once."""
    if TABLE not in resolver.known:
        resolver.known[TABLE] = _read(resolver)
    found = resolver.known[TABLE]
    if isinstance(found, InputError):
        raise found
    assert not isinstance(found, InputError)
    return found


def file_of(resolver: Resolver) -> Path:
    """The record's file, or a result's folder, beside the scenario or what it is made of."""
    table, document = table_of(resolver), resolver.document
    assert table is not None
    places = [s.folder / table.file for s in document.sources]
    found = document.beside(table.file) or next((p for p in places if p.is_dir()), None)
    if found is None:
        raise document.error(f"file = {table.file!r}: no such record", TABLE, "file")
    return found


def _read(resolver: Resolver) -> "Record | InputError":
    table, document = table_of(resolver), resolver.document
    assert table is not None
    try:
        from motionfmu.records import record

        return record(file_of(resolver), **table.layout)
    except InputError as error:
        told, prefix = str(error), "record: "
        if told.startswith(prefix):
            return document.error(told[len(prefix) :], TABLE)
        return error


def wanted(resolver: Resolver) -> list[str]:
    """Outputs that the record is laid over, for recording."""
    return list(dict.fromkeys(o.end.name for o in overlays(resolver)))


def overlays(resolver: Resolver) -> list[Overlay]:
    """What the record is laid over, element by element, in the outputs' units."""
    table = table_of(resolver)
    if table is None:
        return []
    if OVER in resolver.known:
        return list(resolver.known[OVER])
    measured = record_of(resolver)
    found: list[Overlay] = []
    faults = Faults()
    for pair in table.over.items():
        with faults.each():
            found += of_signal(resolver, measured, pair, OVER)
    faults.tell()
    resolver.known[OVER] = found
    return found


def of_signal(
    resolver: Resolver, measured: "Record", pair: tuple[str, str], table: str
) -> list[Overlay]:
    """A column over a signal; a whole array has a column of as many elements."""
    signal, column = pair
    end, elements = recording.elements(resolver, signal, table, signal)
    try:
        data = in_unit_of(measured, column, end.port)
    except InputError as error:
        raise resolver.document.error(str(error), table, signal) from None
    if "[" in signal and resolver.split(signal) != (signal, None):
        elements = (elements[0],)
    wide = data.reshape(len(data), -1)
    if wide.shape[1] != max(1, len(elements)):
        told = f"{column} has {wide.shape[1]} elements, {signal} has {max(1, len(elements))}"
        raise resolver.document.error(told, table, signal)
    if not elements:
        return [Overlay(signal, end, None, column, wide[:, 0])]
    many = data.ndim == 2
    return [
        Overlay(
            f"{end.name}[{k}]", end, k - 1, f"{column}[{i + 1}]" if many else column, wide[:, i]
        )
        for i, k in enumerate(elements)
    ]


def in_unit_of(measured: "Record", column: str, port: Port) -> Array:
    """A column in the unit of a variable; a variable without one takes plain numbers."""
    if port.unit is None:
        own = measured.unit(column)
        if own is not None and own.exponents != units.parse("1").exponents:
            told = f"{column} is in [{spelled(own.name)}], {port.name} is a plain number"
            raise InputError(f"{measured.name}: {told}")
        data = np.asarray(measured[column], dtype=np.float64)
        return data if own is None else data * own.factor
    return measured.in_unit(column, port.unit)


def stimuli(
    resolver: Resolver, times: tuple[int, int], settings: Iterable[Setting]
) -> list[Stimulus]:
    """What the record drives at each step [ns] of so many, in the order of the steps.

    An input takes the record's value at the beginning of a step and keeps it for the step; between
    samples real values lie as the table's `resample` says, and counts hold.
    """
    table = table_of(resolver)
    if table is None or not table.drive:
        return []
    base = {s.end.name: s.values for s in settings}
    key = (DRIVE, times, tuple(base.get(n.partition("[")[0]) for n in table.drive))
    if key in resolver.known:
        return list(resolver.known[key])
    faults, found = Faults(), list[Stimulus]()
    whole: dict[str, dict[int | None, str]] = {}
    for name in table.drive:
        with faults.each():
            variable, element = resolver.split(name)
            whole.setdefault(variable, {})[element] = name
    for variable, names in whole.items():
        with faults.each():
            found += _driven(resolver, (variable, names), times, base)
    faults.tell()
    for old in [k for k in resolver.known if isinstance(k, tuple)]:  # only the last is kept
        del resolver.known[old]
    resolver.known[key] = sorted(found, key=lambda s: s.step)
    return list(resolver.known[key])


# CCN 20: what an input may not be, each with its message.
def _driven(
    resolver: Resolver,
    given: tuple[str, Mapping[int | None, str]],
    times: tuple[int, int],
    base: Mapping[str, Any],
) -> list[Stimulus]:
    """The stimuli of one input."""
    document, table = resolver.document, table_of(resolver)
    assert table is not None
    variable, names = given
    first = next(iter(names.values()))
    end = resolver.end(variable, DRIVE, first)
    port = end.port
    if port.causality != "input" and not port.tunable:
        raise document.error(f"{end.name} is no input ({port.causality})", DRIVE, first)
    if any(d.input == end.name for d in document.body.drive):
        raise document.error(f"{end.name} is driven by [[drive]], too", DRIVE, first)
    if port.type not in ("Float64", "Float32", "Boolean", *WHOLE):
        raise document.error(f"{end.name} is {port.type}, which no record drives", DRIVE, first)
    if None in names and len(names) > 1:
        raise document.error(f"{end.name} is driven whole and by element", DRIVE, first)
    for element, name in names.items():
        if element is not None and not 0 <= element < port.count * bool(port.shape):
            raise document.error(f"{name}: no such element", DRIVE, name)
    step_ns, steps = times
    start = base.get(end.name) or start_values(port)
    values = np.empty((steps, port.count))
    values[:] = np.asarray(start if len(start) == port.count else start * port.count, dtype=float)
    for element, name in names.items():
        column = _sampled(resolver, (name, table.drive[name]), end, np.arange(steps) * step_ns)
        wide = 1 if element is not None else port.count
        if column.shape[1] != wide:
            told = f"{table.drive[name]} has {column.shape[1]} elements, {name} has {wide}"
            raise document.error(told, DRIVE, name)
        values[:, slice(None) if element is None else [element]] = column
    change = np.flatnonzero((np.diff(values, axis=0) != 0).any(axis=1)) + 1
    if len(change) >= CHANGES_MAX:
        told = f"{len(change)} changes of {end.name}; {CHANGES_MAX} are the most: a longer step"
        raise document.error(told, DRIVE, first)
    kind: Any = {"Boolean": bool}.get(port.type, float if port.type.startswith("Float") else int)
    return [
        Stimulus(end, k, tuple(map(kind, values[k].tolist())), True) for k in [0, *change.tolist()]
    ]


def _sampled(resolver: Resolver, pair: tuple[str, str], end: End, ns: Array) -> Array:
    """Values (m, k) of a column at the times of the steps, in the input's unit."""
    document, table, measured = resolver.document, table_of(resolver), record_of(resolver)
    assert table is not None
    name, column = pair
    port = end.port
    try:
        data = in_unit_of(measured, column, port)
    except InputError as error:
        raise document.error(str(error), DRIVE, name) from None
    data = data.reshape(len(data), -1)
    tail = measured.ns[-1] + measured.step_ns  # a sample holds for as long as others do
    if ns[0] < measured.ns[0] or ns[-1] >= tail:
        own = f"{measured.time[0]:.9g} to {measured.time[-1]:.9g} s"
        told = f"the run has steps from 0 to {ns[-1] / 1e9:.9g} s"
        raise document.error(f"{name}: {measured.name} has {own}, {told}", DRIVE, name)
    used = slice(0, int(np.searchsorted(measured.ns, ns[-1])) + 1)
    good: Array = np.asarray(np.isfinite(data).all(axis=1))
    if table.gaps == "refuse":
        ask = 'gaps = "interpolate" bridges it'
        bad = np.flatnonzero(~good[used])
        if len(bad):
            told = f"{measured.place(int(bad[0]))}: {column} has no value, which drives {name}"
            raise InputError(f"{told}: {ask}")
        for before, after in measured.gaps:
            if before < used.stop and measured.ns[after] > 0:
                span = f"{measured.time[before]:.9g} to {measured.time[after]:.9g} s"
                told = f"{measured.place(after)}: no samples from {span}, which drive {name}"
                raise InputError(f"{told}: {ask}")
    known = measured.ns[good]
    if not len(known) or known[0] > ns[0]:
        raise InputError(f"{measured.place(0)}: {column} has no value, which drives {name}")
    _check_range(measured, (column, data), end, np.flatnonzero(good))
    real = port.type.startswith("Float")
    from motionfmu.records import resampling as between

    how = table.resample if real else between.HOLD
    return between.at(known, data[good], np.minimum(ns, known[-1]), how)


def _check_range(measured: "Record", column: tuple[str, Array], end: End, rows: Array) -> None:
    """Refuse a value that the input cannot have; the message says where it stands."""
    name, data = column
    port = end.port
    least, most = WHOLE.get(port.type, (-np.inf, np.inf))
    low, high = max(port.low, least), min(port.high, most)
    if port.type == "Boolean":
        low, high = 0, 1
    outside = (data[rows] < low) | (data[rows] > high)
    if len(bad := np.argwhere(outside)):
        row, k = rows[bad[0, 0]], bad[0, 1]
        told = f"{name} = {data[row, k]:g}: {end.name} is within {low:g} .. {high:g}"
        raise InputError(f"{measured.place(int(row))}: {told}")
    broken = data[rows] != np.round(data[rows])
    if not port.type.startswith("Float") and len(bad := np.argwhere(broken)):
        row, k = rows[bad[0, 0]], bad[0, 1]
        told = f"{name} = {data[row, k]:g}: {end.name} is a whole number"
        raise InputError(f"{measured.place(int(row))}: {told}")
