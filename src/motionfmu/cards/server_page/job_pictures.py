"""Pictures of jobs that were opened on the page: their lines and speeds, beside their bytes."""

import hashlib
from collections import OrderedDict
from dataclasses import dataclass
from typing import Any

import numpy as np

from motionfmu.cards.card_job import Job, decode
from motionfmu.cards.config import CardConfig

POINTS = 12_000  # of a picture
KEPT = 16  # jobs


@dataclass(frozen=True)
class OpenedJob:
    """A job, and its picture."""

    job: bytes
    picture: dict[str, Any]


class Pictures:
    """The last jobs that were opened, by the SHA-256 of their files."""

    def __init__(self) -> None:
        self._kept: OrderedDict[str, OpenedJob] = OrderedDict()

    def get(self, digest: str) -> OpenedJob | None:
        """A job that is still kept."""
        return self._kept.get(digest)

    def add(self, opened: OpenedJob) -> None:
        """Keep a job; the oldest goes."""
        digest = opened.picture["job"]
        self._kept[digest] = opened
        self._kept.move_to_end(digest)
        while len(self._kept) > KEPT:
            self._kept.popitem(last=False)


def opened(data: bytes, name: str, config: CardConfig | None, page: int = 1) -> OpenedJob:
    """A job file, or a drawing that is planned for the configuration; InputError if neither."""
    told = {"notes": [], "page": 1, "pages": 1}
    if not data.startswith(b"MCJ1"):
        data, told = _planned(data, name, config, page)
    return OpenedJob(data, picture(decode(data, name), data, name) | told)


def _planned(
    data: bytes, name: str, config: CardConfig | None, page: int
) -> tuple[bytes, dict[str, Any]]:
    from motionfmu.base.errors import InputError
    from motionfmu.cards import plan
    from motionfmu.drawings import reading

    if config is None:
        raise InputError(f"{name}: a drawing needs the card's configuration: fill it in first")
    drawing = reading.parse(data, name, page=page)
    told = {"notes": [n.text for n in drawing.notes], "page": drawing.page, "pages": drawing.pages}
    return plan.plan(drawing, config).job, told


def picture(job: Job, data: bytes, name: str) -> dict[str, Any]:
    """Points of a job's lines for a screen: position [mm], speed [mm/s], pen and frame of each."""
    scale = np.array([1e3 / p if p else 0.0 for p in job.pulses_per_m])
    places = np.vstack([np.zeros((1, 4)), job.positions * scale])
    steps = np.hypot(*(job.commands * scale)[:, :2].T)
    speed = steps / (1e-9 * job.period_ns)
    down = pen_down(job, places[1:, 2])
    keep = _kept(places[:, :2], down)
    drawn = places[1:][down][:, :2]
    span = drawn if len(drawn) else places[:, :2]
    return {
        "job": hashlib.sha256(data).hexdigest(),
        "name": name,
        "time": job.time,
        "frames": len(job.commands),
        "bytes": len(data),
        "pulses_per_mm": [p / 1e3 for p in job.pulses_per_m],
        "drawn": float(steps[down].sum()),
        "moved": float(steps[~down].sum()),
        "lines": int(np.count_nonzero(np.diff(down.astype(int), prepend=0) == 1)),
        "fastest": float(speed[down].max(initial=0.0)),  # with the tool down
        "low": span.min(axis=0).round(3).tolist(),
        "high": span.max(axis=0).round(3).tolist(),
        "frame": keep.tolist(),
        "x": places[keep, 0].round(3).tolist(),
        "y": places[keep, 1].round(3).tolist(),
        # Of the way that leads to each point.
        "speed": speed[np.maximum(keep - 1, 0)].round(1).tolist() if len(speed) else [],
        "down": down[np.maximum(keep - 1, 0)].astype(int).tolist() if len(speed) else [],
    }


def pen_down(job: Job, height: np.ndarray) -> np.ndarray:
    """Whether the pen is down in each frame: by its events, or by the way of the third axis."""
    if job.events and np.any(job.frame_events):
        at = np.where(job.frame_events > 0, np.arange(len(job.frame_events)), -1)
        last = np.maximum.accumulate(at)
        return (last >= 0) & (job.frame_events[np.maximum(last, 0)] == 1)
    if job.mask & 4 and len(height) and height.min() < height.max():
        return height <= 0.5 * (height.min() + height.max())
    return np.ones(len(height), bool)


def _kept(places: np.ndarray, down: np.ndarray) -> np.ndarray:
    """Points of the picture: evenly spaced in length and angle, and wherever the pen moves."""
    count = len(places)
    if count <= POINTS:
        return np.arange(count)
    ways = np.diff(places, axis=0)
    length = np.hypot(*ways.T)
    heading = np.unwrap(np.arctan2(ways[:, 1], ways[:, 0]))
    turn = np.abs(np.diff(heading, prepend=heading[0])) * (length > 0)
    weight = length / (length.sum() or 1.0) + turn / (turn.sum() or 1.0)
    along = np.concatenate([[0.0], np.cumsum(weight)])
    even = np.searchsorted(along, np.linspace(0.0, along[-1], POINTS)).clip(0, count - 1)
    moves = np.flatnonzero(np.diff(down.astype(int))) + 1
    return np.unique(np.concatenate([[0], even, moves, [count - 1]]))
