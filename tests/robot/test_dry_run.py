"""Programs run dry against runs: times, refusals planted in any line, inputs."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from typer.testing import CliRunner

import motionfmu
from motionfmu import InputError
from motionfmu.analysis.dry_run import DryRun, InputChange, dry_run
from motionfmu.cli import app
from motionfmu.virtual.robot import RobotError, VirtualRobot

PICK = ROOT / "scenarios/robot_pick"
JOBS, ALL = 6, 2000
MOVES = 6
# Points that no line or joint move of the arm can reach, and by which word of a move.
FAULTS = (
    ("MOVL", "X=2500 Y=0 Z=500 A=180 B=0 C=180", "out of reach"),
    ("MOVJ", "J1=0 J2=96 J3=0 J4=0 J5=90 J6=0", "joint 2"),
    ("MOVL", "X=900 Y=100 Z=500 A=180 B=0 C=180 FRONT UP FLIP", "configuration"),
    ("MOVJ", "X=900 Y=0 Z=3000 A=180 B=0 C=180", "out of reach"),
    # Across axis 1: refused, but from a few poses, from which the tool comes by it slowly.
    ("MOVL", "X=-900 Y=1 Z=500 A=180 B=0 C=0", ""),
)


def written(folder: Path, seed: int, fault: bool) -> tuple[Path, int, str]:
    """A job of random moves with its points; the line of the planted fault, 0 none, and a word."""
    rng = np.random.default_rng(seed)
    points = ["P000 J1=0 J2=-10 J3=10 J4=0 J5=90 J6=0"]
    lines = ["NOP", "MOVJ P000 VJ=50.00"]
    planted = int(rng.integers(0, MOVES)) if fault else -1
    word, at = "", 0
    for k in range(MOVES):
        x, y, z = rng.uniform([800.0, -300.0, 400.0], [1100.0, 300.0, 800.0])
        a, b = rng.uniform(-15.0, 15.0, 2)
        move = "MOVL" if rng.integers(0, 2) else "MOVJ"
        point = f"X={x:.1f} Y={y:.1f} Z={z:.1f} A={180 + a:.2f} B={b:.2f} C=180"
        if k == planted:
            move, point, word = FAULTS[int(rng.integers(0, len(FAULTS)))]
            at = len(lines) + 1
        points.append(f"P{k + 1:03d} {point}")
        how = f"V={rng.uniform(300.0, 1500.0):.0f}" if move == "MOVL" else "VJ=60.00"
        lines.append(f"{move} P{k + 1:03d} {how} PL={rng.integers(0, 6)}")
        if rng.integers(0, 3) == 0:
            lines.append("TIMER T=0.05")
    (folder / "a.job").write_text("\n".join([*lines, "END", ""]))
    (folder / "a.points").write_text("\n".join([*points, ""]))
    return folder / "a.job", at, word


def run_of(file: Path) -> tuple[int, str, float]:
    """Line of the error, its words and the time of a run on the controller's own clock."""
    robot = VirtualRobot(tool=[0, 0, 150, 0, 0, 0])
    robot.start(file, file.with_suffix(".points").read_text())
    seen = robot.run_until_stop(600.0)
    return int(seen.error_line), str(seen.words), seen.time


def judged(folder: Path, seed: int) -> None:
    file, at, word = written(folder, seed, seed % 2 == 0)
    dry = dry_run(motionfmu.machine("robot6").scenario(file))
    line, words, time = run_of(file)
    assert dry.fault_line == line, f"seed {seed}: {dry.fault}, {words}"
    after_axis_1 = bool(at) and not word and (line == 0 or line > at)
    assert line == at or after_axis_1, f"seed {seed}: {words}"
    assert word in dry.fault
    assert dry.fault == (f"line {line}: {words}" if line else "")
    if line == at:  # by axis 1 it may come too near to itself
        assert dry.collisions == [], f"seed {seed}: {dry.faults}"
    assert abs(dry.time - time) <= 0.01 * time, f"seed {seed}"


@pytest.mark.more
def test_faults_are_found_where_a_run_has_them(tmp_path: Path) -> None:
    for seed in range(JOBS):
        judged(tmp_path, seed)


@pytest.mark.long
def test_faults_of_two_thousand_jobs(tmp_path: Path) -> None:
    for seed in range(ALL):
        judged(tmp_path, seed)


def test_the_time_is_that_of_the_fmus() -> None:
    scenario = motionfmu.load(PICK)
    dry = dry_run(scenario)
    run = scenario.run()
    done = run.time[np.argmax(run.signals["soft.done"])]
    assert abs(dry.time - done) <= 1e-3 * done
    assert dry.waits > 3.0
    # 12 again behind the second part; the third does not come.
    assert [m.line for m in dry.moves].count(12) == 3
    command = np.degrees(run.signals["soft.joint_command"])
    for k in range(6):
        again = np.interp(run.time, dry.samples["time"], dry.samples["joint"][:, k])
        fast = np.abs(dry.samples["rate"]).max()
        lag = 10 * 0.64e-3  # a cycle of the dry run for each stop
        assert np.abs(again - command[:, k]).max() < lag * fast


