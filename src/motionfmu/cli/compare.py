"""The command that lays one run over another."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from motionfmu.cli.common import (
    FAILED,
    Folder,
    OnMachine,
    Set,
    app,
    bare_table,
    give,
    loaded,
    out,
    report,
    results,
    settings,
)

if TYPE_CHECKING:
    from motionfmu.compare import Comparison
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
    folder: Folder = None,
    as_json: Annotated[
        bool, typer.Option("--json", help="Print JSON; without --out nothing is written.")
    ] = False,
) -> None:
    """Lay run B over run A: signals, contour, verdicts; status 1 if a verdict is worse.

    With --machine both may be programs.

    --set is for the run of B: compare scenarios/circle scenarios/circle --set mcc.p_gain=300.
    """
    from motionfmu import compare as pairs
    from motionfmu.report import result_folder

    if folder:
        result_folder.usable(folder)
    left, right = _side(a, machine), _side(b, machine)
    found = pairs.compare(left, right, signals or ("*",), settings(set_))
    page = None
    if folder or not as_json:
        page = found.save(folder or results(found.a.numbers["scenario"], "compare"))
    if as_json:
        give(json.dumps(found.numbers(), indent=1, allow_nan=False, default=str))
    else:
        _tell(found)
        assert page is not None
        report(page)
    if not found.ok:
        raise typer.Exit(FAILED)


def _side(path: Path, machine: str | None) -> "Path | Scenario":
    """A path, or with a machine the program there on it, if it is no folder."""
    return path if machine is None or path.is_dir() else loaded(path, machine)


def _tell(found: "Comparison") -> None:
    from motionfmu.compare.comparison_view import LARGEST, apart_lines, count_line, verdict_line
    from motionfmu.compare.words import change_text, text_of
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
