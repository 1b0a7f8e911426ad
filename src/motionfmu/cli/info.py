"""The commands that list and describe FMUs and scenarios."""

import fnmatch
import math
from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.extras import Missing
from motionfmu.base.units import spelled
from motionfmu.cli.common import app
from motionfmu.cli.console_text import print_rows, wrapped

if TYPE_CHECKING:
    from motionfmu.run import Scenario
    from motionfmu.run.begin_state import BeginState
    from motionfmu.scenarios.fmus import Port

HEADINGS = {
    "parameter": "parameters",
    "input": "inputs",
    "output": "outputs",
    "local": "locals",
}
START_MAX = 16  # columns of a start value


@app.command()
def info(
    what: Annotated[str, typer.Argument(help="An FMU's name, or a scenario.")],
    patterns: Annotated[
        list[str] | None, typer.Argument(help="Variables, as 'home_*'; all if none.")
    ] = None,
    xml: Annotated[bool, typer.Option("--xml", help="Print the FMU's description.")] = False,
    fmi: Annotated[int, typer.Option(help="FMI version of the XML: 2 or 3.")] = 3,
) -> None:
    """Show the variables of an FMU with units, ranges and meaning, or what a scenario is made of.

    Of a scenario's FMUs, patterns choose variables by component, as 'mcc.home_*', and each is
    shown with its value in the scenario.
    """
    from motionfmu.scenarios import fmus, package_files

    known = fmus.fmu_names()
    if what in known or (xml and not Path(what).exists()):
        if xml:
            print(fmus.description_text(what, fmi), end="")
            return
        ports = fmus.ports(what)
        print(wrapped(fmus.about(what), f"{what}: ", "  "))
        _variables([ports[name] for name in _chosen(ports, patterns)])
        return
    if xml:
        raise InputError(f"--xml: {what} is no FMU")
    if not Path(what).exists() and not package_files.scenario(what):
        names = ", ".join(known) or f"none is built in {fmus.folder()}; run make build"
        hint = suggestion(what, [*known, *package_files.scenarios()])
        known_ones = f"FMUs: {names}; scenarios: motionfmu list"
        raise InputError(f"{what}: neither an FMU nor a scenario{hint} ({known_ones})")
    from motionfmu.run import load

    scenario = load(what)
    if patterns:
        _variables_of(scenario, patterns)
    else:
        _scenario(scenario)


def _chosen(names: Iterable[str], patterns: Sequence[str] | None) -> list[str]:
    """Names that a pattern fits; a pattern that fits none is wrong."""
    names = list(names)
    for pattern in patterns or ():
        if not fnmatch.filter(names, pattern):
            raise InputError(f"no variable {pattern!r}{suggestion(pattern, names)}")
    return [n for n in names if not patterns or any(fnmatch.fnmatch(n, p) for p in patterns)]


def _variables(ports: Sequence["Port"]) -> None:
    """Variables by what they are: name, type, unit, start, range, meaning."""
    for causality, heading in HEADINGS.items():
        if found := [p for p in ports if p.causality == causality]:
            head = (heading.upper(), "type", "unit", "start", "range")
            print_rows([(head, ""), *map(_row, found)])


def _row(port: "Port") -> tuple[tuple[str, ...], str]:
    kind = port.type + "".join(f"[{n}]" for n in port.shape)
    values = (port.start or "").split() if port.type != "String" else [port.start or ""]
    start = values[0] if len(set(values)) == 1 else " ".join(values)
    text = port.doc + (" (may change in a run)" if port.tunable else "")
    if len(start) > START_MAX:
        text, start = f"{text}; start {start}", "..."
    return (port.name, kind, spelled(port.unit), start, _range(port)), text


def _range(port: "Port") -> str:
    low, high = (f"{x:.10g}" for x in (port.low, port.high))
    if math.isfinite(port.low) and math.isfinite(port.high):
        return f"{low} .. {high}"
    return f">= {low}" if math.isfinite(port.low) else f"<= {high}" * math.isfinite(port.high)


def _variables_of(scenario: "Scenario", patterns: Sequence[str]) -> None:
    """Variables of a scenario's FMUs, and what the scenario makes of them."""
    from motionfmu.scenarios import fmus
    from motionfmu.scenarios.system import wires

    body = scenario.document.body
    ports = {
        f"{component}.{name}": port
        for component, fmu in body.component.items()
        for name, port in fmus.ports(fmu).items()
    }
    sources = {wire.target.name: wire.source.name for wire in wires(scenario.resolver)}
    print(wrapped(scenario.document.about, f"{scenario.name}: ", "  "))
    rows: list[tuple[Sequence[str], str]] = [(("", "type", "unit", "start", "range"), "")]
    for name in _chosen(ports, patterns):
        (_, *cells), text = _row(ports[name])
        if name in body.set:
            text = f"here {_value(body.set[name])}; {text}"
        elif name in sources:
            text = f"from {sources[name]}; {text}"
        rows.append(((name, *cells), text))
    print_rows(rows)


