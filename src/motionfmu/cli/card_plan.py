"""The commands that make jobs of drawings, and show both."""

import json
from dataclasses import replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.deprecation import renamed
from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.card import card
from motionfmu.cli.common import FAILED, bare_table, out, results
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
    from motionfmu.cards.card_job import Job
    from motionfmu.cards.plan_figures import Figures
    from motionfmu.drawings import Drawing

Config = Annotated[Path, typer.Option("-c", "--config", help="Configuration of the card.")]
FrameOption = Annotated[
    tuple[float, float, float, float] | None,
    typer.Option("--frame", metavar="X1 Y1 X2 Y2", help="P1 and P2 of the machine, for SC."),
]
Output = Annotated[Path | None, typer.Option("--out", "-o", help="Job file.")]
OldOutput = Annotated[Path | None, typer.Option("--output", hidden=True)]  # in 0.1


@card.command()
def plan(  # noqa: PLR0913  (each is an option of the command)
    file: Annotated[Path, typer.Argument(help="Drawing: .plt, .svg or .dxf.")],
    config: Config,
    output: Output = None,
    old_output: OldOutput = None,
    order: Order = None,
    corners: Corners = None,
    pen: Pens = None,
    at: At = None,
    scale: Larger = None,
    copies: Copies = None,
    pitch: Pitch = None,
    knife: Knife = None,
    speeds: Annotated[bool, typer.Option("--speeds", help="Keep speeds of VS.")] = False,
    frame: FrameOption = None,
    page: Page = None,
    report: Annotated[bool, typer.Option("--report", help="Write a page and a picture.")] = False,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Plan a drawing: a job for the card, and what it comes to."""
    needed("card")
    from motionfmu.cards import load
    from motionfmu.cards.plan import plan as planned
    from motionfmu.cards.plan import write
    from motionfmu.cards.plan_figures import figures
    from motionfmu.drawings import reading
    from motionfmu.drawings.contours import contours_of, way_between

    asked = {"order": order, "corners": corners, "pens": pen, "at": at, "scale": scale}
    table = drawing_table(**asked, copies=copies, pitch=pitch, knife=knife, page=page)
    options = replace(drawing_options(table), speeds=speeds)
    settings = load(config)
    drawing = reading.read(file, frame, options.page)
    found = planned(drawing, settings, options)
    numbers = figures(found, settings, options.offset)
    if old_output is not None:
        renamed("card plan --output", "--out", ends="0.3")
    target = output or old_output or file.with_suffix(".mcj")
    write(found.job, target)
    told: dict[str, Any] = {"drawing": str(file), "job": str(target)} | numbers.numbers()
    told |= {"page": drawing.page, "pages": drawing.pages}
    if options.order == "nearest":
        told["way_up_file"] = way_between(contours_of(drawing, replace(options, order="file")))
    told["notes"] = [n.words for n in drawing.notes]
    if as_json:
        print(json.dumps(told, indent=1, allow_nan=False))
    else:
        if drawing.paged:
            out.print(f"{drawing.paged}; --page chooses another")
        _tell(file, target, numbers, told.get("way_up_file"))
        if drawing.notes:
            out.print(f"note: {drawing.told}", markup=False, soft_wrap=True)
    if report:
        folder = results(file.stem, "plan")
        _report(file.stem, found, drawing, told, folder)
        if not as_json:
            out.print(f"report: {folder / 'report.html'}", soft_wrap=True)
    if numbers.flash > 1.0:
        if not as_json:
            out.print(f"{target}: too long for a slot of the card's flash", soft_wrap=True)
        raise typer.Exit(FAILED)


def _tell(file: Path, target: Path, n: "Figures", by_file: float | None) -> None:
    out.print(f"[bold]{file}[/]  {n.time:.3f} s, contours: {n.contours}, segments: {n.segments}")
    out.print(f"pen down {n.way_down:.1f} mm in {n.time_down:.3f} s", end=", ")
    out.print(f"up {n.way_up:.1f} mm in {n.time - n.time_down:.3f} s, the pen's own time too")
    if by_file is not None:
        out.print(f"between contours in the order of the file: {by_file:.1f} mm")
    out.print(
        f"off the drawing {n.off:.4f} mm, the drawing off the path {n.back:.4f} mm, "
        f"{n.stops} stops, {100 * n.at_feed:.0f} % of the time at feed",
        soft_wrap=True,
    )
    table = bare_table("axis", "v [mm/s]", "a [mm/s²]", "j [mm/s³]")
    for name, v, a, j in zip("XYZU", n.speed, n.acceleration, n.jerk, strict=False):
        table.add_row(name, f"{v:.1f}", f"{a:.0f}", f"{j:.0f}")
    out.print(table)
    out.print(
        f"{target}: {n.size} bytes, {n.frames} frames, {100 * n.flash:.1f} % of the flash; "
        f"planned in {n.planning:.2f} s",
        soft_wrap=True,
    )


def _report(
    name: str, found: Any, drawing: "Drawing", numbers: dict[str, Any], folder: Path
) -> None:
    from motionfmu.report import result_folder
    from motionfmu.report.jobs.card_charts import draw_plan
    from motionfmu.report.jobs.card_page import plan_page

    result_folder.usable(folder)
    with result_folder.whole(folder) as part:
        draw_plan(found, name, part / "plan.png")
        page = plan_page(name, found, drawing, numbers)
        result_folder.write_result(part, page, numbers)


@card.command()
def show(
    file: Annotated[Path, typer.Argument(help="Drawing (.plt, .svg, .dxf) or job (.mcj).")],
    picture: Annotated[Path | None, typer.Option(help="Write a picture, .png or .svg.")] = None,
    frame: FrameOption = None,
    page: Page = None,
) -> None:
    """Show what a drawing or a job holds."""
    from motionfmu.cards import card_job
    from motionfmu.drawings import reading

    if picture and picture.suffix not in (".png", ".svg"):
        raise InputError(f"--picture {picture}: .png or .svg wanted")
    if picture:
        needed("report")
    if file.suffix == ".mcj":
        if frame or page is not None:
            raise InputError(f"{file}: --frame and --page are for drawings, this is a job")
        _show_job(file, card_job.read(file), picture)
    else:
        number = drawing_options(drawing_table(page=page)).page
        _show_drawing(file, reading.read(file, frame, number), picture)
    if picture:
        out.print(f"picture: {picture}", soft_wrap=True)


def _show_drawing(file: Path, drawing: "Drawing", picture: Path | None) -> None:
    import numpy as np

    low, high = drawing.extent
    size = f"X {low[0]:.3f} .. {high[0]:.3f}, Y {low[1]:.3f} .. {high[1]:.3f} mm"
    several = f", {drawing.paged}" if drawing.paged else ""
    out.print(f"[bold]{file}[/]  {size}{several}", soft_wrap=True)
    names = ["of"] if drawing.pens else []
    table = bare_table("pen", *names, "lines", "vertices", "way [mm]", "X [mm]", "Y [mm]")
    for pen, lines in drawing.layers.items():
        points = [p.points for p in lines]
        way = sum(float(np.linalg.norm(np.diff(p, axis=0), axis=1).sum()) for p in points)
        low, high = (f(np.vstack(points), axis=0) for f in (np.min, np.max))
        spans = [f"{a:.3f} .. {b:.3f}" for a, b in zip(low, high, strict=True)]
        of = [drawing.pens.get(pen, "")] if drawing.pens else []
        table.add_row(
            f"{pen}", *of, f"{len(lines)}", f"{sum(map(len, points))}", f"{way:.1f}", *spans
        )
    out.print(table)
    for n in drawing.notes:
        out.print(n.words, markup=False, soft_wrap=True)
    if picture:
        from motionfmu.report.jobs.card_charts import draw_drawing

        draw_drawing(drawing, file.name, picture)


def _show_job(file: Path, found: "Job", picture: Path | None) -> None:
    period = 1e-6 * found.period_ns
    out.print(
        f"[bold]{file}[/]  {found.time:.3f} s, {len(found.commands)} frames of {period:g} ms, "
        f"{found.pages} pages, id {found.origin[:4][::-1].hex()}",
        soft_wrap=True,
    )
    table = bare_table("axis", "pulses/mm", "from [mm]", "to [mm]", "end [pulses]", "most a frame")
    places = found.positions
    for k, name in enumerate("XYZU"):
        if found.mask >> k & 1:
            scale = found.pulses_per_m[k] / 1e3
            low, high = min(0, places[:, k].min()), max(0, places[:, k].max())
            table.add_row(
                name,
                f"{scale:g}",
                *(f"{x / scale:.3f}" for x in (low, high)),
                f"{places[-1, k]}",
                f"{abs(found.commands[:, k]).max()}",
            )
    out.print(table)
    for number, e in enumerate(found.events, 1):
        what = f"pulse of {e.width} µs" if e.pulse else "level"
        pins = ", ".join(str(k) for k in range(16) if e.pins >> k & 1)
        times = int((found.frame_events == number).sum())
        active = "high" if e.level else "low"
        out.print(f"event {number}: output {pins}, {what} {active}, times: {times}")
    if picture:
        from motionfmu.report.jobs.card_charts import draw_job

        draw_job(found, file.name, picture)
