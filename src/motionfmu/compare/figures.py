"""Numbers of two analyses side by side."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

LEFT_OUT = ("units", "commands", "corners")  # tables of their own


@dataclass(frozen=True)
class Number:
    """A number of both runs; None where one does not have it."""

    name: str  # dotted: error.max
    a: float | None
    b: float | None

    @property
    def difference(self) -> float | None:
        """B - A."""
        return None if self.a is None or self.b is None else self.b - self.a

    @property
    def change(self) -> float | None:
        """Of B against A's size [%]; None from 0."""
        gone = self.difference
        return None if gone is None or not self.a else 100.0 * gone / abs(self.a)


def side_by_side(a: Mapping[str, Any] | None, b: Mapping[str, Any] | None) -> list[Number]:
    """Every number of two tables by its dotted name, in the order of A, then what B has beside."""
    first, second = _flat(a or {}), _flat(b or {})
    return [Number(n, first.get(n), second.get(n)) for n in dict.fromkeys((*first, *second))]


def _flat(value: Any, name: str = "") -> dict[str, float]:
    if isinstance(value, bool | str) or value is None:
        return {}
    if isinstance(value, int | float):
        return {name: float(value)} if math.isfinite(value) else {}
    pairs = value.items() if isinstance(value, Mapping) else enumerate(value)
    found: dict[str, float] = {}
    for key, one in pairs:
        if name or key not in LEFT_OUT:
            found |= _flat(one, f"{name}.{key}" if name else str(key))
    return found
