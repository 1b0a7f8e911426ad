"""Numbers of two analyses side by side."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

LEFT_OUT = ("units", "commands", "corners", "left_out")  # tables of their own


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
        """How much larger B's size is than A's [%]; None from 0, and where the sign turns."""
        if self.a is None or self.b is None or not self.a or self.a * self.b < 0.0:
            return None
        return 100.0 * (abs(self.b) - abs(self.a)) / abs(self.a)


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
