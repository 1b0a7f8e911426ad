"""Figures of a plan: times, lengths, deviations, peaks."""

from dataclasses import asdict, dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from motionfmu.cards.config import CardConfig
from motionfmu.cards.plan import DRAWS, PAGE, Plan

# Pages of a slot of the card's flash.
SLOT = 4064
# Number of nearest parts of a line from which a distance is taken, and their least length. [mm]
_NEAR, _SHORTEST = 6, 0.02
_PARTS_MAX = 2_000_000
# A speed above this share of the feed counts as the feed.
_AT_FEED = 0.99


@dataclass(frozen=True)
class Figures:
    """Numbers of a plan."""

    time: float  # [s]
    time_down: float  # [s] drawing
    way_down: float  # [mm]
    way_up: float  # [mm]
    contours: int
    segments: int
    stops: int  # rests within contours
    off: float  # [mm] largest distance of the path from the drawing,
    back: float  # [mm] of the drawing from the path
    speed: list[float]  # [mm/s] of each axis the largest, from the planned places
    acceleration: list[float]  # [mm/s^2]
    jerk: list[float]  # [mm/s^3]
    frames: int
    size: int  # bytes of the job
    flash: float  # its share of a slot of the flash
    at_feed: float  # share of the drawing time at the feed
    planning: float  # [s]

    def numbers(self) -> dict[str, Any]:
        """All figures by name."""
        return asdict(self)


def figures(plan: Plan, config: CardConfig, offset: tuple[float, float] = (0.0, 0.0)) -> Figures:
    """Work out the numbers of a plan."""
    drawing = plan.steps == DRAWS
    ways = np.linalg.norm(steps_of(plan), axis=1)
    places = np.vstack([np.zeros((4, 4)), plan.places, np.repeat(plan.places[-1:], 3, axis=0)])
    peaks = [
        (np.abs(np.diff(places, n, axis=0)).max(axis=0) / plan.period**n).tolist()
        for n in (1, 2, 3)
    ]
    off, back = deviations(plan, offset)
    axes = len(config.axes)
    return Figures(
        time=len(plan.steps) * plan.period,
        time_down=int(drawing.sum()) * plan.period,
        way_down=float(ways[drawing].sum()),
        way_up=float(ways[~drawing].sum()),
        contours=len(plan.contours),
        segments=sum(len(c.points) - 1 for c in plan.contours),
        stops=plan.stops,
        off=off,
        back=back,
        speed=peaks[0][:axes],
        acceleration=peaks[1][:axes],
        jerk=peaks[2][:axes],
        frames=len(plan.steps),
        size=len(plan.job),
        flash=len(plan.job) / PAGE / SLOT,
        at_feed=_at_feed(ways[drawing] / plan.period, config.motion.feed),
        planning=plan.seconds,
    )


def _at_feed(speeds: np.ndarray, feed: float) -> float:
    return float((speeds >= _AT_FEED * feed).mean()) if len(speeds) else 0.0


def steps_of(plan: Plan) -> np.ndarray:
    """Travel of each axis in each frame [mm]."""
    return np.diff(plan.places, axis=0, prepend=np.zeros((1, 4)))


def paths(plan: Plan) -> list[np.ndarray]:
    """Places of X and Y of each contour, its begin included [mm]."""
    drawing = np.concatenate([[False], plan.steps == DRAWS, [False]])
    edges = np.flatnonzero(np.diff(drawing))
    places = np.vstack([np.zeros(4), plan.places])[:, :2]
    return [places[a : b + 1] for a, b in zip(edges[::2], edges[1::2], strict=True)]


def deviations(plan: Plan, offset: tuple[float, float]) -> tuple[float, float]:
    """Largest distance of the path from the contours, and back [mm]."""
    driven = paths(plan)
    lines = [c.points + np.array(offset) for c in plan.contours]
    if len(driven) != len(lines):  # a pen that does not part them
        gone = [p for p in driven if len(p) > 1]
        driven, lines = [np.vstack(gone or driven)], [np.vstack(lines)]
    off = max(distance(p, c) for p, c in zip(driven, lines, strict=True))
    back = max(distance(_dense(c), p) for p, c in zip(driven, lines, strict=True))
    return off, back


def _dense(line: np.ndarray) -> np.ndarray:
    """Closely spaced points along a line."""
    ways = np.linalg.norm(np.diff(line, axis=0), axis=1)
    longest = max(_SHORTEST, float(ways.sum()) / _PARTS_MAX)
    counts = np.maximum(1, np.ceil(ways / longest)).astype(int)
    if not len(ways):
        return line
    begin, step = np.repeat(line[:-1], counts, axis=0), np.diff(line, axis=0) / counts[:, None]
    first = np.repeat(np.cumsum(counts) - counts, counts)
    k = np.arange(counts.sum()) - first
    return np.vstack([begin + k[:, None] * np.repeat(step, counts, axis=0), line[-1:]])


def distance(points: np.ndarray, line: np.ndarray) -> float:
    """Largest distance of points from a line: to those of its parts whose middles are nearest."""
    if len(line) < 2:
        return float(np.linalg.norm(points - line[0], axis=1).max())
    parts = _dense(line)
    begin, way = parts[:-1], np.diff(parts, axis=0)
    square = np.maximum((way**2).sum(axis=1), 1e-300)
    near = min(_NEAR, len(way))
    found = cKDTree(begin + 0.5 * way).query(points, near)[1].reshape(len(points), near)
    most = np.full(len(points), np.inf)
    for k in found.T:
        to = points - begin[k]
        share = np.clip((to * way[k]).sum(axis=1) / square[k], 0.0, 1.0)
        most = np.minimum(most, ((to - share[:, None] * way[k]) ** 2).sum(axis=1))
    return float(np.sqrt(most.max()))


def speeds(plan: Plan) -> np.ndarray:
    """Speed of the tool in X and Y in each frame [mm/s]."""
    return np.linalg.norm(steps_of(plan)[:, :2], axis=1) / plan.period
