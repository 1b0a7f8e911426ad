"""Drawings become jobs: tolerance, limits, the bound of the time, pulses, the file's bytes."""

import dataclasses
import json
import math
import sys
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from lines_apart import apart
from typer.testing import CliRunner

from motionfmu.base.errors import InputError
from motionfmu.cards import CardConfig, card_job, load
from motionfmu.cards.config import read as config_of
from motionfmu.cards.plan import DRAWS, Plan, origin, plan
from motionfmu.cards.plan_figures import deviations, figures, paths
from motionfmu.cli import app
from motionfmu.drawings import DrawingOptions, plt
from motionfmu.drawings.contours import clean, corners, way_between
from motionfmu.report.diagram import Diagram
from motionfmu.report.jobs.card_charts import draw_job

ACC, JERK, SCALE = 1000.0, 50_000.0, 800.0
AXIS = f"""
pulses_per_mm = {SCALE}
minimum = -100
maximum = 300
speed_max = 200
acceleration_max = {ACC}
jerk_max = {JERK}
"""
TEXT = "".join(f'[[axes]]\nname = "{n}"{AXIS}' for n in "XY")


@pytest.fixture(scope="module")
def config() -> CardConfig:
    return config_of(TEXT, "card.toml")


def outline() -> np.ndarray:
    """r = e^cos t - 2 cos 4t + sin^5(t / 12), 8 mm a unit, in whole plotter units."""
    t = 2.0 * np.pi * np.arange(6001) / 6000
    r = 320.0 * (np.exp(np.cos(t)) - 2.0 * np.cos(4.0 * t) + np.sin(t / 12.0) ** 5)
    points = np.round(np.stack([r * np.cos(t), r * np.sin(t)], axis=1)).astype(int)
    return points[np.concatenate([[True], np.diff(points, axis=0).any(axis=1)])]


def written(lines: list[np.ndarray]) -> bytes:
    """Plotter units as a PLT file."""
    parts = [
        f"PU{p[0, 0]},{p[0, 1]};PD" + ",".join(f"{x},{y}" for x, y in p[1:].tolist()) for p in lines
    ]
    return ("IN;SP1;\n" + ";\n".join(parts) + ";PU;").encode()


@pytest.fixture(scope="module")
def planned(config: CardConfig) -> Plan:
    return plan(plt.parse(written([outline()]), "outline.plt"), config)


def test_the_outline_keeps_its_tolerance_both_ways(planned: Plan, config: CardConfig) -> None:
    (driven,) = paths(planned)
    wanted = outline() * 0.025
    there, back = apart([driven], [wanted], 60), apart([wanted], [driven], 60)
    assert 0.005 < there <= 0.02 + 1e-9
    assert 0.005 < back <= 0.02 + 1e-9
    told = figures(planned, config)
    assert told.off == pytest.approx(there, abs=2e-5)
    assert told.back == pytest.approx(back, abs=2e-5)
    assert (told.contours, told.segments, told.stops) == (1, len(wanted) - 1, 0)
    assert told.way_down == pytest.approx(285.0, abs=1.0)
    assert 0.3 < told.at_feed < 0.6


def test_the_outline_is_near_the_least_time(config: CardConfig) -> None:
    """The bound has what is kept free for a pause, and no limit of jerk."""
    sys.path.append(str(ROOT / "scenarios/short_lines"))
    from shape_paths import lines, shaped
    from study import bound

    part = outline()[:700]
    found = plan(plt.parse(written([part])), config)
    least = bound(shaped(lines(part * 0.025, 0.02, 0.02))[0], 100.0)
    time = int((found.steps == DRAWS).sum()) * found.period
    assert 1.0 < time / least < 1.3


def test_each_axis_keeps_its_limits(planned: Plan, config: CardConfig) -> None:
    places = np.vstack([np.zeros((4, 4)), planned.places, planned.places[-1:].repeat(3, axis=0)])
    peaks = [
        np.abs(np.diff(places, n, axis=0)).max(axis=0)[:2] / planned.period**n for n in (1, 2, 3)
    ]
    assert (peaks[0] < 200.0).all() and (peaks[0] > 90.0).all()
    assert (peaks[1] <= 0.9 * ACC * (1 + 1e-6)).all() and (peaks[1] > 0.95 * 0.9 * ACC).all()
    assert (peaks[2] <= 0.9 * JERK * (1 + 1e-6)).all() and (peaks[2] > 0.95 * 0.9 * JERK).all()
    assert figures(planned, config).jerk == pytest.approx(peaks[2].tolist())


