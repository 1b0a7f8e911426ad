"""The way of a drag knife's axis, behind which its edge follows a path.

The edge E trails the axis A by the offset d and is drawn towards it: E' = h (h . A') with the
heading h = (A - E) / d. It follows a path C if A = C + d t with the path's unit tangent t, for then
A - E = d t and E' = C' is along t. So along a line the axis goes d ahead of the edge. Along an arc
of radius R it goes on one of sqrt(R^2 + d^2) about the same centre. About a corner it goes on an
arc of radius d, on which the edge turns in its place.
"""

import numpy as np

from motionfmu.drawings.pen_path import CHORD, Array, PathMaker, PenPath, at_share, joined, tidy

_STRAIGHT = 1e-6  # [rad] turns below it are none
_STEPS_MAX = 4096  # points of the axis along one curve


def knife_path(path: PenPath, closed: bool, offset: float, heading: Array) -> tuple[PenPath, Array]:
    """The axis' way along a path, from the heading that the edge has, and that at its end.

    A closed path is cut on over its begin by the offset, so that the cut closes.
    """
    whole = joined([path, *_begin(path, offset)]) if closed else path
    maker = _AxisWay(whole.nodes[0], offset, heading)
    ways = whole.headings()
    soft = _soft(whole, ways, offset)
    centres = whole.centres()
    for k in range(len(whole.source)):
        maker.source = int(whole.source[k])
        begin, end = whole.nodes[k], whole.nodes[k + 1]
        first, last = ways[k]
        if k and soft[k - 1]:
            first = _between(ways[k - 1, 1], first)
        if k < len(soft) and soft[k]:
            last = _between(last, ways[k + 1, 0])
        maker.turn(begin, first)
        if whole.curved[k]:
            maker.follow(whole.piece(k))
        elif whole.bulges[k]:
            maker.round(centres[k], end, float(whole.bulges[k]), last)
        else:
            maker.straight(end, last)
    return maker.path(), maker.heading


def _soft(path: PenPath, ways: Array, offset: float) -> Array:
    """Inner nodes between lines that turn so little that the axis goes straight on past them.

    There it is on the bisector, and nowhere farther than CHORD from where the edge would need it.
    """
    before, behind = ways[:-1, 1], ways[1:, 0]
    cosine = (before * behind).sum(axis=1)
    least = 1.0 - CHORD / offset if offset > CHORD else 0.0
    half = np.sqrt(np.maximum(0.0, 0.5 + 0.5 * cosine))  # of half the angle
    straight = ~(path.curved | (path.bulges != 0.0))
    found: Array = (half >= least) & straight[:-1] & straight[1:]
    return found


def _between(a: Array, b: Array) -> Array:
    return (a + b) / np.hypot(*(a + b))


def _begin(path: PenPath, length: float) -> list[PenPath]:
    """The begin of a path, whole pieces of chords or a part of one, of a length."""
    points, _ = path.with_chords()
    way = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1))])
    n = int(np.searchsorted(way, length))
    if n >= len(points):
        return [path]
    share = (length - way[n - 1]) / (way[n] - way[n - 1])
    end = points[n - 1] + share * (points[n] - points[n - 1])
    return [tidy(PenPath.lines(np.vstack([points[:n], end]), int(path.source[0])))]


class _AxisWay:
    """The axis' way, piece by piece."""

    def __init__(self, start: Array, offset: float, heading: Array) -> None:
        self.offset, self.heading, self.source = offset, heading, 0
        self._at = start + offset * heading
        self._parts = [PenPath.lines(self._at[None])]

    def _add(self, maker: PathMaker) -> None:
        self._at = maker.at
        self._parts.append(maker.path())

    def turn(self, corner: Array, heading: Array) -> None:
        """Turn the edge in its place."""
        h = self.heading
        angle = np.arctan2(h[0] * heading[1] - h[1] * heading[0], h @ heading)
        self.heading = heading
        if abs(angle) > _STRAIGHT:
            maker = PathMaker(self._at, self.source)
            maker.arc(corner + self.offset * heading, np.tan(angle / 4.0))
            self._add(maker)

    def straight(self, end: Array, heading: Array) -> None:
        """Cut to a place, where the edge has this heading."""
        maker = PathMaker(self._at, self.source)
        maker.line(end + self.offset * heading)
        self.heading = heading
        self._add(maker)

    def round(self, centre: Array, end: Array, bulge: float, heading: Array) -> None:
        """Cut along an arc."""
        arm = end - centre
        self.heading = heading
        maker = PathMaker(self._at, self.source)
        maker.arc(centre + arm + self.offset * heading, bulge)
        self._add(maker)

    def follow(self, cubic: Array) -> None:
        """Cut along a cubic curve: the axis goes in chords."""
        n = 8
        while True:
            places, last = _ahead(cubic, np.arange(1, n + 1) / n, self.offset)
            every = np.vstack([self._at, places])
            middle, _ = _ahead(cubic, (np.arange(n) + 0.5) / n, self.offset)
            off = np.abs(0.5 * (every[1:] + every[:-1]) - middle).max()
            if off <= CHORD or n >= _STEPS_MAX:
                break
            n *= 2
        self.heading, self._at = last, places[-1]
        self._parts.append(tidy(PenPath.lines(every, self.source)))

    def path(self) -> PenPath:
        """All of it."""
        return joined(self._parts)


def _ahead(cubic: Array, t: Array, offset: float) -> tuple[Array, Array]:
    """Places an offset ahead of a curve along its tangents, and the last tangent."""
    d = np.diff(cubic, axis=0)
    u = t[:, None]
    along = (1 - u) ** 2 * d[0] + 2 * u * (1 - u) * d[1] + u**2 * d[2]
    size = np.linalg.norm(along, axis=1)
    rest = size < 1e-12 * max(1.0, float(np.abs(d).max()))
    if rest.any():  # a handle of no length: what the curve comes from
        back = at_share(cubic, t[rest]) - at_share(cubic, t[rest] - 1e-6)
        along[rest] = back
        size = np.linalg.norm(along, axis=1)
    unit = along / np.maximum(size, 1e-300)[:, None]
    return at_share(cubic, t) + offset * unit, unit[-1]
