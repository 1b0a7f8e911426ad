"""The console command that finds servo gains."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

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
    report,
    results,
    settings,
    stages,
)

if TYPE_CHECKING:
    from motionfmu.run import Scenario
    from motionfmu.study.tune import Problem, Tuned


@app.command()
def tune(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    machine: OnMachine = None,
    file: Annotated[
        Path | None, typer.Option("--problem", help="Options; else tune.toml beside the PATH.")
    ] = None,
    velocity: Annotated[bool, typer.Option("--velocity", help="The velocity loop too.")] = False,
    forward: Annotated[bool, typer.Option("--feed-forward", help="Feed-forward too.")] = False,
    equal: Annotated[bool, typer.Option("--equal", help="The same gains on all axes.")] = False,
    cost: Annotated[
        str | None,
        typer.Option(help="contour_rms, contour_max, error_rms, error_max, ise, iae or itae."),
    ] = None,
    identified: Annotated[
        list[str],
        typer.Option(
            metavar="FOLDER",
            help="Result of `motionfmu identify`: its values, and margins for all plants that its"
            " record leaves possible.",
        ),
    ] = [],  # noqa: B006
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """Find servo gains for a scenario's own path; write gains.toml and a report."""
    needed("tune")
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.tune_page import page_text
    from motionfmu.study.tune import problem, read

    scenario = loaded(path, machine)
    beside = (scenario.document.file if machine is None else path).parent / "tune.toml"
    values = read(file or beside, scenario) if file or beside.is_file() else {}
    asked: dict[str, Any] = {
        "velocity": velocity,
        "feed_forward": forward,
        "axes": "equal" if equal else None,
    }
    asked |= {"cost": cost, "identified": identified}
    values |= {k: v for k, v in asked.items() if v}
    wanted = problem(values)
    target = result_folder.usable(folder or results(scenario.name, "tune"))
    tuned = _tune(scenario, wanted, settings(set_))
    with result_folder.whole(target) as part:
        result_folder.write_result(part, page_text(tuned), tuned.numbers())
        (part / "gains.toml").write_text(tuned.toml(), encoding="utf-8")
    _tell(tuned)
    out.print(f"gains: {target / 'gains.toml'}", soft_wrap=True)
    report(target / "report.html")


def _tell(tuned: "Tuned") -> None:
    """Print what was found."""
    from motionfmu.analysis.linear.gains import in_lines

    table = bare_table("plant", tuned.study.path.what, "before", "after", "by the model")
    for before, after in zip(tuned.before, tuned.after, strict=True):
        old, new = before.fmus, after.fmus
        for what, a, b, c in (
            ("rms", old.rms, new.rms, after.model.rms),
            ("largest", old.max, new.max, after.model.max),
        ):
            cells = (f"{x * 1e3:.4g} µm" for x in (a, b, c))
            table.add_row(tuned.plant_name(before.plant), what, *cells)
    out.print(table)
    for name, value in tuned.settings.items():
        out.print(f"{name} = {value}".replace("[", r"\["))
    for line in in_lines(tuned.position_gains(tuned.z)):
        out.print(line, markup=False)
    for text in tuned.stopped_by:
        out.print(f"stopped by: {text}")
    if tuned.region:
        out.print(tuned.region.text, markup=False, soft_wrap=True)


def _tune(scenario: "Scenario", asked: "Problem", given: dict[str, Any]) -> "Tuned":
    """Tune with a progress bar, which shows on a terminal only."""
    from motionfmu.study.tune import tune

    with stages(scenario.name) as show:
        return tune(scenario, asked, given, show)
