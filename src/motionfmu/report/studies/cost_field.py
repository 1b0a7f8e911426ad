"""The cost of a study as something to draw: a curve, a field over two axes, or points."""

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray
from scipy.interpolate import griddata
from scipy.spatial import QhullError

from motionfmu.report.numbers import label
from motionfmu.report.numbers import unit as length_unit

if TYPE_CHECKING:
    from motionfmu.study.study_axes import Value
    from motionfmu.study.study_outcome import Outcome

Array = NDArray[np.float64]

CURVE, FIELD, MATRIX = "curve", "field", "matrix"
DECADES = 1.5  # a cost that spreads over more of them is drawn in logarithms
CELLS = 121  # of the field between scattered points, each way
LEVELS = 12  # about so many lines
STEPS = (1.0, 2.0, 5.0, 10.0)
# Lines in each decade, for fewer than 3 decades, for fewer than 6 and for more.
FINE, MIDDLE, COARSE = (1.0, 1.5, 2.0, 3.0, 5.0, 7.0), (1.0, 2.0, 5.0), (1.0,)


@dataclass(frozen=True)
class Dimension:
    """A varied variable, ready to be drawn."""

    name: str
    label: str  # the axis with its unit
    values: "list[Value]"  # one per row
    numeric: bool  # whether they are numbers
    log: bool  # drawn on a logarithmic scale

    @property
    def numbers(self) -> Array:
        """Values as numbers; texts and Booleans by their order."""
        if self.numeric:
            return np.array(self.values, dtype=np.float64)
        known = list(dict.fromkeys(self.values))
        return np.array([known.index(v) for v in self.values], dtype=np.float64)

    @property
    def even(self) -> Array:
        """The numbers as they lie on a page: on a logarithmic axis their logarithms."""
        return np.log10(self.numbers) if self.log else self.numbers


@dataclass(frozen=True)
class CostField:
    """Cost on a rectangular grid."""

    x: Array  # (n,) in the variable's unit
    y: Array  # (m,)
    z: Array  # (m, n) cost; NaN where there is none


def cost_label(outcome: "Outcome") -> str:
    """The cost as it is drawn, with its unit."""
    study = outcome.study
    unit = next(c.unit for c in study.columns if c.name == study.shown)
    return label(study.shown, _scaled(outcome, unit)[1])


def cost_of(outcome: "Outcome") -> Array:
    """The cost of each run as it is drawn: small lengths in µm."""
    unit = next(c.unit for c in outcome.study.columns if c.name == outcome.study.shown)
    return outcome.cost * _scaled(outcome, unit)[0]


def least_cost(outcome: "Outcome") -> float | None:
    """The cost of the best run as it is drawn, or None."""
    unit = next(c.unit for c in outcome.study.columns if c.name == outcome.study.shown)
    return None if outcome.least is None else outcome.least * _scaled(outcome, unit)[0]


def _scaled(outcome: "Outcome", unit: str) -> tuple[float, str]:
    """Factor and unit in which the cost reads well."""
    known = np.abs(outcome.cost[np.isfinite(outcome.cost)])
    return length_unit(float(known.max())) if unit == "mm" and len(known) else (1.0, unit)


def dimensions(outcome: "Outcome") -> list[Dimension]:
    """The variables that the study varies."""
    found = []
    for axis in outcome.study.axes:
        values = outcome.axis(axis.name)
        numeric = axis.end.port.type in ("Float64", "Int32")
        found.append(Dimension(axis.name, label(axis.name, axis.unit), values, numeric, axis.log))
    return found


def kind(outcome: "Outcome") -> str:
    """The kind of chart that suits the cost: CURVE, FIELD or MATRIX."""
    # CURVE over one axis, FIELD over two axes of numbers, MATRIX of points else.
    shown = dimensions(outcome)
    if len(shown) == 2 and all(d.numeric for d in shown) and field(outcome) is not None:
        return FIELD
    return CURVE if len(shown) == 1 else MATRIX


def field(outcome: "Outcome") -> CostField | None:
    """The cost over two axes of numbers."""
    # A grid as it is; scattered points interpolated linearly inside their hull. None if the points
    # span no area.
    first, second = dimensions(outcome)
    u, v, cost = first.numbers, second.numbers, cost_of(outcome)
    x, i = np.unique(u, return_inverse=True)
    y, j = np.unique(v, return_inverse=True)
    if min(len(x), len(y)) < 2 or np.isfinite(cost).sum() < 3:
        return None
    if outcome.study.sampling == "grid":
        z = np.full((len(y), len(x)), np.nan)
        z[j, i] = cost
        return CostField(x, y, z)
    known = np.isfinite(cost)
    ends = [np.linspace(d.even.min(), d.even.max(), CELLS) for d in (first, second)]
    try:
        z = griddata(
            (first.even[known], second.even[known]), cost[known], np.meshgrid(*ends), rescale=True
        )
    except QhullError:
        return None
    across, up = (10.0**e if d.log else e for e, d in zip(ends, (first, second), strict=True))
    return CostField(across, up, z)


def logarithmic(cost: Array) -> bool:
    """Whether a cost spreads so far that its logarithm is drawn."""
    known = cost[np.isfinite(cost)]
    return bool(len(known) and known.min() > 0 and known.max() > known.min() * 10**DECADES)


def levels(cost: Array) -> Array:
    """At least two round values, increasing, for contour lines."""
    # Where the cost is drawn by its logarithm, each decade has the same values. NaN is no cost.
    known = cost[np.isfinite(cost)]
    low, high = float(known.min()), float(known.max())
    if logarithmic(cost):
        decades = range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1)
        spread = math.log10(high / low)
        steps = FINE if spread < 3.0 else MIDDLE if spread < 6.0 else COARSE
        found = np.array([float(f"{s:g}e{d}") for d in decades for s in steps])
    else:
        width = (high - low) / LEVELS
        unit = 10.0 ** math.floor(math.log10(width)) if width > 0 else 1.0
        step = next((s * unit for s in STEPS if s * unit >= width), unit)
        first = math.floor(low / step)
        last = max(math.ceil(high / step), first + 1)
        found = np.arange(first - 1, last + 2) * step  # rounding may push one out
    first, last = np.flatnonzero(found <= low)[-1], np.flatnonzero(found >= high)[0]
    return found[first : max(last, first + 1) + 1]


def never_negative(cost: Array) -> bool:
    """Whether no cost is below 0, so that an axis of it does not reach below either."""
    known = cost[np.isfinite(cost)]
    return bool(len(known) and known.min() >= 0.0)
