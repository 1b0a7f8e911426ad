"""A quantity that a record tells, or cannot tell."""

import math
from dataclasses import dataclass
from typing import Any


@dataclass(frozen=True)
class Estimate:
    """A quantity with its standard deviation.

    Attributes
    ----------
    value, deviation : float
        In `unit`; the value is the one before where the record cannot tell it.
    unit : str
    why : str
        Why the record cannot tell it; empty if it can.
    """

    value: float
    deviation: float
    unit: str
    why: str = ""

    @property
    def told(self) -> bool:
        """Whether the record tells it."""
        return not self.why

    def in_unit(self, factor: float, unit: str) -> "Estimate":
        """The same in another unit.

        Parameters
        ----------
        factor : float
            From this unit to the other.
        unit : str
            Its name.
        """
        return Estimate(self.value * factor, self.deviation * abs(factor), unit, self.why)

    def numbers(self) -> dict[str, Any]:
        """Its numbers, ready for JSON."""
        known = math.isfinite(self.deviation)
        return {
            "value": self.value,
            "deviation": self.deviation if known else None,
            "unit": self.unit,
            "told": self.told,
            "why": self.why,
        }

    def text(self, factor: float = 1.0) -> str:
        """Value with its deviation, in as many digits as that has.

        Parameters
        ----------
        factor : float
            To the unit in which it is shown.
        """
        value, deviation = self.value * factor, self.deviation * abs(factor)
        if not math.isfinite(deviation) or deviation <= 0.0:
            return f"{value:.6g}"
        digits = 1 - math.floor(math.log10(deviation))
        if not -1 <= digits <= 9:
            return f"{value:.6g} ± {deviation:.2g}"
        return f"{value:.{max(digits, 0)}f} ± {deviation:.2g}"
