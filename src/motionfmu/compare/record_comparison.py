"""A run beside a measured record, or two records side by side, and their page."""

import json
from collections.abc import Mapping
from dataclasses import dataclass
from html import escape
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import is_file
from motionfmu.records import Match, Record, is_record_file, match, record
from motionfmu.report import result_folder
from motionfmu.report.html_page import RUN, Page, PageFrame
from motionfmu.report.html_tables import table
from motionfmu.report.record_section import DRAWN, NOTE, about, chart, heads, row
from motionfmu.run import Result, Scenario, load
from motionfmu.run.result_files import NUMBERS

FOOTER = 'Every number is in <a href="result.json">result.json</a>.'


@dataclass(frozen=True)
class RecordComparison:
    """Signals of A beside columns of B; every difference is A - B.

    Attributes
    ----------
    a, b : Record
        What is compared.
    columns : dict
        B's column by A's signal.
    units : dict
        By A's signal.
    found : dict
        The `Match` by A's signal.
    left : dict
        Why a signal of A is not compared.
    """

    a: Record
    b: Record
    columns: dict[str, str]
    units: dict[str, str]
    found: dict[str, Match]
    left: dict[str, str]

    def numbers(self) -> dict[str, Any]:
        """The numbers, ready for JSON."""
        return {
            "scenario": Path(self.a.name).name,
            "a": _said(self.a),
            "b": _said(self.b),
            "record": {
                name: {"column": self.columns[name], "unit": self.units[name]}
                | one.numbers()
                | {"no_lag": one.lag.reason}
                for name, one in self.found.items()
            },
            "not_compared": self.left,
        }

    def page_text(self) -> str:
        """The whole HTML page."""
        page = Page()
        rows = [row(n, self.columns[n], self.units[n], one) for n, one in self.found.items()]
        notes = f"A: {escape(about(self.a))}<br>B: {escape(about(self.b))}<br>{NOTE}"
        left = "; ".join(f"{n}: {why}" for n, why in self.left.items())
        told = [f"{n}: no lag, {m.lag.reason}" for n, m in self.found.items() if m.lag.reason]
        told += [*self.b.notes, *([f"Not compared: {left}"] if left else [])]
        content = table(heads("A", "B"), rows, 2)
        content += "".join(f'<p class="note">{escape(t)}.</p>' for t in told)
        page.section("Signals", notes, content)
        for i, (name, one) in enumerate(list(self.found.items())[:DRAWN]):
            drawn = chart(name, self.units[name], one, ("A", "B"))
            title = f"<code>{escape(name)}</code>"
            page.section(title, "", page.place(f"signal{i}", drawn, True, RUN))
        names = f"{Path(self.a.name).name} and {Path(self.b.name).name}"
        about_ = f"A: {self.a.name} · B: {self.b.name}"
        return page.text(PageFrame(names, about_, "comparison", (), FOOTER))

    def save(self, folder: str | Path) -> Path:
        """Write the page and result.json, whole or not at all.

        Parameters
        ----------
        folder : str or Path
            New, empty, or with an older result.

        Returns
        -------
        Path
            The page.

        Raises
        ------
        InputError
            The folder cannot be written, or holds something else.
        """
        with result_folder.whole(Path(folder)) as part:
            result_folder.write_result(part, self.page_text(), self.numbers(), str)
        return Path(folder).resolve() / result_folder.PAGE


def _said(x: Record) -> dict[str, Any]:
    return {
        "name": x.name,
        "samples": len(x.ns),
        "from": float(x.time[0]),
        "to": float(x.time[-1]),
        "rate": x.rate,
        "notes": list(x.notes),
    }


