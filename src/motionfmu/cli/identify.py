"""The console command that identifies an axis from a record."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

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
    loaded,
    out,
    report,
    results,
    settings,
    stages,
)

if TYPE_CHECKING:
    from motionfmu.identify import AxisRecord, Identified, IdentifyOptions, RecordRun
    from motionfmu.run import Scenario


@app.command()
def identify(  # noqa: PLR0913  (each is an option of the command)
    path: ScenarioPath,
    record: Annotated[
        list[Path],
        typer.Option(
            help="A measured record: CSV, Parquet, .mat, a result folder; of --frf several."
        ),
    ],
    machine: OnMachine = None,
    axis: Annotated[int | None, typer.Option(help="Axis of the scenario, from 1.")] = None,
    column: Annotated[
        list[str],
        typer.Option(
            metavar="COLUMN=COMP.VAR[*SCALE]",
            help="What a column is: an input that it drives, an output it is compared with.",
        ),
    ] = [],  # noqa: B006
    free: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="What is free, instead of what the plant says."),
    ] = [],  # noqa: B006
    fix: Annotated[
        list[str], typer.Option(metavar="NAME", help="What stays as the scenario has it.")
    ] = [],  # noqa: B006
    law: Annotated[
        list[str],
        typer.Option(metavar="NAME", help="Extend friction so, not as validation chooses."),
    ] = [],  # noqa: B006
    file: Annotated[
        Path | None, typer.Option("--problem", help="Options; else identify.toml beside the PATH.")
    ] = None,
    frf: Annotated[
        bool,
        typer.Option(
            "--frf", help="Two masses from the frequency response, or from a table of it."
        ),
    ] = False,
    period: Annotated[
        float | None, typer.Option(metavar="S", help="--frf: period of the excitation, 0 for none.")
    ] = None,
    band: Annotated[
        str | None, typer.Option(metavar="LOW:HIGH", help="--frf: frequencies that count [Hz].")
    ] = None,
    as_given: Annotated[
        bool, typer.Option("--controller-as-given", help="Take no gains from the record.")
    ] = False,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """Find an axis' or an arm's values from a record; write found.toml and a report.

    With --frf inertias, stiffness and damping of two masses from a closed loop's response.
    """
    needed("tune")
    from motionfmu.cli.frf import ResponseAsked, identify_frf
    from motionfmu.cli.identify_arm import identify_arm_of
    from motionfmu.identify import identify_file
    from motionfmu.identify.arm_dynamics import arm_plant
    from motionfmu.report import result_folder

    scenario = _subject(path, machine)
    beside = (scenario.document.file if machine is None else path).parent / identify_file.FILE
    place = file or (beside if beside.is_file() else None)
    given = {"axis": axis, "free": free, "fix": fix, "laws": law}
    tables = _tables(place, column, given | ({"controller": False} if as_given else {}))
    where = str(place or "--column, or an identify.toml beside the scenario")
    target = result_folder.usable(folder or results(scenario.name, "identify"))
    if frf:
        options, asked = identify_file.options(tables, where), ResponseAsked(record, period, band)
        return identify_frf(scenario, asked, options, settings(set_), target)
    if len(record) > 1 or period is not None or band is not None:
        raise InputError("several --record, --period and --band go with --frf")
    if arm_plant.component_of(scenario) is not None:
        return identify_arm_of(scenario, record[0], (tables, where), settings(set_), target)
    options = identify_file.options(tables, where)
    return _identify_axis(scenario, record[0], (options, settings(set_)), target)


def _tables(place: Path | None, column: list[str], given: dict[str, Any]) -> dict[str, Any]:
    """The tables of a file, with what the command line says instead."""
    from motionfmu.identify import identify_file

    tables = identify_file.with_columns(identify_file.read(place) if place else {}, column)
    return tables | {k: v for k, v in given.items() if v not in (None, [])}


def _identify_axis(
    scenario: "Scenario",
    record: Path,
    asked: "tuple[IdentifyOptions, dict[str, Any]]",
    target: Path,
) -> None:
    """Identify an axis, write, tell; status 1 if the record tells nothing."""
    from motionfmu import records
    from motionfmu.identify import axis_record

    measured = axis_record.of_record(records.record(record))
    found, run = _identify(scenario, measured, *asked)
    _write(target, found, run)
    _tell(found, run)
    print(f"values: {target / 'found.toml'}")
    report(target / "report.html")
    if not any(p.told for p in found.parameters):
        raise typer.Exit(FAILED)


def _subject(path: Path, machine: str | None) -> "Scenario":
    """What was recorded: a scenario, a program on a machine, or a machine alone."""
    from motionfmu import run
    from motionfmu.base.errors import InputError
    from motionfmu.scenarios.table_sources import machine_file

    if machine is None:
        try:
            machine_file(path, Path.cwd())
        except InputError:
            return loaded(path, machine)
        return run.machine(path).plan()
    return loaded(path, machine)


def _identify(
    scenario: "Scenario", record: "AxisRecord", options: "IdentifyOptions", given: dict[str, Any]
) -> "tuple[Identified, RecordRun | None]":
    """Identify and run, with a progress bar, which shows on a terminal only."""
    from motionfmu.identify import identify, run_of_record

    with stages(scenario.name) as show:
        found = identify(scenario, record, options, given, show)
        show("the FMUs", 0.9)
        run = run_of_record(found) if found.ground.loop.driven else None
        return found, run


def _write(target: Path, found: "Identified", run: "RecordRun | None") -> None:
    from motionfmu.identify.found_values import found_numbers, found_toml
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.identify_page import identify_page

    with result_folder.whole(target) as part:
        result_folder.write_result(part, identify_page(found, run), found_numbers(found, run))
        (part / "found.toml").write_text(found_toml(found), encoding="utf-8")


def _tell(found: "Identified", run: "RecordRun | None") -> None:
    from motionfmu.identify.found_values import value_text

    table = bare_table("quantity", "before", "found", "unit")
    for p in found.parameters:
        shown = value_text(p) if p.told else f"cannot be told: {p.why}"
        table.add_row(p.name, f"{p.before:.6g}", shown, p.unit)
    out.print(table)
    for note in found.notes:
        out.print(note, markup=False, soft_wrap=True)
    words = ", ".join(found.laws) or "none"
    print(f"extensions of the friction law: {words}")
    if run is None:
        return
    for name, share in run.differences.items():
        print(f"FMUs beside the record from {run.settled:g} s on: {name} {100 * share:.3g} %")
