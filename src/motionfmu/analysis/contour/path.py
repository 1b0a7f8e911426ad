"""The planned path, as exact segments in the order of the program."""

from collections.abc import Iterable
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import TURN, Array
from motionfmu.analysis.contour.geometry import Segment
from motionfmu.analysis.contour.segments import ARC, CUBIC, KINDS, LINE, Index, Segments

# A move lies in a plane if it leaves it by less than this [mm]; a tenth of the finest pulse.
FLAT = 1e-5
# Number of points of a turn, and of a curve, in a picture.
STEPS = 90


class Path:
    """All segments of a program.

    Parameters
    ----------
    segments : iterable of Segment
        In the order of travel; delays are not among them. Kept as columns: a path of a million
        segments takes little room, and `segments` makes each one when it is asked for.

    Raises
    ------
    ValueError
        There are none, or their commands do not increase.
    """

    def __init__(self, segments: Iterable[Segment]) -> None:
        self.segments = segments if isinstance(segments, Segments) else Segments.of(segments)
        if not len(self.segments):
            raise ValueError("the path has no segments")
        numbers = self.commands
        back = np.flatnonzero(np.diff(numbers) <= 0)
        if len(back):
            before, after = numbers[back[0]], numbers[back[0] + 1]
            raise ValueError(f"command {after} follows command {before} in the path")

    def __repr__(self) -> str:
        return f"<Path: {len(self.segments)} segments, {self.offsets[-1]:.6g} mm>"

    @property
    def commands(self) -> Index:
        """Command index of each segment."""
        return self.segments.columns.command

    @property
    def lines(self) -> Index:
        """Line of the part program of each segment."""
        return self.segments.columns.line

    @property
    def feeds(self) -> Array:
        """Programmed feed of each segment [mm/s]."""
        return self.segments.columns.feed

    @cached_property
    def cut(self) -> NDArray[np.bool_]:
        """Which segments are cut: all but point to point moves."""
        return np.asarray(self.segments.columns.kind != KINDS.index("ptp"))

    @property
    def lengths(self) -> Array:
        """Length of each segment [mm]."""
        return self.segments.lengths

    @cached_property
    def offsets(self) -> Array:
        """Length before each segment, and the whole length [mm]."""
        return np.concatenate([[0.0], np.cumsum(self.lengths)])

    @cached_property
    def normal(self) -> Array | None:
        """Unit normal of the working plane; None for a path in space.

        All cutting moves run in the plane or, as plunges do, along its normal. It is that of G17,
        G18 or G19 where one of them fits, else that of an oblique plane, and points to the
        positive side of its largest component.
        """
        ways, straight = self._ways()
        for axis in (2, 1, 0):
            normal = np.eye(3)[axis]
            level = np.abs(ways[:, axis]) <= FLAT
            others = [i for i in range(3) if i != axis]
            plunge = straight & (np.abs(ways[:, others]).max(axis=1) <= FLAT)
            if (plunge | level).all() and not plunge.all():
                return normal
        rows = np.linalg.svd(ways, full_matrices=len(ways) < 3)[2]
        normal = rows[2]
        if np.abs(ways @ rows[1]).max() <= FLAT:  # one direction: any plane through it is right
            normal = np.eye(3)[int(np.argmin(np.abs(rows[0])))]
            normal = normal - (normal @ rows[0]) * rows[0]
            normal /= np.linalg.norm(normal)
        if np.abs(ways @ normal).max() > FLAT:
            return None
        return np.array(normal * np.sign(normal[np.argmax(np.abs(normal))]))

    def _ways(self) -> tuple[Array, NDArray[np.bool_]]:
        """Vectors (n, 3) that span what the cutting moves cover [mm]; which are of lines."""
        c, arcs = self.segments.columns, self.segments.arcs
        cut = self.cut if self.cut.any() else np.ones(len(c.kind), dtype=bool)
        own = cut & (c.shape == LINE)
        round_ = cut[c.shape == ARC]
        scale = np.stack([arcs.radius, arcs.radius, arcs.rise], axis=-1)[round_]
        parts = [c.end[own] - c.start[own]]
        parts += [scale[:, i, None] * arcs.axes[round_, i] for i in range(3)]
        parts += [np.diff(curve.control, axis=0) for i, curve in c.curves.items() if cut[i]]
        ways = np.concatenate(parts)
        return ways, np.arange(len(ways)) < len(parts[0])

    def segment_of(self, command: Index) -> Index:
        """Segment that a command index stands for.

        Parameters
        ----------
        command : ndarray of int, shape (n,)
            Command indices; a delay stands for the segment before it.
        """
        found = np.searchsorted(self.commands, command, side="right") - 1
        return np.clip(found, 0, len(self.segments) - 1)


def outline(segments: Segments, chosen: Index | None = None) -> tuple[Array, Index]:
    """Points (n, 3) [mm] to draw segments by, all or some, and where each begins among them."""
    c = segments.columns
    counts = np.full(len(c.shape), 2)
    counts[c.shape == ARC] = np.maximum(2, np.ceil(segments.arcs.angle / TURN * STEPS) + 1)
    counts[c.shape == CUBIC] = STEPS + 1
    chosen = np.arange(len(counts)) if chosen is None else chosen
    count = counts[chosen]
    which, starts = np.repeat(chosen, count), np.cumsum(count) - count
    share = (np.arange(len(which)) - np.repeat(starts, count)) / np.repeat(count - 1, count)
    return segments.at(which, share * segments.lengths[which]), starts
