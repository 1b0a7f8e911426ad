"""Lines that a tool follows in the plane: straight, along arcs of circles and cubic curves."""

from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]

CHORD = 0.005  # [mm] farthest chord from an arc or a curve, where lines take its place
# [mm] A cubic curve is this near to a curve of another kind, an ellipse or a rational spline.
NEAR = 1e-4
SAME = 1e-6  # [mm] points nearer than this are one; files round more coarsely
_PIECES_MAX = 3600  # chords of one arc or curve
_HALVINGS_MAX = 12


@dataclass(frozen=True, eq=False)
class PenPath:
    """A path through nodes. A piece, from node to node, is a line, an arc or a cubic curve."""

    nodes: Array  # (n, 2) [mm]
    # (n - 1,) tan(angle / 4) of arcs, positive to the left, at most half a circle; 0 for others
    bulges: Array
    handles: Array  # (n - 1, 4) [mm] both inner control points of curves; else nan
    source: NDArray[np.int64]  # (n - 1,) place in the drawing's file

    @staticmethod
    def lines(nodes: Array, source: int = 0) -> "PenPath":
        """Straight lines through nodes."""
        n = max(len(nodes) - 1, 0)
        return PenPath(
            nodes, np.zeros(n), np.full((n, 4), np.nan), np.full(n, source, dtype=np.int64)
        )

    @property
    def curved(self) -> NDArray[np.bool_]:
        """Which pieces are cubic curves."""
        found: NDArray[np.bool_] = np.isfinite(self.handles[:, 0])
        return found

    @property
    def reversed(self) -> "PenPath":
        """The same path, driven the other way."""
        handles = self.handles[::-1][:, [2, 3, 0, 1]]
        return PenPath(self.nodes[::-1], -self.bulges[::-1], handles, self.source[::-1])

    def moved(self, scale: float, shift: Sequence[float]) -> "PenPath":
        """The path larger by a factor above 0, then elsewhere [mm]."""
        far = np.array(shift, float)
        handles = self.handles * scale + np.tile(far, 2)
        return PenPath(self.nodes * scale + far, self.bulges, handles, self.source)

    def centres(self) -> Array:
        """Centres of the arcs; of other pieces nan."""
        a, b, bulge = self.nodes[:-1], self.nodes[1:], self.bulges[:, None]
        left = (b - a)[:, ::-1] * [-1.0, 1.0]
        with np.errstate(divide="ignore", invalid="ignore"):
            return 0.5 * (a + b) + left * (1.0 - bulge**2) / (4.0 * bulge)

    def piece(self, k: int) -> Array:
        """Control points of a cubic curve."""
        return np.vstack([self.nodes[k], self.handles[k].reshape(2, 2), self.nodes[k + 1]])

    def piece_path(self, k: int) -> "PenPath":
        """One of its pieces; -1 is the last."""
        k %= len(self.source)
        one = slice(k, k + 1)
        return PenPath(self.nodes[k : k + 2], self.bulges[one], self.handles[one], self.source[one])

    def with_chords(self, tolerance: float = CHORD) -> tuple[Array, NDArray[np.int64]]:
        """Vertices of chords within a tolerance of the path, and which of them the nodes are."""
        straight = ~(self.curved | (self.bulges != 0.0))
        if straight.all():
            return self.nodes, np.arange(len(self.nodes))
        parts, at, places = [self.nodes[:1]], 0, [0]
        centres = self.centres()
        for k in range(len(self.bulges)):
            if straight[k]:
                found = self.nodes[k + 1 : k + 2]
            elif self.bulges[k]:
                found = _arc_points(self.nodes[k], centres[k], self.bulges[k], tolerance)
                found[-1] = self.nodes[k + 1]
            else:
                found = _curve_points(self.piece(k), tolerance)
            parts.append(found)
            at += len(found)
            places.append(at)
        return np.vstack(parts), np.array(places)

    @cached_property
    def points(self) -> Array:
        """Vertices of chords within CHORD of the path."""
        return self.with_chords()[0]

    def headings(self) -> Array:
        """Unit vectors along the begin and the end of each piece, (n - 1, 2, 2)."""
        way = np.diff(self.nodes, axis=0)
        angle = 2.0 * np.arctan(self.bulges)  # half that of the arc
        found = np.stack([_turned(way, -angle), _turned(way, angle)], axis=1)
        for k in np.flatnonzero(self.curved).tolist():
            p = self.piece(k)
            found[k] = _first(p[1:] - p[0]), _first(p[-1] - p[-2::-1])
        size = np.linalg.norm(found, axis=2, keepdims=True)
        return np.divide(found, size, out=np.zeros_like(found), where=size > 0.0)


def _first(ways: Array) -> Array:
    """The first way that leads anywhere."""
    long = np.abs(ways).max(axis=1) > SAME
    return ways[int(np.argmax(long))]


