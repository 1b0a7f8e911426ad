"""The command that runs a scenario at many points."""

from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    FAILED,
    Folder,
    OnMachine,
    Set,
    Stopped,
    app,
    out,
    progress_bar,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.sweep import Outcome, Study, Ways


def _sweep(study: "Study", folder: Path, ways: "Ways") -> "Outcome":
    """Run a study with a progress bar, which shows on a terminal only."""
    from rich.progress import BarColumn, MofNCompleteColumn, TextColumn
    from rich.progress import TimeElapsedColumn as TimeUsed
    from rich.progress import TimeRemainingColumn as TimeLeft

    from motionfmu.sweep import conduct

    columns = (
        TextColumn("{task.description}"),
        BarColumn(),
        MofNCompleteColumn(),
        TimeUsed(),
        TextColumn("left"),
        TimeLeft(),
        TextColumn("{task.fields[told]}"),
    )
    with progress_bar(*columns) as bar:
        task, at = bar.add_task(study.name, total=len(study.points), told=""), [0]

        def show(done: int, errors: int) -> None:
            at[0] = done
            told = f"[red]{errors} with an error[/]" if errors else ""
            bar.update(task, completed=done, told=told)

        try:
            return conduct(study, folder, replace(ways, progress=show))
        except KeyboardInterrupt:
            told = f"{at[0]} of {len(study.points)} runs are done; the same command goes on"
            raise Stopped(told) from None


@app.command()
def sweep(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[Path, typer.Argument(help="A study's TOML file, or a scenario.")],
    machine: OnMachine = None,
    vary: Annotated[
        list[str],
        typer.Option(metavar="COMP.VAR=LO:HI:N", help="Or LO:HI, LO:HI:N:log, a list a,b,c."),
    ] = [],  # noqa: B006
    sampling: Annotated[str | None, typer.Option(help="grid, random or latin.")] = None,
    runs: Annotated[int | None, typer.Option(help="Number of runs, if drawn.")] = None,
    seed: Annotated[int | None, typer.Option(help="Of the draws.")] = None,
    result: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="contour.error.max, card.stock.min ...; the checks'."),
    ] = [],  # noqa: B006
    cost: Annotated[str | None, typer.Option(help="Result that is to be small.")] = None,
    tuned: Annotated[str | None, typer.Option(help='TOML file of "comp.var" = value.')] = None,
    set_: Set = [],  # noqa: B006
    stop: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    step: Annotated[float | None, typer.Option(help="Seconds, instead of the scenario's.")] = None,
    workers: Annotated[int | None, typer.Option(min=1, help="Processes; all cores.")] = None,
    scheduler: Annotated[str | None, typer.Option(help="Address of a dask scheduler.")] = None,
    folder: Folder = None,
    new: Annotated[bool, typer.Option("--new", help="Begin again, do not resume.")] = False,
) -> None:
    """Run a scenario at many points; resumes where an earlier call was ended."""
    needed("study")
    from motionfmu import sweep as sweeps
    from motionfmu.study.study_axes import option

    given: dict[str, Any] = {"sampling": sampling, "runs": runs, "seed": seed, "cost": cost}
    given |= {"tuned": tuned, "stop": stop, "step": step, "results": result or None}
    given["machine"] = machine
    given["set"] = settings(set_) or None
    given["axis"] = dict(option(text) for text in vary) or None
    chosen = sweeps.study(path, given)
    target = folder or results(chosen.name, "sweep")
    outcome = _sweep(chosen, target, sweeps.Ways(workers, scheduler, new))
    before = f", {outcome.resumed} of them before" if outcome.resumed else ""
    out.print(f"{chosen.name}: {len(outcome.rows)} runs{before}, {outcome.errors} with an error")
    if outcome.best is not None:
        _tell_best(chosen, outcome, outcome.best)
    elif not chosen.cost:
        out.print("no cost was named, so no run is the best: --cost RESULT")
    out.print(f"table: {outcome.folder / 'sweep.parquet'}", soft_wrap=True)
    report(outcome.folder / "report.html")
    if outcome.errors == len(outcome.rows) or (chosen.cost and outcome.best is None):
        raise typer.Exit(FAILED)


def _tell_best(chosen: "Study", outcome: "Outcome", best: int) -> None:
    """Print the values of the best run, its cost, and which of them are at the study's edge."""
    from motionfmu.base.units import spelled
    from motionfmu.report.numbers import length

    for axis, value in zip(chosen.axes, chosen.points[best], strict=True):
        out.print(f"  {axis.name} = {value} {spelled(axis.unit)}".rstrip(), markup=False)
    unit = next(c.unit for c in chosen.columns if c.name == chosen.cost)
    least = float(outcome.cost[best])
    text = length(least) if unit == "mm" else f"{least:.6g} {spelled(unit)}".rstrip()
    cost = f"{chosen.cost} = {text}".replace("[", r"\[")
    out.print(f"  {cost}  [dim]smallest, run {best}[/]")
    for told in outcome.at_the_edge:
        out.print(f"at the edge of the study: {told}; less may lie beyond", markup=False)
