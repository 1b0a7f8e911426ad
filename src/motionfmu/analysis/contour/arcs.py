"""Arcs and helices, and the nearest points on them: one arc for all points, or one for each."""

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# A number, or one for each point.
Numbers = Any

TURN = 2.0 * math.pi
# Newton's method with bisection as its fall-back gains one bit per round at least. A double has 53
# bits, and the bracket is half a turn wide at most. Good starts need five to eight rounds.
ROUNDS_MAX = 80
# A root is found when the step is within a few roundings of the angle itself.
EPS = float(np.finfo(float).eps)
STEP_DONE = 4.0 * EPS


@dataclass(frozen=True, eq=False)
class Foot:
    """Nearest points of a path to some query points."""

    point: Array  # (n, 3) nearest points [mm]
    along: Array  # (n,) their distance from the segment's start, measured along it [mm]
    distance: Array  # (n,) of the query points to them [mm]
    tangent: Array  # (n, 3) unit tangent there; zero on a line without length


@dataclass(frozen=True, eq=False)
class _Ray:
    """Directions from the axes of circles to the nearest points, in the arcs' own frames."""

    angle: Array  # (n,) from the start [rad]
    x: Array  # (n,) of the unit vector
    y: Array
    zero: Array  # (n,) its height
    distance: Array  # (n,) of the query points to the nearest ones [mm]


