"""ISO 9283 figures against closed forms, brute force and shapely's geometry."""

import itertools
import math

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from motionfmu.analysis.iso9283 import (
    CommandPath,
    Cycle,
    Cycles,
    Evaluation,
    analyse,
    coincidence,
    pose_performance,
    read_points,
    straightness,
)
from motionfmu.analysis.iso9283.evaluation import TREE, wrong
from motionfmu.analysis.iso9283.simplify import simplified
from motionfmu.base.errors import NoNumber

LENGTH = 90.0  # [mm]
SPEED = 30.0  # [mm/s]
LINE = CommandPath(np.array([[0.0, 0.0, 0.0], [LENGTH, 0.0, 0.0]]))
OFFSETS = np.array([-0.2, 0.1, 0.15, 0.4, 0.25])  # [mm]


def along_line(error, count: int = 3001, speed: float = SPEED, turn=None) -> Cycle:
    """A cycle along x whose error is a function of x."""
    x = np.linspace(0.0, LENGTH, count)
    return Cycle(x / speed, np.stack([x, *error(x)], axis=1), turn)


def still(x: np.ndarray, y: float = 0.0, z: float = 0.0) -> tuple[np.ndarray, np.ndarray]:
    return np.full_like(x, y), np.full_like(x, z)


def evaluated(cycles, path: CommandPath = LINE, **how) -> Evaluation:
    return Evaluation(analyse(Cycles(cycles, path, **how)))


def test_offsets_give_their_mean_and_spread() -> None:
    found = evaluated([along_line(lambda x, o=o: still(x, o, 0.3)) for o in OFFSETS])
    mean = OFFSETS.mean()
    far = np.abs(OFFSETS - mean)
    assert found.number("AT_P") == pytest.approx(math.hypot(mean, 0.3), abs=1e-12)
    spread = far.mean() + 3.0 * math.sqrt(((far - far.mean()) ** 2).sum() / (len(far) - 1))
    assert found.number("RT_P") == pytest.approx(spread, abs=1e-12)
    for name in ("straightness", "straightness_in_plane", "in_plane", "height"):
        assert abs(found.number(name)) < 1e-12, name
    assert found.number("coincidence.lines") == pytest.approx(np.ptp(OFFSETS), abs=1e-12)


def test_a_wave_gives_its_amplitude_and_its_range() -> None:
    """A cosine of whole periods has no slope and no mean: the best line is the command."""
    wave, up = 0.07, 0.02

    def error(x: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        turn = 2.0 * np.pi * x / LENGTH
        return wave * np.cos(2.0 * turn), up * np.cos(2.0 * turn)

    found = evaluated([along_line(error)], planes=401, ramp=0.0)
    # both peaks weigh once more at the ends of the planes: the best line moves by their share
    assert found.number("in_plane") == pytest.approx(2.0 * wave, rel=1e-4)
    assert found.number("height") == pytest.approx(2.0 * up, rel=1e-4)
    assert found.number("straightness_in_plane") == pytest.approx(wave, rel=4e-3)
    assert found.number("straightness") == pytest.approx(math.hypot(wave, up), rel=4e-3)
    assert found.number("AT_P") == pytest.approx(math.hypot(wave, up), rel=1e-4)


def test_a_circle_too_small_is_off_by_the_radius() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 7201)
    ring = np.stack([np.cos(turn), np.sin(turn), 0.0 * turn], axis=1)
    path = CommandPath.of(50.0 * ring)
    found = evaluated([Cycle(turn, (50.0 - 0.04) * ring)], path, ramp=0.0)
    chord = 50.0 * (1.0 - math.cos(math.pi / 7200))
    assert found.number("AT_P") == pytest.approx(0.04, abs=2.0 * chord)
    assert found.path.across.mean() == pytest.approx(0.04, abs=2.0 * chord)  # left: inwards
    assert found.number("in_plane") < 2.0 * chord
    with pytest.raises(NoNumber, match="not straight"):
        found.number("straightness")


