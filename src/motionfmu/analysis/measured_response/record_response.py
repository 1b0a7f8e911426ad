"""A record of a loop as the signals of a frequency response: which column is what."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import AxisModel
from motionfmu.analysis.linear.block import Plant
from motionfmu.analysis.measured_response.mass_names import PlantMasses
from motionfmu.analysis.measured_response.plant_response import (
    FoundResponse,
    axis_of,
    found_response,
    source_of,
)
from motionfmu.analysis.measured_response.response_estimate import (
    EstimateOptions,
    LoopSignals,
    MeasuredResponse,
    estimate,
    together,
)
from motionfmu.analysis.measured_response.response_table import read_response, response_table
from motionfmu.base import units
from motionfmu.base.errors import InputError
from motionfmu.identify.axis_record import (
    AxisRecord,
    column_of,
    no_scale,
    of_record,
    scale_of_units,
)
from motionfmu.identify.recorded_loop import ColumnUse
from motionfmu.run import Scenario

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ResponseOptions:
    """What is asked of records or of a table.

    Parameters
    ----------
    columns : mapping
        What each column is, by its name: of a record the reference (an input), what moves the plant
        and a position or a speed; of a table its gain as ``OUTPUT/INPUT``.
    axis : int
        From 1.
    estimate : EstimateOptions
    """

    columns: Mapping[str, ColumnUse]
    axis: int = 1
    estimate: EstimateOptions = field(default_factory=EstimateOptions)


@dataclass(frozen=True)
class _ColumnRoles:
    """Columns of a record by what they are."""

    reference: str | None
    input: str
    output: str


def identify_response(
    scenario: Scenario,
    files: Sequence[str | Path | AxisRecord],
    options: ResponseOptions,
    set: Mapping[str, Any] | None = None,
) -> FoundResponse:
    """Find two masses in records of a loop, or in a table.

    Parameters
    ----------
    scenario : Scenario
    files : sequence of str, Path or AxisRecord
        Records over time, which are averaged, or one table of frequency, gain and phase.
    options : ResponseOptions
    set : mapping, optional
        Values by ``component.variable``.

    Returns
    -------
    FoundResponse

    Raises
    ------
    InputError
        What is wrong, with the file.
    """
    from motionfmu import records

    given = dict(set or {})
    model, masses = axis_of(scenario, options.axis, given)
    found: list[MeasuredResponse] = []
    pair = ("", "")
    for file in files:
        table = None if isinstance(file, AxisRecord) else response_table(Path(file))
        if table is not None:
            if len(files) > 1:
                raise InputError(f"{file}: a table of a response stands alone")
            measured, pair = read_response(table, options.columns, scenario.resolver.ports)
            found.append(_in_band(measured, options.estimate))
            continue
        record = file if isinstance(file, AxisRecord) else of_record(records.record(file))
        roles = _roles(record, options.columns, (model, masses))
        pair = (options.columns[roles.input].signal, options.columns[roles.output].signal)
        found.append(estimate(_signals(record, roles, options, model), options.estimate))
    return found_response(scenario, together(found), pair, options.axis, given)


def _in_band(measured: MeasuredResponse, options: EstimateOptions) -> MeasuredResponse:
    """The frequencies of a table that are asked for."""
    hertz = measured.omega / (2.0 * math.pi)
    high = math.inf if options.high is None else options.high
    kept = measured.kept((hertz >= (options.low or 0.0)) & (hertz <= high))
    if len(kept.omega) < 3:
        raise InputError(f"{measured.name}: {len(kept.omega)} frequencies lie in the band")
    return kept


def _roles(
    record: AxisRecord, uses: Mapping[str, ColumnUse], of: tuple[AxisModel, PlantMasses]
) -> _ColumnRoles:
    """Sort the columns; an InputError says what is missing or too much."""
    model, masses = of
    drive = masses.signal(masses.names.drive)
    source = source_of(model, masses, drive)
    both = source if source == drive else f"{source} or {drive}"
    kinds: dict[str, list[str]] = {"reference": [], "input": [], "output": []}
    for name, use in uses.items():
        column_of(record, name, use.signal)
        if use.signal in (drive, source):
            kinds["input"].append(name)
        elif use.signal in model.inputs:
            kinds["reference"].append(name)
        elif use.signal in model.outputs:
            kinds["output"].append(name)
        else:
            model.port(use.signal, [*model.inputs, *model.outputs], "signal")
    for kind, told in (
        ("input", f"what moves the plant, {both}"),
        ("output", "a position or speed"),
    ):
        if not kinds[kind]:
            raise InputError(
                f"{record.name}: no column is {told}: --column COLUMN=SIGNAL says which"
            )
    for kind, names in kinds.items():
        if len(names) > 1:
            raise InputError(
                f"{record.name}: {' and '.join(names)} are both {kind} of the response: one wanted"
            )
    first = {kind: names[0] if names else None for kind, names in kinds.items()}
    return _ColumnRoles(first["reference"], str(first["input"]), str(first["output"]))


def _signals(
    record: AxisRecord, roles: _ColumnRoles, options: ResponseOptions, model: AxisModel
) -> LoopSignals:
    """The columns in the units of their signals; a reference is an instrument in any unit."""

    def column(name: str) -> Array:
        use = options.columns[name]
        scale = _scale(record, name, use, model) if use.scale is None else use.scale
        return record.columns[name] * scale + use.offset

    reference = None if roles.reference is None else record.columns[roles.reference]
    return LoopSignals(
        reference, column(roles.input), column(roles.output), record.interval, record.name
    )


def _scale(record: AxisRecord, name: str, use: ColumnUse, model: AxisModel) -> float:
    """Of a signal's unit per unit of a column: by the units, or by the plant's own motion."""
    component, _, variable = use.signal.partition(".")
    port = model.scenario.resolver.ports[component][variable.partition("[")[0]]
    own, scale = scale_of_units(record, name, use.signal, port.unit)
    if scale:
        return scale
    block = model.blocks[component]
    if isinstance(block, Plant):
        point = model.points[component]
        ports = model.scenario.resolver.ports[component]
        for moving in (point.rates, point.values):
            mine = moving.get(variable, 0.0)
            for other in block.outputs:
                unit = units.parse(ports[other].unit or "1")
                if unit.exponents == own.exponents and moving.get(other, 0.0) and mine:
                    return float(own.factor / unit.factor * mine / moving[other])
    raise no_scale(record, name, use.signal, port.unit)
