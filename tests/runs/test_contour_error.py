"""Contour errors of synthetic runs against closed formulas."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from contour_runs import Machine, Program, lag_error, run_along

from motionfmu.analysis.contour import ContourInput, Trace, analyse
from motionfmu.analysis.contour.error import servo_lag
from motionfmu.analysis.contour.instants import Instants
from motionfmu.base.errors import NoNumber

FEED = 100.0  # [mm/s]


def circle(radius: float, turns: float = 2.0, start: float = 0.0) -> Program:
    here = (radius * math.cos(start), radius * math.sin(start))
    return Program(*here).arc((0, 0), turns * 2 * math.pi)


@pytest.mark.parametrize(
    ("radius", "feed", "gain"), [(50.0, 100.0, 50.0), (10.0, 100.0, 30.0), (25.0, 50.0, 16.6667)]
)
def test_lagging_circle_is_too_small_by_one_minus_cos(radius, feed, gain) -> None:
    machine = Machine(gains=(gain, gain, gain), step=2e-4)
    result = analyse(run_along(circle(radius).path(), feed, machine))
    phi = math.atan(feed / (radius * gain))
    truth = radius * (1.0 - math.cos(phi))
    steady = result.circles[0].ccw
    assert steady.steady and steady.coverage > 0.99 * 2 * math.pi
    # 10 nm: the commanded points are chords, and exp(-10) of the run-in is left
    assert steady.reading.radius_change == pytest.approx(-truth, abs=1e-5)
    assert result.error.max == pytest.approx(truth, abs=1e-4)
    # the tangent estimate would say this, about twice as much
    assert result.error.max < 0.55 * radius * math.sin(phi) ** 2
    # servo lag does not show in G, and shows in F
    assert steady.reading.g < 1e-4
    assert steady.reading.f_max == pytest.approx(-truth, abs=1e-4)
    # inside a counter-clockwise circle is left of the path
    assert result.track.signed[result.cutting].min() >= -1e-6


@pytest.mark.parametrize("angle", [0.3, math.pi / 4, 2.0, -2.5])
@pytest.mark.parametrize("gains", [(50.0, 45.0, 50.0), (20.0, 33.0, 50.0)])
def test_mismatched_axes_shift_a_line(angle: float, gains) -> None:
    way = 200.0 * np.array([math.cos(angle), math.sin(angle)])
    result = analyse(run_along(Program(0, 0).line(*way).path(), FEED, Machine(gains=gains)))
    theory = FEED * math.sin(angle) * math.cos(angle) * (1.0 / gains[0] - 1.0 / gains[1])
    assert result.error.max == pytest.approx(abs(theory), rel=1e-9)
    middle = len(result.run.time) // 2
    # a smaller Kx leaves x behind: the tool is to the left of a line into the first quadrant
    assert result.track.signed[middle] == pytest.approx(theory, rel=1e-3)
    # Sum of v . gap over sum of v . v, the gap of an axis v (1 - exp(-K t))/K since the start; sums
    # of 2000 steps miss the integrals by a step at either end.
    lag, total = 0.0, 200.0 / FEED
    for part, gain in zip((math.cos(angle), math.sin(angle)), gains, strict=False):
        lag += part**2 / gain * (1.0 - (1.0 - math.exp(-gain * total)) / (gain * total))
    assert result.lag == pytest.approx(lag, rel=2.0 / 2000)


@pytest.mark.parametrize("degrees", [15, 45, 90, 135, 165, -60])
def test_sharp_corner(degrees: float) -> None:
    th, gain = math.radians(degrees), 40.0
    end = (60 + 60 * math.cos(th), 60 * math.sin(th))
    path = Program(0, 0).line(60, 0).line(*end).path()
    result = analyse(run_along(path, FEED, Machine(gains=(gain,) * 3, step=1e-4)))
    theory = abs(math.sin(th)) * FEED / (math.e * gain)
    assert result.error.max == pytest.approx(theory, rel=1e-5)
    corner = result.corners[0]
    assert corner.error == result.error.max
    assert corner.angle == pytest.approx(abs(th))
    assert corner.time == pytest.approx(0.5 + 60 / FEED + 1.0 / gain, abs=2e-4)  # Kp t = 1
    assert (corner.line_before, corner.line_after) == (10, 20)
    assert corner.speed == pytest.approx(FEED, rel=1e-6) or degrees > 90


@pytest.mark.parametrize("degrees", [40, 90, 150])
def test_mixed_corner_is_measured_from_both_sides(degrees: float) -> None:
    """Two lines of which the second begins when the first begins to slow down (G64).

    The distances from the lines are the way left on the first, F (T - t)^2 / 2T, and that gone on
    the second, F t^2 / 2T, times sin th: equal at T/2, where both are F T sin(th) / 8.
    """
    th, ramp, fifo = math.radians(degrees), 0.1, 0.004
    turn = np.array([math.cos(th), math.sin(th)])
    path = Program(0, 0).line(40, 0).line(40 + 40 * turn[0], 40 * turn[1]).path()
    time = np.arange(0.0, 1.2, 1e-4)
    begin = 40.0 / FEED - 0.5 * ramp  # of the second line
    t = np.clip(time - begin, 0.0, ramp)
    left = 40.0 - np.minimum(FEED * time, FEED * begin) - FEED * (t - t**2 / (2.0 * ramp))
    gone = FEED * (t**2 / (2.0 * ramp) + np.clip(time - begin - ramp, 0.0, 0.3))
    commanded = np.zeros((len(time), 6))
    commanded[:, :2] = np.outer(40.0 - left, [1.0, 0.0]) + np.outer(gone, turn)
    command = np.where(time + fifo < begin + ramp, 1, 2)
    newest = np.where(time + fifo < begin, 1, 2)
    run = ContourInput(path, time, commanded, commanded, command, newest, window=0.05)
    run = replace(run, stock=np.full(len(time), 7.0))
    result = analyse(run)

    mixed = (time >= begin) & (time <= begin + ramp)
    corner = commanded[mixed, :2] - [40.0, 0.0]
    first = np.outer(np.minimum(corner[:, 0], 0.0), [1.0, 0.0])
    second = np.outer(np.maximum(corner @ turn, 0.0), turn)
    truth = np.linalg.norm([corner - first, corner - second], axis=2).min(axis=0)
    assert result.command_track.distance[mixed] == pytest.approx(truth, abs=1e-9)
    most = FEED * ramp / 8.0 * math.sin(th) if degrees <= 90 else truth.max()
    assert result.command_error.max == pytest.approx(most, rel=1e-4)
    # with the number of the older command alone, all of the corner would be held against it
    assert analyse(replace(run, newest=None)).command_error.max > 1.5 * most


def test_where_the_largest_error_is() -> None:
    path = Program(0, 0).line(60, 0).line(60, 60).line(0, 60).line(30, 90).path()
    result = analyse(run_along(path, FEED, Machine(gains=(40.0, 40.0, 40.0), step=1e-4)))
    # turning back by 135 degrees in the last corner errs less than the two square ones
    assert result.error.line in (10, 20, 30)
    assert result.error.command * 10 == result.error.line
    foot = np.array(result.error.point)
    assert min(np.linalg.norm(foot - [60, 0, 0]), np.linalg.norm(foot - [60, 60, 0])) < 1.0
    assert [c.line_after for c in result.corners] == [20, 30, 40]
    worst = {row["command"]: row["max"] for row in result.numbers()["commands"]}
    assert max(worst.values()) == result.error.max and set(worst) == {1, 2, 3, 4}


def test_mismatch_turns_the_circle_into_an_ellipse() -> None:
    radius, gains = 50.0, (50.0, 40.0, 50.0)
    run = run_along(circle(radius, 3.0).path(), FEED, Machine(gains=gains, step=2e-4))
    reading = analyse(run).circles[0].ccw.reading
    omega = FEED / radius
    response = np.diag([g / (g + 1j * omega) for g in gains[:2]])
    # x = Re(hx e^jwt), y = Re(-j hy e^jwt): singular values of [Re; -Im] are the semi-axes
    phasor = response @ np.array([1.0, -1j])
    u, s, _ = np.linalg.svd(np.column_stack([phasor.real, -phasor.imag]))
    assert reading.major_change == pytest.approx(radius * (s[0] - 1.0), abs=2e-6)
    assert reading.minor_change == pytest.approx(radius * (s[1] - 1.0), abs=2e-6)
    axis = math.atan2(u[1, 0], u[0, 0])
    assert math.sin(reading.orientation - axis) == pytest.approx(0.0, abs=1e-3)
    assert abs(reading.orientation) == pytest.approx(math.pi / 4, abs=0.03)
    assert reading.g == pytest.approx(radius * (s[0] - s[1]), abs=3e-6)


def test_mismatch_flips_with_direction_and_lag_does_not_show_in_g() -> None:
    program = circle(50.0, 2.0).arc((0, 0), -4 * math.pi)
    machine = Machine(gains=(50.0, 45.0, 50.0), step=2e-4)
    test = analyse(run_along(program.path(), FEED, machine)).circles[0]
    assert test.ccw.reading.orientation * test.cw.reading.orientation < 0.0
    assert test.both.g == pytest.approx(test.ccw.reading.g, rel=0.02)
    mean = 0.5 * (test.ccw.reading.radius_change + test.cw.reading.radius_change)
    assert test.both.d == pytest.approx(mean, abs=1e-6)


def test_backlash_shows_in_both_directions() -> None:
    width = 0.02
    program = circle(50.0, 2.0).arc((0, 0), -4 * math.pi)
    machine = Machine(gains=(200.0,) * 3, backlash=width, step=1e-3)
    result = analyse(run_along(program.path(), 20.0, machine))
    test = result.circles[0]
    # Each axis trails by half the backlash, so each way round is a circle whose quadrants are
    # shifted by +-B/2: radius + B/2 (|cos| + |sin|) signed by the direction of motion
    one_way = test.ccw.reading
    assert one_way.f_max <= 0.5 * width * 1.01
    assert test.both.g >= one_way.g - 1e-9
    assert test.both.g > 0.5 * width


def test_helix_against_dense_sampling() -> None:
    path = Program(20.0, 0, 0).arc((0, 0), 5 * math.pi, rise=12.0).path()
    result = analyse(run_along(path, FEED, Machine(gains=(30.0, 30.0, 45.0), step=1e-3)))
    assert result.track.signed is None and path.normal is None
    dense = path.segments[0].at(np.linspace(0, path.segments[0].length, 200_001))
    chosen = np.flatnonzero(result.cutting)[::37]
    points = result.run.actual[chosen, :3]
    brute = np.array([np.linalg.norm(dense - p, axis=1).min() for p in points])
    gap = path.segments[0].length / 200_000
    exact = result.track.distance[chosen]
    assert (exact <= brute + 1e-12).all()
    assert (brute - exact <= 0.5 * gap).all()


def test_rounding_to_pulses_is_the_command_error() -> None:
    path = Program(0, 0).line(80, 30).line(10, 70).path()
    result = analyse(run_along(path, FEED, Machine(pulse=1e-3)))
    # each axis within half a pulse
    assert 0.0 < result.command_error.max <= math.sqrt(0.5) * 1e-3
    assert result.error.max > 0.1


def test_chord_error_of_coarse_points_is_in_the_command_error() -> None:
    radius, period = 10.0, 0.01
    run = run_along(circle(radius, 1.0).path(), FEED, Machine(step=1e-4))
    grid = np.arange(0.0, run.time[-1] + period, period)
    points = np.column_stack([np.interp(grid, run.time, run.commanded[:, i]) for i in range(6)])
    chords = np.column_stack([np.interp(run.time, grid, points[:, i]) for i in range(6)])
    result = analyse(replace(run, commanded=chords))
    theory = radius * (1.0 - math.cos(FEED * period / (2.0 * radius)))
    assert result.command_error.max == pytest.approx(theory, rel=0.005)


def test_rapids_and_rest_do_not_count() -> None:
    program = Program(0, 0).line(50, 0, kind="ptp").line(50, 80)
    run = run_along(program.path(), FEED, Machine(gains=(50.0, 20.0, 50.0), rest=3.0))
    result = analyse(run)
    assert {10, 20} == {s.label.line for s in program.path().segments}
    assert [row["line"] for row in result.numbers()["commands"]] == [20]
    still = run.time > run.time[-1] - 1.0
    assert not result.cutting[still].any()


def test_a_program_of_rapids_has_no_contour() -> None:
    path = Program(0, 0).line(50, 0, kind="ptp").path()
    with pytest.raises(ValueError, match="no contour"):
        analyse(run_along(path, FEED, Machine()))


def test_the_fifo_delay_does_not_change_the_result() -> None:
    path = Program(0, 0).line(30, 0).line(30, 30).line(0, 30).line(0, 0).path()
    near = analyse(run_along(path, FEED, Machine(fifo=0.0)))
    far = analyse(run_along(path, FEED, Machine(fifo=0.06)))
    assert near.error.max == far.error.max
    assert (near.track.segment == far.track.segment).all()


def test_numbers_are_json_and_found_by_name() -> None:
    result = analyse(run_along(circle(50.0).path(), FEED, Machine()))
    numbers = result.numbers()
    assert json.loads(json.dumps(numbers, allow_nan=False))["error"]["max"] == result.error.max
    assert result.number("error.max") == result.error.max
    assert result.number("circles.0.ccw.g") == result.circles[0].ccw.reading.g
    with pytest.raises(NoNumber, match="no 'cvw', there is centre"):
        result.number("circles.0.cvw.g")
    with pytest.raises(NoNumber, match="is not a number"):
        result.number("circles.0.cw")


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"time": lambda r: r.time[::-1]}, "time must"),
        ({"actual": lambda r: r.actual[:, :3]}, r"actual has the shape"),
        ({"commanded": lambda r: r.commanded * np.nan}, "commanded is not finite at 0 s"),
    ],
)
def test_wrong_signals_are_refused(change, message) -> None:
    run = run_along(Program(0, 0).line(10, 0).path(), FEED, Machine())
    with pytest.raises(ValueError, match=message):
        replace(run, **{k: f(run) for k, f in change.items()})


def test_following_error_is_speed_over_gain() -> None:
    path = Program(0, 0).line(80, 60).path()
    run = run_along(path, FEED, Machine(gains=(40.0, 50.0, 50.0)))
    run = replace(run, traces=(Trace("drive torque", "N.m", np.zeros(len(run.time))),))
    following = analyse(run).numbers()["following"]
    assert following["x"]["max"] == pytest.approx(80.0 / 40.0, rel=1e-9)
    assert following["y"]["max"] == pytest.approx(60.0 / 50.0, rel=1e-9)
    assert following["z"]["max"] == 0.0
    assert isinstance(run, ContourInput)


def test_the_lag_of_a_fast_circle_is_that_of_theory() -> None:
    """Gap over speed of 1/(1 + jw/K), in phase with the speed: (1/K)/(1 + (w/K)^2)."""
    gain, step = 50.0, 1e-3
    time = np.arange(0.0, 3.0, step)
    for w in (1.0, 10.0, 30.0):
        angle = w * time
        commanded = 10.0 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
        actual = commanded - np.column_stack([lag_error(c, gain, step) for c in commanded.T])
        settled = time > 0.5
        found = servo_lag(Instants(time[settled]), commanded[settled], actual[settled])
        assert found == pytest.approx(1.0 / gain / (1.0 + (w / gain) ** 2), rel=0.03)
