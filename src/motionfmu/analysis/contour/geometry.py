"""Exact path segments in X Y Z and the nearest point on each."""

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import ROUNDS_MAX, STEP_DONE, Arcs, Array, Foot

# Parts of a cubic: Gauss and Legendre's rule of 16 points gives their lengths to rounding.
PARTS = 64
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)
# Most halvings of a cubic, after which parts are as short as the last digit of t.
HALVINGS = 54
# Of Bernstein polynomials of degree 3 and 2 to one of degree 5: C(3,i) C(2,j) / C(5,i+j).
PRODUCT = [
    [math.comb(3, i) * math.comb(2, j) / math.comb(5, i + j) for j in range(3)] for i in range(4)
]


@dataclass(frozen=True)
class Label:
    """What a segment is in the part program."""

    command: int  # index of the library's command
    line: int  # of the part program
    kind: str  # ptp, line, arc, helix or curve
    feed: float  # as programmed [mm/s]


@dataclass(frozen=True, eq=False)
class LineSegment:
    """A straight segment; start and end may be the same point."""

    label: Label
    start: Array  # (3,) [mm]
    end: Array  # (3,) [mm]

    @cached_property
    def length(self) -> float:
        """Length [mm]."""
        return float(np.linalg.norm(self.end - self.start))

    @cached_property
    def direction(self) -> Array:
        """Unit vector (3,) from start to end; zero for a line without length."""
        return (self.end - self.start) / (self.length or 1.0)

    def at(self, along: Array) -> Array:
        """Points (n, 3) of the segment at distances (n,) from the start [mm]."""
        return self.start + np.multiply.outer(along, self.direction)

    def tangent(self, along: Array) -> Array:
        """Unit tangents (n, 3) at distances from the start [mm]; zero for a line without length."""
        return np.broadcast_to(self.direction, (len(along), 3))

    def foot(self, points: Array) -> Foot:
        """Nearest points of the segment to points (n, 3) [mm]."""
        along = np.clip((points - self.start) @ self.direction, 0.0, self.length)
        point = self.at(along)
        point[along >= self.length] = self.end
        return Foot(point, along, norms(points - point), self.tangent(along))


@dataclass(frozen=True, eq=False)
class Arc:
    """An arc, full circle or helix of any number of turns.

    The point at angle a, 0 <= a <= `angle`, is
    ``centre + (radius + growth a/angle) u(a) + rise a/angle axis`` with the unit radius u turning
    from the start about `axis`. A growth other than zero is the rounding of a part program whose
    end misses the circle a little; the library spreads it over the arc, and so is it here.
    """

    label: Label
    start: Array  # (3,) [mm]
    centre: Array  # (3,) [mm], in the plane of the start that is normal to the axis
    axis: Array  # (3,) unit vector about which the arc turns counter-clockwise
    angle: float  # turned through, positive [rad]
    rise: float = 0.0  # way along the axis from start to end [mm]
    growth: float = 0.0  # change of the radius from start to end [mm]

    @cached_property
    def own(self) -> Arcs:
        """The arc as `Arcs`, which find points on it."""
        shape = (self.angle, self.rise, self.growth)
        return Arcs.of(self.start, (self.centre, self.axis), shape)

    @property
    def radius(self) -> float:
        """Radius at the start [mm]."""
        return float(self.own.radius)

    @cached_property
    def length(self) -> float:
        """Length [mm]; with growth the library's own measure of it."""
        return float(self.own.length)

    @cached_property
    def end(self) -> Array:
        """Last point [mm]."""
        return self.own.points(np.array([self.angle]))[0]

    def at(self, along: Array) -> Array:
        """Points (n, 3) of the segment at distances (n,) from the start [mm]."""
        return self.own.points(np.asarray(along) / self.length * self.angle)

    def tangent(self, along: Array) -> Array:
        """Unit tangents (n, 3) at distances (n,) from the start [mm]."""
        return self.own.tangents(np.asarray(along) / self.length * self.angle)

    def foot(self, points: Array) -> Foot:
        """Nearest points of the segment to points (n, 3) [mm]."""
        return self.own.foot(points)


