"""Cutter compensation around closed contours against the buffers of shapely.

The way of the tool's centre around a contour of lines and arcs is the boundary of its buffer by the
radius, outside and inside, and what the tool sweeps lies beside the contour.
"""

import math
import random

import numpy as np
import pytest
from shapely import LineString, Polygon

from motionfmu.analysis.gcode import read

CONTOURS = 20
FINE = 0.002  # [rad] of an arc that becomes a line for shapely
Point = tuple[float, float]


def contour(rng: random.Random, convex: bool) -> tuple[list[str], list[Point]]:
    """Lines of a program around a star, counter-clockwise from the middle of a line, and points."""
    count = rng.randint(4, 9)
    turns = sorted((k + rng.uniform(-0.3, 0.3)) * math.tau / count for k in range(count))
    corners = []
    for turn in turns:
        radius = 40.0 if convex else rng.uniform(22.0, 45.0)
        corners.append((round(radius * math.cos(turn), 6), round(radius * math.sin(turn), 6)))
    middle = tuple(round(0.5 * (a + b), 9) for a, b in zip(corners[-1], corners[0], strict=True))
    lines, points = [], [(middle[0], middle[1])]
    for k, (x, y) in enumerate([*corners, (middle[0], middle[1])]):
        x0, y0 = points[-1]
        chord = math.hypot(x - x0, y - y0)
        if 0 < k < count and rng.random() < 0.5:
            ccw = convex or rng.random() < 0.5
            radius = round(chord * rng.uniform(0.75, 2.0), 4)
            lines.append(f"G{3 if ccw else 2} X{x:.9f} Y{y:.9f} R{radius:.4f}")
            points += arc((x0, y0), (x, y), radius if ccw else -radius)
        else:
            lines.append(f"G1 X{x:.9f} Y{y:.9f}")
        points.append((x, y))
    return lines, points


def arc(start: Point, end: Point, radius: float) -> list[Point]:
    """Points between the ends of an arc of less than half a turn; to the right with radius < 0."""
    way = complex(end[0] - start[0], end[1] - start[1])
    half = math.asin(abs(way) / 2.0 / abs(radius))
    centre = (
        complex(*start) + way / 2.0 + 1j * way / 2.0 / math.tan(half) * math.copysign(1, radius)
    )
    spoke = complex(*start) - centre
    count = math.ceil(2.0 * half / FINE)
    turned = [
        centre + spoke * np.exp(1j * math.copysign(2.0 * half, radius) * k / count)
        for k in range(1, count)
    ]
    return [(float(p.real), float(p.imag)) for p in turned]


def centre_way(commands: np.ndarray) -> list[Point]:
    """Points of the way of commands."""
    points: list[Point] = [(commands[0]["start"][0], commands[0]["start"][1])]
    for c in commands:
        end = complex(*c["end"][:2])
        if c["sweep"] != 0.0:
            centre = complex(*c["centre"])
            spoke = complex(*c["start"][:2]) - centre
            count = math.ceil(abs(c["sweep"]) / FINE)
            turned = [centre + spoke * np.exp(1j * c["sweep"] * k / count) for k in range(1, count)]
            points += [(float(p.real), float(p.imag)) for p in turned]
        points.append((end.real, end.imag))
    return points


@pytest.mark.parametrize("inside", [False, True])
@pytest.mark.parametrize("convex", [False, True])
def test_the_way_around_a_contour_is_the_boundary_of_its_buffer(convex: bool, inside: bool) -> None:
    rng = random.Random(7)
    accepted = 0
    for _ in range(CONTOURS):
        lines, points = contour(rng, convex)
        radius = rng.randint(500, 4000) / 1000.0
        ahead = (points[0][0] - points[-2][0], points[0][1] - points[-2][1])
        back = (radius + 1.0) / math.hypot(*ahead)
        start = (points[0][0] - back * ahead[0], points[0][1] - back * ahead[1])
        text = [
            f"G0 X{start[0]:.9f} Y{start[1]:.9f} F600",
            f"{'G41.1' if inside else 'G42.1'} D{2.0 * radius}",
            f"G1 X{points[0][0]:.9f} Y{points[0][1]:.9f}",
            *lines,
            "G40 G0 Z10",
        ]
        program = read("\n".join(text))
        if program.faults:
            assert "tool does not fit" in program.faults[0].why or "short" in program.faults[0].why
            continue
        accepted += 1
        moves = program.commands[program.commands["line"] >= 4]
        way = Polygon(centre_way(moves[:-1]))
        part = Polygon(points)
        want = part.buffer(-radius if inside else radius, quad_segs=200)
        rounding = want.length * 2e-4
        assert way.symmetric_difference(want).area < rounding
        swept = LineString(centre_way(moves[:-1])).buffer(radius, quad_segs=200)
        other = part if not inside else Polygon(points).buffer(100.0).difference(part)
        assert swept.intersection(other).area < rounding
    assert CONTOURS * (1.0 if convex and not inside else 0.5) <= accepted
