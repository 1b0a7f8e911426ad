"""A scenario's [iso9283] and [view]: figures, verdicts, causes, and what is refused."""

import json
import math
import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.analysis.explain import explain_path
from motionfmu.base.errors import InputError, NoNumber
from motionfmu.report.cause_pages.path_causes_page import write_path_explanation
from motionfmu.study import study_columns

PART = """%
N10 G21 G17 G90 G61
N20 G0 X0 Y0
N30 G4 P0.2
N40 G1 X60 Y30 F3000
N50 G0 X0 Y0
N60 G4 P0.3
N70 G1 X60 Y30 F3000
N80 M30
%
"""
LINES = """
[iso9283]
position  = "machine.table_position"
points    = [[0, 0, 0], [60, 30, 0]]
cycles    = [[0.19, 1.8], [2.05, 5.0]]
speed     = 50
pen_width = 1
"""
ROUND = """
[iso9283]
position = "machine.table_position"
command  = "mcc.position"
during   = "mcc.line"
between  = [6, 6]
planes   = 4000
ramp     = 0
"""


def scenario(folder: Path, table: str, part: str = PART, more: str = "") -> Path:
    """The demo's machine with another program and another analysis."""
    shutil.copytree(ROOT / "scenarios/circle", folder)
    text = (folder / "scenario.toml").read_text()
    less = 'stop = 5.0\nwithout = ["contour", "check"]'
    head = text[: text.index("[expect]")].replace("stop = 8.0", less)
    (folder / "scenario.toml").write_text(head + table + more)
    if part:
        (folder / "circle.ngc").write_text(part)
    return folder


@pytest.fixture(scope="module")
def line(tmp_path_factory: pytest.TempPathFactory) -> Path:
    check = (
        '\n[check]\n"iso9283.AT_P" = { min = 1e-4, max = 0.02 }\n"iso9283.AV" = { max = [-9, 9] }\n'
    )
    return scenario(tmp_path_factory.mktemp("line") / "mine", LINES, more=check)


@pytest.fixture(scope="module")
def run(line: Path):
    return motionfmu.load(line).run()


def test_the_verdict_and_the_folder_have_the_figures(run, tmp_path: Path) -> None:
    assert {v.name for v in run.checks} == {"iso9283.AT_P", "iso9283.AV"} and run.ok
    run.save(tmp_path / "out", pictures=True)
    numbers = json.loads((tmp_path / "out/result.json").read_text())["iso9283"]
    assert numbers["AT_P"] == run.figure("iso9283.AT_P") and len(numbers["cycles"]) == 2
    assert {"iso9283.png", "iso9283.svg"} <= {f.name for f in (tmp_path / "out").iterdir()}
    page = (tmp_path / "out/report.html").read_text()
    assert "Path performance" in page and "The machine in motion" in page
    assert "Left out: " in page and "Coincidence of strokes 1.00 mm wide" in page
    assert study_columns.column(run.scenario, "iso9283.RT_P").of(run) == numbers["RT_P"]
    assert study_columns.column(run.scenario, "iso9283.AV").unit == "%"


def test_a_lead_error_is_found_and_explained(line: Path) -> None:
    """X is long by 1e-4: across a line at the angle a that is 1e-4 x sin a."""
    slope = [1e-4, 0.0, 0.0, 0.0, 0.0, 0.0]
    found = explain_path(line, set={"machine.lead_error_slope": slope, "machine.backlash": 1e-5})
    angle = math.atan2(30, 60)
    theory = 1e-4 * 60.0 * math.sin(angle)
    scale = found.effect("scale")
    share = found.along[-1] / math.hypot(60, 30)
    assert scale.size == pytest.approx(theory * share, rel=0.02)
    assert scale.figures["straightness"] < 0.02 * theory and scale.figures["height"] == 0.0
    assert scale.figures["in_plane"] == pytest.approx(
        theory * np.ptp(found.along) / 67.082, rel=0.02
    )
    assert np.linalg.norm(found.residual, axis=1).max() < 0.2 * found.figures["accuracy"]
    whole = sum(e.change for e in found.effects)
    assert np.allclose(whole, found.whole - found.residual)
    assert found.effect("torque").size == 0.0 and found.effect("torque").judged
    sizes = [e.size for e in found.effects]
    assert sizes == sorted(sizes, reverse=True)


def test_the_explanation_is_written(line: Path, tmp_path: Path) -> None:
    found = explain_path(line)
    write_path_explanation(found, tmp_path)
    told = json.loads((tmp_path / "result.json").read_text())
    assert told["figures"]["accuracy"] == found.figures["accuracy"]
    assert (tmp_path / "causes.png").stat().st_size > 5000
    assert "Lead error of the screw" in (tmp_path / "report.html").read_text()


def test_a_recorded_command_and_the_programs_line_do_as_the_contour_does(tmp_path: Path) -> None:
    """The circle's contour error and its path accuracy are the same thing, seen in two ways."""
    contour = '\n[contour]\nposition = "machine.table_position"\npulses = "card.pulse_count"\n'
    folder = scenario(tmp_path / "mine", ROUND, part="", more=contour)
    result = motionfmu.load(folder).run()
    path = result.contour()
    time = result.iso9283().path.time[0]
    cut = (path.run.time >= time[0]) & (path.run.time <= time[-1])
    assert result.figure("iso9283.AT_P") == pytest.approx(path.track.distance[cut].max(), rel=0.01)
    with pytest.raises(NoNumber, match="one cycle only"):
        result.figure("iso9283.RT_P")


