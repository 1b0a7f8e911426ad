"""Segments of src/motion/smooth/shape for rows of commands, and how far they are from the path."""

import itertools
import math
import os
import subprocess
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.interpolate import BPoly, CubicSpline
from scipy.spatial import cKDTree

ROOT = Path(__file__).resolve().parents[2]
BATCH = os.environ.get("SHAPE_BATCH", str(ROOT / "build/tests/shape/shape_batch"))
PLANES = {0: (1, 2), 1: (2, 0), 2: (0, 1)}
Array = np.ndarray


@dataclass
class Segment:
    """One line of shape_batch."""

    kind: str
    length: float
    rest: bool
    data: Array
    feed: float = 0.0

    def at(self, u: Array) -> tuple[Array, Array, Array]:
        """Place, r' and r'' at u."""
        u, d, n = np.asarray(u, float), self.data, len(u)
        if self.kind == "line":
            return d[:6] + u[:, None] * d[6:], np.tile(d[6:], (n, 1)), np.zeros((n, 6))
        if self.kind == "curve":
            control, found = d[6:].reshape(6, 6), []
            for k in range(3):
                degree = 5 - k
                t = (u / self.length)[:, None]
                ways = [math.comb(degree, j) * t**j * (1 - t) ** (degree - j) for j in range(6 - k)]
                found.append(np.hstack(ways) @ control)
                control = degree * np.diff(control, axis=0) / self.length
            return d[:6] + found[0], found[1], found[2]
        if self.kind == "cubic":
            return self._cubic(d[0] + u)
        start, end, (radius, growth, angle, sweep, length, plane) = d[1:7], d[7:13], d[15:21]
        x, (a, b) = (d[0] + u) / length, PLANES[int(plane)]
        turn = np.exp(1j * (angle + sweep * x))
        z = (radius + growth * x) * turn
        first = (1j * sweep * z + growth * turn) / length
        second = (2j * sweep * growth * turn - sweep**2 * z) / length**2
        point, slope = start + x[:, None] * (end - start), np.tile((end - start) / length, (n, 1))
        bend = np.zeros((n, 6))
        for k, values in ((a, z.real + d[13]), (b, z.imag + d[14])):
            point[:, k] = values
        for k, values, more in ((a, first.real, second.real), (b, first.imag, second.imag)):
            slope[:, k], bend[:, k] = values, more
        return point, slope, bend

    def _cubic(self, way: Array) -> tuple[Array, Array, Array]:
        start, end, inner, length = self.data[1:7], self.data[7:13], *np.split(self.data[13:], [6])
        corners = np.vstack([start[:3], inner.reshape(2, 3), end[:3]])
        rates = [3.0 * np.diff(corners, axis=0)]
        rates.append(2.0 * np.diff(rates[0], axis=0))
        curve, rate, second = (BPoly(c[:, None], [0.0, 1.0]) for c in (corners, *rates))
        grid = np.linspace(0.0, 1.0, 4001)
        speed = CubicSpline(grid, np.linalg.norm(rate(grid), axis=1))
        far = speed.antiderivative()
        t = np.interp(way, far(grid), grid)
        for _ in range(4):
            t = np.clip(t - (far(t) - way) / speed(t), 0.0, 1.0)
        point, slope = start + (way / length)[:, None] * (end - start), np.zeros((len(way), 6))
        slope[:, 3:], bend = (end - start)[3:] / length, np.zeros((len(way), 6))
        v = speed(t)[:, None]
        point[:, :3], slope[:, :3], bend[:, :3] = curve(t), rate(t) / v, second(t) / v**2
        bend[:, :3] -= (bend * slope)[:, :3].sum(1)[:, None] * slope[:, :3]
        return point, slope, bend


def shaped(rows: list[str]) -> tuple[list[Segment], list[float]]:
    """The segments of commands in the words of shape_batch.c, and where the commands begin."""
    done = subprocess.run(
        [BATCH], input="\n".join(rows), capture_output=True, text=True, timeout=60
    )
    assert done.returncode == 0, done.stderr
    segments, marks = [], []
    for line in done.stdout.splitlines():
        kind, *numbers = line.split()
        if kind == "mark":
            marks.append(float(numbers[0]))
        elif kind != "commands":
            assert kind in ("line", "curve", "arc", "cubic"), line
            x = [float(n) for n in numbers]
            segments.append(Segment(kind, x[0], x[2] == 1.0, np.array(x[3:]), x[1]))
    return segments, marks


def lines(points: Array, tolerance: float, merge: float = 1e9) -> list[str]:
    """Commands through points of up to six coordinates."""
    full = np.zeros((len(points), 6))
    full[:, : np.shape(points)[1]] = points
    texts = [" ".join(repr(float(x)) for x in p) for p in full]
    return [
        f"merge {merge}",
        f"start {texts[0]}",
        *(f"line {tolerance} 100 {t}" for t in texts[1:]),
    ]