def test_av_is_way_over_time_and_fv_counts_backwards() -> None:
    time = np.arange(0.0, 20.0, 1e-3)  # 5 mm/s with a ripple of 8 mm/s at 7 Hz: it goes back
    ripple = 8.0 / (14.0 * np.pi) * np.sin(14.0 * np.pi * time)
    x = 5.0 * 0.9993 * time + ripple
    path = CommandPath(np.array([[0.0, 0.0, 0.0], [90.0, 0.0, 0.0]]))
    shake = 1e-2 * np.sin(200.0 * time)  # across the path: no part of its speed
    cycle = Cycle(time, np.stack([x, shake, 0.0 * x], axis=1))
    found = Evaluation(analyse(Cycles([cycle], path, 5.0, ramp=0.0)))
    middle = 45.0 / 5.0  # [s]; the ripple moves each end by at most its amplitude
    assert found.number("AV") == pytest.approx(-0.07, abs=100 * 2 * 0.182 / (5.0 * middle))
    tilt = 2 * 1e-2 / (90.0 / 200)  # of the way from plane to plane, by the shake
    assert found.number("FV") == pytest.approx(16.0, abs=2.0 * 2.0 * tilt)


def test_speeds_give_av_rv_and_fv() -> None:
    parts = np.array([0.99, 1.0, 1.02, 0.97])
    found = evaluated([along_line(still, speed=SPEED * p) for p in parts], speed=SPEED)
    assert found.number("AV") == pytest.approx(100.0 * (parts.mean() - 1.0), abs=1e-9)
    assert found.number("RV") == pytest.approx(300.0 * parts.std(ddof=1), abs=1e-9)
    assert found.number("FV") < 1e-9
    x = np.linspace(0.0, LENGTH, 20001)  # dx/dt = v (1 + 0.1 sin): t is the integral of 1/v
    speed = SPEED * (1.0 + 0.1 * np.sin(2.0 * np.pi * x / 9.0))
    time = np.concatenate([[0.0], np.cumsum(np.diff(x) / (0.5 * (speed[1:] + speed[:-1])))])
    cycle = Cycle(time, np.stack([x, 0 * x, 0 * x], axis=1))
    assert evaluated([cycle], speed=SPEED).number("FV") == pytest.approx(0.2 * SPEED, rel=1e-4)


def test_ramps_are_left_out() -> None:
    """With constant acceleration half the speed is reached on a quarter of the ramp's way."""
    ramp, dt = 0.4, 1e-4
    time = np.arange(0.0, 3.4 + dt, dt)
    speed = SPEED * np.clip(np.minimum(time, time[-1] - time) / ramp, 0.0, 1.0)
    x = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * dt)])
    path = CommandPath(np.array([[0.0, 0.0, 0.0], [x[-1], 0.0, 0.0]]))
    cycle = Cycle(time, np.stack([x, 0 * x, 0 * x], axis=1))
    quarter = 0.25 * SPEED * ramp / 2.0
    found = evaluated([cycle], path, speed=SPEED)
    step = path.length / 399  # of the survey
    for end in ("start", "end"):
        assert quarter <= found.number(f"excluded.{end}") <= quarter + step
    whole = evaluated([cycle], path, speed=SPEED, ramp=0.0)
    assert whole.number("excluded.start") == 0.0 and whole.number("excluded.end") <= step


def test_angles_are_those_of_a_rotation_about_the_base_axes() -> None:
    command = Rotation.from_euler(
        "xyz", [180.0, 20.0, -35.0], degrees=True
    )  # a tool that points down
    told = np.array([[0.1, -0.2, 0.3], [0.3, 0.1, -0.1], [-0.1, 0.4, 0.2]])
    path = CommandPath(LINE.points, np.tile(command.as_quat(scalar_first=True), (2, 1)))
    cycles = []
    for k, angles in enumerate(told):
        turned = (Rotation.from_euler("xyz", angles, degrees=True) * command).as_quat(
            scalar_first=True
        )
        cycles.append(along_line(still, turn=np.tile((-1) ** k * turned, (3001, 1))))
    found = evaluated(cycles, path)
    for i, name in enumerate("abc"):
        assert found.number(f"AT_{name}") == pytest.approx(abs(told[:, i].mean()), abs=1e-9)
        assert found.number(f"RT_{name}") == pytest.approx(3 * told[:, i].std(ddof=1), abs=1e-9)


