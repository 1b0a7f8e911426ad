"""A variable of an FMU, as scenarios see it."""

import math
from dataclasses import dataclass, replace

from motionfmu.fmu.describe import FILES


@dataclass(frozen=True)
class Port:
    """One variable of an FMU as its description declares it."""

    name: str
    type: str  # Float64, Int32, Boolean or String; of foreign FMUs any type of FMI 3
    causality: str  # in FMI's words
    tunable: bool  # a parameter that may change during a run
    doc: str
    shape: tuple[int, ...]  # empty for a scalar
    unit: str | None
    reference: int  # the first value reference; elements take successive ones
    start: str | None  # values as written in the description
    low: float  # limits, infinite if not declared
    high: float
    continuous: bool = False  # it changes between communication points
    nominal: float | None = None  # the usual size
    declared: tuple[str, str] | None = None  # its type: name and meaning

    whole: str = ""  # the array of which it is an element

    @property
    def file(self) -> str:
        """``read`` or ``written`` for a variable that names a file; empty for any other."""
        name = self.declared[0] if self.declared else ""
        return {kind[0]: key for key, kind in FILES.items()}.get(name, "")

    @property
    def count(self) -> int:
        """Number of elements."""
        return math.prod(self.shape)

    def element(self, index: str) -> "Port | None":
        """The element of an array at ``2`` or ``1,2``, from 1, as a single variable; None if none.

        An element has a value reference of its own in FMI 2 only.
        """
        texts = index.split(",")
        if len(texts) != len(self.shape) or not all(t.isascii() and t.isdigit() for t in texts):
            return None
        place = 0
        for text, size in zip(texts, self.shape, strict=True):
            if not 1 <= int(text) <= size:
                return None
            place = place * size + int(text) - 1
        starts = (self.start or "").split()
        return replace(
            self,
            name=f"{self.name}[{','.join(str(int(t)) for t in texts)}]",
            shape=(),
            reference=self.reference + place,
            start=starts[place if len(starts) > 1 else 0] if starts else None,
            whole=self.name,
        )
