"""A machine with known errors is measured by its own runs; what is found there is what it has."""

import json
import tomllib
from pathlib import Path

import numpy as np
import pytest
from console import within
from page_outline import shows_what_is_kept
from test_circle_errors import BX, BY, SCALE, SQUARE, ballbar
from test_lead_error import BACKLASH, PERIOD, PHASE, SIZE, SLOPE, made, targets

from motionfmu import InputError
from motionfmu.calibrate import (
    CircleChoice,
    CircleRecord,
    MachineRecords,
    PositionRecord,
    circle_record,
    compensation_tables,
    machine_calibration,
    position_record,
)
from motionfmu.calibrate.machine_tests import MachineTests
from motionfmu.run import machine
from motionfmu.run.run_plan import Options

MACHINE = """# The mill with guides that are not square.
extends = "mill3"

[component]
frame = "machine_frame"

[connect]
"frame.axis_position" = "machine.table_position"

[contour]
position = "frame.tool_position"
"""
TRUTH = {
    "machine.backlash[1]": 12e-6,
    "machine.backlash[2]": 8e-6,
    "machine.lead_error_slope[1]": 40e-6,
    "machine.lead_error_slope[2]": -25e-6,
    "machine.lead_error_amplitude[1]": 6e-6,
    "machine.lead_error_period[1]": 0.13,
    "machine.lead_error_phase[1]": 0.8,
    "frame.squareness_xy": 60e-6,
}


@pytest.fixture
def mill(tmp_path: Path) -> Path:
    folder = tmp_path / "leaning"
    folder.mkdir()
    (folder / "machine.toml").write_text(MACHINE)
    return folder


def laser(name: str, noise: float = 0.0) -> PositionRecord:
    return PositionRecord(f"{name}.csv", name, made(targets(), noise))


def circles(tmp_path: Path) -> list:
    return [circle_record([ballbar(tmp_path)], "XY", CircleChoice(radius=100.0))]


def test_every_figure_goes_to_its_parameter(mill: Path, tmp_path: Path) -> None:
    records = MachineRecords({"X": laser("X")}, circles(tmp_path))
    found = machine_calibration(machine(mill).plan(), records)
    wanted = {
        "machine.backlash[1]": 1e-3 * BACKLASH,
        "machine.lead_error_slope[1]": SLOPE,
        "machine.lead_error_amplitude[1]": 1e-3 * SIZE,
        "machine.lead_error_period[1]": 1e-3 * PERIOD,
        "machine.lead_error_phase[1]": PHASE,
        "machine.backlash[2]": 1e-3 * BY,
        # a circle tells by how much the other axis' scale is apart from the known one
        "machine.lead_error_slope[2]": SLOPE - SCALE,
        "frame.squareness_xy": SQUARE,
    }
    assert set(found.settings) == set(wanted)
    for name, value in wanted.items():
        assert found.settings[name] == pytest.approx(value, rel=0.02), name
    table = found.axes[0].table
    assert table is not None and found.compensated == "mcc.comp_file"
    assert found.axes[0].pulse == pytest.approx(10.0 / 10000)


def test_a_circle_alone_gives_half_of_the_scale_to_either_axis(mill: Path, tmp_path: Path) -> None:
    found = machine_calibration(machine(mill).plan(), MachineRecords({}, circles(tmp_path)))
    assert found.settings["machine.lead_error_slope[1]"] == pytest.approx(0.5 * SCALE, rel=0.02)
    assert found.settings["machine.lead_error_slope[2]"] == pytest.approx(-0.5 * SCALE, rel=0.02)
    assert found.settings["machine.backlash[1]"] == pytest.approx(1e-3 * BX, rel=0.02)
    assert any("half of it is given to either" in note for note in found.notes)
    assert not found.compensation


def test_what_the_plant_has_no_parameter_for_is_said(tmp_path: Path) -> None:
    records = MachineRecords({"X": laser("X")}, circles(tmp_path))
    found = machine_calibration(machine("mill3").plan(), records)
    assert not any("squareness" in name for name in found.settings)
    assert any("squareness" in n and "machine_frame has" in n for n in found.notes)
    stepper = machine_calibration(machine("engraver").plan(), MachineRecords({"X": laser("X")}))
    assert not stepper.settings
    assert any("backlash" in n and "no parameter for it" in n for n in stepper.notes)


def test_an_axis_that_is_not_there_is_refused() -> None:
    records = MachineRecords({"B": laser("B")})
    with pytest.raises(
        InputError, match=r"B\.csv: 'B' is neither an axis of the machine \(X, Y, Z\)"
    ):
        machine_calibration(machine("mill3").plan(), records)


