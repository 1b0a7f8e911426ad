"""A frequency response from a table, as drives' Bode tools write it."""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.measured_response.response_estimate import MeasuredResponse
from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.identify.recorded_loop import ColumnUse
from motionfmu.records.csv_table import csv_table
from motionfmu.records.layout import Layout
from motionfmu.records.quantities import quantity
from motionfmu.records.raw_table import RawTable
from motionfmu.records.readers import TEXTS
from motionfmu.scenarios.port import Port

Array = NDArray[np.float64]
# Names of columns without regard to case; what a unit says is stronger.
_FREQUENCIES = {"frequency", "freq", "freq.", "f", "omega", "frequenz", "hz", "frequency hz"}
_GAINS = {"gain", "magnitude", "mag", "amplitude", "ampl", "amplitudengang", "betrag", "|g|"}
_PHASES = {"phase", "phi", "phasengang", "angle"}
_COHERENCES = {"coherence", "kohärenz", "coh", "gamma2", "γ²"}
_REALS, _IMAGINARIES = {"real", "re", "real part"}, {"imag", "im", "imaginary", "imaginary part"}
_QUOTIENT = re.compile(r"\((.*)\)\s*/\s*\((.*)\)")
_DECIBEL = re.compile(r"\s*[(\[]?\s*db\s*[)\]]?$", re.IGNORECASE)


@dataclass(frozen=True)
class ResponseTable:
    """The columns of a table of frequencies, by number; None: there is none."""

    table: RawTable
    frequency: int
    gain: int | None
    phase: int | None
    real: int | None
    imaginary: int | None
    coherence: int | None


def _plain(name: str) -> str:
    return _DECIBEL.sub("", name).strip().lower()


def _is_decibel(table: RawTable, k: int) -> bool:
    unit = table.units[k] or ""
    return unit.strip().lower() == "db" or (not unit and bool(_DECIBEL.search(table.names[k])))


def _find(table: RawTable, names: set[str]) -> int | None:
    return next((k for k, n in enumerate(table.names) if _plain(n) in names), None)


def response_table(file: Path) -> ResponseTable | None:
    """The columns of a table of frequencies; None if the file is something else."""
    if file.suffix.lower() not in TEXTS or not file.is_file():
        return None
    table = csv_table(file, Layout())
    frequency = _find(table, _FREQUENCIES)
    if frequency is None:
        hertz = [k for k, u in enumerate(table.units) if (u or "").strip().lower() in ("hz", "khz")]
        frequency = hertz[0] if hertz else None
    gain = _find(table, _GAINS)
    if gain is None:
        gain = next((k for k in range(len(table.names)) if _is_decibel(table, k)), None)
    phase = _find(table, _PHASES)
    real, imaginary = _find(table, _REALS), _find(table, _IMAGINARIES)
    if frequency is None or (gain is None and real is None):
        return None
    return ResponseTable(table, frequency, gain, phase, real, imaginary, _find(table, _COHERENCES))


def _column(table: RawTable, k: int) -> Array:
    """A column that has a number in every row."""
    values = np.asarray(table.values[k], np.float64)
    bad = np.flatnonzero(~np.isfinite(values))
    if len(bad):
        raise InputError(f"{table.where(int(bad[0]), k)}: {table.names[k]}: a number wanted")
    return values


def _in_unit(table: RawTable, k: int, wanted: str, usual: float) -> Array:
    """A column in a unit; `usual` is the factor where none is said."""
    values, unit = _column(table, k), table.units[k]
    if unit is None:
        return values * usual
    try:
        own = quantity(unit)
    except ValueError as error:
        raise InputError(f"{table.where(-1, k)}: {table.names[k]}: {error}") from None
    there = units.parse(wanted)
    if own.exponents != there.exponents:
        if wanted == "Hz" and own.exponents == units.parse("rad/s").exponents:
            return values * own.factor / (2.0 * math.pi)
        told = f"{table.names[k]} is in [{unit}], [{units.spelled(wanted)}] wanted"
        raise InputError(f"{table.where(-1, k)}: {told}")
    return values * own.factor / there.factor


