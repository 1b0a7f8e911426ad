"""The command that judges a robot's program before it moves."""

import json
import re
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    FAILED,
    Folder,
    OnMachine,
    ScenarioPath,
    Set,
    app,
    bare_table,
    give,
    loaded,
    out,
    progress_bar,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.analysis.dry_run import DryRun, InputChange
    from motionfmu.job_editor import EditedJob
    from motionfmu.run import Scenario

SHOWN = 12  # lines on the console
CHANGE = re.compile(r"(\d+)=(on|off)(?:@(\d+(?:\.\d*)?))?")


@app.command()
def job(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    machine: OnMachine = None,
    input_: Annotated[
        list[str],
        typer.Option(
            "--input", metavar="N=on@SECONDS", help="A digital input that changes, as IN#(N)."
        ),
    ] = [],  # noqa: B006
    cell: Annotated[
        Path | None,
        typer.Option("--cell", metavar="FILE", help="Bodies around the arm, its thickness: TOML."),
    ] = None,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, write nothing.")] = False,
    edit: Annotated[
        bool,
        typer.Option("--edit", help="A page to edit it at, judged at each change; Ctrl-C ends."),
    ] = False,
    port: Annotated[int, typer.Option(help="Port of that page on 127.0.0.1; 0: any.")] = 8771,
    open_: Annotated[bool, typer.Option("--open", help="Open it in the browser.")] = False,
) -> None:
    """Judge a robot's program before it moves: reach, limits, collisions, cycle time, by line.

    It is run dry: by the controller that drives the arm, a hundred times as fast, without the arm.
    Inputs are those that the scenario drives, or those of --input.
    """
    changes = [_change(text) for text in input_]
    scenario = loaded(path, machine)
    if edit:
        _edit(scenario, changes, settings(set_), cell, (port, open_))
        return
    target = folder or results(scenario.name, "job")
    run = _run(scenario, changes, settings(set_), cell)
    if as_json:
        give(json.dumps(run.numbers(), indent=1, allow_nan=False))
    else:
        _tell(run)
        _write(run, target)
    if run.faults:
        raise typer.Exit(FAILED)


def _change(text: str) -> "InputChange":
    from motionfmu.analysis.dry_run import InputChange
    from motionfmu.analysis.dry_run.robot_dry_run import INPUTS

    found = CHANGE.fullmatch(text.strip())
    if not found or not 1 <= int(found[1]) <= INPUTS:
        raise InputError(f"--input {text}: N=on@SECONDS or N=off@SECONDS wanted, N 1 to {INPUTS}")
    return InputChange(float(found[3] or 0.0), int(found[1]), found[2] == "on")


def _run(
    scenario: "Scenario", changes: "list[InputChange]", given: dict[str, object], cell: Path | None
) -> "DryRun":
    """Run it dry with the time so far, which shows on a terminal only."""
    from motionfmu.analysis.collisions import read_cell
    from motionfmu.analysis.dry_run import dry_run

    around = read_cell(cell) if cell else None
    with progress_bar() as bar:
        task = bar.add_task(scenario.name, total=None)

        def told(seconds: float) -> None:
            bar.update(task, description=f"{scenario.name}: {seconds:.0f} s")

        return dry_run(scenario, changes, given, told, around)


def _edit(
    scenario: "Scenario",
    changes: "list[InputChange]",
    given: dict[str, object],
    cell: Path | None,
    page: tuple[int, bool],
) -> None:
    """Serve the page of the program until Ctrl-C."""
    import asyncio

    needed("live")
    from motionfmu.analysis.collisions import read_cell
    from motionfmu.base.page_server import PORT_MAX
    from motionfmu.job_editor import EditedJob

    if not 0 <= page[0] <= PORT_MAX:
        raise InputError(f"--port {page[0]}: 0 to {PORT_MAX} wanted")
    edited = EditedJob(scenario, given, changes, read_cell(cell) if cell else None)
    asyncio.run(_serve(edited, *page))


async def _serve(edited: "EditedJob", port: int, opened: bool) -> None:
    import asyncio
    import secrets
    import webbrowser

    from motionfmu.base.page_server import PageServer
    from motionfmu.cli.card import on_end, stopped
    from motionfmu.job_editor import application

    ended = asyncio.Event()
    came = on_end(ended.set)
    token = secrets.token_urlsafe(16)
    async with PageServer(application(edited, token), port) as there:
        address = f"http://127.0.0.1:{there}/?token={token}"
        out.print(f"page: {address}", soft_wrap=True)
        if opened:
            webbrowser.open(address)
        await ended.wait()
    stopped(came)


def _tell(run: "DryRun") -> None:
    from motionfmu.report.cycle_time_section import name_of
    from motionfmu.report.jobs.dry_run_page import HEADS, line_cells
    from motionfmu.report.jobs.gcode_page import clock

    for text in run.faults:
        out.print(f"{run.file}: {text}", markup=False, soft_wrap=True)
    if not len(run.samples):
        return
    ends = "until it is refused" if run.fault else "in all"
    waits = f", {clock(run.waits)} of it waits for inputs" if run.waits else ""
    out.print(f"[bold]{run.file.name}[/]  {clock(run.time)} {ends}{waits}; {len(run.moves)} moves")
    where = bare_table("limited by", "s", "%")
    for s in run.motion.shares():
        where.add_row(name_of(s), f"{s.time:.3f}", f"{100.0 * s.time / run.motion.time:.1f}")
    out.print(where)
    lines = run.lines
    if len(lines) > SHOWN:
        out.print(f"the {SHOWN} of {len(lines)} lines whose joints come nearest to their ends:")
        lines = sorted(sorted(lines, key=lambda x: x.nearest.left)[:SHOWN], key=lambda x: x.line)
    table = bare_table(*HEADS)
    for x in lines:
        table.add_row(*line_cells(x, run))
    out.print(table)


def _write(run: "DryRun", target: Path) -> None:
    from motionfmu.report import result_folder
    from motionfmu.report.jobs.dry_run_page import page_text

    result_folder.usable(target)
    with result_folder.whole(target) as part:
        result_folder.write_result(part, page_text(run), run.numbers())
    report(target / "report.html")
