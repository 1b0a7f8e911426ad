"""A mill of the library as a Grbl: homed, jogged, held, probed; a part is streamed as it is run."""

import math
from collections import deque
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from grbl_bench import TURN, GrblBench

from motionfmu.live import LiveMachine
from motionfmu.live.grbl.line_input import ROOM
from motionfmu.run.machine_program import machine

FRAMES = ["mcc.card_cmd_seq", "mcc.card_cmd_count", "mcc.card_cmd_frames"]
AFTER = 2000  # communication steps in which the last frames leave


class FrameRecord:
    """Pulses of each DDA time that the library gives the card."""

    def __init__(self, live: LiveMachine) -> None:
        self._live = live
        self._number = live[FRAMES[0]]
        self._rows: list[Any] = []

    def look(self) -> None:
        """Take what is new."""
        (number,), (count,), frames = self._live.read(FRAMES)
        if number != self._number:
            self._number = number
            self._rows.append(np.array(frames).reshape(16, 6)[:count])

    def moved(self) -> Any:
        """From the first pulse to the last one."""
        frames = np.concatenate(self._rows)
        moving = np.flatnonzero(frames.any(axis=1))
        return frames[moving[0] : moving[-1] + 1]


def run_frames(text: str, folder: Path) -> Any:
    """Those of the program as a file."""
    file = folder / "part.ngc"
    file.write_text(text)
    with LiveMachine(machine("mill3").scenario(str(file))) as live:
        record = FrameRecord(live)
        while not live["mcc.done"]:
            live.step()
            record.look()
            assert not live["mcc.error"]
        return record.moved()


def streamed_frames(lines: list[str], before: str, counting: bool) -> tuple[list[str], Any]:
    """Answers, and those of the program sent line by line."""
    with GrblBench() as bench:
        bench.go(0.3)
        bench.say("$X\n")
        bench.say(before)
        record = FrameRecord(bench.live)
        left, flying = deque(f"{line}\n" for line in lines), deque[str]()
        answers: list[str] = []
        moving = AFTER
        while moving > 0:
            assert bench.live.time < ENDLESS, (bench.name, answers[-3:], len(left))
            while left and (
                sum(map(len, flying)) + len(left[0]) <= ROOM if counting else not flying
            ):
                flying.append(left.popleft())
                bench.controller.receive(flying[-1].encode())
            for line in bench.turn(record.look).split("\r\n"):
                if line == "ok" or line.startswith("error:"):
                    flying.popleft()
                    answers.append(line)
            ended = not left and not flying and bench.live["mcc.path_feed"] == 0.0
            moving = moving - TURN if ended and bench.name == "Idle" else AFTER
        return answers, record.moved()


ENDLESS = 60.0  # [s] simulated: a part of 300 lines takes a few seconds


def outline(count: int) -> list[str]:
    """A closed curve of short lines, then an arc and a corner."""
    turns = [2 * math.pi * k / count for k in range(count + 1)]
    lines = [f"X{10 * math.sin(t):.3f}Y{5 - 5 * math.cos(2 * t):.3f}" for t in turns]
    rest = ["G2X4Y0R2", "M3S1000", "G0Z-2", "G1Z0F2000", "X0", "M30"]
    return ["G21G90G17", "G1F4000X0", *lines, *rest]


@pytest.mark.parametrize("counting", [True, False], ids=["counting", "waiting"])
@pytest.mark.parametrize(
    ("count", "tolerance"),
    [
        pytest.param(300, 0.0, marks=pytest.mark.more),
        (300, 0.02),
        pytest.param(800, 0.02, marks=pytest.mark.more),
    ],
)
def test_a_part_that_is_streamed_has_the_pulses_of_its_run(
    counting: bool, count: int, tolerance: float, tmp_path: Path
) -> None:
    lines = outline(count)
    mode = f"G64P{tolerance}\n" if tolerance else "G61\n"
    expected = run_frames(mode + "\n".join(lines), tmp_path)
    answers, frames = streamed_frames(lines, f"$11={tolerance}\n", counting)
    assert answers == ["ok"] * len(lines)
    assert len(frames) > 500
    np.testing.assert_array_equal(frames, expected)


def test_lines_look_ahead_as_those_of_a_program(tmp_path: Path) -> None:
    lines = outline(40)[2:43]
    text = "G21G90G17G1F6000\n"
    expected = run_frames("G64P0.02\n" + text + "\n".join(lines), tmp_path)
    answers, frames = streamed_frames(lines, "$11=0.02\n" + text, True)
    assert answers == ["ok"] * len(lines)
    np.testing.assert_array_equal(frames, expected)


