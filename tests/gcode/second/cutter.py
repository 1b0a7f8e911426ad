"""Cutter compensation: the way of the tool's centre beside a contour, found from all of it at once.

Convex corners get an arc about them, concave ones the crossing of both offset motions.
"""

import cmath
import math
from dataclasses import dataclass, replace

from second.frames import plane_axes
from second.parameters import Wrong
from second.state import Point, State, Step

SMOOTH = 1e-5  # [mm] offset ends that are nearer need no corner
ROUNDING = 1e-9  # [mm]
SLIGHT = 0.01  # [rad] concave corners below it are what rounding makes of a smooth contour


@dataclass
class Piece:
    """A motion of the contour in its plane, as complex numbers."""

    step: Step
    start: complex
    end: complex
    centre: complex | None
    turn: float  # of an arc: 1 counter-clockwise, -1 clockwise

    def left(self, at: complex) -> complex:
        """Unit vector to the left of the motion there."""
        if self.centre is None:
            way = self.end - self.start
            return 1j * way / abs(way)
        return -self.turn * (at - self.centre) / abs(at - self.centre)

    def beside(self, at: complex, edge: float) -> complex:
        return at + edge * self.left(at)


class Cutter:
    """Turns the steps of a contour into those of the tool's centre, `edge` to the left [mm]."""

    def __init__(self, s: State, edge: float) -> None:
        self.edge, self.plane = edge, s.plane
        self.a, self.b = plane_axes(s.plane)
        self.out: list[Step] = []
        self.line = 0
        self.at = 0j
        self.shortened = False  # by the corner that `corner` looked at last

    def flat(self, p: Point) -> complex:
        return complex(p[self.a], p[self.b])

    def placed(self, p: Point, at: complex) -> Point:
        """A point with another place in the plane."""
        new = list(p)
        new[self.a], new[self.b] = at.real, at.imag
        return tuple(new)

    def piece(self, step: Step) -> Piece | None:
        """The step as a motion in the plane, if it is one."""
        if step.kind not in ("line", "rapid", "arc"):
            return None
        start, end = self.flat(step.start), self.flat(step.end)
        if step.kind == "arc":
            return Piece(step, start, end, complex(*step.centre), math.copysign(1.0, step.sweep))
        return Piece(step, start, end, None, 0.0) if abs(end - start) > ROUNDING else None

    def corner(self, one: Piece, two: Piece) -> tuple[complex, complex]:
        """Where the centre ends a motion and begins the next."""
        u, v = one.left(one.end), two.left(two.start)
        angle = cmath.phase(v / u)
        self.shortened = angle * self.edge >= max(SMOOTH, SLIGHT * abs(self.edge))
        if abs(angle) > math.pi - 1e-6:
            raise Wrong("the contour turns back on itself")
        if abs(angle * self.edge) < SMOOTH:
            place = one.end + self.edge * (u + v) / abs(u + v)
            return place, place
        if angle * self.edge < 0.0:
            return one.beside(one.end, self.edge), two.beside(two.start, self.edge)
        place = self.crossing(one, two)
        return place, place

    def crossing(self, one: Piece, two: Piece) -> complex:
        """The common point of both offset motions that is next to the corner."""
        found = _meet(self.shape(one), self.shape(two))
        if not found:
            raise Wrong("the tool does not fit into the corner")
        return min(found, key=lambda z: abs(z - one.end))

    def shape(self, p: Piece) -> tuple[complex, complex | float]:
        """Its offset: a point and a direction, or a centre and a radius."""
        if p.centre is None:
            return p.beside(p.start, self.edge), (p.end - p.start) / abs(p.end - p.start)
        return p.centre, abs(p.beside(p.end, self.edge) - p.centre)

    def emit(self, piece: Piece, start: complex, end: complex, back: bool) -> None:
        """The motion between two places of the centre, which may lead back."""
        step = piece.step
        new = replace(step, start=self.placed(step.start, start), end=self.placed(step.end, end))
        if back and piece.centre is not None and self.nothing(piece, start, end):
            new.kind, new.centre, new.sweep = "line", (0.0, 0.0), 0.0
        elif piece.centre is not None:
            turn = cmath.phase((end - piece.centre) / (start - piece.centre))
            whole = math.tau * round((step.sweep - turn) / math.tau)
            new.sweep = turn + whole
        elif not back and ((end - start) / (piece.end - piece.start)).real < 0.0:
            raise Wrong("a motion shorter than the tool needs")
        self.out.append(new)
        self.at = end

    @staticmethod
    def nothing(piece: Piece, start: complex, end: complex) -> bool:
        """Whether corners at both ends leave nothing of an arc."""
        assert piece.centre is not None
        ahead = cmath.phase((start - piece.centre) / (piece.start - piece.centre))
        behind = cmath.phase((piece.end - piece.centre) / (end - piece.centre))
        return abs(piece.step.sweep) <= piece.turn * (ahead + behind)

    def round(self, before: Step, step: Step, about: complex, end: complex) -> None:
        """The arc about a convex corner, at the feed of the motion behind it."""
        source = step if step.kind != "rapid" else before
        start = self.placed(step.start, self.at)
        new = replace(source, start=start, end=self.placed(step.start, end), line=step.line)
        new.set = new.clear = 0
        if source.kind != "rapid":
            new.kind, new.plane, new.centre = "arc", self.plane, (about.real, about.imag)
            new.sweep = cmath.phase((end - about) / (self.at - about))
        self.out.append(new)
        self.at = end

    def run(self, steps: list[Step], line: int) -> list[Step]:
        """All steps of the contour as those of the centre; `line` ends it."""
        held: Piece | None = None
        self.line = line
        waiting: list[Step] = []
        begin, entry, short = 0j, True, False
        for step in [*steps, None]:
            piece = self.piece(step) if step else None
            if step and not piece:
                (waiting if held else self.out).append(step)
                continue
            if held:
                self.line = step.line if step else line
                if piece:
                    end, onward = self.corner(held, piece)
                else:
                    end = onward = held.beside(held.end, self.edge)
                shorter = bool(piece) and self.shortened
                self.line = held.step.line
                self.emit(held, begin, end, entry or not (short or shorter))
                entry, short = False, shorter
                for w in waiting:
                    self.out.append(
                        replace(w, start=self.placed(w.start, end), end=self.placed(w.end, end))
                    )
                waiting = []
                if piece and abs(onward - end) > ROUNDING:
                    self.round(held.step, piece.step, piece.start, onward)
                begin = onward
            elif piece:
                self.line = piece.step.line
                begin = piece.start
                if abs(piece.end - piece.start) <= abs(self.edge):
                    raise Wrong("entry shorter than the radius")
            if piece and piece.centre is not None:
                inside = piece.turn * self.edge
                if abs(piece.end - piece.centre) <= inside:
                    raise Wrong("arc too small for the tool")
            held = piece
        return self.out