class Chords:
    """An upper bound of distances to a chain of chords: to those whose middles are nearest."""

    def __init__(self, points: Array, longest: float) -> None:
        ways = np.linalg.norm(np.diff(points, axis=0), axis=1)
        counts = np.maximum(1, np.ceil(ways / longest)).astype(int)
        parts = [
            a + np.arange(n)[:, None] / n * (b - a)
            for a, b, n in zip(points[:-1], points[1:], counts, strict=True)
        ]
        self.points = np.vstack([*parts, points[-1:]])
        self.ways = np.diff(self.points, axis=0)
        self.tree = cKDTree(self.points[:-1] + 0.5 * self.ways)

    def distance(self, x: Array) -> Array:
        near = min(10, len(self.ways))
        index = self.tree.query(x, k=near)[1].reshape(len(x), near)
        best = np.full(len(x), np.inf)
        for i in index.T:
            way, off = self.ways[i], x - self.points[i]
            square = np.maximum((way * way).sum(1), 1e-300)
            t = np.clip((off * way).sum(1) / square, 0.0, 1.0)
            best = np.minimum(best, np.linalg.norm(off - t[:, None] * way, axis=1))
        return best


def fine(segments: list[Segment], error: float) -> Array:
    """Points on the segments whose chords are within an error: |r''| h^2 / 8, bound by samples."""
    rows = []
    for p in segments:
        most = np.linalg.norm(p.at(np.linspace(0.0, p.length, 17))[2], axis=1).max() * 1.5
        n = max(4, math.ceil(p.length * math.sqrt(most / (8.0 * error))))
        rows.append(p.at(np.linspace(0.0, p.length, n + 1))[0])
    return np.vstack(rows)


def farthest(points: Array, chords: Chords, limit: float, slack: float = 2e-7) -> float:
    """Bound of the distance of a chain from another: halves what may be above a limit."""
    a, b, most = points[:-1], points[1:], 0.0
    while len(a):
        middle, reach = 0.5 * (a + b), 0.5 * np.linalg.norm(b - a, axis=1)
        off = chords.distance(middle) + reach
        held = (off <= limit) | (reach <= slack)
        most = max(most, off[held].max(initial=0.0))
        a, b, middle = a[~held], b[~held], middle[~held]
        a, b = np.vstack([a, middle]), np.vstack([middle, b])
    return most


def both_ways(segments: list[Segment], programmed: Array, tolerance: float) -> tuple[float, float]:
    """Bounds of the distances curve to path and path to curve: wider by 5e-4 of the tolerance."""
    error = 5e-4 * tolerance
    full = np.zeros((len(programmed), 6))
    full[:, : programmed.shape[1]] = programmed
    curve = fine(segments, error)
    longest = tolerance
    limit = tolerance - error
    there = farthest(curve, Chords(full, longest), limit) + error
    return there, farthest(full, Chords(curve, longest), limit) + error


def jumps(segments: list[Segment]) -> Array:
    """Largest differences of place, r' and r'' where segments meet; r'' by what rounding makes."""
    most = np.zeros(3)
    for a, b in itertools.pairwise(segments):
        one, two = a.at(np.array([a.length])), b.at(np.array([0.0]))
        far = 1.0 + np.abs(one[0]).max()
        for n in range(1 if a.rest else 3):
            short = min(x.length if x.kind == "curve" else 1.0 for x in (a, b))
            scale = 1.0 + 1e-5 * far / min(1.0, short) ** n
            most[n] = max(most[n], np.abs(one[n] - two[n]).max() / scale)
    return most


def least_time(segments: list[Segment], acc: float, speed: float, step: float = 0.02) -> float:
    """Time-optimal time with each axis' acceleration and a speed: forwards and backwards."""
    total, rows = 0.0, []
    for p in segments:
        n = max(3, math.ceil(p.length / step))
        _, slope, bend = p.at(np.linspace(0.0, p.length, n + 1)[:-1])
        rows.append(np.hstack([slope, bend, np.full((n, 1), p.length / n)]))
        if p.rest:
            total += _time(np.vstack(rows), acc, speed)
            rows = []
    return total


def _time(rows: Array, acc: float, speed: float) -> float:
    """x = (du/dt)^2 and its slope obey  |r' u'' + r'' x| <= acc  in each axis."""
    lead = [[(p, s) for p, s in zip(r[:6], r[6:12], strict=True) if p or s] for r in rows.tolist()]
    h = rows[:, 12]
    most = (speed / np.linalg.norm(rows[:, :3], axis=1)) ** 2
    reach = np.zeros(len(rows) + 1)
    for i in range(len(rows) - 1, -1, -1):
        x, ups, downs = most[i], [(reach[i + 1] / (2 * h[i]), -1 / (2 * h[i]))], []
        for p, s in lead[i]:
            if abs(p) < 1e-7:
                x = min(x, acc / max(abs(s), 1e-300))
            else:
                ups.append((acc / abs(p), -s / p))
                downs.append((-acc / abs(p), -s / p))
        for c, m in downs:
            x = min([x, *((d - c) / (m - k) for d, k in ups if m - k > 1e-15)])
        reach[i] = max(x, 0.0)
    x, v = 0.0, [0.0]
    for i in range(len(rows)):
        gain = min((acc / abs(p) - s / p * x for p, s in lead[i] if abs(p) >= 1e-7), default=0.0)
        x = max(0.0, min(reach[i + 1], x + 2 * h[i] * gain))
        v.append(math.sqrt(x))
    return float(np.sum(2 * h / np.maximum(np.add(v[1:], v[:-1]), 1e-6)))