@dataclass(frozen=True, eq=False)
class Cubic:
    """A curve of Bezier with four control points, as G5 makes it."""

    label: Label
    control: Array  # (4, 3) [mm]

    @property
    def start(self) -> Array:
        """First point [mm]."""
        return self.control[0]

    @property
    def end(self) -> Array:
        """Last point [mm]."""
        return self.control[3]

    @cached_property
    def length(self) -> float:
        """Length [mm]."""
        return float(self._upto[-1])

    @cached_property
    def _upto(self) -> Array:
        edges = np.linspace(0.0, 1.0, PARTS + 1)
        return np.concatenate([[0.0], np.cumsum(self._between(edges[:-1], edges[1:]))])

    @cached_property
    def _powers(self) -> Array:
        """Factors (4, 3) of 1, t, t^2 and t^3 [mm]."""
        a, b, c, d = self.control
        return np.array([a, 3.0 * (b - a), 3.0 * (a - 2.0 * b + c), d - a + 3.0 * (b - c)])

    def _points(self, t: Array) -> Array:
        a, b, c, d = self._powers
        t = t[..., None]
        return np.asarray(a + t * (b + t * (c + t * d)))

    def _slopes(self, t: Array) -> tuple[Array, Array]:
        """First and second derivative of the point by t [mm]."""
        _, b, c, d = self._powers
        t = t[..., None]
        return b + t * (2.0 * c + 3.0 * t * d), 2.0 * c + 6.0 * t * d

    def _between(self, low: Array, high: Array) -> Array:
        """Lengths (n,) between values (n,) of t [mm]."""
        half = 0.5 * (high - low)
        t = 0.5 * (low + high)[:, None] + half[:, None] * NODES
        return half * (np.linalg.norm(self._slopes(t)[0], axis=-1) @ WEIGHTS)

    def _along(self, t: Array) -> Array:
        part = np.clip((t * PARTS).astype(int), 0, PARTS - 1)
        return self._upto[part] + self._between(part / PARTS, t)

    def _parameter(self, along: Array) -> Array:
        along = np.clip(np.asarray(along, dtype=float), 0.0, self.length)
        t = np.interp(along, self._upto, np.linspace(0.0, 1.0, PARTS + 1))
        for _ in range(ROUNDS_MAX):
            step = (along - self._along(t)) / np.linalg.norm(self._slopes(t)[0], axis=-1)
            t = np.clip(t + step, 0.0, 1.0)
            if np.abs(step).max(initial=0.0) <= STEP_DONE * PARTS:
                break
        return t

    def at(self, along: Array) -> Array:
        """Points (n, 3) of the segment at distances (n,) from the start [mm]."""
        return self._points(self._parameter(along))

    def tangent(self, along: Array) -> Array:
        """Unit tangents (n, 3) at distances (n,) from the start [mm]."""
        slope = self._slopes(self._parameter(along))[0]
        return slope / np.linalg.norm(slope, axis=-1)[:, None]

    def foot(self, points: Array) -> Foot:
        """Nearest points of the segment to points (n, 3) [mm]."""
        best = np.zeros(len(points))
        distance = norms(points - self.start)
        rows, t = self._minima(points)
        gaps = norms(points[rows] - self._points(t))
        every = (np.append(rows, np.arange(len(points))), np.append(t, np.ones(len(points))))
        gaps = np.append(gaps, norms(points - self.end))
        np.minimum.at(distance, every[0], gaps)
        least = gaps <= distance[every[0]]
        best[every[0][least]] = every[1][least]
        point, slope = self._points(best), self._slopes(best)[0]
        return Foot(point, self._along(best), norms(points - point), slope / norms(slope)[:, None])

    def _minima(self, points: Array) -> tuple[NDArray[np.intp], Array]:
        """All t at which the distance from points (n, 3) is least nearby, and their rows.

        The slope of half the squared distance is a polynomial of degree 5. By Descartes' rule for
        its Bernstein coefficients a part where these change sign once has one root, one without a
        change none; others are halved.
        """
        rates = 3.0 * np.diff(self.control, axis=0)
        slope = np.zeros((len(points), 6))
        for i, corner in enumerate(self.control):
            for j, rate in enumerate(rates):
                slope[:, i + j] += PRODUCT[i][j] * ((corner - points) @ rate)
        rows, low, width = np.arange(len(points)), np.zeros(len(points)), 1.0
        found: list[tuple[NDArray[np.intp], Array, Array]] = []
        for _ in range(HALVINGS):
            changes = sign_changes(slope)
            one = (changes == 1) & (slope[:, 0] <= 0.0)  # else the distance has a maximum there
            found.append((rows[one], low[one], low[one] + width))
            more = changes > 1
            if not more.any():
                break
            rows, low, width = rows[more], low[more], 0.5 * width
            left, right = halves(slope[more])
            flat = right[:, 0] == 0.0
            found.append((rows[flat], low[flat] + width, low[flat] + width))
            rows, low = np.append(rows, rows), np.append(low, low + width)
            slope = np.vstack([left, right])
        else:
            found.append((rows, low, low + width))
        of, start, end = (np.concatenate(part) for part in zip(*found, strict=True))
        return of, self._root(points[of], start, end)

    def _root(self, points: Array, low: Array, high: Array) -> Array:
        """Values of t where the distance has no slope: by Newton's steps, or by halves."""
        t = 0.5 * (low + high)
        rows = np.arange(len(points))
        for _ in range(ROUNDS_MAX):
            now = t[rows]
            gap = points[rows] - self._points(now)
            slope, bend = self._slopes(now)
            value = _dots(gap, slope)  # above 0: the foot lies further on
            low[rows] = np.where(value > 0.0, now, low[rows])
            high[rows] = np.where(value < 0.0, now, high[rows])
            change = _dots(slope, slope) - _dots(gap, bend)
            step = np.divide(value, change, out=np.full_like(now, np.inf), where=change > 0.0)
            moved = now + step
            inside = (moved >= low[rows]) & (moved <= high[rows])
            half = np.where(value == 0.0, now, 0.5 * (low[rows] + high[rows]))
            t[rows] = np.where(inside, moved, half)
            rows = rows[np.abs(t[rows] - now) > STEP_DONE]
            if not len(rows):
                break
        return t


Segment = LineSegment | Arc | Cubic


def norms(vectors: Array) -> Array:
    """Lengths (n,) of vectors (n, 3)."""
    return np.sqrt(_dots(vectors, vectors))


def sign_changes(coefficients: Array) -> NDArray[np.intp]:
    """Number of changes of sign in each row (n, k); zeros do not count."""
    last = np.zeros(len(coefficients))
    count = np.zeros(len(coefficients), np.intp)
    for column in np.sign(coefficients).T:
        count += column * last < 0.0
        last = np.where(column == 0.0, last, column)
    return count


def halves(bernstein: Array) -> tuple[Array, Array]:
    """Coefficients (n, k) of both halves of Bernstein polynomials, by de Casteljau."""
    left, right = np.empty_like(bernstein), np.empty_like(bernstein)
    rest = bernstein
    for k in range(bernstein.shape[1]):
        left[:, k], right[:, -1 - k] = rest[:, 0], rest[:, -1]
        rest = 0.5 * (rest[:, :-1] + rest[:, 1:])
    return left, right


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))
