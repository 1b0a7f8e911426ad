"""The commands that run scenarios and judge them."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.cli.common import (
    FAILED,
    ScenarioPath,
    Set,
    app,
    bare_table,
    out,
    results,
    run_shown,
    settings,
)
from motionfmu.errors import InputError

if TYPE_CHECKING:
    from motionfmu.run import Scenario
    from motionfmu.run.result import Result

Engine = Annotated[str, typer.Option(help="native, python or fmpy.")]
Fmi = Annotated[int | None, typer.Option(help="FMI version: 2 or 3; 3 but for engine fmpy.")]


def _version(engine: str, fmi: int | None) -> int:
    """FMPy's container runs FMI 2 components only."""
    return fmi if fmi is not None else 2 if engine == "fmpy" else 3


def _verdicts(result: "Result") -> None:
    table = bare_table("", "check", "found", "asked")
    for v in result.checks:
        mark = "[green]ok[/]" if v.ok else "[bold red]FAILED[/]"
        found = "none" if v.reason else f"{v.value:.6g}"
        table.add_row(mark, v.name, found, v.bounds.replace("[", r"\["))
    out.print(table)
    for reason, names in _reasons(result).items():
        out.print(f"{', '.join(names)}: {reason}", markup=False, soft_wrap=True)


def _warnings(result: "Result") -> None:
    for told in result.warnings:
        out.print("[yellow]warning[/]", told.replace("[", r"\["), soft_wrap=True)


def _reasons(result: "Result") -> dict[str, list[str]]:
    """Names of the checks that have no number, by the reason."""
    found: dict[str, list[str]] = {}
    for v in result.checks:
        if v.reason and v.name not in found.setdefault(v.reason, []):
            found[v.reason].append(v.name)
    return found


@app.command()
def run(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    engine: Engine = "native",
    fmi: Fmi = None,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    stop: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    step: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    folder: Annotated[Path | None, typer.Option("--out", help="Result folder.")] = None,
    csv: Annotated[bool, typer.Option("--csv", help="Also write signals.csv.")] = False,
) -> None:
    """Run a scenario, judge it and write its report."""
    from motionfmu.report import outcome
    from motionfmu.run import load

    scenario = load(path)
    target = outcome.usable(folder or results(scenario.name))
    options: dict[str, Any] = {
        "engine": engine,
        "fmi": _version(engine, fmi),
        "set": settings(set_),
        "stop": stop,
        "step": step,
    }
    result = run_shown(scenario, options)
    shown = outcome.save(result, target, options, csv)
    _verdicts(result)
    _warnings(result)
    out.print(f"{scenario.name}: {'all checks hold' if result.ok else 'a check FAILED'}")
    out.print(f"report: {shown}", soft_wrap=True)
    if not result.ok:
        raise typer.Exit(FAILED)


def _can_fail(scenario: "Scenario", options: dict[str, Any]) -> bool:
    """Run every [[contrary]] and show by which checks its verdict fails."""
    from motionfmu.run import contrary

    good = bool(scenario.document.body.contrary)
    if not good:
        out.print(f"[bold red]FAILED[/]  {scenario.name}  no \\[\\[contrary]]")
    for case in scenario.document.body.contrary:
        result = run_shown(scenario, options | contrary.options(scenario.document, case))
        hold = contrary.survivors(case, result.checks)
        mark, off = "[bold red]FAILED[/]" if hold else "[green]ok[/]", case.off.replace("[", r"\[")
        out.print(f"{mark}  {scenario.name}  [dim]off:[/] {off}", soft_wrap=True)
        for name in hold:
            out.print(f"    holds: {name}".replace("[", r"\["), soft_wrap=True)
        for v in result.checks:
            if v.name in case.fails and not v.ok:
                why = f" ({v.reason})" if v.reason else ""
                text = f"    fails: {v.name} = {v.value:.6g}{why}, asked {v.bounds}"
                out.print(text.replace("[", r"\["), soft_wrap=True)
        good &= not hold
    return good


@app.command()
def check(
    paths: Annotated[list[Path] | None, typer.Argument(help="Scenarios; all if none.")] = None,
    engine: Engine = "native",
    fmi: Fmi = None,
    contrary: Annotated[
        bool, typer.Option("--contrary", help="Whether verdicts fail with what is shown off.")
    ] = False,
) -> None:
    """Run scenarios and judge them; nothing is written."""
    from motionfmu.run import load

    chosen = paths or sorted(p.parent for p in Path("scenarios").glob("*/scenario.toml"))
    if not chosen:
        raise InputError("no scenario here: name one, or run from the project's folder")
    failed = False
    for path in chosen:
        scenario = load(path)
        if contrary:
            failed |= not _can_fail(scenario, {"engine": engine, "fmi": _version(engine, fmi)})
            continue
        result = run_shown(scenario, {"engine": engine, "fmi": _version(engine, fmi)})
        mark = "[green]ok[/]" if result.ok else "[bold red]FAILED[/]"
        out.print(f"{mark}  {scenario.name}  [dim]{len(result.checks)} bounds[/]")
        _warnings(result)
        if not result.ok:
            failed = True
            _verdicts(result)
    if failed:
        raise typer.Exit(FAILED)
