"""G5.2 and G5.3 against B-splines of SciPy in homogeneous coordinates."""

import math

import numpy as np
import pytest
from few_cases import few
from numpy.typing import NDArray
from scipy.spatial import cKDTree
from second.nurbs import curve, places

from motionfmu.analysis.gcode import Program, read, strokes

AWAY = 1e-4  # [mm] of a command from the curve

Points = NDArray[np.float64]


def text(points: Points, weights: Points, order: int, names: str = "XY", plane: int = 17) -> str:
    """The program; the first point is where the tool is."""
    first = " ".join(f"{c}{v:.12f}" for c, v in zip(names, points[0], strict=True))
    lines = [f"G{plane} G0 {first}", f"F3000\nG5.2 P{weights[0]:.12f} L{order}"]
    for q, w in zip(points[1:], weights[1:], strict=True):
        lines.append(
            " ".join(f"{c}{v:.12f}" for c, v in zip(names, q, strict=True)) + f" P{w:.12f}"
        )
    return "\n".join([*lines, "G5.3", "M2"]) + "\n"


def drawn(program: Program, axes: tuple[int, int]) -> Points:
    assert program.faults == []
    return np.vstack([s.points for s in strokes(program) if not s.rapid])[:, axes]


def points_at_random(seed: int) -> tuple[Points, Points, int]:
    r = np.random.default_rng(seed)
    count = int(r.integers(3, 40))
    order = int(r.integers(3, min(count, 10) + 1))
    steps = r.uniform(-20.0, 20.0, (count, 2)) + np.array([8.0, 0.0])
    weights = r.uniform(0.3, 3.0, count) if r.random() < 0.7 else np.ones(count)
    return np.cumsum(steps, axis=0), weights, order


@pytest.mark.parametrize("seed", few(range(30), 4))
@pytest.mark.parametrize("plane", (17, 18, 19))
def test_the_path_is_the_curve(seed: int, plane: int) -> None:
    """Each place of the path is on the curve, and each place of the curve on the path."""
    points, weights, order = points_at_random(seed)
    names, axes = {17: ("XY", (0, 1)), 18: ("ZX", (2, 0)), 19: ("YZ", (1, 2))}[plane]
    program = read(text(points, weights, order, names, plane), max_feed=3000.0)
    path = drawn(program, axes)
    fine = places(curve(points, weights, order), 400_000)
    step = np.linalg.norm(np.diff(fine, axis=0), axis=1).max()
    assert cKDTree(fine).query(path)[0].max() < AWAY + step
    gaps = np.linalg.norm(np.diff(path, axis=0), axis=1).max()
    assert cKDTree(path).query(fine[::40])[0].max() < AWAY + gaps
    assert path[0] == pytest.approx(points[0]) and path[-1] == pytest.approx(points[-1])


def test_a_curve_of_the_third_degree_without_weights_is_exact() -> None:
    points, _, _ = points_at_random(7)
    program = read(text(points, np.ones(len(points)), 4), max_feed=3000.0)
    assert (program.commands["cubic"]).sum() == len(points) - 3


