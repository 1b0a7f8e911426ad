"""Exact path segments in X Y Z and the nearest point on each."""

import math
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
    kind: str  # ptp, line, arc or helix
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
    def _direction(self) -> Array:
        return (self.end - self.start) / (self.length or 1.0)

    def at(self, along: Array) -> Array:
        """Points (n, 3) of the segment at distances (n,) from the start [mm]."""
        return self.start + np.multiply.outer(along, self._direction)

    def tangent(self, along: Array) -> Array:
        """Unit tangents (n, 3) at distances from the start [mm]; zero for a line without length."""
        return np.broadcast_to(self._direction, (len(along), 3))

    def foot(self, points: Array) -> Foot:
        """Nearest points of the segment to points (n, 3) [mm]."""
        along = np.clip((points - self.start) @ self._direction, 0.0, self.length)
        point = self.at(along)
        point[along >= self.length] = self.end
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


Segment = Line | Arc


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
