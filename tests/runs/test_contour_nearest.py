"""Nearest segments among many: none is missed, and few are looked at."""

import math
from dataclasses import replace
from unittest.mock import patch

import numpy as np
import pytest
from contour_runs import Machine, Program, run_along
from hypothesis import given, settings
from hypothesis import strategies as st

from motionfmu.analysis.contour import ContourInput, Path, analyse
from motionfmu.analysis.contour.assign import SAME, assign, nearest
from motionfmu.analysis.contour.contour_result import GROUPS
from motionfmu.analysis.contour.scaled_values import ScaledValues
from motionfmu.analysis.contour.segments import Segments


def wild(rng: np.random.Generator, count: int) -> Path:
    """Lines of all lengths, some none, arcs, helices, arcs that grow, and jumps between them."""
    program = Program(*rng.uniform(-5.0, 5.0, 3))
    while len(program.segments) < count:
        kind = rng.integers(0, 8)
        x, y, z = program.here
        if kind == 0:
            program.here = program.here + rng.normal(size=3)  # a jump
        elif kind == 1:
            program.line(x, y, z)
        elif kind == 2:
            program.arc(
                (x + rng.normal(), y + 0.1 + rng.random()),
                rng.uniform(-9.0, 9.0),
                rise=rng.choice([0.0, rng.normal()]),
            )
            arc = program.segments[-1]
            if rng.random() < 0.5:
                program.segments[-1] = replace(arc, growth=0.3 * arc.radius * rng.random())
        else:
            program.line(*program.here + rng.normal(size=3) * 10.0 ** rng.uniform(-3, 0.5))
    return program.path()


def windows(rng: np.random.Generator, samples: int, segments: int) -> tuple[np.ndarray, np.ndarray]:
    ends = np.sort(rng.integers(0, segments, (2, samples)), axis=1)
    return np.minimum(*ends), np.maximum(*ends)


@settings(max_examples=60)
@given(st.integers(0, 2**32), st.integers(1, 40), st.integers(1, 90), st.sampled_from([0.0, 0.4]))
def test_nearest_segments_are_those_of_a_search_of_all(seed, segments, samples, room) -> None:
    rng = np.random.default_rng(seed)
    path = wild(rng, segments)
    # a tool that goes along the path and off it, sometimes far
    way = np.sort(rng.uniform(0.0, path.offsets[-1], samples))
    on = np.clip(np.searchsorted(path.offsets, way, side="right") - 1, 0, segments - 1)
    points = path.segments.at(on, way - path.offsets[on])
    points = points + rng.normal(size=points.shape) * rng.choice([0.0, 0.01, 3.0])
    first, last = windows(rng, samples, segments)
    low, high = nearest(points, path, (first, last), room)
    every = np.array([s.foot(points).distance for s in path.segments])
    for t in range(samples):
        own = every[first[t] : last[t] + 1, t]
        near = first[t] + np.flatnonzero(own <= own.min() + room)
        assert first[t] <= low[t] <= near[0] and near[-1] <= high[t] <= last[t]
        if room == 0.0:
            assert every[low[t], t] <= own.min() + 2.0 * SAME
            assert every[high[t], t] <= own.min() + 2.0 * SAME


@settings(max_examples=25)
@given(st.integers(0, 2**32), st.integers(1, 30))
def test_feet_on_many_segments_are_those_on_each(seed, segments) -> None:
    rng = np.random.default_rng(seed)
    path = wild(rng, segments)
    points = rng.normal(size=(50, 3)) * 6.0
    which = np.sort(rng.integers(0, segments, 50))
    with patch("motionfmu.analysis.contour.segments.RUN", int(rng.choice([1, 256]))):
        found = path.segments.foot(points, which)
    for t in range(50):
        alone = path.segments[int(which[t])].foot(points[t : t + 1])
        assert found.distance[t] == pytest.approx(alone.distance[0], abs=1e-11)
        gap = points[t] - found.point[t]
        assert np.linalg.norm(gap) == pytest.approx(alone.distance[0], abs=1e-11)
        back = path.segments.at(which[t : t + 1], found.along[t : t + 1])[0]
        assert back == pytest.approx(found.point[t], abs=1e-9)
    ends = [path.segments[i].end for i in range(segments)]
    assert path.segments.ends == pytest.approx(np.array(ends), abs=1e-12)
    assert path.lengths == pytest.approx([s.length for s in path.segments], rel=1e-14)


@settings(max_examples=40)
@given(st.integers(0, 2**32), st.sampled_from([1, 7, 400]))
def test_distances_alone_have_the_bits_of_the_feet(seed: int, run: int) -> None:
    """Of points one by one on segments at random, and of long runs on one segment each."""
    rng = np.random.default_rng(seed)
    segments = wild(rng, 12).segments
    which = np.repeat(rng.integers(0, len(segments), 9), run)
    points = rng.normal(size=(len(which), 3)) * 10.0 ** rng.uniform(-2, 1)
    wanted = segments.foot(points, which).distance
    assert segments.distances(points, which).tobytes() == wanted.tobytes()


