"""Write shapes.ngc: outlines as a plotter or an image tracer puts them out, on a raster."""

from pathlib import Path

import numpy as np
import shapes

FEED = 6000  # [mm/min]
TOLERANCE = 0.02  # [mm]
# Each shape, its size, and where it lies [mm].
PLACES = (
    (shapes.outline(), (30.0, 30.0)),
    (shapes.star(4.0), (68.0, 12.0)),
    (shapes.letters(4.0), (62.0, 28.0)),
    (shapes.circle(2.5), (68.0, 43.0)),
    (shapes.spiral(1), (58.0, 52.0)),
)


def blocks(points: np.ndarray) -> list[str]:
    """A rapid to the first point, a line to each other one."""
    first, *others = np.round(points, 4).tolist()
    return [
        f"G0 X{first[0]:g} Y{first[1]:g}",
        *(f"{'G1 ' if n == 0 else ''}X{x:g}Y{y:g}" for n, (x, y) in enumerate(others)),
    ]


def program() -> str:
    """Text of the part program."""
    text = [f"G21 G17 G90 G64 P{TOLERANCE:g} F{FEED} (Outlines on a raster of 1/40 mm)"]
    text.append("/G61 (exact stop, with block delete off)")
    for shape, place in PLACES:
        for points in shapes.contours(shape):
            text += blocks(points + place)
    return "\n".join(["%", *text, "M30", "%", ""])


if __name__ == "__main__":
    (Path(__file__).parent / "shapes.ngc").write_text(program())