def test_a_quarter_of_a_circle() -> None:
    """Weights 1, cos 45 degrees, 1."""
    points = np.array([[10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    program = read(text(points, np.array([1.0, math.sqrt(0.5), 1.0]), 3), max_feed=3000.0)
    assert np.linalg.norm(drawn(program, (0, 1)), axis=1) == pytest.approx(10.0, abs=AWAY)
    assert program.commands["length"][1:].sum() == pytest.approx(5.0 * math.pi, abs=1e-4)


def test_points_that_fall_together_make_a_corner() -> None:
    points = np.array([[0.0, 0], [5, 0], [8, 8], [8, 8], [11, 0], [16, 0]])
    program = read(text(points, np.ones(6), 3), max_feed=3000.0)
    path = drawn(program, (0, 1))
    assert np.linalg.norm(path - [8.0, 8.0], axis=1).min() == 0.0


def test_pieces_follow_each_other_without_a_rest_with_exact_stop_too() -> None:
    points = np.array([[10.0, 0.0], [10.0, 10.0], [0.0, 10.0]])
    program = read("G61\n" + text(points, np.array([1.0, 2.0, 1.0]), 3), max_feed=3000.0)
    moves = program.commands[program.commands["type"] != 0]
    assert len(moves) > 3
    speeds = np.linalg.norm(np.diff(program.places()[:, :2], axis=0), axis=1)
    resting = np.flatnonzero(speeds < 1e-3 * speeds.max())
    begin = int(program.seconds()[0] * 1e3)
    assert not ((resting > begin + 20) & (resting < len(speeds) - 20)).any()


def test_increments_and_a_frame() -> None:
    """Points in G91 go on from the point before; the curve of turned points is the turned curve."""
    line = "G5.2 L3\nX5 Y0\nX3 Y8\nX3 Y-8\nX5 Y0\nG5.3\nM2\n"
    one = read("F600 G91\n" + line)
    points = np.cumsum(np.array([[0.0, 0], [5, 0], [3, 8], [3, -8], [5, 0]]), axis=0)
    fine = places(curve(points, np.ones(5), 3), 100_000)
    assert cKDTree(fine).query(drawn(one, (0, 1)))[0].max() < 2e-4
    turned = drawn(read("F600 G68 R90\nG91\n" + line), (0, 1))
    assert cKDTree(fine[:, ::-1] * [-1.0, 1.0]).query(turned)[0].max() < 2e-4


@pytest.mark.parametrize(
    "lines, why",
    [
        ("G5.3", 'line 2: no G5.2 before "G5.3"'),
        ("G5.2 L4\nX1 Y1\nX2 Y0\nG5.3", "line 5: fewer points since G5.2 than its order"),
        ("G5.2 L11", 'line 2: value out of range "L11"'),
        ("G5.2 L2", 'line 2: value out of range "L2"'),
        ("G5.2 L3.5", 'line 2: value out of range "L3.5"'),
        ("G5.2\nX1", "line 3: point of a NURBS without both axes"),
        ("G5.2\nX1 Y1 P0", 'line 3: value out of range "P0"'),
        ("G5.2\nX1 Y1 Z1", 'line 3: word has no use in this line "Z1"'),
        ("G5.2\nX1 Y1\nP2", 'line 4: word has no use in this line "P2"'),
        ("G5.2\nX1 Y1\nX2 Y2 L3", 'line 4: word has no use in this line "L3"'),
        ("G5.2\nX1 Y1\nX2 Y0\nG1 X3", "line 5: G5.2 is not ended by G5.3"),
        ("G5.2\nX1 Y1\nX2 Y0\nM2", 'line 5: G5.2 is not ended by G5.3 before "M2"'),
        ("G5.2\nX1 Y1\nX2 Y0\n(end)", 'line 4: G5.2 is not ended by G5.3 behind "X2 Y0"'),
        ("G5.2\nX1 Y1\nG30", 'line 4: G5.2 is not ended by G5.3 before "G30"'),
        ("G5.2\nX1 Y1\nG19 Y2 Z0", "line 4: G5.2 is not ended by G5.3 before"),
        ("G93 F1\nG5.2 F1\nX1 Y1 F1", "line 3: NURBS with G93"),
        ("G41 D1\nG5.2\nX1 Y1", "line 3: not while cutter compensation is on"),
    ],
)
def test_wrong_curves_are_told(lines: str, why: str) -> None:
    program = read(f"F600\n{lines}\n", "T1 P1 Z10 D6\n")
    assert str(program.faults[0]).startswith(why)


def test_a_curve_of_many_points_streams() -> None:
    """Its state holds a window of points; 20,000 of them are read."""
    t = np.linspace(0.0, 40.0, 20_000)
    points = np.column_stack([t * np.cos(t), t * np.sin(t)])
    program = read(text(points, np.ones(len(t)), 4), max_feed=3000.0)
    assert program.faults == [] and len(program.commands) >= len(t) - 4
