"""Write plate.ngc: the outline of a plate as a CAM system puts it out.

Straight edges with sharp corners, a rounded one, two half-round notches, and a wavy edge: a cubic
spline through a few points, cut into lines of 0.2 mm.
"""

import math
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

FEED = 3000  # [mm/min]
TOLERANCE = 0.02  # [mm]
# Points of the wavy edge [mm], and the length of its lines.
EDGE = ((74, 44), (68, 49), (61, 43), (55, 41), (48, 47), (42, 44), (36, 45), (30, 41), (22, 46))
SEGMENT = 0.2  # [mm]
BEFORE = """G1 X28 Y0
X34 Y9
X40 Y0
X70
G3 X80 Y10 I0 J10
G1 Y16
G2 X80 Y28 I0 J6
G1 Y44
X74"""
BEHIND = """G1 X10
G3 X0 Y34 R12
G1 Y26
X7 Y23
X0 Y20
Y16
G2 X0 Y8 J-4
G1 Y0"""


def edge() -> np.ndarray:
    """Ends of its lines [mm], shape (n, 2), without the first point."""
    points = np.array(EDGE, float)
    knots = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(points, axis=0).T))])
    curve = CubicSpline(knots, points)
    fine = np.linspace(0.0, knots[-1], 20001)
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(curve(fine), axis=0).T))])
    count = math.ceil(way[-1] / SEGMENT)
    return curve(np.interp(np.linspace(0.0, way[-1], count + 1)[1:], way, fine))


def program() -> str:
    """Text of the part program."""
    blocks = [
        f"G21 G17 G90 G64 P{TOLERANCE:g} F{FEED} (Plate, corners within {TOLERANCE:g} mm)",
        "G61 (exact stop, with block delete off)",
        *BEFORE.splitlines(),
        *(f"X{x:.4f} Y{y:.4f}" for x, y in edge()),
        *BEHIND.splitlines(),
        "M30",
    ]
    numbered = [f"N{10 * n} {b}" for n, b in enumerate(blocks, 1)]
    numbered[1] = "/" + numbered[1]
    return "\n".join(["%", *numbered, "%", ""])


if __name__ == "__main__":
    Path(__file__).with_name("plate.ngc").write_text(program())
