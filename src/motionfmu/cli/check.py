"""The command that judges scenarios."""

import json
import os
import sys
import time
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.cli.common import FAILED, WRONG, OnMachine, app, give, mode, out, run_shown
from motionfmu.cli.drawing_choices import Page, drawing_table
from motionfmu.cli.run import Engine, Fmi, verdicts, warnings

if TYPE_CHECKING:
    from motionfmu.run import suite
    from motionfmu.run.suite import Case


# CCN 18: each option of the command in the order in which it acts, with its message.
@app.command()
def check(  # noqa: PLR0913  (each is an option of the command)
    paths: Annotated[
        list[Path] | None,
        typer.Argument(help="Scenarios, or folders of some; ./scenarios if none."),
    ] = None,
    machine: OnMachine = None,
    engine: Engine = None,
    fmi: Fmi = None,
    contrary: Annotated[
        bool, typer.Option("--contrary", help="Whether verdicts fail with what is shown off.")
    ] = False,
    page: Page = None,
    jobs: Annotated[int, typer.Option("-j", "--jobs", min=1, help="Processes.")] = 1,
    junit: Annotated[Path | None, typer.Option(help="Write a JUnit XML file.")] = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Run scenarios and judge them; no results are written."""
    from datetime import datetime

    from motionfmu.run import suite

    if junit and (junit.is_dir() or not junit.absolute().parent.is_dir()):
        raise InputError(f"--junit {junit}: a file in a folder that exists wanted")
    if machine and contrary:
        raise InputError("--contrary is for scenarios: a machine has no [[contrary]]")
    drawing = drawing_table(page=page)
    if drawing and not machine:
        raise InputError(f"--page {page}: it goes with --machine and a drawing")
    chosen = _chosen(paths or [], machine)
    options = {"engine": engine, "fmi": fmi}
    started, begin = datetime.now(), time.perf_counter()
    cases: list[Case] = []
    ways = suite.SuiteWays(contrary, machine, drawing)
    for some in _judged(chosen, options, ways, jobs):
        cases += some
        for case in some:
            _tell(case, quiet=as_json)
    told = _summary(cases, len(chosen), time.perf_counter() - begin)
    if junit:
        _write_junit(junit, cases, started)
    if as_json:
        give(json.dumps(_numbers(cases, time.perf_counter() - begin), indent=1, allow_nan=False))
    print(told, file=sys.stderr if as_json else sys.stdout)
    if not all(case.ok for case in cases):
        raise typer.Exit(WRONG if any(case.error for case in cases) else FAILED)


def _chosen(paths: list[Path], machine: str | None) -> list[Path]:
    """The scenarios or, with a machine, the programs that the command line means."""
    from motionfmu.run import suite

    if machine and not paths:
        raise InputError(f"--machine {machine}: which programs?")
    if not paths and not Path("scenarios").is_dir():
        raise InputError("no scenario here: name one of `motionfmu list`, or a folder of some")
    return paths if machine else suite.found(paths or [Path("scenarios")])


def _judged(
    paths: Sequence[Path], options: dict[str, Any], ways: "suite.SuiteWays", jobs: int
) -> "Iterator[list[Case]]":
    from motionfmu.run import suite

    if jobs > 1:
        yield from suite.together(paths, options, ways, min(jobs, len(paths)))
        return
    for path in paths:
        yield suite.judged(path, options, ways, lambda s, **given: run_shown(s, given))


def _tell(case: "Case", quiet: bool) -> None:
    if case.error:
        print(f"motionfmu: {case.error}", file=sys.stderr)
    if quiet:
        return
    mark = "[green]ok[/]    " if case.ok else "[bold red]FAILED[/]"
    from motionfmu.run.checks import NOTHING

    what = (
        f"[dim]off:[/] {case.off}"
        if case.off
        else f"[dim]{NOTHING if case.silent else f'{len(case.checks)} bounds'}[/]"
    )
    what = "[dim]wrong[/]" if case.error else what.replace("[[", r"\[[")
    out.print(f"{mark}  {case.scenario}  {what}  [dim]{case.seconds:.1f} s[/]", soft_wrap=True)
    warnings(case.warnings)
    for name in case.holding:
        out.print(f"    holds: {name}", markup=False, soft_wrap=True)
    if case.off:
        for v in case.checks:
            if not v.within:
                why = f" ({v.reason})" if v.reason else ""
                text = f"    fails: {v.name} = {v.value:.6g}{why}, asked {v.bounds}"
                out.print(text, markup=False, soft_wrap=True)
    elif case.checks and (mode.verbose or not case.ok):
        verdicts(case.checks)


def _summary(cases: "Sequence[Case]", scenarios: int, seconds: float) -> str:
    wrong = sum(bool(case.error) for case in cases)
    good = sum(case.ok for case in cases)
    tail = f", {wrong} wrong" if wrong else ""
    failed = len(cases) - good - wrong
    silent = sum(case.silent for case in cases)
    many = f"{scenarios} scenario{'s' * (scenarios != 1)}"
    if any(case.off for case in cases):
        if len(cases) == 1:
            what = f"1 contrary {'fails as it must' if good else 'does not fail'}"
        else:
            what = f"{len(cases)} contraries: {good} fail as they must, {failed} do not"
        return f"{many}, {what}{tail}, {seconds:.0f} s"
    tail += f", {silent} without a check" if silent else ""
    return f"{many}: {good - silent} hold, {failed} fail{tail}, {seconds:.0f} s"


def _numbers(cases: "Sequence[Case]", seconds: float) -> dict[str, Any]:
    """The verdicts for JSON."""
    rows = [
        {
            "scenario": case.scenario,
            "path": case.path,
            "off": case.off or None,
            "ok": case.ok,
            "error": case.error or None,
            "seconds": round(case.seconds, 3),
            "warnings": list(case.warnings),
            "checks": [v.numbers() for v in case.checks],
        }
        for case in cases
    ]
    return {"ok": all(case.ok for case in cases), "seconds": round(seconds, 3), "cases": rows}


def _write_junit(file: Path, cases: "Sequence[Case]", started: Any) -> None:
    """Write the file whole, or leave an older one as it is."""
    from motionfmu.report.junit import junit

    part = file.with_name(f".{file.name}.part{os.getpid()}")
    try:
        part.write_text(junit(cases, started), encoding="utf-8")
        part.rename(file)
    except OSError as error:
        raise InputError(f"--junit {file}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)
