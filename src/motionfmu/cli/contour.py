"""The command that explains a contour error."""

from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, TypeVar

import typer

from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    Folder,
    LayoutFile,
    OnMachine,
    Over,
    ScenarioPath,
    Set,
    app,
    bare_table,
    loaded,
    out,
    progress_bar,
    record_options,
    report,
    results,
    run_shown,
    settings,
)
from motionfmu.cli.record_contour import (
    RecordChoice,
    measured_ballbar,
    measured_contour,
    measured_path,
)

if TYPE_CHECKING:
    from motionfmu.run import Scenario

T = TypeVar("T")


# CCN 16: one command with three kinds of input, each handed on at once.
@app.command()
def contour(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    machine: OnMachine = None,
    set_: Set = [],  # noqa: B006  (typer makes a new list)
    folder: Folder = None,
    figures: Annotated[
        bool, typer.Option("--figures", help="Only print the figures of one run.")
    ] = False,
    path_: Annotated[
        bool, typer.Option("--iso9283", help="The deviation of the tool path, not the contour.")
    ] = False,
    record_: Annotated[
        Path | None,
        typer.Option("--record", metavar="FILE", help="A measured tool, instead of causes."),
    ] = None,
    over: Over = [],  # noqa: B006
    layout: LayoutFile = None,
    radius: Annotated[
        float | None, typer.Option(min=1e-3, help="Of a ballbar's record: nominal [mm].")
    ] = None,
    feed: Annotated[
        float | None, typer.Option(min=1e-3, help="Of a ballbar's record [mm/min].")
    ] = None,
    plane: Annotated[str, typer.Option(help="Of a ballbar's record: XY, ZX or YZ.")] = "XY",
) -> None:
    """Explain the contour error of a scenario: which cause makes how much of it.

    A scenario without a contour, or with --iso9283, has the deviation of its tool path explained.
    With --record the measured tool is analysed against the program, beside a run.

    PATH may be a ballbar's record, of angle and deviation or radius: --radius is its nominal one.
    """
    from motionfmu.records import is_record_file

    given = settings(set_)
    if is_record_file(path):
        needed("report")
        files = [path, *([record_] if record_ else [])]
        measured_ballbar(files, (radius, feed, plane), (over, layout), folder)
        return
    scenario = loaded(path, machine)
    body = scenario.document.body
    of_path = path_ or (body.contour is None and body.iso9283 is not None)
    if figures:
        result = run_shown(scenario, {"set": given})
        found = result.iso9283().numbers() if of_path else result.contour().numbers()
        table = bare_table("figure", "value")
        for name, value in _flat({k: v for k, v in found.items() if k != "commands"}):
            table.add_row(name, value)
        out.print(table)
        return
    needed("report")
    if record_ is not None:
        columns, keys = record_options(over, layout)
        if keys is None and body.record_file is not None:
            keys = body.record_file.layout
        options = RecordChoice(record_, columns, keys or {})
        (measured_path if of_path else measured_contour)(scenario, given, options, folder)
        return
    (_explain_path if of_path else _explain)(scenario, given, folder)


def _with_bar(work: Callable[..., T], scenario: "Scenario", settings: dict[str, Any]) -> T:
    """What an explanation of a scenario finds; a bar shows how far it is."""
    with progress_bar(*bar_columns()) as bar:
        task = bar.add_task(scenario.name, total=1.0)
        return work(
            scenario,
            set=settings,
            progress=lambda what, share: bar.update(task, completed=share, description=what),
        )


def _explain_path(scenario: "Scenario", settings: dict[str, Any], folder: Path | None) -> None:
    from motionfmu.analysis.explain import explain_path
    from motionfmu.report import result_folder
    from motionfmu.report.cause_pages.path_causes_page import HEADS, write_path_explanation
    from motionfmu.report.numbers import length

    target = result_folder.usable(folder or results(scenario.name, "iso9283"))
    found = _with_bar(explain_path, scenario, settings)
    kinds = [n for n in HEADS if n in found.figures]
    table = bare_table("cause")
    for heading in (*(HEADS[n] for n in kinds), "AT_P without"):
        table.add_column(heading, justify="right")
    for e in found.effects:
        sizes = [length(e.figures[n]) if e.judged else "" for n in kinds]
        table.add_row(e.title, *sizes, length(e.without["accuracy"]) if e.without else "")
    table.add_row("[bold]Whole run[/]", *(length(found.figures[n]) for n in kinds), "")
    out.print(table)
    for e in found.effects:
        if not e.judged:
            out.print(f"[bold]{e.title}[/] not judged: {e.how.replace('[', chr(92) + '[')}")
    with result_folder.whole(target) as part:
        shown = write_path_explanation(found, part).name
    report(target / shown)


def bar_columns() -> tuple[Any, ...]:
    """What the bar of a long work shows."""
    from rich.progress import BarColumn, TaskProgressColumn, TextColumn

    return BarColumn(), TaskProgressColumn(), TextColumn("{task.description}")


def _explain(scenario: "Scenario", settings: dict[str, Any], folder: Path | None) -> None:
    from motionfmu.analysis.explain import explain
    from motionfmu.report import result_folder
    from motionfmu.report.cause_pages.explain_page import write_explanation
    from motionfmu.report.numbers import length

    target = result_folder.usable(folder or results(scenario.name, "contour"))
    found = _with_bar(explain, scenario, settings)
    table = bare_table("cause")
    for heading in ("largest", "99 %", "theory", "error without"):
        table.add_column(heading, justify="right")
    for e in found.effects:
        both = ("" if v is None else length(v) for v in (e.theory.value, e.without))
        sizes = (length(e.size), length(e.usual)) if e.judged else ("not judged", "")
        table.add_row(e.title, *sizes, *both)
    numbers = found.numbers()
    for title, key in (("Sum of the effects", "sum_of_effects"), ("Residual", "residual")):
        table.add_row(f"[dim]{title}[/]", length(numbers[key]["max"]))
    table.add_row("[bold]Contour error[/]", length(numbers["contour_error"]["max"]))
    out.print(table)
    for e in found.effects:
        if not e.judged:
            out.print(f"[bold]{e.title}[/] not judged: {e.how.replace('[', chr(92) + '[')}")
    for mark in found.signatures:
        out.print(f"[bold]Ballbar, radius {mark.test.radius:g} mm[/]")
        for words in mark.words():
            out.print(f"  {words}")
    with result_folder.whole(target) as part:
        shown = write_explanation(found, part).name
    report(target / shown)


def _flat(value: Any, name: str = "") -> list[tuple[str, str]]:
    if isinstance(value, dict):
        pairs = list(value.items())
    elif isinstance(value, list):
        pairs = [(str(i), v) for i, v in enumerate(value)]
    else:
        return [(name, f"{value:.6g}" if isinstance(value, float) else str(value))]
    return [row for k, v in pairs for row in _flat(v, f"{name}.{k}" if name else k)]