def _meet(
    one: tuple[complex, complex | float], two: tuple[complex, complex | float]
) -> list[complex]:
    """Common points of lines (complex direction) and circles (real radius)."""
    (p, d), (q, e) = one, two
    if isinstance(d, complex) and isinstance(e, complex):
        cross = (d.conjugate() * e).imag
        return [p + d * ((q - p).conjugate() * e).imag / cross] if cross else []
    if isinstance(d, complex):
        assert not isinstance(e, complex)
        foot = ((q - p) * d.conjugate()).real
        off = e**2 - abs(p + foot * d - q) ** 2
        return [p + (foot + k * math.sqrt(off)) * d for k in (-1, 1)] if off >= 0.0 else []
    if isinstance(e, complex):
        return _meet(two, one)
    way = abs(q - p)
    along = (way**2 + d**2 - e**2) / (2.0 * way) if way else 0.0
    off = d**2 - along**2
    if not way or off < 0.0:
        return []
    return [p + (q - p) / way * complex(along, k * math.sqrt(off)) for k in (-1, 1)]


def begin(s: State, side: int, diameter: float) -> None:
    """G41, G42: from here on the steps are those of a contour."""
    if s.side:
        raise Wrong("compensation is on")
    if s.plane == 0:
        raise Wrong("compensation in YZ")
    s.side, s.edge, s.contour_from = side, side * diameter / 2.0, len(s.steps)


def finish(s: State) -> None:
    """G40 and the end: the contour so far becomes the way of the centre."""
    if s.side and s.edge:
        cutter = Cutter(s, s.edge)
        try:
            new = cutter.run(s.steps[s.contour_from :], s.line)
        except Wrong as error:
            raise Wrong(str(error), cutter.line) from None
        s.steps[s.contour_from :] = new
        for step in reversed(new):
            if step.kind in ("line", "rapid", "arc"):
                s.aside = (list(s.point), list(step.end), plane_axes(s.plane))
                s.point = list(step.end)
                break
    s.side, s.edge = 0, 0.0
