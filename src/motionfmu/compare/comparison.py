"""Two runs side by side."""

import fnmatch
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from motionfmu.compare import overlay
from motionfmu.compare.differences import Checked, Different, checks, different
from motionfmu.compare.figures import Number, side_by_side
from motionfmu.compare.overlay import Common, Pair, pair
from motionfmu.compare.side import Side, side
from motionfmu.errors import InputError, suggestion
from motionfmu.run import Result, Scenario


@dataclass(frozen=True)
class Apart:
    """How far a signal of B is from that of A."""

    name: str
    unit: str
    same: bool  # all common samples are equal
    largest: float  # difference B - A of the largest magnitude, with its sign
    element: str  # where it is: the signal itself, or one of its elements
    at: float  # [s]
    rms: float  # of the difference over common samples and elements
    span: float  # of A, over the elements: largest minus smallest


@dataclass(frozen=True)
class Comparison:
    """Two runs side by side; every difference is B - A.

    Attributes
    ----------
    a, b : Side
        The runs: name, numbers as in result.json, time, signals, track.
    common : Common
        The instants at which signals are compared, and how they were found.
    names : list of str
        Signals that both runs have and that can be compared.
    left : dict
        Why a signal is not among them, by its name.
    """

    a: Side
    b: Side
    common: Common = field(repr=False)
    names: list[str] = field(repr=False)
    left: dict[str, str] = field(repr=False)

    def __getitem__(self, name: str) -> Pair:
        """A signal of both runs on their common time."""
        if name in self.names:
            return pair(name, self.a, self.b, self.common)
        told = f": {self.left[name]}" if name in self.left else suggestion(name, self.names)
        raise InputError(f"{name} is not compared{told}")

    @cached_property
    def signals(self) -> list[Apart]:
        """How far apart every signal is, in the order of A."""
        return [_apart(self[name]) for name in self.names]

    @cached_property
    def different(self) -> list[Different]:
        """What was run differently; empty if the runs were made of the same."""
        return different(self.a, self.b)

    @cached_property
    def checks(self) -> list[Checked]:
        """Verdicts side by side."""
        return checks(self.a, self.b)

    def table(self, name: str) -> list[Number]:
        """Numbers of an analysis side by side.

        Parameters
        ----------
        name : str
            ``contour`` or ``iso9283``.

        Returns
        -------
        list of Number
            Empty if neither run has it.
        """
        return side_by_side(self.a.numbers.get(name), self.b.numbers.get(name))

    @property
    def worse(self) -> list[str]:
        """Checks that held in A and fail in B, or, if A holds as a whole, that fail in B."""
        whole = bool(self.a.numbers["ok"])
        return list(
            dict.fromkeys(c.name for c in self.checks if c.worse or (whole and c.ok[1] is False))
        )

    @property
    def ok(self) -> bool:
        """Whether B's verdict is no worse than A's."""
        return not self.worse

    def numbers(self) -> dict[str, Any]:
        """The comparison, ready for JSON; units as FMI spells them."""
        time, apart = self.common.time, self.signals
        return {
            "a": _said(self.a),
            "b": _said(self.b),
            "ok": self.ok,
            "worse": self.worse,
            "different": [vars(d) for d in self.different],
            "common": {
                "from": float(time[0]),
                "to": float(time[-1]),
                "samples": len(time),
                "notes": list(self.common.words),
            },
            "checks": [
                {"name": c.name, "worse": c.worse}
                | {
                    key: dict(zip("ab", both, strict=True))
                    for key, both in (
                        ("bounds", c.bounds),
                        ("value", c.values),
                        ("ok", c.ok),
                        ("reason", c.reasons),
                    )
                }
                for c in self.checks
            ],
            **{n: [_number(x) for x in self.table(n)] for n in ("contour", "iso9283")},
            "signals": [vars(s) for s in apart],
            "not_compared": self.left,
        }

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
        from motionfmu.compare.page import write_comparison

        return write_comparison(self, Path(folder))


def compare(
    a: "str | Path | Scenario | Result",
    b: "str | Path | Scenario | Result",
    signals: Iterable[str] = ("*",),
    set: Mapping[str, Any] | None = None,
) -> Comparison:
    """Lay one run over another.

    Parameters
    ----------
    a, b : str, Path, Scenario or Result
        A folder of results, a scenario that is run now, or a result.
    signals : iterable of str
        Names or patterns of the signals to compare.
    set : mapping, optional
        Values for the run of B, a scenario: ``{"mcc.p_gain": 300}``.

    Returns
    -------
    Comparison

    Raises
    ------
    InputError
        A folder holds no run, the runs have nothing in common, or a pattern fits no signal.
    """
    if set and isinstance(b, Result):
        raise InputError("set: B is a result that has been run; a scenario is wanted")
    first, second = side(a), side(b, set)
    known = list(dict.fromkeys((*first.signals, *second.signals)))
    chosen = []
    for pattern in signals:
        fits = fnmatch.filter(known, pattern)
        if not fits:
            told = suggestion(pattern, known)
            raise InputError(f"no signal {pattern!r} in {first.name} and {second.name}{told}")
        chosen += fits
    names, left = [], {}
    at = overlay.common(first, second)
    for name in (n for n in known if n in {*chosen}):
        if name not in first.signals or name not in second.signals:
            left[name] = f"only in {'A' if name in first.signals else 'B'}"
        elif why := overlay.mismatch(name, first, second):
            left[name] = why
        else:
            names.append(name)
    found = Comparison(first, second, at, names, left)
    if not names and not any(None not in c.ok for c in found.checks):
        raise InputError(f"{first.name} and {second.name} have no signal and no check in common")
    return found


def _apart(both: Pair) -> Apart:
    largest, element, at = both.largest
    span = float((both.a.max(axis=0) - both.a.min(axis=0)).max())
    return Apart(both.name, both.unit, both.same, largest, both.names[element], at, both.rms, span)


def _said(x: Side) -> dict[str, Any]:
    keys = ("scenario", "about", "ok", "options", "overrides", "stopped", "done_at", "warnings")
    return {"name": x.name} | {k: x.numbers.get(k) for k in keys}


def _number(x: Number) -> dict[str, Any]:
    return {**vars(x), "difference": x.difference, "change": x.change}