def _turned(ways: Array, angles: Array) -> Array:
    c, s = np.cos(angles), np.sin(angles)
    return np.stack([c * ways[:, 0] - s * ways[:, 1], s * ways[:, 0] + c * ways[:, 1]], axis=1)


def chords(radius: float, angle: float, tolerance: float) -> int:
    """Number of chords of an arc [rad] that stay within a tolerance of it."""
    share = min(1.0, tolerance / radius) if radius > 0.0 else 1.0
    step = 2.0 * np.arccos(1.0 - share) if share > 1e-12 else 0.0
    if step * _PIECES_MAX <= abs(angle):
        return _PIECES_MAX
    return max(1, int(np.ceil(abs(angle) / step)))


def _arc_points(start: Array, centre: Array, bulge: float, tolerance: float) -> Array:
    """Vertices along an arc behind its start."""
    angle = 4.0 * np.arctan(bulge)
    arm = start - centre
    n = chords(float(np.hypot(*arm)), angle, tolerance)
    turn = np.arange(1, n + 1) / n * angle
    return centre + _turned(np.tile(arm, (n, 1)), turn)


def at_share(cubic: Array, t: Array) -> Array:
    """Points of a cubic curve at parameters from 0 to 1."""
    u = t[:, None]
    parts = [(1 - u) ** 3, 3 * u * (1 - u) ** 2, 3 * u**2 * (1 - u), u**3]
    return np.hstack(parts) @ cubic


def bend_of(cubic: Array) -> float:
    """The largest curvature of a cubic curve [1/mm], where it is slow, or of 65 points."""
    d = 3.0 * np.diff(cubic, axis=0)
    # C' = a + b t + c t^2, and the derivative of |C'|^2, whose zeros are where it is slow.
    a, b, c = d[0], 2.0 * (d[1] - d[0]), d[0] - 2.0 * d[1] + d[2]
    slow = np.roots([4.0 * (c @ c), 6.0 * (b @ c), 4.0 * (a @ c) + 2.0 * (b @ b), 2.0 * (a @ b)])
    slow = slow.real[(np.abs(slow.imag) < 1e-6) & (slow.real > 0.0) & (slow.real < 1.0)]
    t = np.concatenate([np.linspace(0.0, 1.0, 65), slow])[:, None]
    first, second = a + b * t + c * t**2, b + 2.0 * c * t
    cross = np.abs(first[:, 0] * second[:, 1] - first[:, 1] * second[:, 0])
    size = np.maximum(np.linalg.norm(first, axis=1), 1e-12)
    still = bool((size < 1e-9 * max(1.0, float(np.abs(d).max()))).any())
    return np.inf if still else float((cross / size**3).max())


def shares(cubic: Array, tolerance: float) -> Array:
    """Parameters of vertices whose chords are within a tolerance of a cubic curve, without 0."""
    bend = 6.0 * np.linalg.norm(np.diff(cubic, 2, axis=0), axis=1).max()
    n = min(_PIECES_MAX, max(1, int(np.ceil(np.sqrt(bend / 8.0 / tolerance)))))
    return np.arange(1, n + 1) / n


def _curve_points(cubic: Array, tolerance: float) -> Array:
    return at_share(cubic, shares(cubic, tolerance))


class PathMaker:
    """Builds a path piece by piece."""

    def __init__(self, start: Iterable[float], source: int = 0) -> None:
        self._nodes = [np.array(list(start), float)]
        self._bulges: list[float] = []
        self._handles: list[Array] = []
        self._source = source

    @property
    def at(self) -> Array:
        """Where the path ends."""
        return self._nodes[-1]

    @property
    def empty(self) -> bool:
        """Whether it has no piece."""
        return not self._bulges

    def line(self, end: Iterable[float]) -> None:
        """Go straight on."""
        self._add(end, 0.0, np.full(4, np.nan))

    def arc(self, end: Iterable[float], bulge: float) -> None:
        """Go along an arc of at most half a circle; tan(angle / 4), positive to the left."""
        self._add(end, bulge, np.full(4, np.nan))

    def cubic(self, first: Array, second: Array, end: Iterable[float]) -> None:
        """Go along a cubic curve by its control points."""
        self._add(end, 0.0, np.concatenate([first, second]))

    def _add(self, end: Iterable[float], bulge: float, handles: Array) -> None:
        self._nodes.append(np.array(list(end), float))
        self._bulges.append(bulge)
        self._handles.append(handles)

    def ellipse(self, axes: "EllipseAxes", begin: float, end: float) -> None:
        """Go along an ellipse from the parameter `begin` to `end` [rad]."""
        u, v = axes.u, axes.v
        size = max(np.hypot(*u), np.hypot(*v))
        round_ = abs(np.hypot(*u) - np.hypot(*v)) < 1e-9 * size and abs(u @ v) < 1e-9 * size**2
        sweep = end - begin
        if round_:
            n = max(1, int(np.ceil(abs(sweep) / np.pi - 1e-9)))
            turn = np.sign(u[0] * v[1] - u[1] * v[0])
            for k in range(1, n + 1):
                self.arc(axes.at(begin + sweep * k / n), turn * np.tan(sweep / n / 4.0))
            return
        # The image of a circle's cubic, which is off by 4/27 sin^6(a/4) / cos^2(a/4) of the radius.
        n = max(1, int(np.ceil(abs(sweep) / (np.pi / 2.0) - 1e-9)))
        while _off_circle(sweep / n) * size > NEAR and n < _PIECES_MAX:
            n += 1
        k = 4.0 / 3.0 * np.tan(sweep / n / 4.0)
        for i in range(n):
            a, b = begin + sweep * i / n, begin + sweep * (i + 1) / n
            first, last = axes.at(a) + k * axes.along(a), axes.at(b) - k * axes.along(b)
            self.cubic(first, last, axes.at(b))

    def close(self) -> None:
        """Go back to the start, unless it is there."""
        if np.abs(self.at - self._nodes[0]).max() > SAME:
            self.line(self._nodes[0])
        else:
            self._nodes[-1] = self._nodes[0]

    def path(self) -> PenPath:
        """The path as built, without pieces that lead nowhere."""
        n = len(self._bulges)
        whole = PenPath(
            np.array(self._nodes),
            np.array(self._bulges, float),
            np.array(self._handles, float).reshape(n, 4),
            np.full(n, self._source, dtype=np.int64),
        )
        return tidy(whole)