def written(file: Path, name: str, test) -> None:
    """A record as a laser's software writes it."""
    rows = [f"Axis: {name}", "target [mm],run,direction,deviation [µm]"]
    for run in range(len(test.up)):
        for way, values in (("up", test.up[run]), ("down", test.down[run])):
            rows += [
                f"{x},{run + 1},{way},{1e3 * v:.4f}"
                for x, v in zip(test.targets, values, strict=True)
            ]
    file.write_text("\n".join(rows) + "\n", encoding="utf-8")


@pytest.mark.long
def test_the_loop_closes(mill: Path, tmp_path: Path) -> None:
    """Measured by the FMUs with known errors; found by others; compensated, and measured again."""
    real = MachineTests.of(machine(mill), tmp_path, TRUTH)
    places = {"X": np.linspace(-230.0, 230.0, 11), "Y": np.linspace(-180.0, 180.0, 5)}
    places["X"][1:-1] += np.round(9.0 * np.sin(7.3 * np.arange(1, 10)), 2)
    for name, x in places.items():
        written(tmp_path / f"{name}.csv", name, real.positioning(name, x, TRUTH))
    test = real.circle("XY", 50.0, 50.0, None, TRUTH)
    rows = ["time [s],angle [deg],deviation [um]"]
    start = 0.0
    for way in (test.ccw, test.cw):
        assert way is not None
        angle = np.degrees(np.unwrap(np.arctan2(way.points[:, 1], way.points[:, 0])))
        size = (np.hypot(*way.points.T) - 50.0) * 1e3
        time = way.time - way.time[0] + start
        rows += [f"{t:.4f},{a:.5f},{d:.4f}" for t, a, d in zip(time, angle, size, strict=True)]
        start = float(time[-1]) + 1.0
    (tmp_path / "ballbar.csv").write_text("\n".join(rows) + "\n")
    records = [f"--record={tmp_path / n}.csv" for n in "XY"]
    out = tmp_path / "out"
    told = within(
        "calibrate",
        mill,
        *records,
        f"--record=XY={tmp_path / 'ballbar.csv'}",
        "--radius=50",
        "--out",
        out,
    )
    assert told.returncode == 0, told.stderr
    numbers = json.loads((out / "result.json").read_text())
    found = tomllib.loads((out / "found.toml").read_text())
    for name, value in TRUTH.items():
        away = abs(found[name] - value)
        deviation = numbers["parameters"][name]["deviation"]
        assert away < 3.0 * deviation + 0.002 * abs(value), name
    # without the machine's own runs the servo's part would be in the backlash
    seen = numbers["axes"]["X"]["record"]["backlash"]["value"] * 1e-3
    assert abs(seen - TRUTH["machine.backlash[1]"]) > 4e-6
    # stated: pitch errors and play fall to a tenth; what is left is a pulse of 1 um
    for axis in "XY":
        sides = [numbers["axes"][axis][s]["iso230_2"] for s in ("run", "compensated")]
        for figure in ("A", "E", "M"):
            assert sides[1][figure] < 0.1 * sides[0][figure], (axis, figure)
            assert sides[1][figure] < 1.5e-3
        assert sides[1]["B"] < 0.35 * sides[0]["B"]
    tables = compensation_tables(out / "compensation.csv")
    assert list(tables) == [1, 2]
    compensated = tomllib.loads((out / "compensated.toml").read_text())
    assert compensated["mcc.comp_file"] == str(out / "compensation.csv")
    page = (out / "report.html").read_text()
    shows_what_is_kept("calibration", page)


@pytest.mark.more
def test_a_circle_that_the_machine_runs_tells_play_without_wind_up(
    mill: Path, tmp_path: Path
) -> None:
    own = ("backlash[1]", "backlash[2]", "slope[1]", "slope[2]", "squareness")
    truth = {n: v for n, v in TRUTH.items() if n.endswith(own) or "squareness" in n}
    real = MachineTests.of(machine(mill), tmp_path, truth)
    test = real.circle("XY", 80.0, 40.0, (10.0, -20.0), truth)
    records = MachineRecords({}, [CircleRecord("c.csv", "XY", test, (10.0, -20.0))])
    found = machine_calibration(machine(mill).plan(), records, machine(mill))
    for name in ("machine.backlash[1]", "machine.backlash[2]", "frame.squareness_xy"):
        e = found.parameter(name).found
        assert abs(e.value - truth[name]) < 3.0 * e.deviation
        assert e.deviation < 0.03 * truth[name]
    apart = [found.parameter(f"machine.lead_error_slope[{k}]").found for k in (1, 2)]
    scale = apart[0].value - apart[1].value
    assert abs(scale - 65e-6) < 3.0 * 2.0 * apart[0].deviation
    # seen was more: friction winds the screw up at each reversal
    seen = found.circles[0].errors.backlash[0].value * 1e-3
    assert seen > 1.1 * truth["machine.backlash[1]"]