def test_the_programs_line_picks_the_cycle(tmp_path: Path) -> None:
    second = ROUND.replace("[6, 6]", "[8, 8]").replace("4000", "50")
    folder = scenario(tmp_path / "mine", second, part="")
    text = (folder / "scenario.toml").read_text().replace("stop = 5.0", "stop = 8.0")
    (folder / "scenario.toml").write_text(text)
    result = motionfmu.load(folder).run()
    line, time = result["mcc.line"], result.time
    own = time[line == 8]
    assert result.figure("iso9283.n") == 1
    assert own[0] <= result.figure("iso9283.cycles.0.start") < own[0] + 0.2
    assert own[-1] - 0.2 < result.figure("iso9283.cycles.0.end") <= own[-1] + 1e-3


WAVE = """
[[waveform]]
drives = "drives"
axis   = 1
pulses = "card.pulse_count"
rated  = 2.0
window = [0.1, 0.6]
"""


def test_a_waveform_is_what_the_drive_did(tmp_path: Path) -> None:
    folder = tmp_path / "mine"
    shutil.copytree(ROOT / "scenarios/output_modes", folder)
    file = folder / "scenario.toml"
    before, after = file.read_text().split("[expect]", 1)
    file.write_text(f"{before}{WAVE}\n[expect]{after}")
    result = motionfmu.load(folder).run()
    chart = result.figures()[-1]
    speed, torque, deviation = chart.panels
    command, motor = speed.curves
    turn = result.parameter("drives.pulses_per_turn")[0]
    pulses = result["card.pulse_count"][:, 0]
    k = np.searchsorted(result.time, 0.3)
    at = command.values[np.searchsorted(command.time, result.time[k])]
    assert at == pytest.approx(60 * (pulses[k] - pulses[k - 10]) / turn / 1e-3)
    own = result["drives.speed"][k, 0]
    assert motor.values[np.searchsorted(motor.time, result.time[k])] == own
    assert np.abs(torque.curves[0].values).max() == pytest.approx(
        50 * np.abs(result["drives.torque"][999:6002, 0]).max(), rel=0.01
    )
    units = deviation.curves[0].values
    assert np.array_equal(units, np.round(units)) and np.abs(units).max() > 10
    error = result["drives.following_error"][k, 0] * turn
    got = units[np.searchsorted(deviation.curves[0].time, result.time[k])]
    assert abs(got - error) <= 0.5 and chart.span == (0.1, 0.6)
    for old, new, told in (
        ("axis   = 1", "axis = 7", "axes 1 to 6"),
        ('"drives"', '"mcc"', "no variable 'speed'"),
        ("[0.1, 0.6]", "[0.1, 60]", "window"),
        ("rated  = 2.0", "rated = 0", "rated"),
    ):
        file.write_text(f"{before}{WAVE.replace(old, new)}\n[expect]{after}")
        with pytest.raises(InputError, match=told):
            motionfmu.load(folder)


def test_poses_are_reached_at_their_times(tmp_path: Path) -> None:
    poses = "\nposes = [[0, 0, 0], [60, 30, 0]]\nreached = [[0.2, 1.63], [2.2, 4.9]]\n"
    result = motionfmu.load(scenario(tmp_path / "mine", LINES + poses)).run()
    table = 1e3 * result["machine.table_position"][:, :3]
    want = np.mean([table[16300], table[49000]], axis=0) - [60, 30, 0]
    assert result.figure("iso9283.poses.1.AP_P") == pytest.approx(np.linalg.norm(want), rel=1e-9)
    assert result.figure("iso9283.poses.1.AP_x") == pytest.approx(want[0], rel=1e-9)


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ('"machine.table_position"', '"machine.table_speed"', "table_speed.* is no length"),
        ('"machine.table_position"', '"machine.nothing"', "no variable 'nothing'"),
        ('"machine.table_position"', '"mcc.line"', "three elements or six axes"),
        ("points ", 'command = "mcc.position"\npoints ', "one of command, points and file"),
        ("points    = [[0, 0, 0], [60, 30, 0]]", 'file = "none.txt"', "none.txt: No such file"),
        ("[[0, 0, 0], [60, 30, 0]]", "[[0, 0, 0], [0, 0, 0]]", "m >= 2"),
        ("[0.19, 1.8]", "[0.19, 9.0]", r"cycles: \[0.19, 9\] s is not within 0 .. 5"),
        ("cycles ", 'during = "mcc.line"\nbetween = [1, 2]\ncycles ', "one of cycles and during"),
        ("speed     = 50", "speed = 0", "speed"),
        ("pen_width = 1", "poses = [[1, 2, 3]]", "poses and reached go together"),
        ("pen_width = 1", "pen = 1", "unknown key 'pen'"),
        ("pen_width = 1", 'quaternion = "machine.table_position"', "four elements"),
        ("pen_width = 1", '[view]\ntool = "mcc.line"', "three elements or six axes"),
        ("pen_width = 1", '[view]\njoints = "mcc.line"', "six angles"),
        ("pen_width = 1", '[check]\n"iso9283.AT" = { max = 1 }', "no 'AT', there is"),
        ("pen_width = 1", '[check]\n"contour.error.max" = { max = 1 }', r"no \[contour\] table"),
    ],
)
def test_a_wrong_table_is_refused_before_the_run(tmp_path: Path, old, new, told) -> None:
    assert old in LINES
    folder = scenario(tmp_path / "mine", LINES.replace(old, new))
    with pytest.raises(InputError, match=told) as caught:
        motionfmu.load(folder)
    assert str(caught.value).startswith(str(folder / "scenario.toml:"))
