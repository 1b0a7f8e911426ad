"""What is done at a live machine is a scenario with the same bits."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine

# A scenario, signals to look at, and what is done: name, values among which is drawn.
WORK: list[tuple[str, list[str], list[tuple[str, list[Any]]]]] = [
    (
        "circle",
        ["card.pulse_count", "machine.table_position", "drives.torque", "mcc.path_feed"],
        [
            ("mcc.override", [0.25, 0.5, 1.0, 1.2]),
            ("mcc.hold", [True, False]),
            ("machine.force[2]", [-200.0, 0.0, 350.0]),
            ("drives.velocity_gain[1]", [0.3, 0.6]),
        ],
    ),
    (
        "hydraulic_positioning",
        ["controller.track", "axis.table_position", "controller.voltage"],
        [("axis.force", [0.0, 2000.0, -1500.0]), ("controller.p_gain", [20, 40])],
    ),
    (
        "robot_line",
        ["soft.tool_position", "soft.joint_command", "arm.motor_phase"],
        [("soft.hold", [True, False]), ("soft.override", [0.3, 1.0])],
    ),
]


def work(machine: LiveMachine, signals: list[str], actions: Any, seed: int) -> dict[str, Any]:
    """Do something at random instants, go back now and then; the signals that are left."""
    draw = np.random.default_rng(seed)
    rows: dict[str, Any] = {}
    machine.keep()
    for _ in range(12):
        if draw.random() < 0.75:
            name, values = actions[draw.integers(len(actions))]
            machine.set(name, values[draw.integers(len(values))])
        more = machine.trace(signals, int(draw.integers(1, 400)))
        rows = {n: np.concatenate([rows[n], more[n]]) if rows else more[n] for n in signals}
        if draw.random() < 0.3:
            machine.keep()
        elif draw.random() < 0.3:
            machine.back(float(draw.random()) * machine.time)
            rows = {n: rows[n][: machine.steps] for n in signals}
    return rows


@pytest.mark.parametrize(("name", "signals", "actions"), WORK, ids=[w[0] for w in WORK])
def test_a_saved_scenario_has_the_bits_of_the_work(
    name: str, signals: list[str], actions: Any, tmp_path: Path
) -> None:
    with LiveMachine(name) as machine:
        rows = work(machine, signals, actions, 7)
        assert len(machine.journal) > 2
        machine.save(tmp_path / "saved")
        plan = motionfmu.load(tmp_path / "saved")
        result = plan.changed(record={"every": 1, "signals": signals}).run()
        for signal in signals:
            own = result[signal][: machine.steps]
            assert own.astype(rows[signal].dtype).tobytes() == rows[signal].tobytes(), signal


def test_a_journal_of_other_values_gives_other_bits(tmp_path: Path) -> None:
    with LiveMachine("circle") as machine:
        machine.step(500)
        machine.set("machine.force", [300.0, 0.0, 0.0, 0.0, 0.0, 0.0])
        rows = machine.trace(["machine.table_position"], 500)["machine.table_position"]
        machine.journal.forget(0)
        result = machine.as_scenario().run()
        own = result["machine.table_position"][500:1000]
        assert own[0].tobytes() == rows[0].tobytes() and own.tobytes() != rows.tobytes()


def test_a_step_of_many_is_that_many_steps() -> None:
    with LiveMachine("circle") as one, LiveMachine("circle") as other:
        one.step(777)
        for _ in range(777):
            other.step()
        names = list(one.names[0])
        assert one.read(names) == other.read(names)
        assert one.time == other.time == pytest.approx(0.0777)


def test_going_back_forgets_what_was_done_since() -> None:
    with LiveMachine("circle") as machine:
        machine.step(100)
        machine.keep()
        machine.set("mcc.override", 0.5)
        machine.step(300)
        there = machine.read(["machine.table_position", "mcc.path_feed"])
        assert machine.kept == [pytest.approx(0.01)]
        assert machine.back(0.02) == pytest.approx(0.01) and not len(machine.journal)
        machine.set("mcc.override", 0.5)
        machine.step(300)
        assert machine.read(["machine.table_position", "mcc.path_feed"]) == there
        with pytest.raises(InputError, match=r"no state is kept at or before 0\.001 s"):
            machine.back(0.001)


def test_going_back_takes_back_what_was_set() -> None:
    with LiveMachine("circle") as machine:
        machine.keep()
        machine.set("machine.force[1]", 200.0)
        machine.step(10)
        machine.back(0.0)
        action = machine.set("machine.force[2]", 100.0)
        assert action.values == (0.0, 100.0, 0.0, 0.0, 0.0, 0.0)


def test_what_the_scenario_drives_and_what_is_set_for_it_acts_too(tmp_path: Path) -> None:
    drive = [{"input": "machine.force", "at": [0.05, 0.25], "value": [200.0, 0.0]}]
    plan = motionfmu.load("circle").changed(drive=drive)
    with LiveMachine(plan, set={"drives.velocity_gain": 0.4}) as machine:
        name = "machine.table_position"
        rows = machine.trace([name], 2200)[name]
        machine.step(800)
        with pytest.raises(InputError, match=r"machine\.force is driven by the scenario"):
            machine.set("machine.force[1]", 1.0)
        machine.set("mcc.hold", True)
        rows = np.concatenate([rows, np.zeros((800, 6)), machine.trace([name], 500)[name]])
        machine.save(tmp_path / "own")
    signal = motionfmu.load(tmp_path / "own").run()[name]
    for part in (slice(2200), slice(3000, 3500)):
        assert signal[part].tobytes() == rows[part].tobytes()
    for other in (motionfmu.load("circle").run(set={"drives.velocity_gain": 0.4}), plan.run()):
        assert other[name][:2200].tobytes() != rows[:2200].tobytes()


def test_states_are_dropped_when_they_take_too_much(monkeypatch: pytest.MonkeyPatch) -> None:
    with LiveMachine("circle") as machine:
        machine.step(100)
        machine.keep()
        most = int(3.5 * machine.state_bytes)
        monkeypatch.setattr("motionfmu.live.live_machine.STATES_MAX", most)
        for _ in range(5):
            machine.step(10)
            machine.keep()
        assert machine.kept == pytest.approx([0.013, 0.014, 0.015])


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("mcc.overide", 1.0, "mcc.overide cannot be set; did you mean 'mcc.override'?"),
        ("mcc.override", 9.0, "mcc.override = 9.0"),
        ("mcc.override", True, "mcc.override = True: Float64 wanted"),
        ("machine.force[7]", 1.0, "machine.force[7]: machine.force has the elements 1 to 6"),
        ("machine.force[0]", 1.0, "machine.force[0]: machine.force has the elements 1 to 6"),
        ("machine.force", [1.0], "machine.force has 6 elements, not 1"),
        ("machine.torque_command", 1.0, "machine.torque_command is wired to drives.torque"),
        ("machine.table_position", 1.0, "machine.table_position is an output"),
        ("machine.lead", 1.0, "machine.lead cannot be set"),
    ],
)
def test_what_cannot_be_set_is_told_and_changes_nothing(name: str, value: Any, told: str) -> None:
    with LiveMachine("circle") as machine:
        machine.step(10)
        with pytest.raises(InputError) as error:
            machine.set(name, value)
        assert told in str(error.value)
        assert not len(machine.journal)
        machine.step(10)


def test_a_machine_that_has_not_moved_is_no_scenario(tmp_path: Path) -> None:
    with LiveMachine("circle") as machine:
        with pytest.raises(InputError, match="circle: no step was made"):
            machine.save(tmp_path / "x")
        assert not (tmp_path / "x").exists()


def test_checks_that_are_ticked_go_with_it(tmp_path: Path) -> None:
    with LiveMachine("circle") as machine:
        machine.step(2000)
        machine.save(tmp_path / "seen", {"mcc.path_feed": {"max": 1000.0}})
        with pytest.raises(InputError, match=r"mcc\.path_fed"):
            machine.save(tmp_path / "other", {"mcc.path_fed": {"max": 1000.0}})
        assert not (tmp_path / "other").exists()
    assert motionfmu.load(tmp_path / "seen").run().ok


def test_steps_and_signals_that_are_none_are_told() -> None:
    with LiveMachine("circle") as machine:
        for count in (-1, 1.5, True, "5"):
            with pytest.raises(InputError, match="steps: a whole number from 0 wanted"):
                machine.step(count)  # type: ignore[arg-type]
            with pytest.raises(InputError, match="steps: a whole number from 0 wanted"):
                machine.trace(["drives.torque"], count)  # type: ignore[arg-type]
        told = r"drives\.torqe: no such signal; did you mean 'drives\.torque'"
        with pytest.raises(InputError, match=told):
            machine.trace(["drives.torque", "drives.torqe"], 5)
        with pytest.raises(InputError, match=told):
            machine.read(["drives.torqe"])
        assert machine.steps == 0
        assert machine.trace("drives.torque", 3)["drives.torque"].shape == (3, 6)


def test_a_closed_machine_says_so_and_closes_twice() -> None:
    with LiveMachine("circle") as machine:
        machine.keep()
        with pytest.raises(InputError, match="back to nan s: a finite time wanted"):
            machine.back(float("nan"))
        machine.read(["drives.torque"])
    machine.close()
    for act in (
        machine.step,
        machine.keep,
        lambda: machine.set("machine.force[1]", 1.0),
        lambda: machine.read(["drives.torque"]),
        lambda: machine["drives.torque"],
    ):
        with pytest.raises(InputError, match="circle: the machine is closed"):
            act()
