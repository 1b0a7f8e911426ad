"""Where a recorded cycle goes through planes across the command path, one after the other."""

from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.iso9283.command_path import CommandPath
from motionfmu.analysis.iso9283.cycles import Cycle
from motionfmu.analysis.iso9283.turn import Array, between, unit

# Samples that are looked at together at first; twice as many each time without success.
CHUNK = 64
# A crossing counts if it is nearer to the path than this part of the path's extent.
REACH = 0.25
# A tool that is near a plane goes at most so many times the way of the path, and the reach on top,
# until it has crossed it: else it began behind the plane, and a closed path would bring it back.
DETOUR = 3.0
# Behind a bend of the path the planes turn: a tool off to the inner side has crossed the next one
# before the last one, by at most so many times what it was off; the search goes back so far.
STRAIGHT_ON, BACK = 1.0 - 1e-9, 4.0


@dataclass(frozen=True)
class Crossings:
    """Points of one cycle in the planes; NaN where it does not come through."""

    time: Array  # (m,) [s]
    point: Array  # (m, 3) [mm]
    turn: Array | None  # (m, 4)


def crossings(cycle: Cycle, path: CommandPath, places: Array) -> Crossings:
    """First way of a cycle through each plane across the path, in the path's direction."""
    # Planes come in the order of the path: the search goes on where the last one was crossed.
    # So a path that comes back to its own planes, as a circle or a letter does, is no trouble.
    centre, way = path.at(places), path.direction(places)
    reach = REACH * float(np.linalg.norm(np.ptp(path.points, axis=0)))
    sample = np.full(len(places), -1)
    share = np.full(len(places), np.nan)
    steps = np.linalg.norm(np.diff(cycle.position, axis=0), axis=1)
    gone = np.concatenate([[0.0], np.cumsum(steps)])
    start, place, off = 0, 0.0, 0.0
    for i in range(len(places)):
        if i and way[i] @ way[i - 1] < STRAIGHT_ON:
            start = int(np.searchsorted(gone, gone[start] - BACK * off))
        near = float(np.linalg.norm(cycle.position[start] - centre[i])) <= reach
        room = DETOUR * (places[i] - place) + reach if near else np.inf
        stop = int(np.searchsorted(gone, gone[start] + room, side="right")) + 1
        found = _first(cycle.position[:stop], start, (centre[i], way[i]), reach)
        if found is not None:
            sample[i], share[i] = found
            start, place = found[0], places[i]
            ends = cycle.position[start : start + 2]
            off = float(np.linalg.norm(ends[0] + found[1] * (ends[1] - ends[0]) - centre[i]))
    k = np.maximum(sample, 0)
    there = (sample >= 0)[:, None]

    def put(values: Array) -> Array:
        rows = values.reshape(len(values), -1)
        return np.where(there, rows[k] + share[:, None] * (rows[k + 1] - rows[k]), np.nan)

    turn = None
    if cycle.quaternion is not None:
        q = unit(cycle.quaternion)
        turn = np.where(there, between(q[k], q[k + 1], np.nan_to_num(share)), np.nan)
    return Crossings(put(cycle.time)[:, 0], put(cycle.position), turn)


def _first(
    position: Array, start: int, plane: tuple[Array, Array], reach: float
) -> tuple[int, float] | None:
    """Sample before the first crossing near the path, and how far it is to the next sample."""
    centre, way = plane
    count, size = len(position), CHUNK
    while start < count - 1:
        part = position[start : start + size + 1] - centre
        height = part @ way
        up = np.flatnonzero((height[:-1] <= 0.0) & (height[1:] >= 0.0) & (np.diff(height) > 0.0))
        for k in up.tolist():
            share = float(-height[k] / (height[k + 1] - height[k]))
            if np.linalg.norm(part[k] + share * (part[k + 1] - part[k])) <= reach:
                return start + k, share
        start += size
        size *= 2
    return None
