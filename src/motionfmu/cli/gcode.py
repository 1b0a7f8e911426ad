"""The command that checks part programs."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import install, missing
from motionfmu.cli.common import (
    FAILED,
    Folder,
    OnMachine,
    Set,
    app,
    bare_table,
    give,
    out,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.analysis.gcode import Program

AXES = "XYZUVW"


@app.command()
def gcode(  # noqa: PLR0913  (each is an option of the command)
    files: Annotated[list[Path], typer.Argument(help="Part programs.")],
    tools: Annotated[Path | None, typer.Option(help="Tool table: lines T1 P1 Z10 D6.")] = None,
    max_feed: Annotated[float, typer.Option(help="Highest feed [mm/min].")] = 30000.0,
    rapid: Annotated[float, typer.Option(help="Highest speed of an axis [mm/min].")] = 30000.0,
    acceleration: Annotated[float, typer.Option(help="Along the path [mm/s²].")] = 1000.0,
    jerk: Annotated[float, typer.Option(help="Of it [mm/s³]; 0 none.")] = 0.0,
    limit: Annotated[
        list[str], typer.Option(metavar="AXIS=LO:HI", help="Travel of an axis [mm].")
    ] = [],  # noqa: B006
    fanuc: Annotated[
        bool, typer.Option("--fanuc", help="As for Fanuc and Haas: P in ms, G65, GOTO.")
    ] = False,
    angles: Annotated[bool, typer.Option("--angles", help="A B C in place of U V W.")] = False,
    machine: OnMachine = None,
    set_: Set = [],  # noqa: B006
    strict_feed: Annotated[
        bool, typer.Option("--strict-feed", help="Refuse F above the highest feed.")
    ] = False,
    delete: Annotated[bool, typer.Option("--block-delete", help="Pass over lines with /.")] = False,
    folder: Folder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, write nothing.")] = False,
) -> None:
    """Check part programs: faults, cycle time, extents, tools; draw their paths."""
    if machine is not None:
        good = _on_machine(files, machine, set_, folder, as_json)
        raise typer.Exit(0 if good else FAILED)
    if set_:
        raise InputError(f"--set {set_[0]}: --machine is missing")
    settings: dict[str, Any] = {
        "max_feed": max_feed,
        "speed": rapid / 60.0,
        "acceleration": acceleration,
        "deceleration": acceleration,
        "jerk": jerk,
        "jerk_down": jerk,
        "fanuc": fanuc,
        "angles": angles,
        "strict_feed": strict_feed,
        "block_delete": delete,
    }
    settings |= _limits(limit, angles)
    from motionfmu.analysis.gcode import read
    from motionfmu.analysis.gcode.program import text_in

    table = text_in(tools) if tools else ""
    told, good = {}, True
    for file in files:
        program = read(file, table, **settings)
        good = good and not program.faults
        found = _numbers(program)
        told[str(file)] = found
        if not as_json:
            target = (folder / f"{file.stem}.gcode") if folder else results(file.stem, "gcode")
            _show(file, program, target)
    if as_json:
        give(json.dumps(told, indent=1, allow_nan=False))
    if not good:
        raise typer.Exit(FAILED)


def _on_machine(
    files: list[Path], machine: str, given: list[str], folder: Path | None, as_json: bool
) -> bool:
    """Plan programs as a machine's controller commands them, and tell where their time goes."""
    from motionfmu.analysis.cycle_time import planned, what_if
    from motionfmu.report import result_folder
    from motionfmu.report.cycle_time_section import name_of
    from motionfmu.report.jobs.gcode_page import clock, plan_page
    from motionfmu.run import Machine

    values = settings(given)
    on, told = Machine(machine), {}
    for file in files:
        scenario = on.scenario(file, set=values)
        plan = planned(scenario)
        lifted = what_if(scenario, plan)
        found = plan.numbers() | {
            "what_if": [
                {"limit": x.title, "axis": x.axis, "set": x.set, "time": x.time, "saved": x.saved}
                for x in lifted
            ]
        }
        told[str(file)] = found
        if as_json:
            continue
        out.print(f"[bold]{file}[/] on {on.name}  {clock(plan.time)} ({plan.time:.3f} s)")
        where = bare_table("limited by", "s", "%")
        for s in plan.shares():
            where.add_row(name_of(s), f"{s.time:.3f}", f"{100.0 * s.time / plan.time:.1f}")
        out.print(where)
        saved = bare_table("a quarter more of", "s", "saves")
        for x in lifted:
            if x.saved > 0.0:
                title = f"{x.title}, {x.axis}" if x.axis else x.title
                saved.add_row(title, f"{x.time:.3f}", f"{x.saved:.3f}")
        out.print(saved)
        target = (folder / f"{file.stem}.gcode") if folder else results(file.stem, "gcode")
        result_folder.usable(target)
        with result_folder.whole(target) as part:
            page = plan_page(f"{file.stem} on {on.name}", plan, lifted)
            (part / "report.html").write_text(page, encoding="utf-8")
            text = json.dumps(found, indent=1, allow_nan=False)
            (part / result_folder.NUMBERS).write_text(text + "\n", encoding="utf-8")
        report(target / "report.html")
    if as_json:
        give(json.dumps(told, indent=1, allow_nan=False))
    return True


