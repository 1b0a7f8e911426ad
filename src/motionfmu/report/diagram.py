"""What is in a chart, said once for the plot of a page and for a picture."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.report.numbers import label
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, MUTED

Array = NDArray[Any]

SOLID, DASH, DOT = "solid", "dash", "dot"
# How the axes of a diagram lie: free of each other, of one scale, in space, round a centre.
FREE, EQUAL, SPACE, POLAR = "free", "equal", "space", "polar"
EDGE, SLIM = 0.04, 0.3  # room about a path and its least width, of its largest extent
ROOM = 0.06  # part of the height of the curves that stays free above and below them


@dataclass(frozen=True)
class Scale:
    """One axis: what it shows, and how far it reaches."""

    title: str = ""  # quantity, in a polar diagram empty
    unit: str = ""
    ends: tuple[float, float] | None = None  # None: those of what is drawn
    log: bool = False
    floor: bool = False  # the axis does not reach below 0 unless what is drawn does
    spacing: float | None = None  # distance of the ticks; None: left to the back end
    ticks: tuple[tuple[float, str], ...] = ()  # places and their texts instead of numbers

    @property
    def text(self) -> str:
        """The title with its unit, as it stands beside the axis."""
        return label(self.title, self.unit)


@dataclass(frozen=True)
class Heat:
    """Values that are shown as colours, and what the scale beside the plot says of them."""

    values: Array  # (n,)
    title: str  # with its unit
    ends: tuple[float, float]  # values of the first colour and of the last
    log: bool = False
    ticks: tuple[float, ...] = ()  # values that the scale names; none: left to the back end


@dataclass(frozen=True)
class LineMark:
    """A line through points; NaN interrupts it."""

    x: Array  # (n,) in a polar diagram the angle [°]
    y: Array  # (n,)
    name: str = ""  # for the legend; empty: not in it
    color: str = AXES[0]
    width: float = 1.6  # [pixel]
    dash: str = SOLID
    z: Array | None = None  # (n,) in space
    hover: Sequence[str] | None = None  # text of each point; (): nothing; None: its coordinates
    heat: Heat | None = None  # colour of each point instead of one colour


@dataclass(frozen=True)
class SamplesMark:
    """A curve with all its recorded samples, which a page measures with cursors."""

    samples: Samples
    name: str = ""
    color: str = AXES[0]
    width: float = 1.4  # [pixel]
    dash: str = SOLID


@dataclass(frozen=True)
class PointMark:
    """Points that no line joins."""

    x: Array  # (n,)
    y: Array  # (n,)
    name: str = ""
    color: str = AXES[0]
    symbol: str = "circle"  # circle, ring, cross, x, star or diamond
    size: float = 6.0  # [pixel]
    edge: str = ""  # colour of the outline, if there is one
    texts: Sequence[str] = ()  # drawn beside the points
    side: str = "top right"  # of the point on which its text stands
    hover: Sequence[str] | None = None
    heat: Heat | None = None
    z: Array | None = None  # (n,) in space


@dataclass(frozen=True)
class BandMark:
    """The area between two curves over common places."""

    x: Array  # (n,)
    low: Array  # (n,)
    high: Array  # (n,)
    name: str = ""
    color: str = AXES[0]


@dataclass(frozen=True)
class BarMark:
    """One horizontal bar for each tick of the vertical axis, beside those of other marks."""

    values: Sequence[float | None]  # from the top; None is no bar
    texts: Sequence[str]  # at the ends of the bars
    name: str = ""
    color: str = AXES[0]


@dataclass(frozen=True)
class LevelMark:
    """A straight line across the plot at one value."""

    value: float
    text: str = ""  # at the end of the line
    color: str = MUTED
    dash: str = DOT
    upright: bool = False  # the value is one of the horizontal axis
    side: str = "right"  # of an upright line on which its text stands


@dataclass(frozen=True)
class CircleMark:
    """A circle about a point."""

    x: float
    y: float
    radius: float
    color: str = MUTED
    dash: str = SOLID
    filled: bool = False


@dataclass(frozen=True)
class FieldMark:
    """Values on a rectangular grid, as coloured areas between lines of equal value."""

    x: Array  # (n,)
    y: Array  # (m,)
    heat: Heat  # values (m, n); its ticks are the lines


Mark = LineMark | SamplesMark | PointMark | BandMark | BarMark | LevelMark | CircleMark | FieldMark


@dataclass(frozen=True)
class Subplot:
    """Marks over one vertical axis."""

    y: Scale
    marks: Sequence[Mark]
    height: float = 180.0  # [pixel] of the area between the axes
    legend: bool | None = None  # None: if two marks or more have a name
    beside: Sequence[Sequence[Mark]] = ()  # marks over the further horizontal axes

    @property
    def cells(self) -> list[Sequence[Mark]]:
        """The marks of each column."""
        return [self.marks, *self.beside]

    @property
    def names(self) -> list[str]:
        """The names in its legend, which leaves out marks without points."""
        named = [m for m in self.marks if named_mark(m)]
        shown = len(named) > 1 if self.legend is None else self.legend
        return [getattr(m, "name", "") for m in named] if shown else []


@dataclass(frozen=True)
class Diagram:
    """Subplots below each other, with common horizontal axes."""

    x: Sequence[Scale]  # one for each column
    subplots: Sequence[Subplot]  # from the top
    shape: str = FREE
    z: Scale = field(default_factory=Scale)  # in space

    @property
    def marks(self) -> list[Mark]:
        """All marks of all subplots."""
        return [m for s in self.subplots for cell in s.cells for m in cell]

    @property
    def heat(self) -> Heat | None:
        """The colours that a scale beside the plot explains."""
        return next((h for m in self.marks if (h := getattr(m, "heat", None))), None)


def one(x: Scale, y: Scale, marks: Sequence[Mark], height: float, shape: str = FREE) -> Diagram:
    """A diagram of one subplot."""
    return Diagram((x,), (Subplot(y, marks, height),), shape)


def named_mark(mark: Mark) -> bool:
    """Whether a legend can show the mark: it has a name, and points."""
    points = getattr(mark, "x", None)
    return bool(getattr(mark, "name", "")) and (points is None or np.size(points) > 0)


def ends_of(values: Iterable[Array], zero: bool = False, share: float = ROOM) -> Any:
    """Ends of an axis about all finite values, with room; 0 is between them if wanted."""
    every = np.concatenate([np.ravel(v).astype(np.float64) for v in values] or [np.zeros(0)])
    every = every[np.isfinite(every)]
    low, high = (float(every.min()), float(every.max())) if len(every) else (0.0, 1.0)
    if zero:
        low, high = min(low, 0.0), max(high, 0.0)
    room = share * (high - low) or 0.1 * abs(low) or 0.5
    return low - room, high + room


def bounds(diagram: Diagram) -> tuple[Array, Array]:
    """The corners of what a diagram of one subplot shows, with room."""
    marks = [m for m in diagram.marks if isinstance(m, LineMark | PointMark) and np.size(m.x)]
    scales = (diagram.x[0], diagram.subplots[0].y, diagram.z)
    ends, free = [], []
    for name, scale in zip("xyz", scales, strict=True):
        values = [np.ravel(v) for m in marks if (v := getattr(m, name, None)) is not None]
        if values:
            every = np.concatenate(values)
            ends.append(scale.ends or (float(np.nanmin(every)), float(np.nanmax(every))))
            free.append(scale.ends is None)
    low, high = np.array(ends).T if ends else (np.zeros(2), np.ones(2))
    size = float(np.max(high - low))
    # A straight path along an axis gets some room beside it.
    narrow = np.maximum(0.5 * (SLIM * size - (high - low)), EDGE * size)
    room = (narrow if size > 0.0 else 1.0) * np.array(free or [True])
    return low - room, high + room


def path_lines(points: Array, **look: Any) -> LineMark:
    """A path (n, 2) or (n, 3) as a line."""
    z = points[:, 2] if points.shape[1] == 3 else None
    return LineMark(points[:, 0], points[:, 1], z=z, **look)


def path_diagram(names: Sequence[str], marks: Sequence[Mark], height: float) -> Diagram:
    """A path in a plane or in space over axes of one scale [mm]."""
    scales = [Scale(name, "mm") for name in names]
    shape = SPACE if len(scales) == 3 else EQUAL
    return Diagram(scales[:1], (Subplot(scales[1], marks, height),), shape, scales[-1])
