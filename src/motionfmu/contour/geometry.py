"""Exact path segments in X Y Z and the nearest point on each."""

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

TURN = 2.0 * math.pi
# Newton with bisection as its fall-back gains at least one bit per round: a double has 53, and
# the bracket is at most half a turn wide. Good starts need five to eight.
ROUNDS_MAX = 80
# A root is found when the step is within a few roundings of the angle itself.
EPS = float(np.finfo(float).eps)
STEP_DONE = 4.0 * EPS
# Parts of a cubic: between two of their ends the distance to a point has one minimum at most where
# it matters, and Gauss and Legendre's rule of 16 points gives their lengths to rounding.
PARTS = 64
NODES, WEIGHTS = np.polynomial.legendre.leggauss(16)


@dataclass(frozen=True)
class Foot:
    """Nearest points of a segment to some query points."""

    point: Array  # (n, 3) nearest points [mm]
    along: Array  # (n,) their distance from the segment's start, measured along it [mm]
    distance: Array  # (n,) of the query points to them [mm]


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
        return Foot(point, along, _norm(points - point))


class Lines:
    """Many straight segments, to find the nearest points on all of them in one go."""

    def __init__(self, lines: Sequence[Line]) -> None:
        self.start = np.array([line.start for line in lines])
        self.end = np.array([line.end for line in lines])
        self.direction = np.array([line.direction for line in lines])
        self.length = np.array([line.length for line in lines])

    def foot(self, points: Array, which: NDArray[np.int64]) -> Foot:
        """Nearest point to each of the points (n, 3) [mm] on the line of its index (n,)."""
        start, way, length = self.start[which], self.direction[which], self.length[which]
        along = np.clip(np.einsum("ij,ij->i", points - start, way), 0.0, length)
        point = start + along[:, None] * way
        ended = along >= length
        point[ended] = self.end[which[ended]]
        return Foot(point, along, _norm(points - point))


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
    def radius(self) -> float:
        """Radius at the start [mm]."""
        return float(np.linalg.norm(self.start - self.centre))

    @cached_property
    def length(self) -> float:
        """Length [mm]; with growth the library's own measure of it."""
        way = (self.radius + 0.5 * self.growth) * self.angle
        return math.hypot(way, self.growth, self.rise)

    @cached_property
    def end(self) -> Array:
        """Last point [mm]."""
        return self._points(np.array([self.angle]))[0]

    @cached_property
    def _basis(self) -> tuple[Array, Array]:
        first = (self.start - self.centre) / self.radius
        return first, np.cross(self.axis, first)

    def _points(self, angle: Array) -> Array:
        first, second = self._basis
        part = angle / self.angle
        spoke = np.outer(np.cos(angle), first) + np.outer(np.sin(angle), second)
        out = (self.radius + self.growth * part)[:, None] * spoke
        return self.centre + out + np.outer(self.rise * part, self.axis)

    def at(self, along: Array) -> Array:
        """Points (n, 3) of the segment at distances (n,) from the start [mm]."""
        return self._points(np.asarray(along) / self.length * self.angle)

    def tangent(self, along: Array) -> Array:
        """Unit tangents (n, 3) at distances (n,) from the start [mm]."""
        slope = self._slopes(np.asarray(along) / self.length * self.angle)[0]
        return slope / _norm(slope)[:, None]

    def foot(self, points: Array) -> Foot:
        """Nearest points of the segment to points (n, 3) [mm]."""
        best = np.zeros(len(points))
        distance = _norm(points - self.start)
        for angle in (np.full(len(points), self.angle), *self._candidates(points)):
            inside = np.clip(angle, 0.0, self.angle)
            if self.growth:
                inside = self._refine(points, inside)
            other = _norm(points - self._points(inside))
            nearer = other <= distance  # the later candidates are the more exact
            best = np.where(nearer, inside, best)
            distance = np.where(nearer, other, distance)
        return Foot(self._points(best), best / self.angle * self.length, distance)

    def _candidates(self, points: Array) -> list[Array]:
        """Angles of local minima of the distance, or arbitrary where there is none."""
        first, second = self._basis
        offset = points - self.centre
        x, y = offset @ first, offset @ second
        phase = np.arctan2(y, x)
        turns = math.ceil(self.angle / TURN) if self.growth else 1
        found = [np.mod(phase, TURN) + TURN * k for k in range(turns)]
        if abs(self.rise) > EPS * self.radius:  # a smaller one is lost in rounding anyway
            found += self._helix_candidates(np.hypot(x, y), phase, offset @ self.axis)
        return found

    def _helix_candidates(self, reach: Array, phase: Array, height: Array) -> list[Array]:
        """Local minima of the distance to a helix.

        With w = a - phase the squared distance is ``-2 A cos w + k^2 (w - M)^2`` + constant,
        A = reach * radius, k = rise per radian, M = height/k - phase. Its slope is Kepler's
        equation ``A sin w + k^2 (w - M) = 0``. Each turn has at most one minimum, between the
        turn's own phase 2 pi m and M, and there the slope is concave: one root per bracket.
        The best on a limited range is in the turn nearest to M, or a neighbour, or an end.
        """
        k = self.rise / self.angle
        pull, stiff = reach * self.radius, k * k
        middle = height / k - phase
        low, high = np.round(-phase / TURN), np.round((self.angle - phase) / TURN)
        nearest = np.clip(np.round(middle / TURN), low, high)
        ratio = np.divide(stiff, pull, out=np.full_like(pull, np.inf), where=pull > 0.0)
        bend = np.arccos(np.maximum(-ratio, -1.0))  # where the slope is steepest
        limit = np.where(ratio < 1.0, bend, np.inf)
        found = []
        for turn in (nearest - 1.0, nearest, nearest + 1.0):
            base = TURN * turn
            way = middle - base
            root = kepler_root(pull, stiff, way, np.minimum(np.abs(way), limit))
            found.append(phase + base + root)
        return found

    def _slopes(self, angle: Array) -> tuple[Array, Array]:
        """First and second derivative of the point by the angle [mm/rad, mm/rad^2]."""
        first, second = self._basis
        c, s = np.cos(angle)[:, None], np.sin(angle)[:, None]
        out, round_ = c * first + s * second, c * second - s * first
        g = self.growth / self.angle
        radius = (self.radius + g * angle)[:, None]
        slope = g * out + radius * round_ + self.rise / self.angle * self.axis
        return slope, 2.0 * g * round_ - radius * out

    def _refine(self, points: Array, angle: Array) -> Array:
        """Newton on the exact condition, for the small growth of a rounded part program."""
        for _ in range(ROUNDS_MAX):
            gap = points - self._points(angle)
            slope, curve = self._slopes(angle)
            value = np.sum(gap * slope, axis=1)
            change = np.sum(gap * curve, axis=1) - np.sum(slope * slope, axis=1)
            step = np.divide(value, change, out=np.zeros_like(value), where=change < 0.0)
            moved = np.clip(angle - step, 0.0, self.angle)
            done = np.abs(moved - angle) <= STEP_DONE * self.angle
            angle = moved
            if done.all():
                break
        return angle


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

    def _points(self, t: Array) -> Array:
        u = 1.0 - t
        weights = np.stack([u**3, 3.0 * u * u * t, 3.0 * u * t * t, t**3], axis=-1)
        return weights @ self.control

    def _slopes(self, t: Array) -> tuple[Array, Array]:
        """First and second derivative of the point by t [mm]."""
        first = 3.0 * np.diff(self.control, axis=0)
        second = 2.0 * np.diff(first, axis=0)
        u = 1.0 - t
        weights = np.stack([u * u, 2.0 * u * t, t * t], axis=-1)
        return weights @ first, np.stack([u, t], axis=-1) @ second

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
        known = self._points(edges)
        gaps = np.linalg.norm(points[:, None, :] - known, axis=-1)
        nearest = np.argmin(gaps, axis=1)
        t = edges[nearest]
        low, high = edges[np.maximum(nearest - 1, 0)], edges[np.minimum(nearest + 1, PARTS)]
        for _ in range(ROUNDS_MAX):
            gap = points - self._points(t)
            slope, bend = self._slopes(t)
            value = np.sum(gap * slope, axis=1)  # above 0: the foot lies further on
            low, high = np.where(value > 0.0, t, low), np.where(value < 0.0, t, high)
            change = np.sum(slope * slope, axis=1) - np.sum(gap * bend, axis=1)
            step = np.divide(value, change, out=np.full_like(t, np.inf), where=change > 0.0)
            moved = t + step
            inside = (moved >= low) & (moved <= high)
            moved = np.where(inside, moved, np.where(value == 0.0, t, 0.5 * (low + high)))
            done = np.abs(moved - t) <= STEP_DONE
            t = moved
            if done.all():
                break
        point = self._points(t)
        return Foot(point, self._along(t), _norm(points - point))


