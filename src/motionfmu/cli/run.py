"""The command that runs a scenario, and how verdicts are shown."""

import contextlib
import math
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli import console_text
from motionfmu.cli.common import (
    FAILED,
    Folder,
    OnMachine,
    ScenarioPath,
    Set,
    app,
    detail,
    files_of,
    give,
    loaded,
    report,
    results,
    run_shown,
    settings,
    under_way,
)
from motionfmu.cli.drawing_choices import (
    At,
    Copies,
    Corners,
    Knife,
    Larger,
    Order,
    Page,
    Pens,
    Pitch,
    drawing_table,
)

if TYPE_CHECKING:
    from collections.abc import Sequence

    from motionfmu.run.checks import Verdict
    from motionfmu.run.result import Result

Engine = Annotated[str | None, typer.Option(help="fused, native, python or fmpy.")]
Fmi = Annotated[int | None, typer.Option(help="FMI version: 2 or 3; 3 if not given.")]


# Word and colour of a verdict; None is an expected number that is not judged.
_MARKS = {
    True: ("ok", console_text.GREEN),
    False: ("FAILED", console_text.RED),
    None: ("expected", console_text.DIM),
}


def verdicts(checks: "Sequence[Verdict]") -> None:
    """Each number with its bounds; of one that is not judged the difference; missing numbers."""
    from motionfmu.run.checks import beyond, of_one_number, together

    rows = []
    for same in of_one_number(checks):
        v, bounds = same[0], together([c.bounds for c in same])
        mark, style = _MARKS[v.ok]
        if v.ok is None and not v.reason:
            bounds += f"; {difference(beyond(same))}"
        rows.append(((mark, v.name, "none" if v.reason else f"{v.value:.6g}", bounds), style))
    print(console_text.table(("", "check", "found", "asked"), rows))
    for reason, names in _reasons(checks).items():
        print(f"{', '.join(names)}: {reason}")


def difference(size: float) -> str:
    """How far a number lies beyond what is expected, in words."""
    if math.isnan(size):
        return "not as expected"
    return f"differs by {size:+.4g}" if size else "as expected"


def warnings(texts: "Sequence[str]") -> None:
    """Warnings, one line each."""
    for told in texts:
        print(console_text.styled("warning", console_text.YELLOW), told)


def _reasons(checks: "Sequence[Verdict]") -> dict[str, list[str]]:
    """Names of the checks that have no number, by the reason."""
    found: dict[str, list[str]] = {}
    for v in checks:
        if v.reason and v.name not in found.setdefault(v.reason, []):
            found[v.reason].append(v.name)
    return found


def _ends(result: "Result") -> list[str]:
    """Why a run ended, and when its program was done."""
    done = result.done_at
    own = isinstance(result.scenario.document.body.stop, str) and done is not None
    told = "" if done is None or own else f"; the program was done at {done:.6g} s"
    return [f"ended: {result.stopped}{told}"]


def _tell(result: "Result", early: "Sequence[str]") -> None:
    """Print verdict, warnings that were not told early, what was not as written, the end."""
    if result.checks:
        verdicts(result.checks)
    warnings([told for told in result.warnings if told not in early])
    for line in result.overrides:
        print(f"not as written: {line}")
    detail(f"engine: {result.options.get('engine')}, FMI {result.options.get('fmi')}")
    detail(f"recorded: {result.size}")
    for line in _ends(result):
        print(line)
    print(f"{result.name}: {result.judgement}")


@app.command()
def run(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    machine: OnMachine = None,
    engine: Engine = None,
    fmi: Fmi = None,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    stop: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    step: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    every: Annotated[
        int | None, typer.Option(min=1, help="Record one of so many steps, not as the scenario.")
    ] = None,
    folder: Folder = None,
    csv: Annotated[bool, typer.Option("--csv", help="Also write signals.csv.")] = False,
    trajectory: Annotated[
        bool, typer.Option("--trajectory", help="Also write trajectory.csv, a robot's joints.")
    ] = False,
    signals: Annotated[
        bool, typer.Option(help="Keep signals/, a file for each; they may be large.")
    ] = True,
    pictures: Annotated[
        bool, typer.Option("--pictures", help="Also write the report's pictures, PNG and SVG.")
    ] = False,
    save_as: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="With --machine: also write it there as a scenario."),
    ] = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print result.json; without --out nothing is written.")
    ] = False,
    order: Order = None,
    corners: Corners = None,
    pen: Pens = None,
    at: At = None,
    scale: Larger = None,
    copies: Copies = None,
    pitch: Pitch = None,
    knife: Knife = None,
    page: Page = None,
) -> None:
    """Run a scenario, or a program on a machine, judge it and write its report."""
    from motionfmu.report import result_folder
    from motionfmu.run.result_files import json_of
    from motionfmu.run.run_plan import Options

    if pictures:
        needed("report")
    if save_as and machine is None:
        raise InputError(f"--save-as {save_as}: it goes with --machine")
    asked = {"order": order, "corners": corners, "pens": pen, "at": at, "scale": scale}
    drawing = drawing_table(**asked, copies=copies, pitch=pitch, knife=knife, page=page)
    scenario = loaded(path, machine, drawing)
    if trajectory:
        from motionfmu.run.recorded_trajectory import refuse_unrecorded

        refuse_unrecorded(scenario)
    target = result_folder.usable(folder or results(scenario.name))
    if save_as and machine:
        from motionfmu.run.saved_scenario import save_scenario

        save_scenario(
            scenario, save_as, Options(set=settings(set_), stop=stop, step=step, every=every)
        )
        print(f"scenario: {save_as}")
    options: dict[str, Any] = {
        "engine": engine,
        "fmi": fmi,
        "set": settings(set_),
        "stop": stop,
        "step": step,
        "every": every,
    }
    early: list[str] = []
    with contextlib.suppress(InputError):  # the run tells it, with all else that is wrong
        early = scenario.disagreements(options["set"])
    warnings([] if as_json else early)
    result = run_shown(
        scenario, options | {"source": files_of(set_), "scratch": result_folder.near(target)}
    )
    kept = result_folder.Kept(csv, signals, pictures, trajectory)
    shown = None
    if folder or not as_json:
        shown = result_folder.save(result, target, kept, under_way)
        under_way("")
    if as_json:
        give(json_of(result_folder.all_numbers(result)))
    else:
        _tell(result, early)
    if shown is not None and not as_json:
        report(shown)
    if not result.ok:
        raise typer.Exit(FAILED)
