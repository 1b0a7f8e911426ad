"""What a person does at the library's panel: lines by hand in every engine, kept in the journal."""

import math
from pathlib import Path

import numpy as np
import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.export import system_ssp
from motionfmu.live import LiveMachine
from motionfmu.run.run_plan import Options

HEAD = '# Lines by hand.\nmachine = "xy_table"\nstop = {stop}\n'
SIGNALS = ["mcc.position", "card.pulse_count", "mcc.mdi_done", "mcc.mdi_lines", "mcc.mdi_room"]


def written(folder: Path, more: str = "", stop: float = 0.5) -> Path:
    """A scenario without a program."""
    folder.mkdir(exist_ok=True)
    (folder / "scenario.toml").write_text(HEAD.format(stop=stop) + more)
    return folder


@pytest.fixture
def machine(tmp_path: Path) -> LiveMachine:
    return LiveMachine(written(tmp_path / "bare"))


def give(machine: LiveMachine, text: str, seconds: float = 0.3) -> None:
    """Give lines, and let time pass."""
    machine.set("mcc.mdi", text)
    machine.set("mcc.mdi_seq", int(machine["mcc.mdi_taken"]) + 1)
    machine.step(round(seconds / machine.step_seconds))


DRIVES = """
[[drive]]
input = "mcc.mdi"
at    = [0.0, 0.01, 0.2]
value = ["G1 X10 F3000", "G91 X1 Y3", "G1 X1 Q"]

[[drive]]
input = "mcc.mdi_seq"
at    = [0.0, 0.01, 0.2]
value = [1, 2, 3]
"""


def test_texts_of_a_drive_have_the_same_bits_in_every_engine(tmp_path: Path) -> None:
    plan = motionfmu.load(written(tmp_path / "lines", DRIVES))
    plan = plan.changed(record={"every": 1, "signals": [*SIGNALS, "mcc.mdi_refused"]})
    seen = []
    for engine, fmi in (("fused", 3), ("native", 3), ("native", 2), ("python", 3), ("fmpy", 2)):
        result = plan.run(engine=engine, fmi=fmi)
        seen.append([result[n].tobytes() for n in (*SIGNALS, "mcc.mdi_refused")])
        assert tuple(result["mcc.position"][-1][:2]) == (11.0, 3.0)
        assert result["mcc.mdi_refused"][-1] == 3
    assert all(one == seen[0] for one in seen)


def test_a_number_is_no_text_and_a_text_has_its_length(tmp_path: Path) -> None:
    bad = DRIVES.replace('"G1 X10 F3000"', "7")
    with pytest.raises(InputError, match=r"scenario\.toml:8: mcc\.mdi = 7: String wanted"):
        motionfmu.load(written(tmp_path / "bad", bad)).run()
    bad = DRIVES.replace("G1 X10 F3000", "G" * 1024)
    with pytest.raises(InputError, match=r"less than 1024 bytes wanted"):
        motionfmu.load(written(tmp_path / "long", bad)).run()


def test_an_export_tells_that_it_leaves_the_lines_out(tmp_path: Path) -> None:
    plan = motionfmu.load(written(tmp_path / "lines", DRIVES))
    _, lost = system_ssp.stimuli(plan.resolved(Options()))
    assert [text for text in lost if "mcc.mdi:" in text]


def test_lines_given_by_hand_are_kept_as_they_were(tmp_path: Path, machine: LiveMachine) -> None:
    with machine:
        give(machine, "G1 X4 F6000")
        machine.keep()
        give(machine, 'G10 L20 P0 X0 (a "quoted" \\ word, and µ)\nG0 Y2')
        give(machine, "G1 X-2")
        there = machine.time
        machine.back(0.3)  # the lines since then are forgotten, their numbers too
        assert machine["mcc.mdi_lines"] == 1 and machine.time < there
        give(machine, "X5 F3000")
        rows = {n: machine[n] for n in SIGNALS}
        machine.save(tmp_path / "saved")
        result = motionfmu.load(tmp_path / "saved").changed(record={"signals": SIGNALS}).run()
    for name in SIGNALS:
        assert np.array_equal(result[name][-1], rows[name]), name
    assert tuple(rows["mcc.position"][:2]) == (5.0, 0.0)