def test_pulses_are_the_plan_to_half_a_pulse(planned: Plan) -> None:
    at = np.cumsum(planned.commands, axis=0)
    assert np.abs(at - planned.places * SCALE).max() <= 0.5 + 1e-9
    assert at[-1].tolist() == [*(outline()[-1] * 0.025 * SCALE).round().astype(int), 0, 0]


def test_the_job_says_what_was_planned(planned: Plan) -> None:
    read = card_job.decode(planned.job)
    np.testing.assert_array_equal(read.commands, planned.commands)
    np.testing.assert_array_equal(read.frame_events, planned.events)
    assert card_job.encode(read) == planned.job
    assert (read.period_ns, read.mask) == (1_000_000, 3)
    assert read.pulses_per_m[:2] == (800_000, 800_000)
    assert read.speed_max[:2] == (160_000, 160_000)
    assert read.acc_max[:2] == (800_000, 800_000) and read.jerk_max[:2] == (40_000_000, 40_000_000)
    assert read.events == [card_job.FrameEvent(1, False, 1), card_job.FrameEvent(1, False, 0)]
    assert np.flatnonzero(read.frame_events).size == 3
    assert read.time == pytest.approx(len(planned.steps) * 1e-3)


def test_jobs_of_both_writers_are_the_same_bytes() -> None:
    """Wide commands, all axes, events: what a plan seldom has."""
    draws = np.random.default_rng(3)
    commands = draws.integers(-25000, 25001, (900, 4)).astype(np.int32)
    commands[300:600] = draws.integers(-2, 3, (300, 4))
    commands[[0, -1]] = 0
    events = np.where(draws.random(900) < 0.2, draws.integers(1, 4, 900), 0)
    for mask in (15, 10, 4):
        moved = commands * [mask >> k & 1 for k in range(4)]
        one = card_job.Job(
            1_000_000, mask, moved, events, [card_job.FrameEvent(3, True, 1, 50)] * 3
        )
        read = card_job.decode(card_job.encode(one))
        np.testing.assert_array_equal(read.commands, moved)
        np.testing.assert_array_equal(read.frame_events, events)
        assert read.events == one.events and read.mask == mask


def test_a_damaged_job_is_refused(planned: Plan) -> None:
    text = planned.job[: 3 * card_job.PAGE]
    with pytest.raises(InputError, match="page 0: axes 3, period 1000000 ns, "):
        card_job.decode(text)
    draws = np.random.default_rng(1)
    for at in draws.integers(0, len(planned.job), 40):
        bad = bytearray(planned.job)
        bad[at] ^= 1 << draws.integers(8)
        with pytest.raises(InputError, match=f"page {at // card_job.PAGE}: its CRC is wrong"):
            card_job.decode(bytes(bad))
    for at in draws.integers(0, len(planned.job), 200):  # with a CRC that fits
        bad = bytearray(planned.job)
        page = at - at % card_job.PAGE
        bad[at] ^= 1 << draws.integers(8)
        bad[page : page + card_job.PAGE] = card_job._sealed(
            bytes(bad[page : page + card_job.CRC_AT])
        )
        try:
            card_job.decode(bytes(bad))
        except InputError:
            continue
        assert page == 0 or at % card_job.PAGE >= card_job.FIRST_BYTE


@pytest.mark.parametrize(
    ("payload", "why"),
    [
        ([0x80, 0x00, 0], "a number that is not the shortest"),
        ([0x80, 0x80, 0x80, 1, 0], "a number that does not end"),
        ([0, 0x80], "a number that does not end"),
        ([0], "fewer numbers than 1 frames have"),
        ([1, 0], "fewer numbers than 1 frames have"),
        ([0, 0, 0], "more numbers than 1 frames have"),
        ([1, 0, 9], "an event or a command beyond its range"),
    ],
)
def test_numbers_of_a_page_are_judged(payload: list[int], why: str) -> None:
    one = card_job.Job(1_000_000, 3, np.zeros((1, 4), np.int32), np.zeros(1, int))
    text = card_job.encode(one)
    page = card_job._page(0, np.zeros(4, int), 1, bytes(payload))
    with pytest.raises(InputError, match=f"x: page 1: {why}"):
        card_job.decode(text[: card_job.PAGE] + card_job._sealed(page), "x")


