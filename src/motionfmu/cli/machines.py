"""The command that lists machines, and measures one."""

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import (
    Folder,
    Set,
    app,
    bare_table,
    out,
    report,
    results,
    settings,
    stages,
)
from motionfmu.cli.console_text import print_rows
from motionfmu.cli.list import first_line

if TYPE_CHECKING:
    from motionfmu.analysis.data_sheet import DataSheet

SHOWN = ("A", "E", "R", "B", "M")


@app.command()
def machines(
    path: Annotated[
        Path | None, typer.Argument(help="A machine: its folder or file, or a name of the list.")
    ] = None,
    set_: Set = [],  # noqa: B006
    folder: Folder = None,
) -> None:
    """List the machines on which programs run: those of the package and of ./machines.

    With a machine, measure it by runs and write its data sheet: limits, positioning (ISO 230-2),
    circles (ISO 230-4), margins and step answers of its loops, poses and path of a robot (ISO
    9283).
    """
    if path is None:
        from motionfmu.scenarios import package_files

        known = package_files.machines()
        print_rows([((name,), first_line(place)) for name, place in known.items()])
        if set_ or folder is not None:
            raise InputError("--set and --out go with a machine")
        return
    needed("tune")
    from motionfmu.report import result_folder
    from motionfmu.report.data_sheet_page import page_text, write_sheet_picture
    from motionfmu.report.data_sheet_table import markdown
    from motionfmu.run import machine

    given, own = settings(set_), machine(path)
    target = result_folder.usable(folder or results(own.name, "machine"))
    sheet = _measured(own, given)
    _print(sheet)
    with result_folder.whole(target) as part:
        for name, text in sheet.programs.items():
            (part / name).write_text(text, encoding="utf-8")
        result_folder.write_result(part, page_text(sheet), sheet.numbers())
        (part / "figures.md").write_text(markdown(sheet), encoding="utf-8")
        write_sheet_picture(sheet, part / "figures")
    report(target / "report.html")


def _measured(own: "object", given: dict[str, object]) -> "DataSheet":
    """The data sheet, with a progress bar, which shows on a terminal only."""
    from motionfmu.analysis.data_sheet import data_sheet

    with stages() as show:
        return data_sheet(own, given, show)  # type: ignore[arg-type]


def _print(sheet: "DataSheet") -> None:
    """The figures in short."""
    from motionfmu.report.numbers import figure, length

    measured = [a for a in sheet.axes if a.positioning is not None]
    if measured:
        rows = bare_table("ISO 230-2", *SHOWN, "unrest")
        for a in measured:
            assert a.positioning is not None
            factor, unit = a.axis.fine
            found = a.positioning.figures()
            shown = [*(found[n] for n in SHOWN), a.unrest or 0.0]
            rows.add_row(a.axis.name, *(f"{figure(size * factor)} {unit}" for size in shown))
        out.print(rows)
    for name, c in sheet.circles.items():
        both = length(c.both.g) if c.both else ""
        radius = length(c.both.d_nominal, sign=True) if c.both else ""
        out.print(f"ISO 230-4, {name}, R {c.radius:g} mm: G(b) {both}, D {radius}")
    _print_loops(sheet)
    if sheet.robot is not None:
        found = sheet.robot.found.numbers()
        poses = f"AP {length(sheet.robot.ap)}, RP {length(sheet.robot.rp)}"
        path = f"AT {length(found['AT_P'])}, RT {length(found['RT_P'])}"
        out.print(f"ISO 9283: {poses}, {path}")
    for what, why in sheet.left_out.items():
        out.print(f"left out: {what}: {why}", markup=False, soft_wrap=True)


def _print_loops(sheet: "DataSheet") -> None:
    """Margins and steps, a row a loop."""
    from motionfmu.report.data_sheet_page import gain_words, milliseconds, percent, phase_words

    rows = bare_table("loop", "gain", "phase", "rise", "overshoot", "settling")
    for a in sheet.axes:
        for loop in a.loops:
            step = loop.step
            sizes = gain_words(loop.margins), phase_words(loop.margins)
            times = milliseconds(step.rise), milliseconds(step.settling)
            cells = (*sizes, times[0], percent(step.overshoot), times[1])
            rows.add_row(f"{a.axis.name} {loop.kind}", *cells)
    if rows.row_count:
        out.print(rows)