def test_poses() -> None:
    rng = np.random.default_rng(3)
    command = rng.uniform(-500, 500, (5, 3))
    reached = command + rng.normal(0.1, 0.05, (30, 5, 3))
    found = pose_performance(reached, command)
    for i, pose in enumerate(found):
        xs, ys, zs = (sum(row[i][a] for row in reached) / 30 for a in range(3))
        off = (xs - command[i][0], ys - command[i][1], zs - command[i][2])
        assert pose.AP_P == pytest.approx(math.sqrt(sum(o * o for o in off)), rel=1e-12)
        far = [math.dist(row[i], (xs, ys, zs)) for row in reached]
        mean = sum(far) / 30
        spread = mean + 3.0 * math.sqrt(sum((f - mean) ** 2 for f in far) / 29)
        assert pose.RP_l == pytest.approx(spread, rel=1e-12)


def test_a_round_scatter_is_repeated_within_so_many_deviations() -> None:
    """Of 1 mm in each direction: Maxwell's mean and deviation in space, Rayleigh's in a plane."""
    drawn = np.random.default_rng(9).normal(size=(200_000, 1, 3))
    space = pose_performance(drawn, np.zeros((1, 3)))[0].RP_l
    assert space == pytest.approx(np.sqrt(8 / np.pi) + 3 * np.sqrt(3 - 8 / np.pi), rel=5e-3)
    drawn[:, :, 0] = 0.0
    plane = pose_performance(drawn, np.zeros((1, 3)))[0].RP_l
    assert plane == pytest.approx(np.sqrt(np.pi / 2) + 3 * np.sqrt(2 - np.pi / 2), rel=5e-3)


def test_the_best_line_is_the_one_that_a_search_finds() -> None:
    rng = np.random.default_rng(8)
    points = np.outer(np.linspace(-50, 50, 40), [0.6, 0.48, 0.64]) + rng.normal(0, 0.2, (40, 3))

    def distances(free: np.ndarray) -> np.ndarray:
        way = np.array([free[2], free[3], 1.0])
        way /= np.linalg.norm(way)
        return np.linalg.norm(np.cross(points - [free[0], free[1], 0.0], way), axis=1)

    start = np.array([0.0, 0.0, 0.9, 0.75])
    best = minimize(lambda f: (distances(f) ** 2).sum(), start, method="BFGS", tol=1e-10).x
    assert straightness(points) == pytest.approx(distances(best).max(), rel=1e-4)


@settings(max_examples=60)
@given(st.lists(st.floats(-3, 3), min_size=2, max_size=12), st.floats(0.1, 2.5))
def test_strokes_are_what_shapely_paints(offsets: list[float], width: float) -> None:
    found = coincidence(np.array(offsets)[:, None], width)
    lines = [shapely.LineString([(-10, o), (10, o)]) for o in offsets]
    painted = shapely.unary_union([line.buffer(width / 2, cap_style="flat") for line in lines])
    across = shapely.LineString([(0, -10), (0, 10)]).intersection(painted)
    pieces = sorted(p.bounds[1::2] for p in getattr(across, "geoms", [across]))
    white = max((b[0] - a[1] for a, b in itertools.pairwise(pieces)), default=0.0)
    assert found.band == pytest.approx(pieces[-1][1] - pieces[0][0], abs=1e-9)
    assert found.gap == pytest.approx(white, abs=1e-9)
    whole = lines[0].buffer(width / 2, cap_style="flat")
    for line in lines[1:]:
        whole = whole.intersection(line.buffer(width / 2, cap_style="flat"))
    assert found.common == pytest.approx(whole.area / (20.0 * width), abs=1e-9)


