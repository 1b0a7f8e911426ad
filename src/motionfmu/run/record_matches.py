"""A run beside the record of its scenario: what its report, its checks and result.json have."""

import hashlib
from collections.abc import Iterable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.errors import InputError, NoNumber, suggestion
from motionfmu.run.run_record import RunRecord
from motionfmu.scenarios.record_signals import Overlay, file_of, overlays, record_of, table_of
from motionfmu.scenarios.system import Resolver

if TYPE_CHECKING:
    from motionfmu.records import Match, Record

TABLE = "record"  # the first part of a number's name: record.position.nrmse
# Numbers of a `Match`.
FIGURES = ("samples", "max", "at", "rms", "mean", "nrmse", "nrmse_centred", "lag", "correlation")
DIGITS = 16  # of a file's SHA-256: enough to tell two files apart


@dataclass(frozen=True)
class RecordMatches:
    """Each column of a record over its signal of a run.

    Attributes
    ----------
    record : Record
    found : dict
        By signal, its `Overlay`, which has the column, and the `Match`.
    """

    record: "Record"
    found: dict[str, tuple[Overlay, "Match"]]

    def numbers(self) -> dict[str, Any]:
        """The numbers, ready for JSON."""
        return {
            signal: {"column": over.column, "unit": over.unit}
            | one.numbers()
            | {"no_lag": one.lag.reason}
            for signal, (over, one) in self.found.items()
        }

    def number(self, name: str) -> float:
        """One number by column or signal, and its own name.

        Parameters
        ----------
        name : str
            ``position.nrmse``.

        Raises
        ------
        NoNumber
            There is none; the reason.
        """
        whole, _, own = name.rpartition(".")
        signals = _signals(whole, (over for over, _ in self.found.values()))
        value = self.found[signals[0]][1].numbers()[own]
        if value is None:
            why = self.found[signals[0]][1].lag.reason if own == "lag" else ""
            raise NoNumber(f"record number {name!r}: {why or 'it is none'}")
        return float(value)


def _signals(whole: str, over: Iterable[Overlay]) -> list[str]:
    """The signals that a column's or a signal's name means."""
    listed = list(over)
    return [o.signal for o in listed if o.signal == whole] or [
        o.signal for o in listed if o.column == whole
    ]


def wrong(name: str, resolver: Resolver) -> str:
    """Why no run of a scenario can have this number; empty if it can."""
    if table_of(resolver) is None:
        return f"{TABLE}.{name}: there is no [record_file] table"
    whole, _, own = name.rpartition(".")
    if own not in FIGURES:
        return f"{TABLE}.{name}: no number {own!r}{suggestion(own, FIGURES)}"
    try:
        over = overlays(resolver)
    except InputError:
        return ""  # told by itself
    signals = _signals(whole, over)
    if not signals:
        known = [*(o.column for o in over), *(o.signal for o in over)]
        return f"{TABLE}.{name}: nothing lies over {whole!r}{suggestion(whole, known)}"
    if len(signals) > 1:
        told = " and ".join(signals)
        return f"{TABLE}.{name}: {whole} lies over {told}: say which, {TABLE}.{signals[0]}.{own}"
    return ""


def matches(run: RunRecord) -> RecordMatches:
    """The record of a scenario over its run; NoNumber if they have no time in common."""
    from motionfmu.records import match

    measured = record_of(run.resolver)
    ns = np.rint(np.asarray(run.time) * 1e9).astype(np.int64)
    found = {}
    for over in overlays(run.resolver):
        data = run.signals[over.end.name]
        signal = data if over.element is None else data[:, over.element]
        hold = over.end.port.type != "Float64"
        try:
            one = match((ns, signal), (measured.ns, over.values), hold)
        except InputError as error:
            raise NoNumber(f"record over {over.signal}: {error}") from None
        found[over.signal] = (over, one)
    return RecordMatches(measured, found)


def made_of(resolver: Resolver) -> dict[str, Any] | None:
    """The record as one of the things that a run depends on; None without one."""
    table = table_of(resolver)
    if table is None:
        return None
    return {
        "file": table.file,
        "content": digest(file_of(resolver)),
        "layout": table.layout,
        "drive": dict(table.drive),
        "resample": table.resample,
        "gaps": table.gaps,
        "over": dict(table.over),
    }


def digest(path: Path) -> str:
    """What tells the content of a file, or of a result's folder, from that of another."""
    files = sorted((path / "signals").glob("*.npy")) if path.is_dir() else [path]
    found = hashlib.sha256()
    for file in files:
        found.update(file.read_bytes())
    return found.hexdigest()[:DIGITS]
