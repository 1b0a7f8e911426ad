"""The console command that makes an excitation for a measurement."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    Folder,
    Set,
    app,
    bare_table,
    out,
    progress_bar,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.excite import AxisExcitation, ExciteOptions
    from motionfmu.run import Scenario


@app.command()
def excite(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[
        Path,
        typer.Argument(help="A scenario, or a machine: its folder, or a name of either."),
    ],
    axis: Annotated[int, typer.Option(help="Axis, from 1.")] = 1,
    input: Annotated[
        str | None,
        typer.Option(metavar="COMP.VAR", help="Where it is put; else the drive's command."),
    ] = None,
    band: Annotated[
        str | None, typer.Option(metavar="LOW:HIGH", help="Frequencies [Hz]; else 2:500.")
    ] = None,
    period: Annotated[float, typer.Option(help="Period [s]; lines are 1/period apart.")] = 1.0,
    periods: Annotated[int, typer.Option(help="Periods to be measured.")] = 6,
    speed: Annotated[
        float | None,
        typer.Option(help="Mean speed of the motor [rad/s]; else it never turns back."),
    ] = None,
    margin: Annotated[float, typer.Option(help="Share of every limit that is used.")] = 0.8,
    seed: Annotated[
        int | None, typer.Option(help="Random phases of this seed; else those with low peaks.")
    ] = None,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """Make a multisine for an axis within its limits: a CSV, a scenario, a part program."""
    needed("tune")
    from motionfmu.cli.frf import band_of
    from motionfmu.excite import ExciteOptions
    from motionfmu.report import result_folder
    from motionfmu.run.machine_program import machine_scenario

    low, high = band_of(band)
    options = ExciteOptions(axis, input, low or 2.0, high, period, periods, speed, margin, seed)
    scenario = machine_scenario(path)
    target = result_folder.usable(folder or results(scenario.name, "excite"))
    made = _made(scenario, options, settings(set_))
    _write(target, made)
    _tell(made)
    print(f"command: {target / 'excitation.csv'}")
    print(f"scenario: {target / 'scenario'}")
    report(target / "report.html")


def _made(
    scenario: "Scenario", options: "ExciteOptions", given: dict[str, Any]
) -> "AxisExcitation":
    """Make it with a progress bar, which shows on a terminal only."""
    from motionfmu.excite import excitation_of

    with progress_bar() as bar:
        bar.add_task(f"{scenario.name}: phases", total=None)
        return excitation_of(scenario, options, given)


def _write(target: Path, made: "AxisExcitation") -> None:
    from motionfmu.excite import part_program, write_scenario
    from motionfmu.excite.excite_files import COMMAND, command_record
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.excite_page import excite_numbers, excite_page

    with result_folder.whole(target) as part:
        write_scenario(made, part / "scenario")
        command_record(made).save(part / COMMAND)
        program = part_program(made)
        if program is not None:
            (part / "program.ngc").write_text(program.text, encoding="utf-8")
        result_folder.write_result(part, excite_page(made, program), excite_numbers(made, program))


def _tell(made: "AxisExcitation") -> None:
    from motionfmu.report.loop_pages.excite_page import sentences

    table = bare_table("signal", "mean", "peak", "limit", "used", "unit")
    for m in made.moves:
        cells = f"{m.mean:.4g}", f"{m.peak:.4g}", f"{m.limit:.4g}", f"{100 * m.share:.0f} %"
        table.add_row(m.signal, *cells, m.unit)
    out.print(table)
    for text in (*sentences(made), *made.notes):
        out.print(text, markup=False, soft_wrap=True)