def test_no_two_points_of_a_path_are_farther_apart_than_the_way_between() -> None:
    rng = np.random.default_rng(3)
    path = wild(rng, 60)
    begin, end = path.segments.way
    for i, j in rng.integers(0, 60, (400, 2)):
        i, j = sorted((int(i), int(j)))
        gap = path.segments[j].end - path.segments[i].start
        assert np.linalg.norm(gap) <= end[j] - begin[i] + 1e-9
    for segment, room in zip(path.segments, end - begin, strict=True):
        dense = segment.at(np.linspace(0.0, segment.length, 4000))
        way = np.linalg.norm(np.diff(dense, axis=0), axis=1).sum()
        assert way <= room + 1e-9 and room <= 1.1 * way + 1e-9


def test_work_does_not_grow_with_the_candidates() -> None:
    # A wave of 8000 lines of 10 um: each sample may lie on 100, then on 1600 of them.
    k = np.arange(8001)
    points = np.column_stack([0.01 * k, np.sin(0.002 * k), 0.0 * k])
    program = Program(0, 0)
    for x, y, _ in points[1:]:
        program.line(x, y)
    path = program.path()
    on = np.repeat(np.arange(1000, 7000), 2)
    tool = points[on] + [0.0, 0.03, 0.0]
    looked: list[int] = []

    def counted(self, points, which):
        looked.append(len(which))
        return foot(self, points, which)

    foot, found = Segments.foot, []
    with patch.object(Segments, "foot", counted):
        for half in (50, 800):
            looked.clear()
            found.append(assign(tool, path, on - half, on + half))
            found.append(np.array(sum(looked) / len(on)))
    assert (found[0] == found[2]).all()
    assert 1.0 < found[3] < 20.0 and found[3] == pytest.approx(found[1], rel=0.2)


def test_a_sample_that_rests_at_a_corner_belongs_to_the_later_move() -> None:
    path = Program(0, 0).line(10, 0).line(10, 0).line(10, 10).path()
    points = np.array([[9.0, 0, 0], [10.0, 0, 0], [10.1, -0.1, 0], [10.1, -0.1, 0], [10.0, 3.0, 0]])
    first, last = np.zeros(5, dtype=int), np.full(5, 2)
    assert assign(points, path, first, last).tolist() == [0, 2, 2, 2, 2]
    # not before the next sample allows it
    points[3] = [9.5, 0.0, 0.0]
    assert assign(points, path, first, last).tolist() == [0, 0, 0, 0, 2]


def figure_of_eight() -> ContourInput:
    path = Program(20, 0).arc((0, 0), 2 * math.pi).line(40, 0).arc((60, 0), -2 * math.pi).path()
    machine = Machine(gains=(40.0, 55.0, 50.0), pulse=5e-4, backlash=2e-3)
    return run_along(path, 60.0, machine)


def test_parts_leave_no_seam_and_memory_maps_are_read_as_arrays(tmp_path) -> None:
    run = figure_of_eight()
    run.command[-300:] = 0  # the newest command so far counts
    whole = analyse(run)
    assert len(whole.circles) == 2 and whole.track.segment[-1] == 2
    np.save(tmp_path / "actual.npy", run.actual * 1e-3)
    np.save(tmp_path / "pulses.npy", np.round(run.commanded * [2000.0, 1000, 2000, 1, 1, 1]))
    actual = np.load(tmp_path / "actual.npy", mmap_mode="r")
    pulses = np.load(tmp_path / "pulses.npy", mmap_mode="r")
    per = np.array([2000.0, 1000, 2000, 1, 1, 1])
    mapped = replace(run, actual=ScaledValues(actual, 1e-3), commanded=ScaledValues(pulses, per))
    assert mapped.commanded[5:9, 1:3] == pytest.approx(run.commanded[5:9, 1:3], abs=1e-12)
    assert mapped.actual[[7, 3], 0] == pytest.approx(run.actual[[7, 3], 0], abs=1e-12)
    told: list[float] = []
    with patch("motionfmu.analysis.contour.scaled_values.BLOCK", 97):
        parts = analyse(mapped, told.append)
        numbers = parts.numbers()
    for name in ("segment", "along", "distance", "right"):
        one, other = getattr(whole.track, name), getattr(parts.track, name)
        assert other == pytest.approx(one, abs=1e-11), name
    assert numbers["following"]["x"]["rms"] == pytest.approx(
        whole.number("following.x.rms"), abs=1e-11
    )
    assert numbers["circles"][0]["ccw"]["g"] == pytest.approx(
        whole.number("circles.0.ccw.g"), abs=1e-11
    )
    assert told == sorted(told) and told[-1] == 1.0
    assert whole.track.feet(np.array([5, 900])) == pytest.approx(whole.track.foot[[5, 900]])


def test_numbers_are_made_once_and_only_those_asked_for() -> None:
    result = analyse(figure_of_eight())
    made: list[str] = []
    groups = {
        name: lambda r, name=name, make=make: made.append(name) or make(r)
        for name, make in GROUPS.items()
    }
    with patch("motionfmu.analysis.contour.contour_result.GROUPS", groups):
        for _ in range(3):
            assert result.number("error.max") == result.error.max
            assert result.number("circles.1.cw.g") > 0.0
        assert made == ["error", "circles"]
        whole = result.numbers()
    assert sorted(made) == sorted(groups) == sorted(whole)