def test_it_is_homed_jogged_held_and_reset() -> None:
    with GrblBench() as bench:
        assert bench.go(0.2)[-1] == "[MSG:'$H'|'$X' to unlock]"
        assert bench.say("G0X1\n$X\n") == ["error:9", "[MSG:Caution: Unlocked]", "ok"]
        assert bench.say("$J=G91X5F6000\n", 0.05) == ["ok"]
        assert bench.until("<", "?")[-1].startswith("<Jog|")
        assert "|MPos:5.000,0.000,0.000|" in bench.idle()
        bench.say("$J=G91Y100F6000\n", 0.3)
        assert bench.say("\x85", 0.4) == []
        place = float(bench.idle().split(",")[1])
        assert 5.0 < place < 60.0
        bench.say("G10L20P0Y0\nG1X20F600\n", 0.5)
        assert bench.until("<", "!?")[-1].startswith("<Hold:1|")
        bench.go(0.3)
        held = bench.until("<", "?")[-1]
        assert held.startswith("<Hold:0|")
        bench.go(0.2)
        assert bench.until("<", "?")[-1].split("|")[1] == held.split("|")[1], "it rests"
        bench.say("~", 0.3)
        told = bench.say("\x18", 0.6)
        assert told == ["ALARM:3", "", "Grbl 1.1h ['$' for help]", "[MSG:'$H'|'$X' to unlock]"]
        assert bench.say("$X\n")[-1] == "ok"
        origin = next(line for line in bench.say("$#\n") if line.startswith("[G54:"))
        assert float(origin.split(",")[1]) == pytest.approx(place, abs=1e-3)
        wide = next(line for line in bench.say("?") if "|WCO:" in line)
        assert f"|WCO:0.000,{place:.3f},0.000" in wide


@pytest.mark.more
def test_homing_finds_the_origins() -> None:
    with GrblBench() as bench:
        bench.go(0.2)
        assert bench.until("ok", "$H\n") == ["ok"]
        assert bench.until("<", "?")[-1].startswith("<Idle|")
        assert bench.live["mcc.homed"]
        assert bench.say("G0X1\n", 0.3) == ["ok"]


def test_a_probe_tells_the_place_of_its_contact() -> None:
    with GrblBench() as bench:
        bench.go(0.3)
        bench.say("$X\n")
        bench.controller.receive(b"G21G90G38.2Z-20F600\n")
        bench.go(0.5)
        touched = 1e3 * bench.live["machine.table_position"][2]
        bench.live.set("mcc.probe_in", True)
        told = bench.until("ok")
        assert told[0].startswith("[PRB:0.000,0.000,-") and told[0].endswith(":1]")
        assert float(told[0].split(",")[2].split(":")[0]) == pytest.approx(touched, abs=0.02)
        bench.live.set("mcc.probe_in", False)
        missed = bench.until("ok", "G38.3Z-5F6000\n")
        assert missed == ["[PRB:0.000,0.000,-5.000:0]", "ok"]
        assert bench.until("ok", "G38.2Z-6F6000\n") == [
            "ALARM:5",
            "[PRB:0.000,0.000,-6.000:0]",
            "ok",
        ]
        bench.go(1.2)
        bench.live.set("mcc.probe_in", True)
        assert bench.until("ok", "$X\n")[-1] == "ok"
        assert bench.until("ok", "G38.2Z-7F6000\n")[:1] == ["ALARM:4"]


def test_spindle_and_coolant_by_hand() -> None:
    with GrblBench() as bench:
        bench.go(0.3)
        bench.say("$X\n")
        assert bench.say("M3S1000M8\n") == ["ok"]
        assert (bench.live["mcc.spindle_speed"], bench.live["mcc.coolant"]) == (1000.0, 2)
        bench.say("\xa1\xa0")
        assert bench.live["mcc.coolant"] == 1
        bench.say("\x9a\x84")
        assert (bench.live["mcc.spindle_speed"], bench.live["mcc.coolant"]) == (0.0, 0)
        bench.say("~")
        assert (bench.live["mcc.spindle_speed"], bench.live["mcc.coolant"]) == (1100.0, 1)
        bench.say("!\x9e")
        assert bench.live["mcc.spindle_speed"] == 0.0
        assert bench.say("~") == ["[MSG:Restoring spindle]"]
        assert bench.live["mcc.spindle_speed"] == 1100.0
        assert bench.say("M9\n") == ["ok"]
        assert bench.live["mcc.coolant"] == 0


def test_the_soft_limit_stops_what_comes_behind() -> None:
    with GrblBench() as bench:
        bench.go(0.3)
        bench.say("$X\n")
        told = bench.say("G1X1F600\nX251\nX2\n", 0.5)
        assert told[-2:] == ["ALARM:2", "[MSG:Reset to continue]"]
        assert bench.say("\x18", 0.6)[-1] == "[MSG:'$H'|'$X' to unlock]"
        assert bench.say("$X\nG1X0F600\n", 0.2)[-1] == "ok"
        assert "|MPos:0.000,0.000,0.000|" in bench.idle()


def test_what_a_sender_did_is_a_scenario_with_the_same_bits() -> None:
    signals = ["card.pulse_count", "mcc.spindle_speed"]
    with GrblBench() as bench:
        bench.go(0.1)
        bench.say("$X\nM3S500\nG1X3F3000\n", 0.1)
        bench.say("!\x91~", 0.05)
        bench.say("\x18", 0.2)
        seen = bench.live.read(signals)
        steps = bench.live.steps
        again = bench.live.as_scenario()
    with LiveMachine(again) as live:
        live.step(steps)
        assert live.read(signals) == seen
    assert seen[0][0] > 0
