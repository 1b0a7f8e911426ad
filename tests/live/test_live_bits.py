"""Two minutes at a machine are a scenario with the same bits, at any pace, whoever looks."""

import math
from pathlib import Path
from typing import Any

import numpy as np
import pytest

import motionfmu
from motionfmu.live import LiveMachine, Pace
from motionfmu.live.machine_loop import MachineLoop

EVERY = 97  # steps between two looks at all signals
SETTINGS: list[tuple[str, list[Any]]] = [
    ("mcc.override", [0.3, 0.7, 1.0, 1.2]),
    ("mcc.hold", [True, False]),
    ("machine.force[1]", [-200.0, 0.0, 350.0]),
    ("machine.force[2]", [-100.0, 0.0]),
    ("drives.velocity_gain[1]", [0.3, 0.5]),
]
CHANNELS = ["mcc.line", "drives.torque[1]", "mcc.path_feed", "machine.table_position[2]"]


class Wall:
    """A clock that goes on while somebody sleeps."""

    def __init__(self) -> None:
        self.now = 0.0

    def sleep(self, seconds: float) -> None:
        self.now += seconds


class Seen:
    """A machine that is run by its loop, and all its signals at every so many steps."""

    def __init__(self, machine: LiveMachine, pace: float) -> None:
        wall = Wall()
        self.machine = machine
        self.loop = MachineLoop(machine, Pace(pace, lambda: wall.now, wall.sleep))
        self.names = list(machine.names[0])
        self.rows: dict[int, list[Any]] = {}

    def run(self, count: int, turn: int) -> None:
        end = self.machine.steps + count
        while self.machine.steps < end:
            now = self.machine.steps
            if now % EVERY == 0:
                self.rows[now] = self.machine.read(self.names)
            self.loop.pace.wait(self.machine.time)
            self.loop.advance(min(turn, end - now, EVERY - now % EVERY))
            assert not self.loop.error


def worked(machine: LiveMachine, actions: int, seed: int) -> Seen:
    """Do something at random so many times; go back now and then."""
    draw = np.random.default_rng(seed)
    seen = Seen(machine, 3.0)
    loop = seen.loop
    for _ in range(actions):
        kind = draw.integers(8)
        if kind < 3:
            name, values = SETTINGS[draw.integers(len(SETTINGS))]
            loop.do_set(name, values[draw.integers(len(values))])
        elif kind == 3:
            for _ in range(draw.integers(1, 9)):
                loop.do_jog("mcc", int(draw.integers(1, 3)), 1.0)
                seen.run(400, 30)
        elif kind == 4:
            loop.do_press(str(draw.choice(["mcc.clear_error", "mcc.cycle_start"])))
        elif kind == 5:
            chosen = [str(c) for c in draw.choice(CHANNELS, 2, False)]
            loop.do_channels(chosen)
            loop.do_trigger(chosen[0], kind="change", mode="normal", length=200)
        elif kind == 6:
            loop.do_pause()
            loop.do_frame(seen.names)
            loop.do_go()
        elif draw.random() < 0.2:
            loop.do_back(seen.machine.time * 0.9)
            seen.rows = {k: row for k, row in seen.rows.items() if k < machine.steps}
            loop.do_go()
        seen.run(int(draw.integers(1, 6000)), int(draw.integers(1, 200)))
    return seen


def replayed(folder: Path, pace: float, turn: int, scope: bool) -> dict[int, list[Any]]:
    """All signals of a saved scenario that a loop runs, at every so many steps."""
    plan = motionfmu.load(folder)
    with LiveMachine(plan) as machine:
        seen = Seen(machine, pace)
        if scope:
            seen.loop.do_channels(CHANNELS)
            seen.loop.do_trigger(CHANNELS[0], kind="change", mode="normal", length=100)
        seen.run(round(plan.document.body.stop_limit / machine.step_seconds), turn)
    return seen.rows


def compare(folder: Path, actions: int) -> None:
    """Work, save, replay at four paces and run by another engine."""
    with LiveMachine("circle") as machine:
        seen = worked(machine, actions, 11)
        assert len(machine.journal) > actions // 2
        machine.save(folder)
    runs = ((0.1, 10, True), (1.0, 97, False), (100.0, 1000, True), (math.inf, 13, False))
    for run in runs:
        assert repr(replayed(folder, *run)) == repr(seen.rows)
    # what another engine records: scalars, and arrays of six
    names = [n for n, v in zip(seen.names, seen.rows[0], strict=True) if len(v) in (1, 6)]
    assert len(names) > 0.8 * len(seen.names)
    record = {"every": EVERY, "signals": names}
    result = motionfmu.load(folder).changed(record=record).run()
    for place, name in enumerate(seen.names):
        if name in names:
            own = np.array([row[place] for row in seen.rows.values()])
            got = result[name].reshape(len(own), -1)
            assert own.astype(got.dtype).tobytes() == got.tobytes(), name


def test_what_was_done_is_there_at_any_pace_with_and_without_a_scope(tmp_path: Path) -> None:
    compare(tmp_path / "short", 7)


@pytest.mark.long
def test_two_minutes_are_there_at_any_pace(tmp_path: Path) -> None:
    compare(tmp_path / "long", 450)
