"""Shapes of SVG as paths, through a matrix onto the sheet."""

import re
from collections.abc import Iterator, Mapping

import numpy as np

from motionfmu.drawings.pen_path import Array, EllipseAxes, PathMaker, PenPath
from motionfmu.drawings.svg_words import WrongValue, length, numbers

Size = tuple[float, float]
_NO_DATA = re.compile(r"[^MmZzLlHhVvCcSsQqTtAa0-9eE+\-.,\s]")
# Four arcs make an ellipse; begin at the right and go the way that SVG's arcs of positive angle go.
_TURN = 2.0 * np.pi


class ShapePen:
    """Draws shapes in user units; what it makes is on the sheet [mm], Y up."""

    def __init__(self, matrix: Array, line: int) -> None:
        self._linear, self._shift = matrix[:2, :2], matrix[:2, 2]
        self._line = line
        self._maker: PathMaker | None = None
        self._done: list[PenPath] = []

    def _at(self, x: float, y: float) -> Array:
        return self._linear @ np.array([x, y]) + self._shift

    def _way(self, x: float, y: float) -> Array:
        return self._linear @ np.array([x, y])

    @property
    def _path(self) -> PathMaker:
        if self._maker is None:
            raise WrongValue("path data that begins with M wanted")
        return self._maker

    def move(self, x: float, y: float) -> None:
        """Begin a path."""
        self._end()
        self._maker = PathMaker(self._at(x, y), self._line)

    def line(self, x: float, y: float) -> None:
        """Go straight on."""
        self._path.line(self._at(x, y))

    def quadratic(self, control: Size, end: Size) -> None:
        """Go along a parabola, which is a cubic curve, too."""
        c, e, s = self._at(*control), self._at(*end), self._path.at
        self._path.cubic(s + 2 / 3 * (c - s), e + 2 / 3 * (c - e), e)

    def cubic(self, first: Size, second: Size, end: Size) -> None:
        """Go along a cubic curve."""
        self._path.cubic(self._at(*first), self._at(*second), self._at(*end))

    def ellipse(self, centre: Size, radii: tuple[Size, Size], begin: float, sweep: float) -> None:
        """Go along an ellipse by two conjugate radii."""
        axes = EllipseAxes(self._at(*centre), self._way(*radii[0]), self._way(*radii[1]))
        self._path.ellipse(axes, begin, begin + sweep)

    def close(self) -> None:
        """Go back to where the path begins."""
        self._path.close()

    def _end(self) -> None:
        if self._maker is not None and not self._maker.empty:
            self._done.append(self._maker.path())
        self._maker = None

    def paths(self) -> list[PenPath]:
        """All that is drawn."""
        self._end()
        return self._done


class ShapeValues:
    """Attributes of a shape as numbers."""

    def __init__(self, attributes: Mapping[str, str], size: Size) -> None:
        self._attributes, self._size = attributes, size
        self.name = ""  # of the attribute that was read last

    def text(self, name: str) -> str:
        """The attribute as it is."""
        self.name = name
        return self._attributes.get(name, "")

    def length(self, name: str) -> float:
        """A length, 0 if it is missing; percentages by the axis that the name is of."""
        text = self.text(name)
        return length(text, self._whole(name)) if text.strip() else 0.0

    def size(self, name: str) -> float:
        """A length that is not negative."""
        value = self.length(name)
        if value < 0.0:
            raise WrongValue("0 or more wanted")
        return value

    def _whole(self, name: str) -> float:
        if name in ("x", "cx", "x1", "x2", "width", "rx"):
            return self._size[0]
        if name == "r":
            return float(np.hypot(*self._size) / np.sqrt(2.0))
        return self._size[1]

    def corner_radii(self) -> Size:
        """rx and ry of a rectangle; one that is missing is the other."""
        found = {}
        for name in ("rx", "ry"):
            text = self.text(name).strip()
            found[name] = self.size(name) if text and text != "auto" else None
        rx = found["rx"] if found["rx"] is not None else found["ry"] or 0.0
        ry = found["ry"] if found["ry"] is not None else rx
        return rx, ry


