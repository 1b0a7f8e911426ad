"""Synthetic runs whose contour error is known from theory."""

import math
from dataclasses import dataclass

import numpy as np
from scipy.signal import lfilter

from motionfmu.analysis.contour import ContourInput, Path
from motionfmu.analysis.contour.geometry import Label, LineSegment, Segment
from motionfmu.analysis.contour.planned_geometry import make_arc

Z = (0.0, 0.0, 1.0)


class Program:
    """A path built move by move; every move gets the next command and line number."""

    def __init__(self, *start: float) -> None:
        self.here = np.array([*start, 0.0][:3])
        self.segments: list[Segment] = []

    def _label(self, kind: str) -> Label:
        number = len(self.segments) + 1
        return Label(number, 10 * number, kind, 0.0)

    def line(self, *end: float, kind: str = "line") -> "Program":
        goal = np.array([*end, self.here[2]][:3])
        self.segments.append(LineSegment(self._label(kind), self.here, goal))
        self.here = goal
        return self

    def arc(self, centre, sweep, rise: float = 0.0, normal=Z) -> "Program":
        centre, normal = np.array([*centre, self.here[2]][:3]), np.array(normal)
        gap = self.here - centre
        c, s = math.cos(sweep), math.sin(sweep)
        turned = gap * c + np.cross(normal, gap) * s + normal * (normal @ gap) * (1.0 - c)
        goal = centre + turned + rise * normal
        kind = "helix" if rise else "arc"
        arc = make_arc(self._label(kind), (self.here, goal), (centre, normal), sweep)
        self.segments.append(arc)
        self.here = goal
        return self

    def path(self) -> Path:
        return Path(tuple(self.segments))


@dataclass
class Machine:
    """Axes that follow with a first-order lag each."""

    gains: tuple[float, float, float] = (50.0, 50.0, 50.0)  # [1/s]
    pulse: float = 0.0  # [mm]; 0 does not round
    backlash: float = 0.0  # [mm]
    fifo: float = 0.02  # [s] how far the written points are ahead of the pulses
    rest: float = 0.5  # [s] before and after the motion
    step: float = 1e-3  # [s]


def run_along(path: Path, feed: float, machine: Machine, ramp: float = 0.0) -> ContourInput:
    """Run a path at a feed [mm/s], reached and left in `ramp` seconds."""
    total = float(path.offsets[-1])
    duration = total / feed + ramp
    time = np.arange(0.0, duration + 2.0 * machine.rest, machine.step)

    def way(t: np.ndarray) -> np.ndarray:
        t = np.clip(t - machine.rest, 0.0, duration)
        if ramp == 0.0:
            return np.minimum(feed * t, total)
        acc = feed / ramp
        end = np.clip(duration - t, 0.0, ramp)
        up = np.minimum(t, ramp)
        s = 0.5 * acc * up**2 + feed * (np.clip(t, ramp, duration - ramp) - ramp)
        return np.clip(s + 0.5 * acc * (ramp**2 - end**2), 0.0, total)

    def owner(s: np.ndarray) -> np.ndarray:
        found = np.searchsorted(path.offsets, s, side="right") - 1
        return np.clip(found, 0, len(path.segments) - 1)

    s = way(time)
    on = owner(s)
    commanded = np.zeros((len(time), 6))
    for k in np.unique(on):
        commanded[on == k, :3] = path.segments[k].at(s[on == k] - path.offsets[k])
    if machine.pulse:
        commanded = np.round(commanded / machine.pulse) * machine.pulse
    command = path.commands[owner(way(time + machine.fifo))]
    actual = commanded.copy()
    for i, gain in enumerate(machine.gains):
        actual[:, i] -= lag_error(commanded[:, i], gain, machine.step)
        if machine.backlash:
            actual[:, i] = play(actual[:, i], machine.backlash)
    return ContourInput(path, time, actual, commanded, command)


def lag_error(commanded: np.ndarray, gain: float, step: float) -> np.ndarray:
    """Exact command minus position of x' = Kp (c - x) for a command linear between samples."""
    decay = math.exp(-gain * step)
    speed = np.diff(commanded, prepend=commanded[0]) / step
    return lfilter([(1.0 - decay) / gain], [1.0, -decay], speed)


def play(position: np.ndarray, width: float) -> np.ndarray:
    """Position of the load behind a backlash of the given width, centred."""
    out = np.empty_like(position)
    load = position[0]
    for i, motor in enumerate(position):
        load = min(max(load, motor - 0.5 * width), motor + 0.5 * width)
        out[i] = load
    return out