def _value(value: Any) -> str:
    """A value as TOML has it."""
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_value, value))}]"
    if isinstance(value, bool):
        return str(value).lower()
    return f'"{value}"' if isinstance(value, str) else f"{value:.10g}"


def _scenario(scenario: "Scenario") -> None:
    from motionfmu.analysis.linear import gain_of
    from motionfmu.analysis.linear.gains import in_lines
    from motionfmu.scenarios import fmus
    from motionfmu.scenarios.body import CHECK, EXPECT

    body = scenario.document.body
    print(wrapped(scenario.document.about, f"{scenario.name}: ", "  "))
    print(_until(body))
    if scenario.begin is not None:
        print(wrapped(_begin(scenario.begin), "begins ", "  "))
    print(_engine(scenario))
    print("components")
    print_rows([((name, fmu), fmus.about(fmu)) for name, fmu in body.component.items()])
    _section("values", [(_set(name, scenario), _value(v)) for name, v in body.set.items()])
    try:
        gains = in_lines(gain_of(scenario))
    except Missing as told:
        gains = [f"in 1/s: {told}"]
    for line in gains:
        print(wrapped(line, "  gain ", "    "))
    steps = [(d.input, f"{_value(d.value)} at {_value(d.at)} s") for d in body.drive]
    _section("steps of inputs", steps)
    if (record := body.record_file) is not None:
        _section(f"driven by {record.file}", list(record.drive.items()))
        _section(f"{record.file} over", list(record.over.items()))
    every = f", of {body.record.every} steps one" if body.record.every > 1 else ""
    _section(f"recorded{every}", [("", ", ".join(body.record.signals))])
    _section("figures", [("", figure.title) for figure in body.figure])
    for heading, wanted in (("checks", CHECK), ("expected of it as written", EXPECT)):
        checks = [
            (name, _bounds(check.model_dump(exclude_none=True)))
            for table, name, rows in body.asked
            for check in rows
            if table == wanted
        ]
        _section(heading, checks)
    _section("what fails them", [(case.off, _bounds(case.set)) for case in body.contrary])


def _engine(scenario: "Scenario") -> str:
    """Which engine runs it, and why if that is not the usual one."""
    from motionfmu.run import Options
    from motionfmu.run.engines import usual

    name, why = usual(scenario.resolved(Options()))
    return f"engine: {name}" + (f" ({why})" if why else "")


def _begin(state: "BeginState") -> str:
    """When a scenario begins, and what has been set by then."""
    force = ", ".join(f"{n} = {_plain(v)}" for n, v in state.force.items())
    return f"at {state.ns / 1e9:.9g} s, in {state.name}" + (f", with {force}" if force else "")


def _plain(values: tuple[Any, ...]) -> str:
    return str(values[0] if len(set(values)) == 1 else list(values))


def _until(body: Any) -> str:
    limit = getattr(body, "limit", None)
    seconds = "twice its planned time" if limit == "planned" else f"{limit or 0.0:g} s"
    at_most = f", {seconds} at most" if limit else ""
    fault = f" or {body.fault}" if getattr(body, "fault", None) else ""
    signals = f"until {body.stop}{fault}{at_most}"
    end = f"{body.stop:g} s" if isinstance(body.stop, float) else signals
    return f"{end}, in steps of {body.step:g} s"


def _set(name: str, scenario: "Scenario") -> str:
    component, _, variable = name.partition(".")
    from motionfmu.scenarios import fmus

    port = fmus.ports(scenario.document.body.component[component]).get(variable.split("[")[0])
    unit = spelled(port.unit) if port else ""
    return f"{name} [{unit}]" if unit else name


def _bounds(values: dict[str, Any]) -> str:
    return ", ".join(f"{key} = {_value(value)}" for key, value in values.items())


def _section(heading: str, rows: Sequence[tuple[str, str]]) -> None:
    """A heading and rows of a name and a text, or of texts; nothing if there are no rows."""
    if rows:
        print(heading)
        named = all(name for name, _ in rows)
        print_rows([((name,), text) if named else ((), text) for name, text in rows])