def draw_rect(pen: ShapePen, v: ShapeValues) -> None:
    """rect, with round corners or without."""
    x, y, w, h = v.length("x"), v.length("y"), v.size("width"), v.size("height")
    rx, ry = v.corner_radii()
    rx, ry = min(rx, w / 2), min(ry, h / 2)
    if w == 0.0 or h == 0.0:
        return
    if rx == 0.0 or ry == 0.0:
        pen.move(x, y)
        for corner in ((x + w, y), (x + w, y + h), (x, y + h)):
            pen.line(*corner)
        pen.close()
        return
    pen.move(x + rx, y)
    corners = [
        (x + w - rx, y + ry),
        (x + w - rx, y + h - ry),
        (x + rx, y + h - ry),
        (x + rx, y + ry),
    ]
    for k, (cx, cy) in enumerate(corners):
        begin = (k - 1) * np.pi / 2
        pen.line(cx + rx * round(np.cos(begin)), cy + ry * round(np.sin(begin)))
        pen.ellipse((cx, cy), ((rx, 0.0), (0.0, ry)), begin, np.pi / 2)
    pen.close()


def draw_circle(pen: ShapePen, v: ShapeValues) -> None:
    """circle."""
    r = v.size("r")
    _around(pen, (v.length("cx"), v.length("cy")), (r, r))


def draw_ellipse(pen: ShapePen, v: ShapeValues) -> None:
    """ellipse."""
    _around(pen, (v.length("cx"), v.length("cy")), v.corner_radii())


def _around(pen: ShapePen, centre: Size, radii: Size) -> None:
    rx, ry = radii
    if rx == 0.0 or ry == 0.0:
        return
    pen.move(centre[0] + rx, centre[1])
    pen.ellipse(centre, ((rx, 0.0), (0.0, ry)), 0.0, _TURN)
    pen.close()


def draw_line(pen: ShapePen, v: ShapeValues) -> None:
    """line."""
    pen.move(v.length("x1"), v.length("y1"))
    pen.line(v.length("x2"), v.length("y2"))


def draw_polyline(pen: ShapePen, v: ShapeValues) -> None:
    """polyline."""
    _through(pen, v)


def draw_polygon(pen: ShapePen, v: ShapeValues) -> None:
    """polygon."""
    if _through(pen, v):
        pen.close()


def _through(pen: ShapePen, v: ShapeValues) -> bool:
    places = numbers(v.text("points"))
    if len(places) % 2:
        raise WrongValue("an even number of coordinates wanted")
    for k, place in enumerate(_pairs(places)):
        (pen.line if k else pen.move)(*place)
    return len(places) > 2


def _pairs(places: list[float]) -> Iterator[Size]:
    yield from zip(places[::2], places[1::2], strict=True)


def draw_path(pen: ShapePen, v: ShapeValues) -> None:
    """path, its data read by svgelements."""
    from svgelements import Arc, Close, CubicBezier, Line, Move, Path, QuadraticBezier

    data = v.text("d")
    if m := _NO_DATA.search(data):
        raise WrongValue(f"{m[0]!r} is no path data")
    try:
        pieces = Path(data)
    except (ValueError, TypeError, ArithmeticError):
        raise WrongValue("path data ends within a command") from None
    for piece in pieces:
        _finite(piece)
        match piece:
            case Move(end=end):
                pen.move(end.x, end.y)
            case Close():
                pen.close()
            case Line(end=end):
                pen.line(end.x, end.y)
            case QuadraticBezier(control=c, end=end):
                pen.quadratic((c.x, c.y), (end.x, end.y))
            case CubicBezier(control1=a, control2=b, end=end):
                pen.cubic((a.x, a.y), (b.x, b.y), (end.x, end.y))
            case Arc(center=c, prx=u, pry=w, sweep=sweep):
                radii = ((u.x - c.x, u.y - c.y), (w.x - c.x, w.y - c.y))
                pen.ellipse((c.x, c.y), radii, piece.get_start_t(), sweep)


def _finite(piece: object) -> None:
    for name in ("end", "control", "control1", "control2"):
        point = getattr(piece, name, None)
        if point is not None and not (abs(point.x) < 1e9 and abs(point.y) < 1e9):
            raise WrongValue("coordinates below 1e9 wanted")


SHAPES = {
    "rect": draw_rect,
    "circle": draw_circle,
    "ellipse": draw_ellipse,
    "line": draw_line,
    "polyline": draw_polyline,
    "polygon": draw_polygon,
    "path": draw_path,
}
