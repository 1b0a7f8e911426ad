"""The monotone assignment of samples to segments."""

import itertools
import math
from unittest.mock import patch

import numpy as np
import pytest
from contour_runs import Machine, Program, run_along
from hypothesis import example, given, settings
from hypothesis import strategies as st

from motionfmu.analysis.contour import Path, analyse
from motionfmu.analysis.contour.assign import assign
from motionfmu.analysis.contour.geometry import Label, LineSegment

small = st.integers(-3, 3).map(float)
dot = st.tuples(small, small).map(lambda p: np.array([*p, 0.0]))


def best_by_trying_all(points, segments, first, last) -> float:
    """Least cost over every monotone assignment there is."""
    square = np.array([s.foot(points).distance ** 2 for s in segments])
    least = math.inf
    ranges = [range(a, b + 1) for a, b in zip(first, last, strict=True)]
    for choice in itertools.product(*ranges):
        if all(a <= b for a, b in itertools.pairwise(choice)):
            least = min(least, sum(square[s, t] for t, s in enumerate(choice)))
    return least


@st.composite
def cases(draw):
    count, samples = draw(st.integers(1, 4)), draw(st.integers(1, 6))
    corners = [draw(dot) for _ in range(count + 1)]
    segments = tuple(
        LineSegment(Label(i + 1, i + 1, "line", 0.0), corners[i], corners[i + 1])
        for i in range(count)
    )
    points = np.array([draw(dot) for _ in range(samples)])
    bound = st.integers(0, count - 1)
    ends = [sorted(draw(st.tuples(bound, bound))) for _ in range(samples)]
    first = np.minimum.accumulate([e[0] for e in ends][::-1])[::-1]
    last = np.maximum.accumulate([e[1] for e in ends])
    return points, segments, first, last


def triangle():
    """Run round once: at its start the first and the last side are as near, the second is not."""
    segments = Program(0, 0).line(0, 1).line(1, 0).line(0, 0).path().segments
    points = np.array([[0.0, 0, 0]] * 4 + [[0.0, 1.0, 0]])
    return points, tuple(segments), np.zeros(5, dtype=int), np.array([0, 0, 0, 2, 2])


@settings(max_examples=200)
@example(triangle(), 1)
@given(cases(), st.integers(1, 4))
def test_no_monotone_assignment_is_better(case, together) -> None:
    points, segments, first, last = case
    with patch("motionfmu.analysis.contour.assign.STRIDE", together):
        chosen = assign(points, Path(segments), first, last)
    assert (np.diff(chosen) >= 0).all()
    assert (chosen >= first).all() and (chosen <= last).all()
    cost = sum(
        segments[s].foot(points[t : t + 1]).distance[0] ** 2 for t, s in enumerate(chosen.tolist())
    )
    assert cost == pytest.approx(best_by_trying_all(points, segments, first, last), abs=1e-9)


def test_candidates_must_not_go_back() -> None:
    path = Program(0, 0).line(1, 0).line(2, 0).path()
    points = np.zeros((2, 3))
    with pytest.raises(ValueError, match="candidates"):
        assign(points, path, np.array([1, 0]), np.array([1, 1]))
    with pytest.raises(ValueError, match="candidates"):
        assign(points, path, np.array([1, 1]), np.array([0, 1]))


def test_a_crossing_path_attracts_nothing_to_the_other_branch() -> None:
    # A bow tie: the two long diagonals cross at (50, 50). A tool that stands 3 mm left of the
    # first diagonal there is nearer to the second one, and must not be given to it.
    path = Program(0, 0).line(100, 100).line(100, 0).line(0, 100).path()
    run = run_along(path, 100.0, Machine(gains=(40.0, 40.0, 40.0)))
    shift = np.zeros_like(run.actual)
    s = np.hypot(run.commanded[:, 0] - 50.0, run.commanded[:, 1] - 50.0)
    late = run.time > run.time[np.argmax(run.commanded[:, 0])]
    shift[:, 0] = np.where((s < 10.0) & ~late, -2.0, 0.0)
    shift[:, 1] = -shift[:, 0]
    moved = type(run)(run.path, run.time, run.actual + shift, run.commanded, run.command)
    result = analyse(moved)
    near = (s < 5.0) & ~late
    assert (result.track.segment[near] == 0).all()
    assert result.track.distance[near] == pytest.approx(2.0 * math.sqrt(2.0), abs=1e-9)
    second = path.segments[2].foot(moved.actual[near, :3]).distance
    assert (second < 2.0).any()  # the other branch would have been nearer


def test_a_path_run_twice_advances_once() -> None:
    path = Program(50, 0).arc((0, 0), 2 * math.pi).arc((0, 0), 2 * math.pi).path()
    result = analyse(run_along(path, 200.0, Machine()))
    along = result.track.along
    assert along[-1] == pytest.approx(path.offsets[-1], abs=1e-6)
    assert np.diff(along).min() > -1e-9
    assert set(result.track.segment.tolist()) == {0, 1}


def test_several_turns_in_one_command_advance_once() -> None:
    path = Program(50, 0).arc((0, 0), 6 * math.pi).path()
    result = analyse(run_along(path, 400.0, Machine()))
    assert result.track.along[-1] == pytest.approx(300 * math.pi, abs=1e-6)
    assert np.diff(result.track.along).min() > -1e-9
