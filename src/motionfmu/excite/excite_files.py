"""An excitation as files: a command over time, and a scenario that runs along it."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.freq.bench import Bench, Setup
from motionfmu.excite.axis_excitation import AxisExcitation
from motionfmu.records import Record
from motionfmu.scenarios.toml_text import pair_lines, table_lines

COMMAND, COLUMN = "excitation.csv", "command"


def command_record(made: AxisExcitation) -> Record:
    """The command as a record: time, and the command in the input's unit."""
    return Record(
        COMMAND,
        np.round(made.time * 1e9).astype(np.int64),
        {COLUMN: made.command},
        {COLUMN: made.unit},
    )


def scenario_tables(made: AxisExcitation) -> dict[str, Any]:
    """The tables of a scenario of what lies between the command and the axis, driven by a file."""
    axis, position = made.axis, made.masses.signal(made.masses.names.motor.position)
    source = made.moves_source
    bench = Bench(Setup(axis, (made.input,), (source, position), (made.input,)))
    system, ports = bench.system, axis.scenario.resolver.ports
    wires = {w.target.name: w.source.name for w in system.wires}
    given = {end.name: _plain(values, end.port.shape) for end, values in bench.given}
    driven = _element(made, made.input)
    open_ = [
        f"{c}.{p.name}"
        for c in system.components
        for p in ports[c].values()
        if p.causality == "input" and f"{c}.{p.name}" not in {*wires, *given, made.input}
    ]
    shown = [source, position, made.masses.signal(made.masses.names.load.position)]
    shown += [m.signal for m in made.moves if m.signal.partition(".")[0] in system.components]
    return {
        "stop": round(float(made.time[-1]), 9),
        "step": system.step_ns * 1e-9,
        "leave": open_,
        "component": dict(system.components),
        "connect": wires,
        "set": given,
        "record_file": {"file": COMMAND, "drive": {driven: COLUMN}},
        "record": {"signals": list(dict.fromkeys(shown))},
        "check": _checks(made, list(system.components)),
    }


def _checks(made: AxisExcitation, components: list[str]) -> dict[str, Any]:
    """That nothing goes beyond its limit."""
    return {
        m.signal: {"absmax": m.limit}
        for m in made.moves
        if m.signal.partition(".")[0] in components
    }


def _plain(values: Any, shape: tuple[int, ...]) -> Any:
    listed = list(values)
    return listed if shape else listed[0]


def _element(made: AxisExcitation, name: str) -> str:
    component, _, variable = name.partition(".")
    shape = made.axis.scenario.resolver.ports[component][variable].shape
    return f"{name}[{made.axis.axis}]" if shape else name


def identify_tables(made: AxisExcitation) -> dict[str, Any]:
    """An identify.toml that takes the record of that scenario."""
    shown = (made.moves_source, made.masses.signal(made.masses.names.motor.position))
    return {"axis": made.axis.axis, "columns": {_element(made, n): n for n in shown}}


def toml_of(about: str, tables: Mapping[str, Any]) -> str:
    """Text of a TOML file with a first line that says what it is."""
    lines = [f"# {about}"]
    for key, value in tables.items():
        if not isinstance(value, dict):
            lines += pair_lines(key, value)
    for key, value in tables.items():
        if isinstance(value, dict):
            inner = {k: v for k, v in value.items() if isinstance(v, dict) and key == "record_file"}
            lines += table_lines(key, {k: v for k, v in value.items() if k not in inner})
            for name, table in inner.items():
                lines += table_lines(f"{key}.{name}", table)
    return "\n".join(lines) + "\n"


def write_scenario(made: AxisExcitation, folder: Path) -> None:
    """Write a scenario of an excitation into a new folder.

    It has scenario.toml, the command as excitation.csv, and identify.toml for its record.

    Parameters
    ----------
    made : AxisExcitation
    folder : Path
        It must not be there.
    """
    folder.mkdir()
    about = (
        f"Axis {made.axis.axis} of {made.axis.scenario.name}, excited at {made.input}:"
        f" {made.hertz[0]:.4g} to {made.hertz[-1]:.4g} Hz, {made.options.periods} periods."
    )
    (folder / "scenario.toml").write_text(toml_of(about, scenario_tables(made)), encoding="utf-8")
    (folder / "identify.toml").write_text(
        toml_of("What the columns of this scenario's record are.", identify_tables(made)),
        encoding="utf-8",
    )
    command_record(made).save(folder / COMMAND)
