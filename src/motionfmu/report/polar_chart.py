"""A circular test as a ballbar shows it: radial deviation over the angle."""

import math
from collections.abc import Sequence
from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.report.diagram import DASH, POLAR, SOLID, Diagram, LineMark, Scale, one
from motionfmu.report.numbers import MINUS, round_up
from motionfmu.report.style import CCW, CW, INK
from motionfmu.run.decimate import keep_peaks

BUCKETS = 500
RING_MIN = 0.1  # [µm] finer than any pulse
NAMES = "XYZ"
HEIGHT = 434  # [pixel]


def polar_chart(test: CircularTest) -> Diagram:
    """Radial deviation of a circle, both ways round."""
    lines = []
    for way, name, color in ((test.ccw, "counter-clockwise", CCW), (test.cw, "clockwise", CW)):
        if way is not None:
            deviation = np.hypot(way.points[:, 0], way.points[:, 1]) - test.radius
            angle = np.arctan2(way.points[:, 1], way.points[:, 0])
            lines.append(deviation_line(angle, deviation * 1e3, name, color))
    return polar_rings(lines, test.axes)


def deviation_line(
    angle: Array, deviation: Array, name: str, color: str, dash: str = SOLID
) -> LineMark:
    """Radial deviation [µm] over an angle [rad], with every peak of it."""
    kept = keep_peaks(deviation, BUCKETS)
    look: Any = {"name": name, "color": color, "dash": dash, "width": 2.0}
    return LineMark(angle[kept] * 180.0 / math.pi, deviation[kept], **look)


def polar_rings(lines: Sequence[LineMark], axes: Array) -> Diagram:
    """Curves of deviations [µm] over an angle [°], about the nominal circle."""
    top = max((float(np.abs(line.y).max()) for line in lines), default=0.0)
    ring = round_up(max(top, RING_MIN))
    turn = np.arange(0.0, 361.0, 2.0)
    look: Any = {"color": INK, "width": 1.3, "dash": DASH, "hover": ()}
    nominal = LineMark(turn, np.zeros_like(turn), "nominal circle", **look)
    texts = (f"{MINUS}{ring:g} µm", "", "0", "", f"+{ring:g} µm")
    rings = (-ring, -0.5 * ring, 0.0, 0.5 * ring, ring)
    radius = Scale(
        unit="µm", ends=(-2.2 * ring, 1.05 * ring), ticks=tuple(zip(rings, texts, strict=True))
    )
    # At 0, 45, ... degrees: the axes' names at the quarters.
    first, second = (NAMES[int(np.argmax(np.abs(a)))] for a in axes)
    quarters = (f"+{first}", f"+{second}", f"{MINUS}{first}", f"{MINUS}{second}")
    angles = [(a, f"{a}°" if a % 90 else quarters[a // 90]) for a in range(0, 360, 45)]
    return one(Scale(ticks=tuple(angles)), radius, [nominal, *lines], HEIGHT, POLAR)
