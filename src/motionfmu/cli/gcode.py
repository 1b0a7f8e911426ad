"""The command that checks part programs."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.axis_names import LINEAR, ROTARY
from motionfmu.base.errors import InputError
from motionfmu.base.extras import install, missing
from motionfmu.base.program_endings import ROBOT_JOBS
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
from motionfmu.cli.drawing_choices import (
    At,
    Copies,
    Corners,
    Knife,
    Larger,
    Order,
    Page,
    Pens,
    Pitch,
    drawing_options,
    drawing_table,
)

if TYPE_CHECKING:
    from motionfmu.analysis.cycle_time import CommandedMotion, Lifted
    from motionfmu.analysis.gcode import Fault, Program, Summary
    from motionfmu.run.program_translation import MachineProgram

Planned = tuple["CommandedMotion", list["Lifted"]]


@app.command()
def gcode(  # noqa: PLR0913  (each is an option of the command)
    files: Annotated[list[Path], typer.Argument(help="Part programs.")],
    machine: OnMachine = None,
    set_: Set = [],  # noqa: B006
    tools: Annotated[Path | None, typer.Option(help="Tool table: lines T1 P1 Z10 D6.")] = None,
    max_feed: Annotated[float | None, typer.Option(help="Highest feed [mm/min]; 30000.")] = None,
    rapid: Annotated[
        float | None, typer.Option(help="Highest speed of an axis [mm/min]; 30000.")
    ] = None,
    acceleration: Annotated[
        float | None, typer.Option(help="Along the path [mm/s²]; 1000.")
    ] = None,
    jerk: Annotated[float | None, typer.Option(help="Of it [mm/s³]; 0 none.")] = None,
    limit: Annotated[
        list[str], typer.Option(metavar="AXIS=LO:HI", help="Travel of an axis [mm].")
    ] = [],  # noqa: B006
    fanuc: Annotated[
        bool, typer.Option("--fanuc", help="As for Fanuc and Haas: P in ms, G65, GOTO.")
    ] = False,
    angles: Annotated[bool, typer.Option("--angles", help="A B C in place of U V W.")] = False,
    strict_feed: Annotated[
        bool, typer.Option("--strict-feed", help="Refuse F above the highest feed.")
    ] = False,
    delete: Annotated[bool, typer.Option("--block-delete", help="Pass over lines with /.")] = False,
    folder: Folder = None,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, write nothing.")] = False,
    order: Order = None,
    corners: Corners = None,
    pen: Pens = None,
    at: At = None,
    scale: Larger = None,
    copies: Copies = None,
    pitch: Pitch = None,
    knife: Knife = None,
    page: Page = None,
) -> None:
    """Check part programs: faults, cycle time, extents, tools; draw their paths.

    A drawing is checked as the part program that a mill gets.

    With --machine its speeds, ramps, travel, tools and words count, where no option says other, and
    the time is that of its controller's planner, which tells where it goes.
    """
    from motionfmu.analysis.gcode import read, summarise
    from motionfmu.analysis.gcode.program import text_in

    given = settings(set_)
    read_as, table = _of_machine(machine, given)
    read_as |= _rates(max_feed, rapid, acceleration, jerk)
    switches = {"fanuc": fanuc, "angles": angles, "strict_feed": strict_feed}
    read_as |= {name: True for name, on in switches.items() if on}
    if machine is None or delete:
        read_as["block_delete"] = delete
    read_as |= _limits(limit, read_as.get("angles", False))
    table = text_in(tools) if tools else table
    asked = {"order": order, "corners": corners, "pens": pen, "at": at, "scale": scale}
    drawing = drawing_table(**asked, copies=copies, pitch=pitch, knife=knife, page=page)
    told, good = {}, True
    for file in files:
        made = _translated(file, machine, drawing)
        program = read(made.file, table, **read_as)
        good = good and not program.faults
        tables = {"set": given} | ({"drawing": drawing} if drawing else {})
        planned = None if program.faults else _planned(file, machine, tables)
        told[str(file)] = found = _numbers(program, summary := summarise(program), planned)
        found |= _of_drawing(made)
        if not as_json:
            target = folder / f"{file.stem}.gcode" if folder else results(file.stem, "gcode")
            _show(file, made, (program, summary, planned), found, target)
    if as_json:
        give(json.dumps(told, indent=1, allow_nan=False))
    if not good:
        raise typer.Exit(FAILED)


def _of_drawing(made: "MachineProgram") -> dict[str, Any]:
    """What is left out of a drawing, and which of its pages it is, if it has several."""
    found: dict[str, Any] = {"left_out": list(made.notes)} if made.notes else {}
    return found | ({"page": made.page, "pages": made.pages} if made.paged else {})


def _of_machine(machine: str | None, given: dict[str, Any]) -> tuple[dict[str, Any], str]:
    """Settings of the reader and the tool table of a machine; none without one."""
    if machine is None:
        if given:
            raise InputError(f"--set {next(iter(given))}: --machine is missing")
        return {}, ""
    from motionfmu.run.program_reading import reading_on

    return reading_on(machine, given)


def _rates(
    max_feed: float | None, rapid: float | None, along: float | None, jerk: float | None
) -> dict[str, Any]:
    """Settings of the speeds and accelerations that options give."""
    given: dict[str, Any] = {} if max_feed is None else {"max_feed": max_feed}
    given |= {} if rapid is None else {"speed": rapid / 60.0}
    if along is not None or jerk is not None:
        from motionfmu.analysis.gcode import defaults

        size = defaults()["acceleration"] if along is None else along
        given |= {"acceleration": size, "deceleration": size, "acc_time": 0.0, "dec_time": 0.0}
        given |= {"jerk": jerk or 0.0, "jerk_down": jerk or 0.0}
    return given


def _more(note: "Fault") -> str:
    return f" ({note.limits})" if note.limits else ""


def _limits(texts: list[str], angles: bool) -> dict[str, Any]:
    """Settings of travel by ``X=0:300``."""
    if not texts:
        return {}
    names = "".join(axis.name for axis in (ROTARY if angles else LINEAR))
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


def _translated(file: Path, machine: str | None, drawing: dict[str, Any]) -> "MachineProgram":
    """The part program of a file, which a drawing becomes."""
    from motionfmu.drawings.reading import ENDINGS, is_drawing
    from motionfmu.run.machine_program import Machine
    from motionfmu.run.program_translation import MachineProgram, drawing_as_gcode

    if is_drawing(file):
        if machine is not None:
            return Machine(machine).translated(file, drawing)
        return drawing_as_gcode(file.resolve(), drawing_options(drawing), True)
    if drawing:
        told = f"it is for drawings ({', '.join(ENDINGS)})"
        raise InputError(f"--{next(iter(drawing))}: {file}: {told}")
    if file.suffix.lower() in ROBOT_JOBS:
        raise InputError(f"{file}: a robot's job: motionfmu job {file} --machine ROBOT")
    return MachineProgram(file)


def _planned(file: Path, machine: str | None, tables: dict[str, Any]) -> Planned | None:
    """The program as a machine's controller commands it, and with each limit lifted."""
    given = tables["set"]
    if machine is None:
        return None
    from motionfmu.analysis.cycle_time import planned, what_if
    from motionfmu.run import Machine

    scenario = Machine(machine).scenario(file, **tables)
    plan = planned(scenario)
    return plan, what_if(scenario, plan, set=given)


