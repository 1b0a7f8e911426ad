"""A measured tool against its program, a ballbar's record, and figures after ISO 9283."""

import json
import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from console import within
from page_outline import shows_what_is_kept

import motionfmu
from motionfmu.analysis.explain import BallbarRecord, ballbar_test, signature
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.records import Record
from motionfmu.run import Result
from motionfmu.run.record_analyses import record_contour, record_iso9283

SCENARIOS = ROOT / "scenarios"


@pytest.fixture(scope="module")
def square() -> Result:
    return motionfmu.load(SCENARIOS / "square").run()


def axes(result: Result, noise: float = 0.0, every: int = 1) -> Record:
    """What a drive traces of a run: X and Y [mm], with noise [mm], one of so many samples."""
    place = np.asarray(result["machine.table_position"])[::every, :2] * 1e3
    place = place + noise * np.random.default_rng(3).normal(size=place.shape)
    ns = np.round(result.time[::every] * 1e9).astype(np.int64)
    columns = {"Ax": place[:, 0], "Ay": place[:, 1]}
    return Record("trace", ns, columns, {"Ax": "mm", "Ay": "mm"})


MAP = {"X": "Ax", "Y": "Ay"}


def test_corners_and_lines_are_those_of_the_run(square: Result) -> None:
    """The record knows no command, but where the tool is: each corner's error is the same."""
    run, found = square.contour(), record_contour(square, axes(square), MAP)
    assert [c.error for c in found.corners] == pytest.approx([c.error for c in run.corners])
    assert [c.line_after for c in found.corners] == [c.line_after for c in run.corners]
    assert found.error.max == pytest.approx(run.error.max, rel=1e-12)
    assert found.error.line == run.error.line
    assert found.error.rms == pytest.approx(run.error.rms, rel=0.01)


def test_noise_and_a_coarse_trace_move_them_by_as_much(square: Result) -> None:
    run = square.contour()
    found = record_contour(square, axes(square, 1e-3, 10), MAP)  # 1 um, 1 kHz
    gone = [a.error - b.error for a, b in zip(found.corners, run.corners, strict=True)]
    assert np.abs(gone).max() < 6e-3  # 50 mm/s over 1 ms cut a corner's top by less
    assert found.error.max == pytest.approx(run.error.max, abs=6e-3)


def test_a_circle_both_ways_is_that_of_the_run() -> None:
    result = motionfmu.load(SCENARIOS / "circle").run()
    run, found = result.contour(), record_contour(result, axes(result, 2e-4), MAP)
    (one,), (other,) = run.circles, found.circles
    for way in ("ccw", "cw"):
        a, b = getattr(one, way), getattr(other, way)
        assert b.steady and b.speed == pytest.approx(a.speed, rel=1e-3)
        assert b.reading.radius_change == pytest.approx(a.reading.radius_change, abs=5e-5)
        assert b.reading.g == pytest.approx(a.reading.g, abs=1.5e-3)  # of the noise: 6 sigma
        assert b.reading.f_max == pytest.approx(a.reading.f_max, abs=1.2e-3)
    said, told = (signature(c, 0.0) for c in (one, other))
    for a in said.findings:
        assert told.finding(a.name).size == pytest.approx(a.size, abs=5e-4)


def test_lines_short_as_a_cam_writes_them() -> None:
    result = motionfmu.load(SCENARIOS / "lookahead").run()
    run, found = result.contour(), record_contour(result, axes(result), MAP)
    assert found.error.max == pytest.approx(run.error.max, rel=1e-9)
    assert [c.error for c in found.corners] == pytest.approx([c.error for c in run.corners])


def test_a_run_of_other_gains_is_a_record(square: Result) -> None:
    """Whatever takes a measured record takes a run's: its own columns are found by their names."""
    slow = motionfmu.load(SCENARIOS / "square").run(set={"mcc.p_gain": 100})
    found = record_contour(square, slow.record())
    wanted = [c.error for c in slow.contour().corners]
    assert [c.error for c in found.corners] == pytest.approx(wanted)


@pytest.mark.parametrize(
    ("change", "over", "told"),
    [
        (lambda r: r.part(0.0, 0.8), MAP, "the tool travels .* mm in the program"),
        (lambda r: r, {"X": "Ax", "Y": "Az"}, "no column 'Az'; did you mean 'Ay'"),
        (lambda r: r, {"X": "Ax"}, "no column Y, which the program moves: say which it is"),
    ],
)
def test_a_record_that_does_not_fit_is_refused(
    square: Result, change: Any, over: dict[str, str], told: str
) -> None:
    with pytest.raises((InputError, NoNumber), match=told):
        record_contour(square, change(axes(square)), over)


def test_the_command_compares_record_and_run(square: Result, tmp_path: Path) -> None:
    axes(square, 1e-4, 5).save(tmp_path / "trace.csv")
    maps = ("--map", "X=Ax", "--map", "Y=Ay")
    scenario = SCENARIOS / "square"
    told = within("contour", scenario, "--record", "trace.csv", *maps, folder=tmp_path)
    assert told.returncode == 0, told.stderr
    made = json.loads((tmp_path / "results/square.contour/result.json").read_text())
    assert made["contour"]["error"]["line"] == made["run"]["error"]["line"]
    assert "following" not in made["contour"] and len(made["contour"]["corners"]) == 7
    page = (tmp_path / "results/square.contour/report.html").read_text()
    shows_what_is_kept("record", page)
    wrong = within("contour", scenario, "--record", "trace.csv", folder=tmp_path)
    assert wrong.returncode == 2 and "no column X, which the program moves" in wrong.stderr