Segment = Line | Arc | Cubic


def kepler_root(pull: Array, stiff: float, way: Array, reach: Array) -> Array:
    """Solve ``pull sin(w) + stiff (w - way) = 0`` for w (n,) between 0 and `way` [rad].

    Newton, with bisection where it would leave the bracket, which starts at 0 and goes `reach`
    [rad] towards `way`, where the linear term vanishes. Where the bracket holds no root, the result
    is a point of it. `pull` is not negative, `stiff` is positive.
    """
    goal = np.abs(way)
    high = reach.copy()
    low = np.where(pull * np.sin(high) + stiff * (high - goal) < 0.0, high, 0.0)
    w = np.clip(stiff * goal / (pull + stiff), low, high)
    for _ in range(ROUNDS_MAX):
        value = pull * np.sin(w) + stiff * (w - goal)
        slope = pull * np.cos(w) + stiff
        low, high = np.where(value < 0.0, w, low), np.where(value > 0.0, w, high)
        step = np.divide(value, slope, out=np.full_like(w, np.inf), where=slope > 0.0)
        moved = w - step
        moved = np.where((moved > low) & (moved < high), moved, 0.5 * (low + high))
        moved = np.where(value == 0.0, w, moved)
        done = np.abs(moved - w) <= STEP_DONE * np.maximum(1.0, w)
        w = moved
        if done.all():
            break
    return np.copysign(w, way)


def _norm(vectors: Array) -> Array:
    return np.sqrt(np.einsum("ij,ij->i", vectors, vectors))
