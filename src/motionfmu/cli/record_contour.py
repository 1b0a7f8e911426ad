"""What `contour` does with a measured record: against a program, or as a ballbar's."""

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

from motionfmu.base.errors import InputError
from motionfmu.cli.common import bare_table, out, record_options, report, results, run_shown

if TYPE_CHECKING:
    from motionfmu.run import Scenario


@dataclass(frozen=True)
class RecordChoice:
    """Which record, which column is what, and how the file is laid out."""

    file: Path
    over: dict[str, str] | None
    layout: dict[str, Any]


def measured_contour(
    scenario: "Scenario", given: dict[str, Any], choice: RecordChoice, folder: Path | None
) -> None:
    """Analyse a measured tool against the program of a scenario, beside its run."""
    from motionfmu.records import record
    from motionfmu.report import result_folder
    from motionfmu.report.cause_pages.record_page import ContourRecord, write_record_contour
    from motionfmu.report.numbers import length
    from motionfmu.run.record_analyses import record_contour

    target = result_folder.usable(folder or results(scenario.name, "contour"))
    measured = record(choice.file, **choice.layout)
    run = run_shown(scenario, {"set": given})
    own = record_contour(run, measured, choice.over)
    found = ContourRecord(scenario.name, measured, run.contour(), own)
    table = bare_table("contour error", "record", "run")
    for words, key in (("largest", "max"), ("RMS", "rms"), ("95 %", "p95")):
        table.add_row(words, *(length(getattr(x.error, key)) for x in (own, found.run)))
    out.print(table)
    for mark in found.signatures:
        out.print(f"[bold]Ballbar, radius {mark.test.radius:g} mm[/]")
        for words in mark.words():
            out.print(f"  {words}")
    for told in measured.notes:
        out.print(f"record: {told}", markup=False, soft_wrap=True)
    with result_folder.whole(target) as part:
        shown = write_record_contour(found, part).name
    report(target / shown)


def measured_path(
    scenario: "Scenario", given: dict[str, Any], choice: RecordChoice, folder: Path | None
) -> None:
    """Evaluate a measured tool after ISO 9283, beside the run of a scenario."""
    import json

    from motionfmu.records import record
    from motionfmu.report import result_folder
    from motionfmu.report.html_page import Page, PageFrame
    from motionfmu.report.iso9283_section import add_iso9283
    from motionfmu.run.record_analyses import record_iso9283

    target = result_folder.usable(folder or results(scenario.name, "iso9283"))
    measured = record(choice.file, **choice.layout)
    run = run_shown(scenario, {"set": given})
    own = record_iso9283(run, measured, choice.over)
    sides = [own.numbers(), run.iso9283().numbers()]
    table = bare_table("figure", "record", "run")
    for name, value in sides[0].items():
        if isinstance(value, float):
            other = sides[1].get(name)
            shown = f"{other:.6g}" if isinstance(other, float) else ""
            table.add_row(name, f"{value:.6g}", shown)
    out.print(table)
    page = Page()
    add_iso9283(page, own)
    frame = PageFrame(scenario.name, measured.name, "path performance of a record", (), "")
    with result_folder.whole(target) as part:
        found = {"scenario": scenario.name, "record": measured.name, "iso9283": sides[0]}
        text = json.dumps(found | {"run": sides[1]}, indent=1)
        (part / "result.json").write_text(text + "\n", encoding="utf-8")
        (part / "report.html").write_text(page.text(frame), encoding="utf-8")
    report(target / "report.html")


# CCN 16: what may be missing of a ballbar's record, each with its words.
def measured_ballbar(
    files: Sequence[Path],
    nominal: tuple[float | None, float | None, str],
    asked: tuple[list[str], Path | None],
    folder: Path | None,
) -> None:
    """Read a ballbar's record, or one for each way, and say what it tells of the machine."""
    from motionfmu.analysis.explain import ballbar_of, ballbar_test, signature
    from motionfmu.report import result_folder
    from motionfmu.report.cause_pages.record_page import write_ballbar
    from motionfmu.report.numbers import length

    radius, feed, plane = nominal
    if radius is None:
        raise InputError(f"{files[0]}: a ballbar's record: --radius, the nominal one [mm], wanted")
    target = result_folder.usable(folder or results(files[0].stem, "ballbar"))
    over, layout = record_options(*asked)
    pairs = [ballbar_of(file, radius, over or {}, layout or {}) for file in files]
    try:
        speed = None if feed is None else feed / 60.0
        test = ballbar_test([own for _, own in pairs], radius, plane, speed)
        mark = signature(test) if test.ccw and test.cw else None
    except (ValueError, ArithmeticError) as error:
        raise InputError(f"{files[0]}: {error}") from None
    for name in ("ccw", "cw"):
        way = getattr(test, name)
        if way is not None:
            out.print(f"{name}: G {length(way.reading.g)}, {way.coverage / 0.0174533:.0f}°")
    for words in mark.words() if mark else ("One way round: the diagnosis needs both.",):
        out.print(f"  {words}", markup=False)
    with result_folder.whole(target) as part:
        shown = write_ballbar(test, mark, [r for r, _ in pairs], part).name
    report(target / shown)
