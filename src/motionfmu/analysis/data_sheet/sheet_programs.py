"""Part programs of the tests on a data sheet."""

import math
from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.data_sheet.sheet_axes import SheetAxis

# ISO 230-2 wants five targets a metre, five at least, and five approaches from each side.
PER_METRE, FEWEST, MOST, APPROACHES = 5, 7, 21, 5
# Share of the travel that stays free at either end; of that the half is used to turn back.
FREE = 0.04
# The distance of targets differs by this share of their mean, so that no periodic error hides.
UNEVEN = 0.3
RADIUS, FEED = 50.0, 3000.0  # of the circle [mm], [mm/min]
SPAN = 0.3  # of the shorter travel that a circle's radius may have
TURNS = 2  # of a circle each way
PLANES = (("G17", "X", "Y"), ("G18", "Z", "X"), ("G19", "Y", "Z"))
OFFSETS = {"X": "I", "Y": "J", "Z": "K"}


@dataclass(frozen=True)
class PositioningProgram:
    """A program that approaches targets from both sides."""

    text: str
    targets: np.ndarray  # (m,) in the unit of the axis
    lines: np.ndarray  # (n, 2, m) number of the line of each rest; up, and down as targets ascend
    order: np.ndarray  # (2 n m,) places in `lines`, flat, in the order of time


def targets(axis: SheetAxis) -> np.ndarray:
    """Targets over the travel of an axis, unevenly spaced, rounded to a hundredth."""
    span = axis.high - axis.low
    wanted = PER_METRE * span / 1000.0 if not axis.rotary else FEWEST
    count = int(min(MOST, max(FEWEST, math.ceil(wanted))))
    first, last = axis.low + FREE * span, axis.high - FREE * span
    even = np.linspace(first, last, count)
    # The golden ratio fills an interval as evenly as anything that never comes back.
    shift = np.mod(np.arange(count) * 0.6180339887498949, 1.0) - 0.5
    shift[[0, -1]] = 0.0
    return np.round(even + UNEVEN * (even[1] - even[0]) * shift, 2)


def positioning_program(
    axis: SheetAxis,
    dwell: float,
    pen: bool = False,
    places: np.ndarray | None = None,
    approaches: int = APPROACHES,
) -> PositioningProgram:
    """Go to each target upwards and downwards, five times, and rest there.

    With a pen nothing but its lift makes a rest: rapids and feeds take turns. `places` are other
    targets than those of a data sheet.
    """
    places, word = targets(axis) if places is None else places, axis.word
    turn = 0.5 * FREE * (axis.high - axis.low)
    ends = places[0] - turn, places[-1] + turn
    text = [f"(ISO 230-2: {axis.name})", "G21 G90", "F3000", f"G0 {word}{ends[0]:.2f}"]
    if pen:
        text = [f"(ISO 230-2: {axis.name})", "G21 G90", f"G0 {word}{ends[0]:.2f}"]
    lines = np.zeros((approaches, 2, len(places)), int)
    order, fed = [], False
    flat = np.arange(lines.size).reshape(lines.shape)

    def go(place: float) -> None:
        nonlocal fed
        fed = pen and not fed
        text.append(f"G1 {word}{place:.2f} F3000" if fed else f"G0 {word}{place:.2f}")

    for run in range(approaches):
        for way, listed in enumerate((range(len(places)), reversed(range(len(places))))):
            for k in listed:
                go(places[k])
                if not pen:
                    text.append(f"G4 P{dwell:g}")
                lines[run, way, k] = len(text)
                order.append(flat[run, way, k])
            go(ends[0] if way else ends[1])
    return PositioningProgram("\n".join([*text, "M2", ""]), places, lines, np.array(order))


def circle_program(
    axes: dict[str, SheetAxis],
    plane: tuple[str, str, str],
    radius: float | None = None,
    feed: float = FEED,
    centre: tuple[float, float] | None = None,
) -> str:
    """A circle both ways round, [mm] and [mm/min]; else in the middle of the travel of two axes."""
    code, first, second = plane
    a, b = axes[first], axes[second]
    if radius is None:
        radius = min(RADIUS, SPAN * min(a.high - a.low, b.high - b.low))
        radius = round(radius, 1 if radius < 10.0 else 0)
    middle = centre or tuple(round(0.5 * (x.low + x.high), 1) for x in (a, b))
    at = f"{first}{middle[0] + radius:g} {second}{middle[1]:g}"
    back = f"{OFFSETS[first]}{-radius:g}"
    turns = [f"{way} {at} {back} P{TURNS}" for way in ("G2", "G3")]
    head = [f"(ISO 230-4: circle of R {radius:g} in {first}{second}, {TURNS} turns each way)"]
    head += [f"G21 G90 {code} F{feed:g}", f"G0 {at}"]
    return "\n".join([*head, *turns, "M2", ""])
