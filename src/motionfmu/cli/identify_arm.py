"""What `motionfmu identify` does where the plant is an arm."""

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import typer

from motionfmu.cli.common import FAILED, bare_table, out, report, stages

if TYPE_CHECKING:
    from motionfmu.identify.arm_dynamics import ArmOptions, HeldArm, IdentifiedArm
    from motionfmu.records import Record
    from motionfmu.run import Scenario


def identify_arm_of(
    scenario: "Scenario",
    record: Path,
    asked: tuple[Mapping[str, Any], str],
    set_: Mapping[str, Any],
    target: Path,
) -> None:
    """Identify, write found.toml and a report, and tell; `asked` are tables and their place."""
    from motionfmu import records
    from motionfmu.identify.arm_dynamics.arm_options import asked_of

    tables, place = asked
    wanted = asked_of(tables, place)
    measured = records.record(record, **wanted.layout)
    found, run = _found(scenario, measured, wanted.options, set_)
    _write(target, found, run)
    _tell(found, run)
    print(f"values: {target / 'found.toml'}")
    report(target / "report.html")
    if not any(q.told for q in (*found.base, *found.joints)):
        raise typer.Exit(FAILED)


def _found(
    scenario: "Scenario", record: "Record", options: "ArmOptions", set_: Mapping[str, Any]
) -> "tuple[IdentifiedArm, HeldArm]":
    """Identify and run, with a progress bar, which shows on a terminal only."""
    from motionfmu.identify.arm_dynamics import held_arm, identify_arm

    with stages(scenario.name) as show:
        found = identify_arm(scenario, record, options, set_, lambda w, s: show(w, 0.7 * s))
        run = held_arm(found, progress=lambda s: show("the FMU", 0.7 + 0.3 * s))
        return found, run


def _write(target: Path, found: "IdentifiedArm", run: "HeldArm") -> None:
    from motionfmu.identify.arm_dynamics.arm_files import arm_numbers, arm_toml
    from motionfmu.report import result_folder
    from motionfmu.report.loop_pages.arm_page import arm_page

    with result_folder.whole(target) as part:
        result_folder.write_result(part, arm_page(found, run), arm_numbers(found, run))
        (part / "found.toml").write_text(arm_toml(found), encoding="utf-8")


def _tell(found: "IdentifiedArm", run: "HeldArm") -> None:
    from motionfmu.identify.arm_dynamics.arm_files import law_names, with_deviation

    rows = bare_table("base parameter", "before", "found", "unit")
    for q in (*found.base, *found.joints):
        shown = with_deviation(q.value, q.deviation)
        before = f"{q.before:.6g}" if q.before == q.before else ""
        rows.add_row(q.text or q.name, before, shown if q.told else f"({shown})", q.unit)
    out.print(rows)
    print("in brackets: known worse than to 30 % of itself")
    for k, gear in found.gears.items():
        slopes = ", ".join(
            with_deviation(float(v), float(d))
            for v, d in zip(gear.stiffness, gear.stiffness_deviation, strict=True)
        )
        lost, deviation = gear.values["lost"]
        gap = f"lost motion {with_deviation(lost, deviation)} rad" if gear.told("lost") else ""
        print(f"gear {k + 1}: {slopes} N·m/rad  {gap}".rstrip())
    for note in found.notes:
        out.print(note, markup=False, soft_wrap=True)
    laws = (f"{n} of {', '.join(map(str, on))}" for n, on in law_names(found).items())
    print(f"laws beside Coulomb and viscous friction and an offset: {'; '.join(laws) or 'none'}")
    shares = " ".join(f"{100 * x:.2g}" for x in found.kept)
    print(f"torques left unexplained on the part kept back, by joint: {shares} %")
    shares = " ".join(f"{100 * x:.2g}" for x in run.shares)
    print(f"the arm's FMU along that part: loops add {shares} % of the torques")
