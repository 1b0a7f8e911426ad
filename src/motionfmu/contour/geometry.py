"""Exact path segments in X Y Z and the nearest point on each."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np

from motionfmu.contour.arcs import ROUNDS_MAX, STEP_DONE, Arcs, Array, Foot

# Parts of a cubic: between two of their ends the distance to a point has one minimum at most where
# it matters, and Gauss and Legendre's rule of 16 points gives their lengths to rounding.
PARTS = 64
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


@dataclass(frozen=True)
class Label:
    """What a segment is in the part program."""

    command: int  # index of the library's command
    line: int  # of the part program
    kind: str  # ptp, line, arc, helix or curve
    feed: float  # as programmed [mm/s]


@dataclass(frozen=True, eq=False)
class Line:
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
        """The same, to find points on it."""
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
        edges = np.linspace(0.0, 1.0, PARTS + 1)
        middle = self.control.mean(axis=0)
        known = self._points(edges) - middle
        # |p - k|^2 = |p|^2 + |k|^2 - 2 p k, the least of one p over all k
        nearest = np.argmin(
            np.sum(known * known, axis=1) - 2.0 * (points - middle) @ known.T, axis=1
        )
        t = edges[nearest]
        low, high = edges[np.maximum(nearest - 1, 0)], edges[np.minimum(nearest + 1, PARTS)]
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
        point, slope = self._points(t), self._slopes(t)[0]
        return Foot(point, self._along(t), norms(points - point), slope / norms(slope)[:, None])


Segment = Line | Arc | Cubic


def norms(vectors: Array) -> Array:
    """Lengths (n,) of vectors (n, 3)."""
    return np.sqrt(_dots(vectors, vectors))


def _dots(a: Array, b: Array) -> Array:
    return np.asarray(np.einsum("ij,ij->i", a, b))