@dataclass(frozen=True, eq=False)
class Arcs:
    """One arc for all points, or one for each of n: then every field has n rows.

    In an arc's own frame the point at angle a, 0 <= a <= `angle`, is ``radius + growth a/angle``
    away from the axis, in the direction a, and ``rise a/angle`` high. All searches are made in
    this frame, in x, y and height.
    """

    centre: Array  # (3,) [mm]
    axes: Array  # (3, 3) rows: from the centre to the start, a quarter turn on, the axis
    radius: Numbers  # at the start [mm]
    angle: Numbers  # turned through, positive [rad]
    rise: Numbers  # way along the axis from start to end [mm]
    growth: Numbers  # change of the radius from start to end [mm]

    @classmethod
    def of(cls, start: Array, about: tuple[Array, Array], shape: tuple[Numbers, ...]) -> "Arcs":
        """Arcs by their start, centre and axis, and by angle, rise and growth."""
        spoke = start - about[0]
        radius = np.linalg.norm(spoke, axis=-1)
        first = spoke / radius[..., None]
        x, y, z = np.moveaxis(about[1], -1, 0)
        u, v, w = np.moveaxis(first, -1, 0)
        second = np.stack([y * w - z * v, z * u - x * w, x * v - y * u], axis=-1)
        axes = np.stack([first, second, about[1]], axis=-2)
        return cls(about[0], axes, radius, *(np.asarray(v, dtype=float) for v in shape))

    def __getitem__(self, rows: Any) -> "Arcs":
        """Some of many arcs."""
        return Arcs(*(getattr(self, name)[rows] for name in self.__dataclass_fields__))

    @cached_property
    def length(self) -> Numbers:
        """Length [mm]; with growth the library's own measure of it."""
        way = (self.radius + 0.5 * self.growth) * self.angle
        return np.sqrt(way * way + self.growth**2 + self.rise**2)

    @cached_property
    def reach(self) -> Numbers:
        """Upper bound of the length, which holds with growth as well [mm]."""
        first, last = self.radius * self.angle, (self.radius + self.growth) * self.angle
        both = np.hypot(first, self.rise) + np.hypot(last, self.rise)
        return np.where(self.growth == 0.0, self.length, 0.5 * both + np.abs(self.growth))

    @cached_property
    def flat(self) -> NDArray[np.bool_]:
        """Which arcs are parts of a circle, without rise and growth."""
        return np.asarray((self.rise == 0.0) & (self.growth == 0.0))

    def points(self, angle: Array) -> Array:
        """Points (n, 3) at angles (n,) from the start [mm]."""
        return self._placed(*self._local(angle))

    def tangents(self, angle: Array) -> Array:
        """Unit tangents (n, 3) at angles (n,) from the start."""
        slope, _ = self._slopes(angle)
        size = np.sqrt(sum(v * v for v in slope))
        return self._turned(*(v / size for v in slope))

    def foot(self, points: Array) -> Foot:
        """Nearest point to each of the points (n, 3) [mm]."""
        flat = self.flat
        if flat.all():
            return self._foot_flat(points)
        if flat.ndim == 0 or not flat.any():
            return self._foot_turned(points)
        found = Foot(*(np.empty((len(points), *s)) for s in ((3,), (), (), (3,))))
        for rows, foot in ((flat, Arcs._foot_flat), (~flat, Arcs._foot_turned)):
            part = foot(self[rows], points[rows])
            for name in found.__dataclass_fields__:
                getattr(found, name)[rows] = getattr(part, name)
        return found

    def distances(self, points: Array) -> Array:
        """Distance (n,) of each of the points (n, 3), as `foot` gives it [mm]."""
        return self._ray(points).distance if self.flat.all() else self.foot(points).distance

    def _frame(self, points: Array) -> tuple[Array, Array, Array]:
        """Points in the arc's own frame."""
        # Sums of three products: matrix products of a library with threads would be slower.
        u, v, w = (points[:, i] - c for i, c in enumerate(self.centre.T))
        x, y, z = (a * u + b * v + c * w for a, b, c in self._rows)
        return x, y, z

    @cached_property
    def _rows(self) -> Array:
        """Elements of the axes, each a number or (n,)."""
        return self.axes if self.axes.ndim == 2 else self.axes.transpose(1, 2, 0)

    def _turned(self, x: Array, y: Array, z: Array) -> Array:
        """Vectors (n, 3) of the arc's own frame in space."""
        found = np.empty((3, len(x)))  # each column of the result in a piece
        for out, (a, b, c) in zip(found, np.swapaxes(self._rows, 0, 1), strict=True):
            np.add(a * x + b * y, c * z, out=out)
        return found.T

    def _placed(self, x: Array, y: Array, z: Array) -> Array:
        return self.centre + self._turned(x, y, z)

    def _local(self, angle: Array) -> tuple[Array, Array, Array]:
        part = angle / self.angle
        radius = self.radius + self.growth * part
        return radius * np.cos(angle), radius * np.sin(angle), self.rise * part

    def _slopes(self, angle: Array) -> tuple[tuple[Array, ...], tuple[Array, ...]]:
        """First and second derivative of the point by the angle, in the own frame."""
        c, s = np.cos(angle), np.sin(angle)
        g = self.growth / self.angle
        radius = self.radius + g * angle
        first = (g * c - radius * s, g * s + radius * c, self.rise / self.angle + 0.0 * c)
        return first, (-2.0 * g * s - radius * c, 2.0 * g * c - radius * s, 0.0 * c)

    def _foot_flat(self, points: Array) -> Foot:
        """Nearest points on parts of circles."""
        ray = self._ray(points)
        u, v, zero = ray.x, ray.y, ray.zero
        point = self._placed(self.radius * u, self.radius * v, zero)
        return Foot(point, ray.angle * self.radius, ray.distance, self._turned(-v, u, zero))

    def _ray(self, points: Array) -> _Ray:
        """Where the nearest points on parts of circles are: radially, or at the nearer end."""
        x, y, z = self._frame(points)
        size = np.sqrt(x * x + y * y)
        middle = size == 0.0  # a point on the axis is as far from all points: the start is taken
        angle = np.where(middle, 0.0, np.arctan2(y, x))  # of coordinates whose squares vanish, too
        angle = np.where(angle < 0.0, angle + TURN, angle)
        inside = angle <= self.angle
        scale = 1.0 / np.where(middle, 1.0, size)
        u, v = np.where(middle, 1.0, x * scale), y * scale
        off = size - self.radius
        if not inside.all():
            ended = ~inside & (angle - self.angle <= TURN - angle)
            angle = np.where(inside, angle, np.where(ended, self.angle, 0.0))
            u = np.where(inside, u, np.where(ended, np.cos(self.angle), 1.0))
            v = np.where(inside, v, np.where(ended, np.sin(self.angle), 0.0))
            gap = np.hypot(x - self.radius * u, y - self.radius * v)
            off = np.where(inside, off, gap)
        return _Ray(angle, u, v, 0.0 * z, np.sqrt(off * off + z * z))

    def _foot_turned(self, points: Array) -> Foot:
        """Nearest points on helices and growing arcs: the best of local minima and ends."""
        own = self._frame(points)
        best = np.zeros(len(points))
        distance = self._distance(own, best)
        found = self._minima(own) if np.any(self.growth) else self._candidates(own)
        for angle in (best + self.angle, *found):
            inside = np.clip(angle, 0.0, self.angle)
            other = self._distance(own, inside)
            nearer = other <= distance  # the later candidates are the more exact
            best = np.where(nearer, inside, best)
            distance = np.where(nearer, other, distance)
        along = best / self.angle * self.length
        return Foot(self.points(best), along, distance, self.tangents(best))

    def _distance(self, own: tuple[Array, ...], angle: Array) -> Array:
        gap = [a - b for a, b in zip(own, self._local(angle), strict=True)]
        return np.asarray(np.sqrt(sum(v * v for v in gap)))

    def _candidates(self, own: tuple[Array, ...]) -> list[Array]:
        """Angles of local minima of the distance, or arbitrary where there is none."""
        x, y, z = own
        phase = np.arctan2(y, x)
        found = [np.mod(phase, TURN)]
        helix = np.abs(self.rise) > EPS * self.radius  # a smaller one is lost in rounding anyway
        if np.any(helix):
            rise = np.where(helix, self.rise, self.angle)
            near = self._helix_candidates(rise, (np.hypot(x, y), phase, z))
            # The foot's own angle is not compared: so near to rounding it is no less exact.
            found += [np.where(helix, angle, found[0]) for angle in near[1:]]
            found[0] = np.where(helix, near[0], found[0])
        return found

    def _helix_candidates(self, rise: Numbers, own: tuple[Array, ...]) -> list[Array]:
        """Local minima of the distance to a helix.

        With w = a - phase the squared distance is ``-2 A cos w + k^2 (w - M)^2`` + constant,
        A = reach * radius, k = rise per radian, M = height/k - phase. Its slope is Kepler's
        equation ``A sin w + k^2 (w - M) = 0``. Each turn has at most one minimum, between the
        turn's own phase 2 pi m and M, and there the slope is concave: one root per bracket.
        The best on a limited range is in the turn nearest to M, or a neighbour, or an end.
        """
        reach, phase, height = own
        k = rise / self.angle
        pull, stiff = reach * self.radius, k * k + 0.0 * reach
        middle = height / k - phase
        low, high = np.round(-phase / TURN), np.round((self.angle - phase) / TURN)
        nearest = np.clip(np.round(middle / TURN), low, high)
        with np.errstate(over="ignore"):  # what is too large is inf, as where nothing pulls
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

    def _minima(self, own: tuple[Array, ...]) -> Iterator[Array]:
        """Angles of all local minima of the distance to an arc that grows, one for each turn.

        With w = a - phase, R = radius + g a and `reach` from the axis to the point, half the
        squared distance D has ``D'' = reach (R cos w + 2 g sin w) + g^2 + k^2``. Its derivative
        vanishes where ``tan w = 3 g/R``: as R is not negative and tan w - 3 g/R rises, once in each
        half turn. So D'' has one peak a turn. Between a peak and a minimum of D, where D'' >= 0, it
        falls away from the peak: D' is concave to the right of it, convex to the left. So Newton
        from the peak, or from the end of the arc before it, never steps over the root.
        """
        x, y, _ = own
        phase = np.arctan2(y, x)
        g = self.growth / self.angle
        for turn in range(-1, math.ceil(float(np.max(self.angle)) / TURN) + 2):
            base = phase + TURN * turn
            peak = np.clip(base, 0.0, self.angle)
            for _ in range(ROUNDS_MAX):  # each leaves a third of the error at most
                before = peak
                ahead = np.arctan2(3.0 * g, self.radius + g * peak)
                peak = np.clip(base + ahead, 0.0, self.angle)
                if (np.abs(peak - before) <= STEP_DONE * self.angle).all():
                    break
            yield self._newton(own, peak)

    def _newton(self, own: tuple[Array, ...], start: Array) -> Array:
        """Where the distance has no slope: Newton from angles (n,), while it is convex."""
        found = start.copy()
        rows = np.arange(len(start))
        arcs, near, angle = self, own, start
        for _ in range(ROUNDS_MAX):
            gap = [a - b for a, b in zip(near, arcs._local(angle), strict=True)]
            slope, curve = arcs._slopes(angle)
            value = sum(a * s for a, s in zip(gap, slope, strict=True))
            change = sum(s * s - a * c for a, c, s in zip(gap, curve, slope, strict=True))
            step = np.divide(value, change, out=np.zeros_like(angle), where=change > 0.0)
            moved = np.clip(angle + step, 0.0, arcs.angle)
            found[rows] = moved
            going = np.abs(moved - angle) > STEP_DONE * arcs.angle
            if not going.any():
                break
            rows, angle = rows[going], moved[going]
            near = tuple(v[going] for v in near)
            arcs = arcs[going] if np.ndim(arcs.angle) else arcs
        return found


def unwrapped(values: Array, period: float) -> Array:
    """Values (n,) less the jumps of whole periods between one and the next."""
    jumps = np.rint(np.diff(values) / period)
    if not jumps.any():
        return values
    found = values.copy()
    found[1:] -= period * np.cumsum(jumps)
    return found


def kepler_root(pull: Array, stiff: Numbers, way: Array, reach: Array) -> Array:
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
