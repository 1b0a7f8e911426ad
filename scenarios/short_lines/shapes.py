"""Shapes that planners are tried on: dense rasters, long contours, a plate, a gear, a carved chip.

Each shape is the text of a part program from its first motion on: lines and arcs in mm, without
feed or path mode.
"""

import math
from collections.abc import Callable, Iterable
from itertools import pairwise
from pathlib import Path

import numpy as np

RASTER = 1 / 40  # [mm]
PLATE = Path(__file__).parent.parent / "lookahead" / "plate.ngc"


def words(points: Iterable[Iterable[float]]) -> list[str]:
    """One line of the program to each point [mm]."""
    return [" ".join(f"{n}{x:.4f}" for n, x in zip("XYZ", p, strict=False)) for p in points]


def contours(points: np.ndarray | list[np.ndarray]) -> list[np.ndarray]:
    """The pen is lifted between them."""
    return points if isinstance(points, list) else [points]


def on_raster(points: np.ndarray) -> np.ndarray:
    """The points rounded to the raster, without those met twice in a row."""
    rounded = np.round(points / RASTER) * RASTER
    new = np.any(np.diff(rounded, axis=0) != 0.0, axis=1)
    return rounded[np.concatenate([[True], new])]


def drawn(corners: np.ndarray | list[tuple[float, float]]) -> np.ndarray:
    """Straight strokes on the raster, a point every raster step."""
    points = np.asarray(corners)
    parts = [points[:1]]
    for a, b in pairwise(points):
        steps = math.ceil(np.abs(b - a).max() / RASTER)
        parts.append(a + np.linspace(0.0, 1.0, steps + 1)[1:, None] * (b - a))
    return on_raster(np.vstack(parts))


def outline() -> np.ndarray:
    """A butterfly: r = e^cos t - 2 cos 4t + sin^5(t / 12), 8 mm a unit, in 5751 lines."""
    t = 2.0 * np.pi * np.arange(6001) / 6000
    r = 8.0 * (np.exp(np.cos(t)) - 2.0 * np.cos(4.0 * t) + np.sin(t / 12.0) ** 5)
    return on_raster(np.column_stack([r * np.cos(t), r * np.sin(t)]))


def star(radius: float = 8.0) -> np.ndarray:
    """Five points on a circle, five on one of 7 / 16 of its radius."""
    corners = [
        (r * math.sin(k * math.pi / 5), r * math.cos(k * math.pi / 5))
        for k, r in enumerate([radius, 0.4375 * radius] * 5 + [radius])
    ]
    return drawn(corners)


def circle(radius: float = 5.0) -> np.ndarray:
    """Once round."""
    t = np.linspace(0.0, 2.0 * np.pi, 5001)
    return on_raster(radius * np.column_stack([np.cos(t), np.sin(t)]))


def spiral(turns: int = 3) -> np.ndarray:
    """From 1 mm out, 2 mm a turn."""
    t = np.linspace(0.0, 2.0 * np.pi * turns, 20001)
    r = np.linspace(1.0, 1.0 + 2.0 * turns, len(t))
    return on_raster(np.column_stack([r * np.cos(t), r * np.sin(t)]))


def letters(height: float = 8.0) -> list[np.ndarray]:
    """An S of two arcs, a Z of three lines and an O: the pen is lifted between them."""
    t = np.linspace(0.25 * np.pi, 1.5 * np.pi, 2001)
    upper = np.column_stack([4.0 + 4.0 * np.cos(t), 12.0 + 4.0 * np.sin(t)])
    lower = (8.0, 16.0) - upper[::-1]
    z = np.array([(12.0, 16.0), (20.0, 16.0), (12.0, 0.0), (20.0, 0.0)])
    t = np.linspace(0.0, 2.0 * np.pi, 4001)
    o = np.column_stack([30.0 - 6.0 * np.cos(t), 8.0 + 8.0 * np.sin(t)])
    return [drawn(height / 16.0 * strokes) for strokes in (np.vstack([upper, lower[1:]]), z, o)]


def contour() -> np.ndarray:
    """A closed contour of 250 lines of 2.3 mm with waves and narrow bends."""
    t = np.linspace(0.0, 2.0 * np.pi, 100001)
    r = 72.0 + 16.0 * np.cos(3.0 * t) + 6.0 * np.sin(7.0 * t + 1.0) + 2.5 * np.cos(13.0 * t)
    fine = np.column_stack([r * np.cos(t), r * np.sin(t)])
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine, axis=0).T))])
    at = np.linspace(0.0, way[-1], 251)
    return np.column_stack([np.interp(at, way, x) for x in fine.T])


def chip() -> np.ndarray:
    """Relief carved in 60 rows to and fro: about 4700 lines of 1 to 2 mm in X Y Z."""
    rng = np.random.default_rng(15)
    points = [np.zeros((1, 3))]
    for row in range(60):
        x = np.cumsum(np.concatenate([[0.0], rng.uniform(1.0, 2.0, 78)]))
        x *= 110.0 / x[-1]
        x = x if row % 2 == 0 else 110.0 - x
        y = np.full_like(x, 1.2 * row)
        z = 3.0 * np.sin(x / 7.0) * np.cos(y / 9.0) + 1.2 * np.sin((x + y) / 3.1)
        z += np.where(np.hypot(x - 55.0, y - 35.0) < 18.0, -4.0, 0.0)  # an island with walls
        points.append(np.column_stack([x, y, z]))
    return np.vstack(points)


def gear() -> list[str]:
    """Outline of a gear of 40 teeth, 1240 mm long: straight flanks, arcs at tip and root."""
    tip, root, teeth = 100.0, 92.2, 40
    step = 2.0 * math.pi / teeth
    lines = []

    def at(r: float, angle: float) -> str:
        return f"X{r * math.cos(angle):.4f} Y{r * math.sin(angle):.4f}"

    lines.append("G1 " + at(root, 0.0))
    for n in range(teeth):
        a = n * step
        lines.append(f"G3 {at(root, a + 0.25 * step)} R{root:g}")
        lines.append("G1 " + at(tip, a + 0.40 * step))
        lines.append(f"G3 {at(tip, a + 0.65 * step)} R{tip:g}")
        lines.append("G1 " + at(root, a + 0.80 * step))
        lines.append(f"G3 {at(root, a + step)} R{root:g}")
    return lines


def plate() -> list[str]:
    """That of the scenario lookahead: edges, arcs, and a spline in 329 lines of 0.2 mm."""
    text = PLATE.read_text().splitlines()
    blocks = [line.split(" ", 1)[1] for line in text if line.startswith("N")]
    return [b for b in blocks if not b.startswith(("G21", "G61", "M30"))]


def lines_of(points: Callable[[], np.ndarray | list[np.ndarray]]) -> Callable[[], list[str]]:
    """A program of lines through the points of one contour or several."""

    def made() -> list[str]:
        text = []
        for contour in contours(points()):
            first, *others = words(contour)
            text += ["G0 " + first, *("G1 " + w for w in others)]
        return text

    return made


SHAPES: dict[str, Callable[[], list[str]]] = {
    "outline": lines_of(outline),
    "star": lines_of(star),
    "letters": lines_of(letters),
    "circle": lines_of(circle),
    "spiral": lines_of(spiral),
    "contour": lines_of(contour),
    "plate": plate,
    "gear": gear,
    "chip": lines_of(chip),
}
