"""The command that shows margins and largest stable gains."""

import math
from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    Folder,
    OnMachine,
    ScenarioPath,
    Set,
    app,
    bare_table,
    loaded,
    out,
    progress_bar,
    report,
    results,
    setting,
    settings,
)

if TYPE_CHECKING:
    from rich.table import Table

    from motionfmu.analysis.freq.loop_study import LoopStudy, LoopStudyOptions
    from motionfmu.analysis.linear import AxisModel


@app.command()
def margins(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    machine: OnMachine = None,
    axis: Annotated[int, typer.Option(help="Axis, from 1.")] = 1,
    at: Annotated[
        list[str],
        typer.Option("--at", metavar="COMP.VAR=VALUE", help="Operating point of a plant."),
    ] = [],  # noqa: B006
    loop: Annotated[str | None, typer.Option(help="Input at which to open; all if none.")] = None,
    gain: Annotated[
        str | None, typer.Option(help="With --loop: parameter whose largest value is wanted.")
    ] = None,
    kick: Annotated[
        float | None, typer.Option(help="Step that makes it ring, in the input's unit.")
    ] = None,
    simulate: Annotated[bool, typer.Option(help="Also run the FMUs.")] = True,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """Margins and largest stable gains of a scenario's loops, and their report."""
    needed("tune")
    from motionfmu.analysis.freq.loop_study import LoopStudyOptions
    from motionfmu.analysis.linear import gain_of, model
    from motionfmu.analysis.linear.gains import in_lines
    from motionfmu.analysis.linear.tuning_parts import held
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.margin_page import numbers, page_text, point_line

    if gain is not None and loop is None:
        raise InputError(f"--gain {gain}: say with --loop which loop it belongs to")
    point = dict(setting(text) for text in at)
    linear = model(loaded(path, machine), axis, point, settings(set_))
    whence = "stated"
    if not point:
        found, whence = _of_the_program(linear)
        linear = linear.moved(found) if found else linear
    about = point_line(linear, whence)
    out.print(about, markup=False, soft_wrap=True)
    target = result_folder.usable(folder or results(linear.scenario.name, "margins"))
    gains = {loop: gain} if loop is not None and gain is not None else {}
    studies = _study(linear, LoopStudyOptions(loop, gains, simulate, kick))
    with result_folder.whole(target) as part:
        page = page_text(linear, studies, about)
        result_folder.write_result(part, page, numbers(linear, studies))
    out.print(_table(studies))
    for line in in_lines(gain_of(linear.scenario, linear.set, axis, linear.at)):
        out.print(line, markup=False)
    if kept := held(linear):
        out.print(kept, markup=False)
    for s in studies:
        if s.silent:
            out.print(f"FMUs not run: {s.silent}", markup=False)
        if s.difference is not None:
            size, angle = s.difference
            out.print(f"{s.at}: the running FMUs differ by at most {size:.2g} % and {angle:.2g}°")
        for note in s.notes:
            out.print(note, markup=False)
    report(target / "report.html")


def _table(studies: Sequence["LoopStudy"]) -> "Table":
    """Margins of each loop, a row for each."""
    table = bare_table()
    table.add_column("loop", overflow="fold")
    for heading in ("gain", "phase", "delay", "peak S", "largest", "simulated"):
        table.add_column(heading, no_wrap=True)
    for s in studies:
        m, ringing = s.margins, s.simulated.gain if s.simulated else math.nan
        cells = (f"x {m.gain:.4g}", f"{m.phase:.4g}°", f"{m.delay * 1e3:.4g} ms")
        name = s.at if m.stable else f"{s.at} [bold red]unstable[/]"
        limits = f"{s.linear.gain:.5g}", f"{ringing:.5g}"
        table.add_row(name, *cells, f"{m.sensitivity:.4g}", *limits)
    return table


def _of_the_program(linear: "AxisModel") -> tuple[dict[str, float], str]:
    """The speed of the scenario's program as an operating point, and where it is from."""
    from motionfmu.study.tune.choice import operating_point, speed_output

    contour = linear.scenario.document.body.contour
    component = contour.position.partition(".")[0] if contour else ""
    if linear.others or contour is None or component not in linear.blocks:
        return {}, "no path tells a speed"
    if not speed_output(linear, contour.position):
        return {}, "the plant shows no speed"
    try:
        base = linear.scenario.run(set=linear.set)
    except InputError as error:
        return {}, f"the program did not run: {str(error).splitlines()[0]}"
    return operating_point(linear, base), "mean feed of the program"


def _study(linear: "AxisModel", asked: "LoopStudyOptions") -> "list[LoopStudy]":
    """Study with a progress bar, which shows on a terminal only."""
    from motionfmu.analysis.freq.loop_study import study

    with progress_bar() as bar:
        task = bar.add_task(linear.scenario.name, total=1.0)
        return study(
            linear, replace(asked, progress=lambda share: bar.update(task, completed=share))
        )
