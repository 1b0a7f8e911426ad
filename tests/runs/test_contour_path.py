"""Reading the planned geometry, and what a wrong file gets."""

import math

import numpy as np
import pytest
from contour_runs import Program

from motionfmu.analysis.contour.geometry import Arc, LineSegment
from motionfmu.analysis.contour.path import Path, outline
from motionfmu.analysis.contour.planned_geometry import COLUMNS, read_path

HEAD = (
    ["command", "line", "type"]
    + [f"{what}_{axis}" for what in ("start", "end") for axis in "xyzuvw"]
    + [f"{what}_{axis}" for what in ("centre", "normal") for axis in "xyz"]
    + ["radius", "sweep", "length", "feed"]
)


def row(command: int, kind: int, start, end, sweep: float = 0.0) -> str:
    about, normal = [0.0, 0.0, 0.0], [0.0, 0.0, 1.0 if sweep else 0.0]
    values = [command, 10 * command, kind, *start, 0, 0, 0, *end, 0, 0, 0, *about, *normal]
    return ",".join(map(repr, [*values, 0.0, sweep, 0.0, 100.0]))


ROWS = [
    row(1, 0, (0.0, 0.0, 0.0), (50.0, 0.0, 0.0)),
    row(2, 3, (50.0, 0.0, 0.0), (50.0, 0.0, 0.0), sweep=2 * math.pi),
    row(3, 6, (50.0, 0.0, 0.0), (50.0, 0.0, 0.0)),
    row(4, 4, (50.0, 0.0, 0.0), (0.0, 50.0, -6.0), sweep=-1.5 * math.pi),
    row(6, 1, (0.0, 50.0, -6.0), (0.0, 0.0, -6.0)),
]


def write(tmp_path, rows, head=HEAD):
    file = tmp_path / "path.csv"
    file.write_text("\n".join([",".join(head), *rows, ""]))
    return file


def test_the_library_s_file_is_read_by_column_name(tmp_path) -> None:
    path = read_path(write(tmp_path, ROWS))
    kinds = [(s.label.command, s.label.line, s.label.kind) for s in path.segments]
    assert kinds == [(1, 10, "ptp"), (2, 20, "arc"), (4, 40, "helix"), (6, 60, "line")]
    assert [type(s) for s in path.segments] == [LineSegment, Arc, Arc, LineSegment]
    circle, helix = path.segments[1:3]
    assert circle.length == pytest.approx(100 * math.pi, rel=1e-14)
    assert helix.length == pytest.approx(math.hypot(75 * math.pi, 6.0), rel=1e-14)
    assert helix.end == pytest.approx([0.0, 50.0, -6.0], abs=1e-12)
    assert path.segments[3].label.feed == 100.0
    assert list(path.offsets) == pytest.approx([0, *np.cumsum([s.length for s in path.segments])])
    # a delay stands for what came before it; before the first command there is the first
    assert list(path.segment_of(np.array([0, 1, 2, 3, 4, 5, 6, 7]))) == [0, 0, 1, 1, 2, 2, 3, 3]


def test_a_curve_has_its_inner_control_points(tmp_path) -> None:
    inner = [f"inner_{k}_{axis}" for k in (0, 1) for axis in "xyz"]
    text = row(1, 14, (0.0, 0.0, 0.0), (6.0, 0.0, 0.0)) + ",0.0,2.0,0.0,6.0,2.0,0.0"
    path = read_path(write(tmp_path, [text], HEAD + inner))
    curve = path.segments[0]
    assert curve.label.kind == "curve"
    assert curve.at(np.array([0.5 * curve.length])) == pytest.approx(np.array([[3.0, 1.5, 0.0]]))
    assert path.normal == pytest.approx([0.0, 0.0, 1.0])
    assert outline(path.segments)[0].shape == (91, 3)


def test_an_end_off_the_circle_is_kept_as_growth(tmp_path) -> None:
    text = row(1, 3, (50.0, 0.0, 0.0), (0.0, 50.0004, 0.0), sweep=math.pi / 2)
    arc = read_path(write(tmp_path, [text])).segments[0]
    assert arc.growth == pytest.approx(4e-4, rel=1e-9)
    assert arc.end == pytest.approx([0.0, 50.0004, 0.0], abs=1e-12)
    foot = arc.foot(
        np.array([[0.0, 50.0004, 0.0], [60.0 * math.cos(0.5), 60.0 * math.sin(0.5), 0]])
    )
    assert foot.distance[0] == pytest.approx(0.0, abs=1e-12)
    assert foot.distance[1] == pytest.approx(10.0 - 4e-4 / math.pi, abs=1e-8)