def tidy(path: PenPath) -> PenPath:
    """A path without pieces that lead nowhere, and arcs that are straight as lines."""
    size = np.abs(np.diff(path.nodes, axis=0)).max(axis=1, initial=0.0)
    reach = np.abs(path.handles.reshape(-1, 2, 2) - path.nodes[:-1, None]).max(axis=(1, 2))
    keep = (size > SAME) | (path.curved & (reach > SAME))
    flat = np.abs(path.bulges) * size < SAME  # twice the height of the arc above its chord
    nodes = np.vstack([path.nodes[:1], path.nodes[1:][keep]])
    bulges = np.where(flat, 0.0, path.bulges)
    return PenPath(nodes, bulges[keep], path.handles[keep], path.source[keep])


def _off_circle(angle: float) -> float:
    return float(4.0 / 27.0 * np.sin(angle / 4.0) ** 6 / np.cos(angle / 4.0) ** 2)


@dataclass(frozen=True, eq=False)
class EllipseAxes:
    """An ellipse: its centre and two of its radii that are conjugate, all in mm."""

    centre: Array
    u: Array
    v: Array

    def at(self, t: float) -> Array:
        """The point centre + u cos t + v sin t."""
        return self.centre + self.u * np.cos(t) + self.v * np.sin(t)

    def along(self, t: float) -> Array:
        """The derivative of `at` by t."""
        return self.v * np.cos(t) - self.u * np.sin(t)


def cubics_of(
    place: Callable[[float], tuple[Array, Array]], begin: float, end: float
) -> list[Array]:
    """Cubic curves within NEAR of a smooth curve from a parameter to another.

    place: point and its derivative by the parameter.
    """
    found: list[Array] = []
    share = np.array([1 / 8, 1 / 4, 3 / 8, 1 / 2, 5 / 8, 3 / 4, 7 / 8])

    def between(a: float, b: float, depth: int) -> None:
        (p, dp), (q, dq) = place(a), place(b)
        third = (b - a) / 3.0
        cubic = np.vstack([p, p + third * dp, q - third * dq, q])
        there = np.array([place(a + s * (b - a))[0] for s in share])
        off = np.linalg.norm(at_share(cubic, share) - there, axis=1).max()
        if off <= NEAR or depth == 0:
            found.append(cubic)
        else:
            middle = 0.5 * (a + b)
            between(a, middle, depth - 1)
            between(middle, b, depth - 1)

    between(begin, end, _HALVINGS_MAX)
    return found


def joined(parts: Sequence[PenPath]) -> PenPath:
    """Paths one after the other, with a line between two that do not meet."""
    nodes, source = [parts[0].nodes], list[NDArray[np.int64]]()
    bulges, handles = list[Array](), list[Array]()
    at = parts[0].nodes[-1]
    for k, part in enumerate(parts):
        if k:
            if np.abs(part.nodes[0] - at).max() > SAME:
                nodes.append(part.nodes)
                bulges.append(np.zeros(1))
                handles.append(np.full((1, 4), np.nan))
                source.append(part.source[:1] if len(part.source) else source[-1][-1:])
            else:
                nodes.append(part.nodes[1:])
            at = part.nodes[-1]
        bulges.append(part.bulges)
        handles.append(part.handles)
        source.append(part.source)
    return PenPath(
        np.vstack(nodes), np.concatenate(bulges), np.vstack(handles), np.concatenate(source)
    )