@settings(max_examples=30)
@given(st.integers(0, 10**6), st.integers(2, 5), st.integers(1, 6))
def test_any_path_is_as_shapely_cuts_it(seed: int, corners: int, cycles: int) -> None:
    """Planes are lines in a drawing: where shapely cuts the recorded lines is where we do."""
    rng = np.random.default_rng(seed)
    turns = np.cumsum(rng.uniform(-1.2, 1.2, corners))
    points = np.cumsum(np.stack([np.cos(turns), np.sin(turns), 0 * turns], axis=1) * 20.0, axis=0)
    path = CommandPath(np.vstack([np.zeros(3), points]))
    place = np.linspace(0.0, path.length, 1501)
    base, runs = path.at(place), []
    for _ in range(cycles):
        low = rng.normal(0.0, 0.05, (12, 3)) * [1.0, 1.0, 0.0]
        noise = np.stack([np.interp(place, np.linspace(0, path.length, 12), c) for c in low.T], 1)
        runs.append(Cycle(place / SPEED, base + noise))
    found = analyse(Cycles(runs, path, planes=60, ramp=0.0, corner=1.5))
    drawn = [shapely.LineString(r.position[:, :2]) for r in runs]
    accuracy = []
    for i, s in enumerate(found.along):
        centre, way = path.at(np.array([s]))[0, :2], found.way[i, :2]
        side = np.array([-way[1], way[0]])
        plane = shapely.LineString([centre - side, centre + side])
        cut = [line.intersection(plane) for line in drawn]
        middle = shapely.Point(*centre)
        own = [min(getattr(c, "geoms", [c]), key=middle.distance) for c in cut]
        mean = np.mean([[p.x, p.y] for p in own], axis=0)
        accuracy.append(math.dist(mean, centre))
        assert np.allclose(found.point[:, i, :2], [[p.x, p.y] for p in own], atol=1e-9)
    assert np.allclose(found.accuracy, accuracy, atol=1e-9)


def test_a_path_out_and_back_keeps_its_own_passes() -> None:
    """The way back crosses the same places the other way; only the way out counts there."""
    path = CommandPath(np.array([[0.0, 0, 0], [50.0, 0, 0], [50.0, 1, 0], [0.0, 1, 0]]))
    place = np.linspace(0.0, path.length, 5001)
    out = place <= 50.0
    error = np.where(out, 0.1, -0.25)
    cycle = Cycle(place, path.at(place) + np.outer(error, [0, 0, 1]))
    found = evaluated([cycle], path, ramp=0.0, corner=1.0)
    assert found.path.height.min() == pytest.approx(-0.25) and found.path.height.max() == 0.1
    assert np.allclose(found.path.height[0], np.where(found.path.along <= 50.0, 0.1, -0.25))


@pytest.mark.parametrize("turn", [20.0, 60.0, -60.0, 89.0])
def test_planes_behind_a_corner_are_found_on_the_inner_side(turn: float) -> None:
    """A tool that runs inside a corner crosses the first plane behind it before the last one."""
    way = np.array([math.cos(math.radians(turn)), math.sin(math.radians(turn)), 0.0])
    path = CommandPath(np.array([[0.0, 0, 0], [40.0, 0, 0], 40.0 * way + [40, 0, 0]]))
    inner = math.copysign(0.2, turn) * np.array([[0.0, 1, 0], [-way[1], way[0], 0]])
    middle = np.array([40.0, 0, 0]) + inner[0] - [0.2 * math.tan(abs(math.radians(turn)) / 2), 0, 0]
    ends = np.array([inner[0], middle, path.points[2] + inner[1]])
    tool = CommandPath(ends)
    place = np.linspace(0.0, tool.length, 8001)
    found = evaluated(
        [Cycle(place / SPEED, tool.at(place))], path, planes=1999, ramp=0.0, corner=0.0
    )
    far = np.abs(found.path.along - 40.0) > 0.2 * math.tan(abs(math.radians(turn)) / 2) + 1e-6
    assert np.allclose(found.path.accuracy[far], 0.2, atol=1e-9) and far.sum() > 1900


