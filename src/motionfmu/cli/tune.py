"""The console command that finds servo gains."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

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
    report,
    results,
    settings,
    stages,
)

if TYPE_CHECKING:
    from motionfmu.run import Scenario
    from motionfmu.study.arm_gains import ArmTuned
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
    """Find servo gains for a scenario's own path; write gains.toml and a report.

    Of an arm, or a machine with one: gains that keep its margins in all poses. A machine runs its
    own example.job.
    """
    needed("tune")
    from motionfmu.report import result_folder
    from motionfmu.study.arm_gains import is_arm
    from motionfmu.study.tune import problem, read

    scenario, program, name = _subject(path, machine)
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
    arm = is_arm(scenario)
    if not program and not arm and scenario.document.tables.get("contour"):
        raise InputError(
            f"{name}: gains are found for a program's path: tune PROGRAM --machine {path}"
        )
    target = result_folder.usable(folder or results(name, "tune"))
    if arm:
        _tune_arm(scenario, wanted, settings(set_), program, target)
        return
    from motionfmu.report.loop_pages.tune_page import page_text

    tuned = _tune(scenario, wanted, settings(set_))
    _write(target, page_text(tuned), tuned)
    _tell(tuned)
    out.print(f"gains: {target / 'gains.toml'}", soft_wrap=True)
    report(target / "report.html")


def _write(target: Path, page: str, tuned: Any) -> None:
    """The page, its figures and the gains as a file for ``--set``."""
    from motionfmu.report import result_folder

    with result_folder.whole(target) as part:
        result_folder.write_result(part, page, tuned.numbers())
        (part / "gains.toml").write_text(tuned.toml(), encoding="utf-8")


def _subject(path: Path, machine: str | None) -> "tuple[Scenario, bool, str]":
    """A scenario, or a machine with the example beside it; if it has a program; its name."""
    from motionfmu.run.machine_program import machine_of

    own = machine_of(path) if machine is None else None
    if own is None:
        scenario = loaded(path, machine)
        return scenario, True, scenario.name
    example = own.file.parent / "example.job"
    if not (own.takes_programs and example.is_file()):
        return own.plan(), False, own.name
    return own.scenario(example), True, own.name


def _tune_arm(
    scenario: "Scenario", asked: "Problem", given: dict[str, Any], program: bool, target: Path
) -> None:
    """Tune the drives of an arm, tell and write what was found."""
    from motionfmu.report.loop_pages.arm_gains_page import page_text
    from motionfmu.study.arm_gains import tune_arm

    with stages(scenario.name) as show:
        tuned = tune_arm(scenario, asked, given, program, show)
    _write(target, page_text(tuned), tuned)
    _tell_arm(tuned)
    out.print(f"gains: {target / 'gains.toml'}", soft_wrap=True)
    report(target / "report.html")


def _tell_arm(tuned: "ArmTuned") -> None:
    """Print the worst pose, inertia and margins of each joint, and what the runs show."""
    from motionfmu.report.loop_pages.arm_gains_page import margin_cells

    heads = ("gain", "phase", "bandwidth", "peak S", "swing")
    table = bare_table("joint", "inertia", "gains", *heads, "worst pose [°]")
    sides = zip(tuned.before.joints, tuned.after.joints, tuned.inertia.T * 1e4, strict=True)
    for before, after, (low, high) in sides:
        for side, j in (("before", before), ("after", after)):
            first = (f"J{j.joint}", f"{low:.3g} to {high:.3g}") if side == "before" else ("", "")
            peaks = f"{j.sensitivity:.3g}", f"{j.swing:.3g}"
            pose = " ".join(f"{x:.0f}" for x in j.pose)
            table.add_row(*first, side, *margin_cells(j.margins), *peaks, pose)
    out.print(table)
    out.print("inertia at the motor [kg·cm²]; swing: largest |link/command|", markup=False)
    for name, value in tuned.settings.items():
        out.print(f"{name} = {value}", markup=False, soft_wrap=True)
    out.print(f"J{tuned.slowest} is the slowest: all lag as long as it must")
    for side, run in zip(("before", "after"), tuned.runs, strict=False):
        told = f"tool beside its way at rest {run.rms:.3g} mm RMS, {run.max:.3g} mm at most"
        torque = f"{100.0 * run.torque.max():.3g} % of the torque limit"
        behind = f"joints {run.lag.max():.3g}° behind"
        out.print(f"{side}: {told}; {behind}; {torque}", markup=False, soft_wrap=True)


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