def squares() -> list[np.ndarray]:
    """Ten by ten closed squares and a line, in an order that goes to and fro."""
    square = np.array([[0, 0], [200, 0], [200, 200], [0, 200], [0, 0]])
    at = [(400 * (7 * k % 10), 400 * (3 * k // 10 % 10)) for k in range(20)]
    return [*(square + p for p in at), np.array([[4000, 4000], [4000, 100]])]


def test_nearest_neighbours_save_way(config: CardConfig) -> None:
    drawing = plt.parse(written(squares()))
    by_file, nearest = clean(drawing), clean(drawing, order="nearest")
    assert way_between(nearest) < 0.5 * way_between(by_file)
    ends = [sorted(c.points.round(3).tolist()) for c in by_file]
    assert sorted(ends) == sorted(sorted(c.points.round(3).tolist()) for c in nearest)
    begins = {c.first: c.points[:2].tolist() for c in by_file if c.closed}
    assert begins == {c.first: c.points[:2].tolist() for c in nearest if c.closed}
    (line,) = (c for c in nearest if not c.closed)
    assert line.points[0].tolist() == [100.0, 2.5]  # turned round
    assert [c.closed for c in by_file] == [True] * 20 + [False]
    quick, slow = (plan(drawing, config, DrawingOptions(order=o)) for o in ("nearest", "file"))
    assert len(quick.steps) < 0.9 * len(slow.steps)
    assert int((quick.steps == DRAWS).sum()) == pytest.approx(int((slow.steps == DRAWS).sum()))


def test_lines_that_follow_each_other_are_one_contour() -> None:
    text = "SP1;PU0,0;PD0,0,40,0;PA40,0;PU;PU40,0;PD40,40;SP2;PD0,40;PU4,4;PD;PU9,9;"
    found = clean(plt.parse(text.encode()))
    assert [c.points.tolist() for c in found] == [
        [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
        [[1.0, 1.0], [0.0, 1.0]],
        [[0.1, 0.1]],
    ]
    assert [len(c.points) for c in clean(plt.parse(text.encode()), pens=[1])] == [3]


def test_corners_to_stop_at(config: CardConfig) -> None:
    """The raster of a circle has no corner, a square three, met exactly."""
    turn = 2.0 * np.pi * np.arange(2001) / 2000
    circle = np.round(np.stack([400 * np.cos(turn), 400 * np.sin(turn)], axis=1)).astype(int)
    circle = circle[np.concatenate([[True], np.diff(circle, axis=0).any(axis=1)])]
    assert not corners(circle * 0.025, 30.0).any()
    drawing = plt.parse(written([squares()[0], np.add(circle, (2000, 0))]))
    stopped, rounded = (plan(drawing, config, DrawingOptions(corners=c)) for c in ("stop", "round"))
    assert (stopped.stops, rounded.stops) == (3, 0)
    (driven, _), (free, _) = paths(stopped), paths(rounded)
    vertex = squares()[0][1:4] * 0.025
    off, more = (np.linalg.norm(d[:, None] - vertex, axis=2).min(axis=0) for d in (driven, free))
    assert off.max() < 1e-9 and 0.001 < more.min() and more.max() < 0.021 + 0.1


def test_settings_make_the_motion(config: CardConfig) -> None:
    drawing = plt.parse(b"SP1;VS2;PU400,400;PD2400,400;PU;")
    slow, quick = plan(drawing, config, DrawingOptions(speeds=True)), plan(drawing, config)
    assert figures(slow, config).speed[0] <= 200.0
    tops = [np.diff(p.places[p.steps == DRAWS, 0]).max() * 1e3 for p in (slow, quick)]
    # With limited jerk the end of a ramp is eased towards the feed.
    assert np.all(np.array(tops) <= [20.0 + 1e-9, 100.0 + 1e-9])
    assert tops == pytest.approx([20.0, 100.0], rel=2e-3)
    moved = plan(drawing, config, DrawingOptions(offset=(5.0, -3.0)))
    assert (moved.places[-1] - quick.places[-1])[:2].tolist() == pytest.approx([5.0, -3.0])
    assert moved.job[128:160] != quick.job[128:160] == plan(drawing, config).job[128:160]
    dwell = int((quick.steps == 1).sum())
    assert dwell == 3 * math.ceil(config.motion.pen.dwell / config.motion.period)


@pytest.mark.parametrize(
    ("text", "axes", "why"),
    [
        ("SP1;\nPU0,0;PD0,16000;", 2, "x.plt: line 2, column 7, byte 11: a line goes to Y = 400"),
        ("PU0,0;", 2, "x.plt: nothing is drawn"),
        ("PD5,5;", 1, "1 axes in the configuration, X and Y wanted"),
    ],
)
def test_what_cannot_be_planned(text: str, axes: int, why: str, config: CardConfig) -> None:
    fewer = config.model_copy(update={"axes": config.axes[:axes]})
    with pytest.raises(InputError, match=why.replace("(", r"\(")):
        plan(plt.parse(text.encode(), "x.plt"), fewer)


def test_a_pen_by_an_axis(config: CardConfig) -> None:
    three = TEXT + f'[[axes]]\nname = "Z"{AXIS}[motion.pen]\nkind = "axis"\nup = 3\ndown = -1\n'
    found = plan(plt.parse(written(squares()[:2])), config_of(three, "card.toml"))
    read = card_job.decode(found.job)
    assert read.events == [] and read.mask == 7 and not read.frame_events.any()
    assert read.positions[-1].tolist()[2] == 3 * SCALE
    assert set(found.places[found.steps == DRAWS, 2].round(9)) == {-1.0}


def test_the_commands(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    Path("card.toml").write_text(TEXT)
    Path("a.plt").write_bytes(written(squares()[:3]))
    run = CliRunner().invoke
    words = ["card", "plan", "a.plt", "-c", "card.toml", "-o", "a.mcj"]
    told = run(app, [*words, "--json", "--order", "nearest", "--report"], catch_exceptions=False)
    numbers = json.loads(told.stdout)
    assert numbers["contours"] == 3 and numbers["way_up"] <= numbers["way_up_file"] + 1e-6
    assert numbers["size"] == Path("a.mcj").stat().st_size
    assert json.loads(Path("results/a.plan/result.json").read_text()) == numbers
    page = Path("results/a.plan/report.html").read_text()
    assert "Speed of the axes" in page and Path("results/a.plan/plan.png").stat().st_size > 10_000
    plain = run(app, words, catch_exceptions=False)
    assert "contours: 3, segments: 12" in plain.stdout
    for file, text in (("a.plt", "pen"), ("a.mcj", "event 1: output 0, level high, times: 3")):
        shown = run(app, ["card", "show", file, "--picture", "x.png"], catch_exceptions=False)
        assert shown.exit_code == 0 and text in shown.stdout
        assert Path("x.png").stat().st_size > 10_000
    monkeypatch.setattr("motionfmu.cards.plan_figures.SLOT", 3)
    long = run(app, words, catch_exceptions=False)
    assert long.exit_code == 1 and "too long for a slot of the card's flash" in long.stdout
    with pytest.raises(InputError, match="--order far: file, nearest or inside wanted"):
        run(app, [*words, "--order", "far"], catch_exceptions=False)
    with pytest.raises(InputError, match=r"cannot read b\.plt"):
        run(app, ["card", "show", "b.plt"], catch_exceptions=False)
    for option in (["--page", "2"], ["--frame", "0", "0", "1", "1"]):
        with pytest.raises(InputError, match=r"a\.mcj: --frame and --page are for drawings"):
            run(app, ["card", "show", "a.mcj", *option], catch_exceptions=False)


def test_the_picture_of_a_job_marks_each_event_where_it_is(config, monkeypatch) -> None:
    """The pen goes down where a square begins, and up there again: one square starts and ends."""
    drawn: list[list[Diagram]] = []
    monkeypatch.setattr(
        "motionfmu.report.matplotlib_figure.write_file", lambda *given: drawn.append(given[-1])
    )
    found = card_job.decode(plan(plt.parse(written(squares()[:3]), "a.plt"), config).job)
    draw_job(found, "a.mcj", Path("a.png"))
    ((path, _),) = drawn
    line, *events = path.subplots[0].marks
    assert [m.name for m in (line, *events)] == [
        "path",
        *(f"event {k}" for k in range(1, len(found.events) + 1)),
    ]
    begins = np.array([p[0] for p in squares()[:3]]) / 40.0  # [mm]
    places = [np.stack([m.x, m.y], axis=1) for m in events]
    near = pytest.approx(begins, abs=1.5 / SCALE)
    assert places[0] == near and places[1][-3:] == near and len(places) == 2
    assert places[1][:-3] == pytest.approx(np.zeros((1, 2)))  # it is up before the first way


def test_a_job_of_a_page_of_several(tmp_path, monkeypatch) -> None:
    """Lines of 10 mm and of 20 mm: which page was taken is told, and each has an id of its own."""
    monkeypatch.chdir(tmp_path)
    Path("card.toml").write_text(TEXT)
    Path("a.plt").write_text("IN;SP1;PU0,0;PD400,0;PU;PG;PU0,0;PD800,0;PU;PG;")
    run, ids = CliRunner().invoke, set()
    words = ["card", "plan", "a.plt", "-c", "card.toml", "-o", "a.mcj"]
    for page, asked in ((1, []), (2, ["--page", "2"])):
        plain = run(app, [*words, *asked], catch_exceptions=False)
        assert f"page {page} of 2; --page chooses another" in plain.stdout
        assert f"pen down {10 * page:.1f} mm" in plain.stdout
        numbers = json.loads(run(app, [*words, *asked, "--json"], catch_exceptions=False).stdout)
        assert (numbers["page"], numbers["pages"]) == (page, 2)
        ids.add(card_job.read(Path("a.mcj")).origin)
        shown = run(app, ["card", "show", "a.plt", *asked], catch_exceptions=False)
        assert f"a.plt  X 0.000 .. {10 * page:.3f}, Y 0.000 .. 0.000 mm, page {page} of 2" in (
            shown.stdout.replace("\n", " ")
        )
    assert len(ids) == 2
    for command in (words, ["card", "show", "a.plt"]):
        with pytest.raises(InputError, match=r"a\.plt: no page 3, it has 2 pages"):
            run(app, [*command, "--page", "3"], catch_exceptions=False)
    Path("a.plt").write_text("IN;SP1;PU0,0;PD400,0;PU;PG;")
    assert "page" not in run(app, words, catch_exceptions=False).stdout


def test_the_job_of_the_scenario_is_of_its_drawing() -> None:
    folder = ROOT / "scenarios/plt_plate"
    drawing, settings = plt.read(folder / "plate.plt"), load(folder / "card.toml")
    kept = card_job.read(folder / "plate.mcj")
    assert kept.origin == origin(drawing, settings, DrawingOptions())
    (line,) = clean(drawing)
    vertices = np.loadtxt(folder / "plate.txt")[:, :2]
    np.testing.assert_allclose(line.points, vertices, atol=1e-9)
    fresh = plan(drawing, settings)
    assert len(fresh.steps) == pytest.approx(len(kept.commands), rel=0.05)


def test_each_path_is_compared_with_its_own_contour(config: CardConfig) -> None:
    """Drawn in another order they are far off; a pen that does not part them has one path."""
    found = plan(plt.parse(written(squares()[:2])), config)
    near = deviations(found, (0.0, 0.0))
    assert max(near) < 0.1
    swapped = dataclasses.replace(found, contours=found.contours[::-1])
    assert min(deviations(swapped, (0.0, 0.0))) > 5.0
    never_up = dataclasses.replace(found, steps=np.full_like(found.steps, DRAWS))
    assert len(paths(never_up)) == 1 and deviations(never_up, (0.0, 0.0))[1] < 0.1
