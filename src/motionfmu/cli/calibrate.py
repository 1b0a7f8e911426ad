"""The console command that finds a machine's geometry in measured records."""

from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    Folder,
    LayoutFile,
    Over,
    Set,
    app,
    bare_table,
    out,
    record_options,
    report,
    results,
    settings,
    stages,
)

if TYPE_CHECKING:
    from motionfmu.calibrate import ArmCalibration, MachineCalibration, MachineRecords
    from motionfmu.run import Scenario
    from motionfmu.run.machine_program import Machine


@app.command()
def calibrate(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[
        Path, typer.Argument(help="A machine: its folder, file or name; or a scenario.")
    ],
    record: Annotated[
        list[str],
        typer.Option(
            metavar="[NAME=]FILE",
            help="A record: X=FILE positioning of an axis (ISO 230-2), XY=FILE a circle of a"
            " plane (ISO 230-4), FILE poses of a robot.",
        ),
    ],
    radius: Annotated[
        float | None, typer.Option(help="Nominal radius of the circles [mm].")
    ] = None,
    feed: Annotated[
        float | None, typer.Option(help="Along the circles [mm/min]; else by their times.")
    ] = None,
    known_base: Annotated[
        bool, typer.Option("--known-base", help="Poses are in the robot's own base.")
    ] = False,
    known_tool: Annotated[
        bool, typer.Option("--known-tool", help="Poses are those of the tip that the arm has.")
    ] = False,
    runs: Annotated[
        bool,
        typer.Option("--runs/--no-runs", help="Run the tests on the machine, too, with its FMUs."),
    ] = True,
    over: Over = [],  # noqa: B006
    layout: LayoutFile = None,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """Find backlash, lead errors, squareness, or an arm's zeros and lengths, in records.

    Writes found.toml for --set, the compensation tables, and a report.
    """
    needed("tune")
    from motionfmu.report import result_folder

    machine, plan = _opened(path)
    columns, given = record_options(over, layout)
    named = [_named(text) for text in record]
    target = result_folder.usable(folder or results((machine or plan).name, "calibrate"))
    values = settings(set_)
    poses = [f for name, f in named if not name and _has_poses(f, given or {})]
    if poses:
        if len(named) > 1:
            raise InputError(f"{poses[0]}: poses of a robot go alone")
        options = {"known_base": known_base, "known_tool": known_tool}
        _arm(plan, poses[0], (options, columns, given), values, target)
        return
    _refuse_arm(plan, named, values)
    asked = {"radius": radius, "feed": feed, "over": columns or {}, "layout": given or {}}
    records = _records(plan, named, asked)
    _refuse_unread(records, over, layout)
    _tool(plan, machine if runs else None, records, values, target)


def _opened(path: Path) -> "tuple[Machine | None, Scenario]":
    """A machine and its plan; of a scenario the scenario alone."""
    from motionfmu import run

    scenario = path if path.is_file() else path / "scenario.toml"
    if scenario.is_file() and scenario.name == "scenario.toml":
        return None, run.load(path)
    try:
        found = run.machine(path)
    except InputError:
        with suppress(InputError):
            return None, run.load(path)  # a name of `motionfmu list`
        raise
    return found, found.plan()


def _named(text: str) -> tuple[str, Path]:
    """Name and file of ``NAME=FILE``; a file whose name has an equals sign needs a name, too."""
    name, equals, file = text.partition("=")
    if not equals:
        return "", Path(text)
    if not name.strip() or not file.strip():
        raise InputError(f"--record {text}: FILE or NAME=FILE wanted")
    return name.strip().upper(), Path(file.strip())


def _has_poses(file: Path, layout: dict[str, Any]) -> bool:
    from motionfmu.calibrate.pose_record import is_pose_record
    from motionfmu.calibrate.position_record import is_position_record

    return not is_position_record(file) and is_pose_record(file, layout)


def _refuse_arm(plan: "Scenario", named: list[tuple[str, Path]], values: dict[str, Any]) -> None:
    """An InputError for records of a machine tool that go with an arm."""
    from motionfmu.calibrate.plant_geometry import MachineGeometry

    geometry = MachineGeometry.of(plan, values)
    if geometry.find("pose") and not geometry.find("axis"):
        raise InputError(
            f"{named[0][1]}: {plan.name} is an arm: poses of its tool are wanted (--record FILE),"
            " not a positioning test nor a circle"
        )


def _refuse_unread(records: "MachineRecords", over: list[str], layout: Path | None) -> None:
    """An InputError for options that say how records are read of which there are none."""
    if not records.circles and (over or layout):
        option = f"--map {over[0]}" if over else f"--layout {layout}"
        names = ", ".join(r.name for r in records.positions.values())
        raise InputError(
            f"{option}: it goes with circles and poses; {names}: columns of a positioning test are"
            " known by their headings: target, position or deviation, direction"
        )


def _records(
    plan: "Scenario", named: list[tuple[str, Path]], asked: dict[str, Any]
) -> "MachineRecords":
    """Positioning tests and circles by what their names say."""
    from motionfmu.calibrate import CircleChoice, MachineRecords, circle_record, position_record
    from motionfmu.calibrate.plant_geometry import PLANES, axis_rows, row_of_axis

    rows = axis_rows(plan)
    planes: dict[str, list[Path]] = {}
    positions: dict[str, Any] = {}
    for name, file in named:
        plane = next((p for p in PLANES if sorted(p) == sorted(name)), None)
        if plane is not None:
            planes.setdefault(plane, []).append(file)
            continue
        if name:
            row_of_axis(rows, name, f"--record {name}={file}")
        found = position_record(file)
        axis = name or found.axis
        if not axis:
            raise InputError(f"{file}: which axis was measured? --record X={file}")
        if axis in positions:
            raise InputError(f"{file}: {axis} was measured in {positions[axis].name}, too")
        positions[axis] = found
    choice = CircleChoice(**asked)
    circles = [circle_record(files, plane, choice) for plane, files in planes.items()]
    return MachineRecords(positions, circles)


def _tool(
    plan: "Scenario",
    machine: "Machine | None",
    records: "MachineRecords",
    values: dict[str, Any],
    target: Path,
) -> None:
    """A machine tool, with a progress bar, which shows on a terminal only."""
    from motionfmu.calibrate import machine_calibration
    from motionfmu.calibrate.calibration_files import COMPENSATION, machine_files
    from motionfmu.report import result_folder
    from motionfmu.report.calibration_page import machine_page

    with stages() as show:
        found = machine_calibration(plan, records, machine, values, show)
    with result_folder.whole(target) as part:
        result_folder.write_result(part, machine_page(found), found.numbers())
        for name, text in machine_files(found, target).items():
            (part / name).write_text(text, encoding="utf-8")
    _tell(found)
    print(f"values: {target / 'found.toml'}")
    if found.compensation:
        print(f"compensation: {target / COMPENSATION}")
    report(target / "report.html")


def _tell(found: "MachineCalibration") -> None:
    table = bare_table("parameter", "before", "found", "unit")
    for p in found.parameters:
        shown = p.found.text() if p.found.told else f"cannot be told: {p.found.why}"
        table.add_row(p.name, f"{p.before:.6g}", shown, p.found.unit)
    out.print(table)
    if any(a.after for a in found.axes):
        rows = bare_table("ISO 230-2 [µm]", "A", "E", "B", "M", "compensated: A", "E", "B", "M")
        for a in found.axes:
            if a.after is not None:
                sides = (a.error.test.figures(), a.after.test.figures())
                cells = [f"{s[k] * 1e3:.3g}" for s in sides for k in "AEBM"]
                rows.add_row(a.name, *cells)
        out.print(rows)
    for note in found.notes:
        out.print(note, markup=False, soft_wrap=True)


def _arm(
    plan: "Scenario",
    file: Path,
    asked: tuple[dict[str, bool], dict[str, str] | None, dict[str, Any] | None],
    values: dict[str, Any],
    target: Path,
) -> None:
    """An arm."""
    from motionfmu.calibrate import ArmCalibrationOptions, arm_calibration, pose_record
    from motionfmu.calibrate.calibration_files import arm_files
    from motionfmu.report import result_folder
    from motionfmu.report.calibration_page import arm_page

    options, columns, layout = asked
    found = arm_calibration(
        plan, pose_record(file, columns, layout), ArmCalibrationOptions(**options), values
    )
    with result_folder.whole(target) as part:
        result_folder.write_result(part, arm_page(found), found.numbers())
        for name, text in arm_files(found).items():
            (part / name).write_text(text, encoding="utf-8")
    _tell_arm(found)
    print(f"values: {target / 'found.toml'}, {target / 'compensated.toml'}")
    report(target / "report.html")


def _tell_arm(found: "ArmCalibration") -> None:
    table = bare_table("quantity", "change", "unit")
    for name, e in found.parameters.items():
        table.add_row(name, e.text() if e.told else f"left: {e.why}", e.unit)
    out.print(table)
    sides = found.numbers()
    for name, words in (
        ("before", "base and tool alone"),
        ("known", "with what a controller can know"),
        ("after", "with all that was found"),
        ("kept_back", "poses kept back"),
    ):
        size = sides["rms"][name]
        if size is not None:
            print(f"{words}: {size:.4g} mm rms")
    for note in found.notes:
        out.print(note, markup=False, soft_wrap=True)