def test_reserves_are_those_of_the_samples() -> None:
    dry = dry_run(motionfmu.load(PICK))
    low, high = np.array([-180, -155, -155, -400, -120, -400]), [180, 95, 75, 400, 120, 400]
    s = dry.samples
    for m in dry.moves:
        own = s[(s["time"] > m.begin + 1e-9) & (s["time"] <= m.end + 1e-9)]
        room = np.minimum(own["joint"] - low, high - own["joint"]).min(axis=0)
        assert m.joint == room.argmin() + 1
        assert m.left == pytest.approx(room.min(), abs=1e-9)
        assert m.way == pytest.approx(
            np.linalg.norm(np.diff(own["place"][1:], axis=0), axis=1).sum(), abs=2.0
        )
        assert 0.0 < m.share <= 1.0 + 1e-9
    assert {x.line: x.passes for x in dry.lines}[12] == 3
    assert sum(x.time for x in dry.lines) == pytest.approx(sum(m.end - m.begin for m in dry.moves))


def test_without_the_parts_the_alarm_is_the_end() -> None:
    scenario = motionfmu.load(PICK)
    none = dry_run(scenario, [InputChange(0.0, 9, True)])
    assert {m.line for m in none.moves} == {8, 12, 29}
    one = dry_run(scenario, [InputChange(0.5, 1, True), InputChange(0.5, 2, True)])
    assert {m.line for m in one.moves} > {32, 35, 38}


def test_a_wait_without_end_is_told(tmp_path: Path) -> None:
    (tmp_path / "a.job").write_text("MOVJ P000\nWAIT IN#(3)=ON\nMOVJ P000\nEND\n")
    (tmp_path / "a.points").write_text("P000 J1=0 J2=0 J3=0 J4=0 J5=60 J6=0\n")
    scenario = motionfmu.machine("robot6").scenario(tmp_path / "a.job")
    with pytest.raises(InputError, match=r"a\.job: line 2 waits for an input that does not come"):
        dry_run(scenario)
    assert not dry_run(scenario, [InputChange(1.0, 3, True)]).fault


def test_a_pendants_job_calls_the_one_beside_it(tmp_path: Path) -> None:
    head = "/JOB\n//NAME {0}\n//POS\n///NPOS 1,0,0,0,0,0\n///TOOL 0\n///POSTYPE PULSE\n///PULSE\n"
    # Pulses of joints by gear and motor: joint 1 to 10 degrees.
    pulses = f"C00000={round(10 / 360 * 100 * 2500)},0,0,0,62500,0\n"
    body = "//INST\n///DATE 2026/01/01 10:00\n///ATTR SC,RW\n///GROUP1 RB1\nNOP\n"
    (tmp_path / "A.JBI").write_text(f"{head.format('A')}{pulses}{body}CALL JOB:B\nEND\n")
    move = "MOVJ C00000 VJ=50.00\n"
    (tmp_path / "B.JBI").write_text(f"{head.format('B')}{pulses}{body}{move}END\n")
    scenario = motionfmu.machine("robot6").scenario(tmp_path / "A.JBI")
    dry = dry_run(scenario)
    assert not dry.fault
    assert dry.samples["joint"][-1] == pytest.approx([10, 0, 0, 0, 90, 0], abs=1e-3)
    (tmp_path / "B.JBI").write_text(f"{head.format('B')}{pulses}{body}MOVQ C00000\nEND\n")
    assert "MOVQ" in dry_run(motionfmu.machine("robot6").scenario(tmp_path / "A.JBI")).fault
    robot = VirtualRobot()
    with pytest.raises(RobotError, match=r"^B: line 14.*MOVQ"):
        robot.start(tmp_path / "A.JBI")


def command(*words: str) -> tuple[int, str]:
    done = CliRunner().invoke(app, ["job", *words])
    return done.exit_code, done.output + (str(done.exception) if done.exception else "")


def test_the_command_writes_a_page(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    status, told = command(str(PICK))
    assert status == 0
    assert "pick.job" in told and "22.7 s" in told
    page = (tmp_path / "results/robot_pick.job/report.html").read_text(encoding="utf-8")
    assert "Joints and their limits" in page
    file, at, word = written(tmp_path, 0, fault=True)
    status, told = command(str(file), "--machine", "robot6", "--json")
    assert status == 1
    assert f'"fault_line": {at}' in told and word in told


@pytest.mark.parametrize(
    ("words", "told"),
    (
        (("circle",), "circle: its machine has no robot's controller with a program; robot6 of"),
        ((str(PICK), "--input", "40=on"), "--input 40=on: N=on@SECONDS or N=off@SECONDS wanted"),
        ((str(PICK), "--input", "1=high"), "--input 1=high"),
        ((str(PICK), "--set", "soft.a1=99"), "soft.a1"),
    ),
)
def test_wrong_words(words: tuple[str, ...], told: str) -> None:
    status, text = command(*words)
    assert status == 1 or status == 2
    assert told in text


def test_a_trace_tells_underruns_as_a_run_does() -> None:
    for run in ("trace", "run"):
        robot = VirtualRobot(ik_time=1e-3)
        points = "P000 J1=0 J2=0 J3=0 J4=0 J5=60 J6=0\nP001 X=1000 Y=100 Z=900 A=180 B=0 C=180\n"
        robot.start("MOVJ P000\nMOVL P001 V=1000.0\nEND\n", points)
        with pytest.warns(RuntimeWarning, match="underruns of the card") as told:
            robot.trace(10.0, 1e-3) if run == "trace" else robot.run(10.0)
        assert {w.filename for w in told} == {__file__}


def test_a_trace_needs_a_program() -> None:
    with pytest.raises(RobotError, match="no program has been started"):
        VirtualRobot().trace(1.0, 1e-3)
    robot = VirtualRobot()
    robot.start("MOVJ P000\nEND\n", "P000 J1=0 J2=0 J3=0 J4=0 J5=60 J6=0\n")
    with pytest.raises(InputError, match="25 ns or more"):
        robot.trace(1.0, 0.0)
    assert isinstance(dry_run(motionfmu.load(PICK)), DryRun)