def _limits(texts: list[str], angles: bool) -> dict[str, Any]:
    """Settings of travel by ``X=0:300``."""
    if not texts:
        return {}
    names = "XYZABC" if angles else AXES
    bounded, low, high = [False] * 6, [0.0] * 6, [0.0] * 6
    for text in texts:
        name, _, span = text.partition("=")
        try:
            i = names.index(name.strip().upper() or "?")
            low[i], high[i] = map(float, span.split(":"))
        except ValueError:
            raise InputError(f"--limit {text}: AXIS=LO:HI wanted, axes {names}") from None
        if not low[i] < high[i]:
            raise InputError(f"--limit {text}: LO is not below HI")
        bounded[i] = True
    return {"bounded": bounded, "low": low, "high": high}


def _numbers(program: "Program") -> dict[str, Any]:
    from dataclasses import asdict

    from motionfmu.analysis.gcode import summarise

    faults = [asdict(f) for f in program.faults]
    notes = [asdict(n) for n in program.notes]
    return {"faults": faults, "more": program.more, "notes": notes} | summarise(program).numbers()


def _show(file: Path, program: "Program", target: Path) -> None:
    """Print what was found and write the report."""
    from motionfmu.analysis.gcode import strokes, summarise
    from motionfmu.report import result_folder
    from motionfmu.report.jobs.gcode_page import (
        clock,
        fault_lines,
        metres,
        page_text,
        place,
        write_path,
    )

    for text in fault_lines(str(file), program):
        out.print(text, markup=False, soft_wrap=True)
    for note in program.notes:
        out.print(
            f"{place(str(file), note)}: note: {note.why} {note.text}", markup=False, soft_wrap=True
        )
    if program.faults:
        return
    s = summarise(program)
    out.print(f"[bold]{file}[/]  {clock(s.time)}, {s.commands} commands, {s.stops} stops")
    low, high = s.feeds
    out.print(f"feed {metres(s.feed_way)} at {low:.4g} to {high:.4g} mm/min", end=", ")
    out.print(f"rapid {metres(s.rapid_way)}")
    for name, a, b in zip(AXES, s.low, s.high, strict=True):
        if a != b:
            out.print(f"  {name} {a:.4f} .. {b:.4f} mm")
    table = bare_table("tool", "time", "way with feed", "deepest Z")
    for u in s.tools:
        name = f"T{u.tool}" if u.tool else "none"
        table.add_row(name, clock(u.time), metres(u.feed_way), f"{u.low[2]:.4g} mm")
    out.print(table)
    drawn = list(strokes(program))
    result_folder.usable(target)
    with result_folder.whole(target) as part:
        if not (without := missing("report")):
            write_path(file.stem, drawn, part)
        page = page_text(file.stem, program, s, drawn)
        (part / "report.html").write_text(page, encoding="utf-8")
        numbers = json.dumps(_numbers(program), indent=1, allow_nan=False)
        (part / result_folder.NUMBERS).write_text(numbers + "\n", encoding="utf-8")
    if without:
        out.print(f"no picture: {install('report')}", markup=False)
    report(target / "report.html")
