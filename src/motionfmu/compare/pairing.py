"""Two runs on one time axis, their numbers and verdicts."""

import math
from dataclasses import dataclass, field
from functools import cached_property
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.compare.differences import Checked, Different, checks, different
from motionfmu.compare.number_pairs import Number, side_by_side
from motionfmu.compare.overlay import Common, Pair, pair
from motionfmu.compare.side import Side


@dataclass(frozen=True)
class Apart:
    """Differences of a signal of B from the one of A."""

    name: str
    unit: str
    same: bool  # all common samples are equal
    largest: float  # difference B - A of the largest magnitude, with its sign
    element: str  # where it is: the signal itself, or one of its elements
    at: float  # [s]
    rms: float  # of the difference over common samples and elements
    span: float  # of A, over the elements: largest minus smallest


@dataclass(frozen=True)
class Pairing:
    """Two runs side by side; every difference is B - A."""

    a: Side  # the runs: name, numbers as in result.json, time, signals, track
    b: Side
    common: Common = field(repr=False)  # instants at which signals are compared
    names: list[str] = field(repr=False)  # signals that both have and that can be compared
    left: dict[str, str] = field(repr=False)  # why a signal is not compared, by its name

    def __getitem__(self, name: str) -> Pair:
        """A signal of both runs on their common time."""
        if name in self.names:
            return pair(name, self.a, self.b, self.common)
        told = f": {self.left[name]}" if name in self.left else suggestion(name, self.names)
        raise InputError(f"{name} is not compared{told}")

    @cached_property
    def signals(self) -> list[Apart]:
        """The differences of every signal, in the order of A."""
        return [_apart(self[name]) for name in self.names]

    @property
    def apart(self) -> list[Apart]:
        """Signals that differ: first what differs by the largest share of its range."""
        return sorted(
            (s for s in self.signals if not s.same),
            key=lambda s: -abs(s.largest) / s.span if s.span else -math.inf,
        )

    @cached_property
    def different(self) -> list[Different]:
        """What was run differently."""
        return different(self.a, self.b)

    @cached_property
    def checks(self) -> list[Checked]:
        """Verdicts side by side."""
        return checks(self.a, self.b)

    def table(self, name: str) -> list[Number]:
        """Numbers of an analysis, ``contour`` or ``iso9283``, side by side."""
        return side_by_side(self.a.numbers.get(name), self.b.numbers.get(name))

    @property
    def worse(self) -> list[str]:
        """Checks whose verdict is worse in B than in A."""
        # A check is worse if it held in A and fails in B, or if all checks of A hold and it fails
        # in B.
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
        time, signals = self.common.time, self.signals
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
            "signals": [vars(s) for s in signals],
            "not_compared": self.left,
        }


def _apart(both: Pair) -> Apart:
    largest, element, at = both.largest
    span = float((both.a.max(axis=0) - both.a.min(axis=0)).max())
    return Apart(both.name, both.unit, both.same, largest, both.names[element], at, both.rms, span)


def _said(x: Side) -> dict[str, Any]:
    keys = ("scenario", "about", "ok", "options", "overrides", "stopped", "done_at", "warnings")
    return {"name": x.name} | {k: x.numbers.get(k) for k in keys}


def _number(x: Number) -> dict[str, Any]:
    return {**vars(x), "difference": x.difference, "change": x.change}