def _tell_plan(found: Planned) -> None:
    """Where the time goes, and which limit would save some."""
    from motionfmu.report.cycle_time_section import name_of

    plan, lifted = found
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


def _numbers(program: "Program", summary: "Summary", planned: Planned | None) -> dict[str, Any]:
    from dataclasses import asdict

    faults = [asdict(f) for f in program.faults]
    notes = [asdict(n) for n in program.notes]
    found = {"faults": faults, "more": program.more, "notes": notes}
    found |= summary.numbers()
    if planned is not None:
        plan, lifted = planned
        found |= plan.numbers() | {"what_if": [asdict(x) for x in lifted]}
    return found


def _fault_places(made: Path, program: "Program") -> list[str]:
    """Faults of a program that was made of a drawing, by their places there."""
    from motionfmu.run.translated_places import in_source

    found = [f"{made}: line {f.line}: {f.why} {f.text}{_more(f)}" for f in program.faults]
    return list(dict.fromkeys(in_source(text) for text in found))


def _show(
    file: Path,
    made: "MachineProgram",
    read: tuple["Program", "Summary", Planned | None],
    found: dict[str, Any],
    target: Path,
) -> None:
    """Print what was found and write the report."""
    from motionfmu.report import result_folder
    from motionfmu.report.jobs.drawn_strokes import DrawnStrokes
    from motionfmu.report.jobs.gcode_page import (
        clock,
        fault_lines,
        metres,
        page_text,
        place,
        write_path,
    )
    from motionfmu.run.translated_places import in_source

    program, s, planned = read
    drawn = made.file != file
    told = [f"note: {note}" for note in made.told]
    told += _fault_places(made.file, program) if drawn else fault_lines(str(file), program)
    for note in program.notes:
        where = f"{made.file}: line {note.line}" if drawn else place(str(file), note)
        told.append(in_source(f"{where}: note: {note.why} {note.text}{_more(note)}"))
    for text in told:
        out.print(text, markup=False, soft_wrap=True)
    if program.faults:
        return
    time = s.time if planned is None else planned[0].time
    out.print(f"[bold]{file}[/]  {clock(time)}, {s.commands} commands, {s.stops} stops")
    low, high = s.feeds
    out.print(f"feed {metres(s.feed_way)} at {low:.4g} to {high:.4g} mm/min", end=", ")
    out.print(f"rapid {metres(s.rapid_way)}")
    for axis, a, b in zip(program.axes, s.low, s.high, strict=True):
        if a != b:
            out.print(f"  {axis.name} {a:.4f} .. {b:.4f} {axis.unit}")
    table = bare_table("tool", "time", "way with feed", "deepest Z")
    for u in s.tools:
        name = f"T{u.tool}" if u.tool else "none"
        table.add_row(name, clock(u.time), metres(u.feed_way), f"{u.low[2]:.4g} mm")
    out.print(table)
    if planned is not None:
        _tell_plan(planned)
    path = DrawnStrokes(program, s)
    result_folder.usable(target)
    with result_folder.whole(target) as part:
        if not (without := missing("report")):
            write_path(file.stem, path.strokes, part)
        page = page_text(file.stem, program, s, path, planned)
        result_folder.write_result(part, page, found)
    if without:
        out.print(f"no picture: {install('report')}", markup=False)
    report(target / "report.html")