# CCN 17: what each argument stands for if it is not given.
def compare_record(
    a: Any,
    b: Any,
    over: Mapping[str, str] | None = None,
    layout: Mapping[str, Any] | None = None,
    set: Mapping[str, Any] | None = None,
) -> RecordComparison:
    """Lay a run over a measured record, or a record over another.

    Parameters
    ----------
    a, b : str, Path, Scenario, Result or Record
        Files of records, folders of results, scenarios, which are run then.
    over : mapping, optional
        B's column by A's signal. If not given, what the [record_file] of either run's scenario
        says, else columns of one name.
    layout : mapping, optional
        How files are laid out, as of `motionfmu.record`; if not given that of [record_file].
    set : mapping, optional
        Values for runs: ``{"mcc.p_gain": 300}``.

    Returns
    -------
    RecordComparison

    Raises
    ------
    InputError
        A file is wrong, units do not fit, or there is nothing in common.
    """
    known = {} if over is not None and layout is not None else _known(a) or _known(b)
    given = known.get("layout", {}) if layout is None else layout
    wanted = known.get("over", {}) if over is None else over
    first, second = (_record(x, given, set) for x in (a, b))
    if not wanted:
        wanted = {n: n for n in _elements(first) if n in second}
    if not wanted:
        some = ", ".join(second)
        told = f"{first.name} and {second.name} have no name in common: say which lies over which"
        raise InputError(f"{told} (columns: {some})")
    found: dict[str, Match] = {}
    columns: dict[str, str] = {}
    units: dict[str, str] = {}
    left: dict[str, str] = {}
    for signal, column in wanted.items():
        for name, own, x, y in _pairs(first, second, signal, column):
            try:
                found[name] = match((first.ns, x), (second.ns, y), x.dtype.kind != "f")
            except InputError as error:
                left[name] = str(error)
                continue
            columns[name], units[name] = own, first.units.get(signal.partition("[")[0]) or "1"
    if not found:
        raise InputError(*(f"{name}: {why}" for name, why in left.items()))
    return RecordComparison(first, second, columns, units, found, left)


def _known(given: Any) -> dict[str, Any]:
    """What the scenario of a run says of its record: its layout and what it is laid over."""
    if isinstance(given, Result | Scenario):
        body = (given.scenario if isinstance(given, Result) else given).document.body
        table = body.record_file
        return {} if table is None else {"layout": table.layout, "over": dict(table.over)}
    if isinstance(given, Record) or is_record_file(given):
        return {}
    file = Path(given) / NUMBERS
    if not is_file(file):
        return _known(load(given))
    try:
        return dict(json.loads(file.read_text(encoding="utf-8"))["run"].get("record") or {})
    except (ValueError, KeyError, AttributeError):
        return {}


def _record(given: Any, layout: Mapping[str, Any], set: Mapping[str, Any] | None) -> Record:
    if isinstance(given, Record):
        return given
    if isinstance(given, Result):
        return given.record()
    if isinstance(given, Scenario):
        return given.run(set=set or {}).record()
    if is_record_file(given):
        return record(given, **layout)
    if is_file(Path(given) / NUMBERS):
        return record(given)
    return load(given).run(set=set or {}).record()


def _elements(x: Record) -> list[str]:
    return [
        name
        for whole, data in x.items()
        for name in (
            [whole] if data.ndim == 1 else [f"{whole}[{i + 1}]" for i in range(data.shape[1])]
        )
    ]


def _pairs(a: Record, b: Record, signal: str, column: str) -> list[tuple[str, str, Any, Any]]:
    """Elements of a signal and of a column, in the signal's unit."""
    if signal not in a:
        raise InputError(f"{a.name}: no signal {signal!r}{suggestion(signal, a)}")
    x = np.asarray(a[signal])
    unit = a.units.get(signal.partition("[")[0])
    plain = unit in (None, "1") or a.unit(signal) is None
    y = np.asarray(b[column], dtype=float) if plain and b.unit(column) is None else None
    y = b.in_unit(column, "1" if plain else unit) if y is None else y
    if x.shape[1:] != y.shape[1:]:
        raise InputError(f"{signal} and {column} have not as many elements")
    if x.ndim == 1:
        return [(signal, column, x, y)]
    many = range(x.shape[1])
    return [(f"{signal}[{i + 1}]", f"{column}[{i + 1}]", x[:, i], y[:, i]) for i in many]
