"""The command that lays one run over another."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.cli.common import (
    FAILED,
    Folder,
    LayoutFile,
    OnMachine,
    Over,
    Set,
    app,
    bare_table,
    give,
    loaded,
    out,
    record_options,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.compare import Comparison, RecordComparison
    from motionfmu.run import Scenario

Run = Annotated[Path, typer.Argument(help="Folder of a run's result, or a scenario to run.")]
SIGNALS = 8  # are told on the console


@app.command()
def compare(  # noqa: PLR0913  (each is an option of the command)
    a: Run,
    b: Run,
    machine: OnMachine = None,
    signals: Annotated[
        list[str], typer.Option(metavar="PATTERN", help="Signals, as 'card.*'; all if none.")
    ] = [],  # noqa: B006
    set_: Set = [],  # noqa: B006
    over: Over = [],  # noqa: B006
    layout: LayoutFile = None,
    folder: Folder = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON; without --out nothing is written.")
    ] = False,
) -> None:
    """Lay run B over run A: signals, contour, verdicts; status 1 if a verdict is worse.

    With --machine both may be programs. Either may be a measured record, a file: signals only.

    --set is for the run of B: compare scenarios/circle scenarios/circle --set mcc.p_gain=300.
    """
    from motionfmu import compare as pairs
    from motionfmu.records import is_record_file
    from motionfmu.report import result_folder

    if folder:
        result_folder.usable(folder)
    if is_record_file(a) or is_record_file(b):
        one, other = (x if is_record_file(x) else _side(x, machine) for x in (a, b))
        columns, given = record_options(over, layout)
        of = pairs.compare_record(one, other, columns, given, settings(set_))
        _tell_record(of, folder, as_json)
        return
    left, right = _side(a, machine), _side(b, machine)
    found = pairs.compare(left, right, signals or ("*",), settings(set_))
    page = None
    if folder or not as_json:
        page = found.save(_place(folder, found.a.numbers["scenario"]))
    if as_json:
        give(json.dumps(found.numbers(), indent=1, allow_nan=False, default=str))
    else:
        _tell(found)
        assert page is not None
        report(page)
    if not found.ok:
        raise typer.Exit(FAILED)


def _place(folder: Path | None, name: str) -> Path:
    """The folder of the result."""
    return folder or results(name, "compare")


def _side(path: Path, machine: str | None) -> "Path | Scenario":
    """A path, or with a machine the program there on it, if it is no folder."""
    return path if machine is None or path.is_dir() else loaded(path, machine)


def _tell_record(found: "RecordComparison", folder: Path | None, as_json: bool) -> None:
    """Print how far signals are from a record's columns, and write the page."""
    from motionfmu.base.units import spelled
    from motionfmu.report.numbers import text_of
    from motionfmu.report.record_section import lag_text

    page = None
    if folder or not as_json:
        page = found.save(_place(folder, Path(found.a.name).stem))
    if as_json:
        give(json.dumps(found.numbers(), indent=1, allow_nan=False, default=str))
        return
    table = bare_table("A", "B", "largest A - B", "RMS", "NRMSE", "lag")
    for name, one in found.found.items():
        n, unit = one.numbers(), spelled(found.units[name])
        texts = (text_of(n["max"], unit, sign=True), text_of(n["rms"], unit))
        share = "" if n["nrmse"] is None else f"{100 * n['nrmse']:.3g} %"
        table.add_row(name, found.columns[name], *texts, share, lag_text(n["lag"]))
    out.print(table)
    for name, why in found.left.items():
        out.print(f"{name} not compared: {why}", markup=False, soft_wrap=True)
    for told in found.b.notes:
        out.print(f"B: {told}", markup=False, soft_wrap=True)
    assert page is not None
    report(page)


def _tell(found: "Comparison") -> None:
    from motionfmu.compare.comparison_view import LARGEST, apart_lines, count_line, verdict_line
    from motionfmu.compare.words import change_text
    from motionfmu.report.numbers import text_of
    from motionfmu.run.checks import tally

    for name, x in (("A", found.a), ("B", found.b)):
        judged = tally(c["ok"] for c in x.numbers["checks"]).words
        out.print(f"{name}: {x.name}, {judged}", markup=False, soft_wrap=True)
    for d in found.different:
        out.print(f"  {d.what}: {d.a} → {d.b}", markup=False, soft_wrap=True)
    known = {n.name: n for n in found.table("contour")}
    table = bare_table("", "A", "B", "change of size")
    for name, words in LARGEST:
        if name in known:
            n = known[name]
            table.add_row(words, text_of(n.a, "mm"), text_of(n.b, "mm"), change_text(n))
    if table.row_count:
        out.print(table)
    for text in apart_lines(found, SIGNALS):
        out.print(f"  {text}", markup=False, soft_wrap=True)
    out.print(count_line(found), markup=False, soft_wrap=True)
    for told in found.common.words:
        out.print(told, markup=False, soft_wrap=True)
    out.print(verdict_line(found), markup=False, soft_wrap=True)