def test_the_command_writes_what_a_run_takes(mill: Path, tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    written(file, "X", made(targets(), 1e-4))
    out = tmp_path / "out"
    told = within("calibrate", mill, "--record", file, "--no-runs", "--out", out)
    assert told.returncode == 0, told.stderr
    assert "machine.lead_error_slope[1]" in told.stdout
    found = tomllib.loads((out / "found.toml").read_text())
    assert found["machine.lead_error_period[1]"] == pytest.approx(0.13, rel=0.01)
    values = tomllib.loads((out / "compensated.toml").read_text())
    machine(mill).plan().resolved(Options(set=values))
    assert position_record(file).axis == "X"


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        (["--record", "{bare}"], "which axis was measured?"),
        (
            ["--record", "QQ={bare}"],
            "bare.csv: 'QQ' is neither an axis of the machine (X, Y, Z) nor",
        ),
        (["--record", "X={bare}", "--map", "target=A"], "--map target=A: it goes with circles and"),
        (["--record", "X={bare}", "--record", "X={bare}"], "X was measured in"),
        (["--record", "XY={ballbar}"], "--radius"),
        (["--record", "X="], "FILE or NAME=FILE wanted"),
        (["--record", "X={missing}"], "missing.csv"),
    ],
)
def test_a_wrong_command_is_one_message(
    mill: Path, tmp_path: Path, arguments: list[str], told: str
) -> None:
    written(tmp_path / "bare.csv", "", made(targets(), 1e-4))
    names = {n: tmp_path / f"{n}.csv" for n in ("bare", "ballbar", "missing")}
    ballbar(tmp_path)
    line = [a.format(**names) for a in arguments]
    got = within("calibrate", mill, *line, "--no-runs", "--out", tmp_path / "out")
    assert got.returncode == 2
    assert told in got.stderr, got.stderr
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("name", ["", "X="])
def test_an_arm_takes_no_positioning_test(tmp_path: Path, name: str) -> None:
    file = tmp_path / "x.csv"
    written(file, "X", laser("X").test)
    out = tmp_path / "out"
    got = within("calibrate", "robot6", "--record", f"{name}{file}", "--no-runs", "--out", out)
    assert got.returncode == 2
    assert "robot6 is an arm: poses of its tool are wanted" in got.stderr, got.stderr
    assert not out.exists()


def test_a_scenarios_name_is_enough(tmp_path: Path) -> None:
    file = tmp_path / "x.csv"
    rows = [f"{t},{d},{s}" for t in (0, 50, 100) for s, d in (("+", 0), ("-", 8)) for _ in (1, 2)]
    file.write_text("target,deviation [um],direction\n" + "\n".join(rows) + "\n")
    out = tmp_path / "out"
    told = within("calibrate", "circle", "--record", f"X={file}", "--out", out)
    assert told.returncode == 0, told.stderr
    found = tomllib.loads((out / "found.toml").read_text())
    assert found["machine.backlash[1]"] == pytest.approx(8e-6)
    told = within("calibrate", "circel", "--record", f"X={file}")
    assert "no such machine" in told.stderr


def test_poses_by_the_command(tmp_path: Path) -> None:
    from test_arm_calibration import RIGID, errors, record

    poses = record(errors(1), noise=0.02, attitude=False)
    rows = [
        ",".join(f"{v:.5f}" for v in [*q, *p])
        for q, p in zip(poses.joints, poses.places, strict=True)
    ]
    file = tmp_path / "tracker.csv"
    file.write_text("J1,J2,J3,J4,J5,J6,X [mm],Y [mm],Z [mm]\n" + "\n".join(rows) + "\n")
    out = tmp_path / "out"
    values = [f"--set={n}={v}" for n, v in RIGID.items()]
    told = within("calibrate", "robot6", "--record", file, *values, "--out", out)
    assert told.returncode == 0, told.stderr
    assert "left: it acts as the base" in told.stdout
    found = tomllib.loads((out / "found.toml").read_text())
    assert len(found["arm.origin_error"]) == 18
    both = tomllib.loads((out / "compensated.toml").read_text())
    assert both["soft.a1"] == both["arm.a1"] != 0.15
    numbers = json.loads((out / "result.json").read_text())
    assert numbers["rms"]["after"] < 0.05 < numbers["rms"]["before"]