def test_a_recorded_command_becomes_a_polyline_that_is_as_good() -> None:
    turn = np.linspace(0.0, 2.0 * np.pi, 20001)
    points = np.stack([np.cos(turn), np.sin(turn), 0 * turn], axis=1) * 40.0
    points = np.vstack([points[0] + np.outer(np.linspace(-30, 0, 500), [1, 0, 0]), points])
    kept = simplified(points, 1e-4)
    assert len(kept) < 2500 and kept[0] == 0 and kept[-1] == len(points) - 1
    line = shapely.LineString(points[kept][:, :2])
    off = max(line.distance(shapely.Point(*p[:2])) for p in points[::37])
    assert 2e-5 < off <= 1e-4 + 1e-9
    back = np.array([[0.0, 0, 0], [60, 0, 0], [100, 0, 0], [70, 0, 0], [50, 0, 0]])
    assert simplified(back).tolist() == [0, 2, 4]


def test_points_are_read_and_a_wrong_line_is_named(tmp_path) -> None:
    file = tmp_path / "path.txt"
    file.write_text("# x y z\n0 0 1\n\n0, 5, 1  # corner\n9 5 1\n")
    assert read_points(file).length == pytest.approx(14.0)
    for text, told in (
        ("0 0 1\n0 5\n", r"path.txt:2: '0 5': 3 numbers"),
        ("0 0 1\n0 5 x\n", r"path.txt:2:"),
        ("0 0 nan\n0 5 1\n", r"path.txt:1:"),
        ("0 0 1\n", r"two points or more"),
        ("1 1 1\n1 1 1\n", r"m >= 2"),
    ):
        file.write_text(text)
        with pytest.raises(ValueError, match=told):
            read_points(file)
    with pytest.raises(ValueError, match=r"none.txt: No such file"):
        read_points(tmp_path / "none.txt")


def test_a_cycle_that_goes_elsewhere_is_refused() -> None:
    good, far = along_line(still), along_line(lambda x: still(x, 30.0))
    with pytest.raises(ValueError, match="cycle 2 does not follow the path"):
        analyse(Cycles([good, far], LINE))
    x = good.position
    jump = Cycle(
        good.time, np.where((x[:, :1] > 40) & (x[:, :1] < 50), x + np.array([0, 80, 0]), x)
    )
    with pytest.raises(ValueError, match=r"cycle 1 does not cross the path at 4\d"):
        analyse(Cycles([jump], LINE))
    with pytest.raises(ValueError, match=r"cycle 1 never reaches 0.5 of 300"):
        analyse(Cycles([good], LINE, speed=300.0))


def test_every_name_there_can_be_is_a_number_or_has_a_reason() -> None:
    found = evaluated([along_line(still)])

    def names(tree, before: str = ""):
        for name in tree:
            here = tree[name] if isinstance(tree, dict) else ()
            if isinstance(here, list):
                yield from names(dict.fromkeys(here[0], ()), f"{before}{name}.0.")
            elif here:
                yield from names(here, f"{before}{name}.")
            else:
                yield f"{before}{name}"

    listed = list(names(TREE))
    assert len(listed) > 40
    for name in listed:
        assert wrong(name) == ""
        try:
            assert math.isfinite(found.number(name))
        except NoNumber as told:
            assert "there is" in str(told) or "orientation" in str(told) or "no speed" in str(told)
    for name, told in (("AT_X", "no 'AT_X'"), ("cycles.0", "several"), ("AT_P.x", "is a number")):
        assert told in wrong(name)