def read_response(
    found: ResponseTable, uses: Mapping[str, ColumnUse], ports: Mapping[str, Mapping[str, Port]]
) -> tuple[MeasuredResponse, tuple[str, str]]:
    """The response of a table in the units of its signals, and its input and output.

    `uses` has one column, the gain (or the real part): ``OUTPUT/INPUT``.
    """
    table = found.table
    hertz = _in_unit(table, found.frequency, "Hz", 1.0)
    if not (hertz > 0.0).all():
        k = int(np.flatnonzero(hertz <= 0.0)[0])
        where = table.where(k, found.frequency)
        raise InputError(f"{where}: {table.names[found.frequency]} = {hertz[k]:g}: above 0 wanted")
    order = np.argsort(hertz, kind="stable")
    twice = np.flatnonzero(np.diff(hertz[order]) == 0.0)
    if len(twice):
        k = int(order[twice[0] + 1])
        raise InputError(f"{table.where(k, found.frequency)}: {hertz[k]:g} Hz is there twice")
    kept = found.gain if found.gain is not None else found.real
    assert kept is not None
    name = table.names[kept]
    pair, factor = _pair(table, kept, uses, ports)
    if found.gain is not None:
        if found.phase is None:
            raise InputError(f"{table.name}: {name} without a phase: a column phase [°] wanted")
        size = _column(table, kept)
        decibel = _is_decibel(table, kept)
        size = 10.0 ** (size / 20.0) if decibel else size
        bad = np.flatnonzero(size <= 0.0)
        if len(bad):
            raise InputError(
                f"{table.where(int(bad[0]), kept)}: {name} = {size[bad[0]]:g}: above 0 wanted;"
                " a gain in decibels says [dB]"
            )
        angle = _in_unit(table, found.phase, "rad", math.pi / 180.0)
        values = size * np.exp(1j * angle)
    else:
        if found.imaginary is None:
            raise InputError(f"{table.name}: {name} without an imaginary part")
        values = _column(table, kept) + 1j * _column(table, found.imaginary)
    values = (values * factor)[order]
    coherence = np.full(len(hertz), math.nan)
    deviation = coherence.copy()
    notes = ["the table tells no coherence: how sure it is comes from what the model leaves"]
    if found.coherence is not None:
        coherence = np.clip(_column(table, found.coherence)[order], 1e-6, 1.0)
        deviation = np.abs(values) * np.sqrt((1.0 - coherence) / (2.0 * coherence))
        notes = ["deviations are those that the coherence tells of one average"]
    measured = MeasuredResponse(
        2.0 * math.pi * hertz[order],
        values,
        deviation,
        coherence,
        f"a table of {len(hertz)} frequencies",
        table.name,
        tuple(notes),
    )
    return measured, pair


def _pair(
    table: RawTable,
    column: int,
    uses: Mapping[str, ColumnUse],
    ports: Mapping[str, Mapping[str, Port]],
) -> tuple[tuple[str, str], float]:
    """Input and output of the gain's column, and its factor to their units."""
    name = table.names[column]
    bare = {n: n for n in (name, _DECIBEL.sub("", name).strip(), _plain(name))}
    use = next((uses[n] for n in bare if n in uses), None)
    ask = f"--column {_DECIBEL.sub('', name).strip()}=OUTPUT/INPUT says of what"
    if use is None:
        others = ", ".join(n for n in uses if n not in bare)
        told = f" (--column {others}: no such column here)" if others else ""
        raise InputError(f"{table.where(-1, column)}: {name}: {ask}{told}")
    output, stroke, source = (part.strip() for part in use.signal.partition("/"))
    if not stroke or "." not in source or "." not in output:
        raise InputError(f"--column {name}={use.signal}: OUTPUT/INPUT wanted, as {ask}")
    if use.scale is not None:
        return (source, output), use.scale
    return (source, output), _factor(table, column, [_unit(ports, s) for s in (output, source)])


def _factor(table: RawTable, column: int, both: list[str]) -> float:
    """Of a gain in its own unit, to those of its output and input, `both`."""
    name, unit = table.names[column], table.units[column]
    if unit is None or unit.strip() in ("", "1", "-") or _is_decibel(table, column):
        return 1.0
    there, own = _divided("/".join(f"({u})" for u in both)), _divided(unit)
    if there is None or own is None or own.exponents != there.exponents:
        shown = "/".join(f"[{units.spelled(u)}]" for u in both)
        told = f"{name} is in [{unit}], the response of its signals in {shown}: say its scale"
        raise InputError(f"{table.where(-1, column)}: {told}")
    return own.factor / there.factor


def _divided(unit: str) -> units.Unit | None:
    """A unit, or a quotient of two whose parts may stand in brackets: ``(rad/s)/(N.m)``."""
    upper, stroke, lower = unit.rpartition("/")
    found = _QUOTIENT.fullmatch(unit.strip())
    if found:
        upper, stroke, lower = found[1], "/", found[2]
    try:
        if not stroke:
            return quantity(unit)
        a, b = quantity(upper.strip("() ") or "1"), quantity(lower.strip("() "))
    except ValueError:
        return None
    exponents = tuple(x - y for x, y in zip(a.exponents, b.exponents, strict=True))
    return units.Unit(unit, a.factor / b.factor, exponents)


def _unit(ports: Mapping[str, Mapping[str, Port]], signal: str) -> str:
    component, _, variable = signal.partition(".")
    port = ports.get(component, {}).get(variable.partition("[")[0])
    if port is None:
        raise InputError(f"{signal}: the scenario has no such variable")
    return port.unit or "1"