def ballbar(sizes: dict[str, float], radius: float = 100.0) -> tuple[Any, Any]:
    """Angle [rad] and deviation [mm] of both ways with 45 degrees before and behind."""
    turn = np.arange(-0.25 * np.pi, 2.25 * np.pi, 2e-3)
    angle = np.concatenate([turn, turn[::-1]])
    way = np.repeat([1.0, -1.0], len(turn))
    deviation = (
        sizes.get("mean", 0.0)
        + sizes.get("scale", 0.0) * np.cos(2 * angle)
        + sizes.get("squareness", 0.0) * np.sin(2 * angle)
        + way * sizes.get("mismatch", 0.0) * np.sin(2 * angle)
    )
    del radius
    return angle, deviation


@pytest.mark.parametrize("name", ["scale", "squareness", "mismatch"])
def test_a_ballbar_record_is_read_for_what_made_it(name: str) -> None:
    angle, deviation = ballbar({"mean": 0.004, name: 0.012})
    test = ballbar_test([BallbarRecord(angle, deviation)], 100.0, feed=1000 / 60)
    assert test.ccw and test.cw and test.both
    assert math.degrees(test.ccw.coverage) == pytest.approx(360.0, abs=0.3)
    for way, sign in ((test.ccw, 1.0), (test.cw, -1.0)):
        turned = np.unwrap(np.arctan2(way.points[:, 1], way.points[:, 0]))
        assert np.sign(turned[-1] - turned[0]) == sign
    mark = signature(test)
    assert mark.findings[0].name == name
    assert mark.findings[0].size == pytest.approx(0.012, rel=1e-6)
    assert mark.mean == pytest.approx(0.004, abs=1e-9)
    assert [f.name for f in mark.findings if f.named] == [name]
    if name == "mismatch":  # y behind by T makes the radius v T / 2 sin 2 angle less
        assert " X lags Y by 1.44 ms: " in mark.findings[0].words


def test_the_command_reads_a_ballbar_in_two_files_without_times(tmp_path: Path) -> None:
    angle, deviation = ballbar({"squareness": 0.01})
    half = len(angle) // 2
    for name, part in (("ccw", slice(half)), ("cw", slice(half, None))):
        rows = zip(np.degrees(angle[part]), 1e3 * deviation[part], strict=True)
        text = "".join(f"{a:.6f};{d:.6f}\n" for a, d in rows)
        (tmp_path / f"{name}.csv").write_text(f"Angle [°];Deviation [µm]\n{text}")
    told = within("contour", "ccw.csv", "--record", "cw.csv", "--radius", 100, folder=tmp_path)
    assert told.returncode == 0, told.stderr
    assert "Squareness, 10 µm" in told.stdout and "by 0 ms" not in told.stdout
    made = json.loads((tmp_path / "results/ccw.ballbar/result.json").read_text())
    assert made["ballbar"]["findings"][0]["name"] == "squareness"
    for line, words in (
        (("contour", "ccw.csv"), "--radius, the nominal one [mm], wanted"),
        (("contour", "ccw.csv", "--radius", 100, "--plane", "XX"), "XY, ZX, YZ are known"),
        (("contour", "ccw.csv", "--radius", 100, "--map", "angle=Winkel"), "no column 'Winkel'"),
    ):
        wrong = within(*line, folder=tmp_path)
        assert wrong.returncode == 2 and words in wrong.stderr, wrong.stderr
    one = within("contour", "ccw.csv", "--radius", 100, folder=tmp_path)
    assert "One way round" in one.stdout and one.returncode == 0, one.stderr


@pytest.mark.more
def test_iso9283_of_a_record_is_that_of_the_run() -> None:
    result = motionfmu.load(SCENARIOS / "robot_line").run()
    table = result.resolver.document.body.iso9283
    assert table is not None
    own, found = result.iso9283(), record_iso9283(result, result.record())
    for name in ("AT_P", "RT_P", "AV", "FV", "straightness"):
        a, b = own.numbers()[name], found.numbers()[name]
        assert b == (a if a is None else pytest.approx(a, rel=1e-9))  # times in whole ns
    place = np.asarray(result[table.position])[:, :3]
    unit = result.units[table.position]
    off = 0.01 if unit == "m" else 10.0  # across the line, far more than its deviation
    ns = np.round(result.time * 1e9).astype(np.int64)
    columns = {"x": place[:, 0] + off, "y": place[:, 1], "z": place[:, 2]}
    if table.quaternion:
        columns["q"] = np.asarray(result[table.quaternion])
    if table.during:
        columns["during"] = np.asarray(result[table.during])
    over = {n: k for n, k in ((table.quaternion, "q"), (table.during, "during")) if n}
    units = dict.fromkeys("xyz", unit) | {"q": None, "during": None}
    shifted = Record("measured", ns, columns, units)
    moved = record_iso9283(result, shifted, over)
    assert 8.0 < moved.number("AT_P") < 15.0
    assert moved.number("straightness") == pytest.approx(own.number("straightness"), rel=1e-6)