def lines(path: str) -> list[str]:
    """A contour of short lines, with a dwell in front in which the first of them come."""
    points = [(20 * math.sin(0.05 * k), 20 - 20 * math.cos(0.05 * k)) for k in range(300)]
    moves = [f"G1 X{x:.4f} Y{y + 0.01 * (k % 3):.4f}" for k, (x, y) in enumerate(points)]
    return [f"{path}\nF6000 G4 P0.2", *moves, "M2"]


@pytest.mark.parametrize("path", ["G64 P0.05", "G64"])
def test_a_stream_has_the_bits_of_the_program(path: str, tmp_path: Path) -> None:
    program = tmp_path / "contour.ngc"
    program.write_text("\n".join(lines(path)) + "\n")
    place, looks = written(tmp_path / "bare"), 12000
    with LiveMachine(place, set={"mcc.program": str(program)}) as machine:
        want = machine.trace(SIGNALS[:2], looks)
    with LiveMachine(place) as machine:
        found: list[list[list[float]]] = []
        waiting = lines(path)
        for step in range(looks):
            if waiting and machine["mcc.mdi_room"] > len(waiting[0].encode()):
                machine.set("mcc.mdi", waiting.pop(0))
                machine.set("mcc.mdi_seq", step + 1)
            found.append(machine.read(SIGNALS[:2]))
            machine.step()
        assert not waiting and machine["mcc.mdi_refused"] == 0
    assert np.array_equal([row[0] for row in found], want["mcc.position"])
    assert np.array_equal([row[1] for row in found], want["card.pulse_count"])
    assert np.ptp(want["mcc.position"][:, 0]) > 10


def test_a_refused_line_is_told_as_of_a_program(machine: LiveMachine) -> None:
    with machine:
        give(machine, "G1 X1 F600\nG3 X9 Y9 I1 J50", 0.5)
        assert (machine["mcc.mdi_refused"], machine["mcc.mdi_lines"]) == (2, 2)
        told = "mcc: mdi: line 2: arc end does not lie on the circle through its start"
        assert machine.warnings[-1].startswith(told)
        assert machine.warnings[-1].endswith("column 1")
        give(machine, "G1 X2")
        assert machine["mcc.position"][0] == 2.0 and machine["mcc.error"] == 0


def test_the_readout_follows_the_motion_not_the_reading(machine: LiveMachine) -> None:
    with machine:
        give(machine, "G10 L2 P2 X100\nG1 X5 F600\nG55 G0 X-90", 0.2)
        assert machine["mcc.system"] == 1 and machine["mcc.work_offset"][0] == 0.0
        assert machine["mcc.modes"][8] == 550  # what is read is ahead
        left = machine["mcc.distance_to_go"][0]
        assert left == pytest.approx(5.0 - machine["mcc.position"][0]) and left > 1.0
        machine.step(5000)
        assert machine["mcc.system"] == 2 and machine["mcc.work_offset"][0] == 100.0
        assert machine["mcc.position"][0] == 10.0 and machine["mcc.distance_to_go"][0] == 0.0


def test_a_program_waits_for_cycle_start(tmp_path: Path) -> None:
    program = tmp_path / "part.ngc"
    program.write_text("G1 X1 F6000\nG91 X1 S100 M3\nX1\nM1\nX1\nM2\n")
    given = {"mcc.program": str(program), "mcc.auto_start": False}
    with LiveMachine(written(tmp_path / "bare"), set=given) as machine:
        machine.step(500)
        assert not machine["mcc.done"] and machine["mcc.position"][0] == 0.0
        give(machine, "G10 L20 P0 X-1", 0.1)
        for run, stop in ((0, False), (3, True), (9, False)):
            machine.set("mcc.run_from", run)
            machine.set("mcc.optional_stop", stop)
            machine.set("mcc.spindle_override", 1.5)
            for down in (True, False):
                machine.set("mcc.cycle_start", down)
                machine.step(20 if down else 8000)
            there = machine["mcc.position"][0]
            if run == 0:
                assert there == 1.0 + 1.0 + 3.0 and machine["mcc.done"]
            elif run == 3:  # M1 acts now; line 2 has switched the spindle on
                assert there == 6.0 and machine["mcc.status"] == 2
                assert machine["mcc.spindle_speed"] == 150.0
                machine.set("mcc.cycle_start", True)
                machine.step(5000)
                machine.set("mcc.cycle_start", False)
                machine.step(20)
                assert machine["mcc.position"][0] == 7.0
            else:
                assert there == 7.0
                told = "the program does not come to line"
                assert machine.warnings[-1].endswith(f"line 9: {told}")
