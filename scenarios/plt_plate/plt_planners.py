"""Study plt_planners: shapes on the raster of a plotter as jobs of this scenario's card.

    .venv/bin/python scenarios/plt_plate/plt_planners.py

The bound is that of scenarios/short_lines: the least time along our own curve by toppra, with the
share of the acceleration that is kept free and without a limit of jerk.
"""

import sys
from pathlib import Path

import numpy as np

HERE = Path(__file__).parent
sys.path.append(str(HERE.parent / "short_lines"))
import shapes  # noqa: E402
import study as least  # noqa: E402

from motionfmu.cards import load  # noqa: E402
from motionfmu.cards.plan import plan  # noqa: E402
from motionfmu.cards.plan_figures import figures  # noqa: E402
from motionfmu.drawings import plt  # noqa: E402
from motionfmu.drawings.contours import clean  # noqa: E402

UNITS = 40  # of the plotter in a mm
RANGE = 1e4  # [mm] of the axes, as the shapes lie anywhere


def chamfers() -> np.ndarray:
    """A square of 30 mm whose corners are cut by 0.1 mm."""
    a, b, c = 0.0, 30.0, 0.1
    return np.array(
        [(c, a), (b - c, a), (b, c), (b, b - c), (b - c, b), (c, b), (a, b - c), (a, c), (c, a)]
    )


def walk() -> np.ndarray:
    """A random walk of 100,000 steps of 0.1 mm, each turned by up to 0.1 rad."""
    angle = np.cumsum(np.random.default_rng(1).uniform(-0.1, 0.1, 100_000) + 1e-3)
    steps = 0.1 * np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return np.vstack([[(0.0, 0.0)], np.cumsum(steps, axis=0)])


SHAPES = {
    "outline": shapes.outline,
    "star": shapes.star,
    "letters": shapes.letters,
    "circle": shapes.circle,
    "spiral": shapes.spiral,
    "square, chamfers of 0.1 mm": chamfers,
    "walk of 100,000 segments": walk,
}
BOUNDED = 20_000  # segments; toppra takes minutes for more


def written(contours: list[np.ndarray]) -> bytes:
    """A PLT file of contours in mm."""
    text = "IN;SP1;"
    for c in contours:
        first, *rest = np.round(c * UNITS).astype(int).tolist()
        text += f"PU{first[0]},{first[1]};PD" + ",".join(f"{x},{y}" for x, y in rest) + ";"
    return f"{text}PU;".encode()


def bound(contours: list[np.ndarray], feed: float, tolerance: float) -> float:
    """Least time of all contours [s]."""
    total = 0.0
    for points in contours:
        head = ["merge 0.02", ""]
        rows = [f"line {tolerance} {feed} {x!r} {y!r} 0 0 0 0" for x, y in points[1:].tolist()]
        head[1] = "start " + " ".join(map(repr, points[0].tolist())) + " 0 0 0 0"
        total += least.bound(least.shaped([*head, *rows])[0], feed)
    return total


def main() -> None:
    """Print the table."""
    card = load(HERE / "card.toml")
    wide = [a.model_copy(update={"minimum": -RANGE, "maximum": RANGE}) for a in card.axes]
    card = card.model_copy(update={"axes": wide})
    least.ACC = card.axes[0].acceleration_max * (1.0 - card.motion.reserve)
    print(
        "| shape | segments | drawing [s] | over bound | off / back [µm] | a [mm/s²] "
        "| j [m/s³] | at feed | stops | planning [ms per 1000] | job [bytes] |\n"
        + "|---" * 11
        + "|"
    )
    for name, shape in SHAPES.items():
        drawing = plt.parse(written(shapes.contours(shape())), name)
        contours = [c.points for c in clean(drawing)]
        n = figures(plan(drawing, card), card)
        over = "-"
        if n.segments < BOUNDED:
            time = bound(contours, card.motion.feed, card.motion.tolerance)
            over = f"{n.time_down / time:.2f}"
        pulls = " / ".join(f"{a:.0f}" for a in n.acceleration)
        jerks = " / ".join(f"{j / 1e3:.0f}" for j in n.jerk)
        print(
            f"| {name} | {n.segments} | {n.time_down:.2f} | {over} "
            f"| {1e3 * n.off:.1f} / {1e3 * n.back:.1f} | {pulls} | {jerks} | "
            f"{100 * n.at_feed:.0f} % | {n.stops} | {1e6 * n.planning / n.segments:.1f} "
            f"| {n.size} |",
            flush=True,
        )


if __name__ == "__main__":
    main()
