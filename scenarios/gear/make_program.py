"""Write gear.ngc: the outline of an involute spur gear in short straight lines.

A user would get such a file from a CAM system; the numbers are the usual ones of gear geometry:
module m, pressure angle 20 degrees, tip circle m above, root circle 1.25 m below the pitch circle.
"""

import math
from pathlib import Path

MODULE = 3.0  # [mm]
TEETH = 24
PRESSURE_ANGLE = math.radians(20.0)
FLANK_POINTS = 12  # points on each involute flank
FEED = 1200  # [mm/min]


def involute(angle: float) -> float:
    """Involute function of an angle [rad]."""
    return math.tan(angle) - angle


def flank(points: int) -> list[tuple[float, float]]:
    """Radius [mm] and angle from the tooth's middle [rad] of a flank, root to tip."""
    pitch_radius = MODULE * TEETH / 2.0
    base_radius = pitch_radius * math.cos(PRESSURE_ANGLE)
    tip, root = pitch_radius + MODULE, pitch_radius - 1.25 * MODULE
    half_tooth = math.pi / (2.0 * TEETH) + involute(PRESSURE_ANGLE)
    out = [(root, half_tooth)]
    for i in range(points):
        radius = base_radius + (tip - base_radius) * i / (points - 1)
        pressure = math.acos(min(1.0, base_radius / radius))
        out.append((radius, half_tooth - involute(pressure)))
    return out


def outline() -> list[tuple[float, float]]:
    """Corner points x, y [mm] of the whole gear, counter-clockwise, closed."""
    shape = flank(FLANK_POINTS)
    points = []
    for tooth in range(TEETH):
        middle = 2.0 * math.pi * tooth / TEETH
        for radius, angle in shape:
            points.append((radius, middle - angle))
        for radius, angle in reversed(shape):
            points.append((radius, middle + angle))
    points.append(points[0])
    return [(r * math.cos(a), r * math.sin(a)) for r, a in points]


def program() -> str:
    """Text of the part program."""
    points = outline()
    x0, y0 = points[0]
    lines = [
        "%",
        f"N10 G21 G17 G90 G64 (Gear, module {MODULE:g} mm, {TEETH} teeth, F {FEED} mm/min)",
        "/N15 G61 (exact stop, with block delete off)",
        f"N20 G0 X{x0:.4f} Y{y0:.4f}",
        "N30 G4 P0.3",
        f"N40 G1 F{FEED}",
    ]
    for i, (x, y) in enumerate(points[1:], 5):
        lines.append(f"N{10 * i} X{x:.4f} Y{y:.4f}")
    return "\n".join([*lines, f"N{10 * (len(points) + 5)} M30", "%", ""])


if __name__ == "__main__":
    Path(__file__).with_name("gear.ngc").write_text(program())