@pytest.mark.parametrize(
    ("rows", "head", "message"),
    [
        (ROWS, [c for c in HEAD if c != "sweep"], "path.csv:1: column 'sweep' is missing"),
        ([ROWS[0], ROWS[1].replace("100.0", "fast")], HEAD, "path.csv:3: feed 'fast' is not a num"),
        ([ROWS[0].replace("50.0", "nan", 1)], HEAD, "path.csv:2: end_x 'nan' is not finite"),
        ([row(1, 9, (0.0,) * 3, (1.0, 0.0, 0.0))], HEAD, "path.csv:2: type '9' is none of 0 to"),
        ([row(1, 14, (0.0,) * 3, (1.0, 0, 0))], HEAD, "path.csv:2: inner_0_x None is not a number"),
        ([row(1, 3, (1.0, 0, 0), (0.0, 1, 0))], HEAD, "path.csv:2: the normal of an arc is zero"),
        (
            [row(1, 3, (1.0, 0, 0), (0.0, 1, 0), sweep=3.0)],
            HEAD,
            r"path.csv:2: the arc misses its end by 1\.3\d* mm",
        ),
        ([ROWS[2]], HEAD, "path.csv: no motion in the planned geometry"),
        ([ROWS[4], ROWS[0]], HEAD, "command 1 follows command 6"),
    ],
)
def test_a_wrong_file_is_refused_by_line_and_value(tmp_path, rows, head, message) -> None:
    with pytest.raises(ValueError, match=message):
        read_path(write(tmp_path, rows, head))


def test_columns_are_in_the_file_format() -> None:
    assert set(COLUMNS) <= set(HEAD)


@pytest.mark.parametrize(
    ("program", "normal"),
    [
        (Program(0, 0).line(10, 0), [0, 0, 1]),
        (Program(0, 0).line(10, 5).line(0, 9), [0, 0, 1]),
        (Program(0, 0, 5).line(10, 0, 5, kind="ptp").line(10, 0, 0).line(20, 9, 0), [0, 0, 1]),
        (Program(9, 0).arc((0, 0), -3.0), [0, 0, 1]),
        (Program(9, 0).arc((0, 0, 0), 3.0, normal=(0.0, 1.0, 0.0)), [0, 1, 0]),
        (Program(0, 0, 0).line(1, 0, 1), [0, 1, 0]),
        (Program(0, 0, 0).line(0, 2, 1).line(0, 0, 7), [1, 0, 0]),
        (Program(9, 0).arc((0, 0), 9.0, rise=3.0), None),
        (Program(0, 0, 0).line(1, 0, 0).line(1, 1, 0).line(2, 2, 3), None),
        (
            Program(0, 0, 0).line(1, 0, -1).line(0, 1, -1),
            [1 / math.sqrt(3)] * 3,
        ),
    ],
)
def test_working_plane(program: Program, normal) -> None:
    found = program.path().normal
    if normal is None:
        assert found is None
    else:
        assert found == pytest.approx(normal, abs=1e-12)


def test_a_line_in_space_has_a_plane_that_holds_it() -> None:
    normal = Program(0, 0, 0).line(3, 2, 1).path().normal
    assert normal @ np.array([3, 2, 1]) == pytest.approx(0.0, abs=1e-12)
    assert np.linalg.norm(normal) == pytest.approx(1.0)


def test_outline_runs_through_all_joints() -> None:
    path = Program(9, 0).arc((0, 0), -3.0).line(20, 20).path()
    points, starts = outline(path.segments)
    assert starts.tolist() == [0, len(points) - 2]
    assert points[0] == pytest.approx(path.segments[0].start)
    assert points[-1] == pytest.approx([20, 20, 0])
    assert (path.segments[0].foot(points[:-2]).distance < 1e-12).all()
    assert np.linalg.norm(np.diff(points, axis=0), axis=1).max() < 36.0


def test_an_empty_path_is_refused() -> None:
    with pytest.raises(ValueError, match="no segments"):
        Path(())
