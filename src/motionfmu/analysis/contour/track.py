"""A position that is followed along the exact path."""

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import TURN, Array, unwrapped
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.scaled_values import blocks, places
from motionfmu.analysis.contour.segments import ARC, Index
from motionfmu.base.columns import room


@dataclass(frozen=True, eq=False)
class Track:
    """Nearest points of some samples on the path."""

    path: Path
    segment: Index  # (n,) index; never decreases
    along: Array  # (n,) way along the whole path [mm]
    distance: Array  # (n,) to them [mm]
    right: NDArray[np.bool_] | None  # (n,) of the direction of travel; None for a path in space

    @property
    def signed(self) -> Array | None:
        """The distance (n,), negative to the right of the direction of travel [mm]."""
        return None if self.right is None else np.where(self.right, -self.distance, self.distance)

    @property
    def foot(self) -> Array:
        """Nearest points (n, 3) [mm]."""
        return self.feet(slice(None))

    def feet(self, rows: Any) -> Array:
        """Nearest points (m, 3) of some samples [mm]."""
        which = self.segment[rows]
        return self.path.segments.at(which, self.along[rows] - self.path.offsets[which])


def follow(positions: Any, path: Path, owners: Index) -> Track:
    """Nearest points of positions (n, 3 or more) [mm] on the segments they belong to."""
    count = len(owners)
    along, distance = (room(count, np.float64, positions) for _ in range(2))
    right = None if path.normal is None else room(count, np.bool_, positions)
    for own in blocks(count, positions, owners, along, distance, right):
        points, which = places(positions, own), owners[own]
        near = path.segments.foot(points, which)
        along[own], distance[own] = near.along, near.distance
        if right is not None and path.normal is not None:
            (u, v, w), (x, y, z) = (points - near.point).T, near.tangent.T
            left = (v * z - w * y, w * x - u * z, u * y - v * x)  # tangent x gap
            right[own] = sum(n * c for n, c in zip(path.normal, left, strict=True)) > 0.0
    _unwrap(along, path, owners)
    for own in blocks(count, along, owners):
        along[own] += path.offsets[owners[own]]
    return Track(path, owners, along, distance, right)


def _unwrap(along: Array, path: Path, owners: Index) -> None:
    """Convert positions on circles [mm] to positions on arcs of more than one turn."""
    columns, arcs = path.segments.columns, path.segments.arcs
    # a shorter arc has no two points that are half a turn apart
    wide = (columns.turned[:, 0] > 0.5 * TURN) & (columns.turned[:, 1] == 0.0)
    for s in np.flatnonzero(columns.shape == ARC)[wide].tolist():
        a, b = np.searchsorted(owners, [s, s + 1])
        if a < b:
            k = path.segments.place[s]
            turn = TURN / arcs.angle[k] * arcs.length[k]
            way = unwrapped(along[a:b], turn)
            way = way - turn * np.round(way[0] / turn)
            along[a:b] = np.clip(way, 0.0, arcs.length[k])
