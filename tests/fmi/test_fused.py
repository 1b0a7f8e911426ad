"""A system as one program: what every FMU must do, and what the components do one by one."""

import os
import re
import subprocess
import zipfile
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
import test_fmi_descriptions as descriptions
import test_fmi_runs as runs
import test_fmi_states as states
from fmi_tools import ERROR, OK, Instance, unpacked

import motionfmu
from motionfmu import fused
from motionfmu.base import compiler
from motionfmu.fused import fmu_parts
from motionfmu.run.run_plan import Options
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, System

NAME = "two_drives_and_a_scope"
STEP = 1e-4  # [s]
TABLES: dict[str, Any] = {
    "stop": 0.05,
    "step": STEP,
    "leave": ["drives.*", "others.*", "machine.force", "scope.*"],
    "component": {
        "drives": "servo_drives",
        "others": "servo_drives",
        "machine": "ball_screw_axes",
        "scope": "scope",
    },
    "connect": {
        "drives.phase": "machine.motor_phase",
        "others.phase": "machine.motor_phase",
        "machine.torque_command": "drives.torque",
        "scope.axes_real_1": "machine.motor_phase",
        "scope.axes_int_1": "others.alarm",
    },
    "set": {
        "drives.active": True,
        "others.active": True,
        "machine.active": True,
        "drives.dac": 0.5,
        "others.dac": -0.5,
        "scope.axes_real_used": 1,
        "scope.axes_int_used": 1,
    },
    "record": {
        "signals": ["machine.motor_phase", "drives.*", "others.torque", "others.alarm"],
    },
}


def system_of(tables: dict[str, Any]) -> tuple[System, list[End]]:
    scenario = motionfmu.scenario(tables)
    return scenario.resolved(Options()), scenario.ends


def packed(program: fused.FusedProgram, target: Path) -> None:
    with zipfile.ZipFile(target, "w") as archive:
        for file in sorted(f for f in program.folder.rglob("*") if f.is_file()):
            archive.write(file, file.relative_to(program.folder))


@pytest.fixture(scope="module")
def system() -> tuple[System, list[End]]:
    return system_of(TABLES)


@pytest.fixture(scope="module", autouse=True)
def among_fmus(
    system: tuple[System, list[End]], tmp_path_factory: pytest.TempPathFactory
) -> Iterator[None]:
    """The system as two FMUs, which `Instance` finds by its name."""
    folder = tmp_path_factory.mktemp("fmus")
    for fmi in (2, 3):
        packed(fused.exported(*system, fmi, "TwoDrives"), folder / f"{NAME}.fmi{fmi}.fmu")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MOTIONFMU_FMUS", str(folder))
        yield
    unpacked.cache_clear()


@pytest.mark.parametrize("fmi", (2, 3))
def test_it_is_what_every_fmu_is(
    fmi: int, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    if fmi == 3:  # 2's validator takes seconds for a thousand scalars; fmutool has the schema, too
        descriptions.test_fmpy_finds_nothing_wrong(NAME)
    descriptions.test_fmutool_finds_nothing_wrong(NAME, fmi, monkeypatch, capsys)
    descriptions.test_the_library_exports_the_standard_and_nothing_else(NAME, fmi)
    descriptions.test_both_versions_describe_the_same_variables(NAME)
    descriptions.test_outputs_and_initial_unknowns_are_complete(NAME, fmi)
    runs.test_reset_gives_a_fresh_instance(NAME, fmi, tmp_path)
    runs.test_a_state_runs_on_anywhere(NAME, fmi, tmp_path)
    runs.test_two_instances_do_not_know_each_other(NAME, fmi, tmp_path)
    runs.test_fmpy_simulates_it(NAME, fmi, tmp_path)
    states.test_a_damaged_state_is_refused_and_changes_nothing(NAME, fmi, tmp_path)


def test_both_versions_give_the_same_bits(tmp_path: Path) -> None:
    runs.test_both_versions_give_the_same_bits(NAME, tmp_path)


def recorded(folder: Path) -> dict[str, Any]:
    return {f.stem: np.load(f) for f in sorted(folder.iterdir())}


def started(folder: Path, **values: Any) -> Instance:
    given = {"recorder.folder": str(folder / "rows"), "scope.file": str(folder / "trace")}
    return Instance(NAME, 3).initialize(given | values)


def ended(instance: Instance) -> None:
    assert instance.call("Terminate") == OK, instance.said
    instance.free()


@pytest.fixture(scope="module")
def straight(tmp_path_factory: pytest.TempPathFactory, among_fmus: None) -> dict[str, Any]:
    """The rows of 500 steps in one call, and the trace of the scope."""
    folder = tmp_path_factory.mktemp("straight")
    instance = started(folder)
    assert instance.step(500 * STEP) == OK, instance.said
    ended(instance)
    rows = recorded(folder / "rows")
    assert len(rows["time"]) == 500 and rows["machine.motor_phase"].shape == (500, 6)
    assert np.ptp(rows["machine.motor_phase"]) > 1e-6  # the first axis is driven
    np.testing.assert_array_equal(
        np.load(folder / "trace.real.npy")[:500, :6], rows["machine.motor_phase"]
    )
    return rows


def test_components_called_one_by_one_give_the_same_rows(straight: dict[str, Any]) -> None:
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("MOTIONFMU_FMUS")
        unpacked.cache_clear()
        result = motionfmu.scenario(TABLES).run(engine="python")
        unpacked.cache_clear()
    for name, rows in result.signals.items():
        np.testing.assert_array_equal(straight[name], rows, name)


@pytest.mark.parametrize("calls", ([1, 499], [1] * 3 + [97, 400], [10] * 50))
def test_any_split_of_a_run_records_the_same_rows(
    calls: list[int], tmp_path: Path, straight: dict[str, Any]
) -> None:
    instance = started(tmp_path)
    for steps in calls:
        assert instance.step(steps * STEP) == OK, instance.said
    ended(instance)
    for name, rows in recorded(tmp_path / "rows").items():
        np.testing.assert_array_equal(straight[name], rows, name)


def test_the_recorder_goes_back_with_a_state(tmp_path: Path, straight: dict[str, Any]) -> None:
    instance = started(tmp_path)
    assert instance.step(200 * STEP) == OK
    state, time = instance.save(), instance.time
    instance.set("drives.enable", False)  # another way, to be forgotten
    assert instance.step(100 * STEP) == OK
    assert instance.restore(state, time) == OK
    assert instance.step(300 * STEP) == OK
    instance.free_state(state)
    ended(instance)
    for name, rows in recorded(tmp_path / "rows").items():
        np.testing.assert_array_equal(straight[name], rows, name)


def test_of_some_steps_one_is_recorded(tmp_path: Path, straight: dict[str, Any]) -> None:
    instance = started(tmp_path, **{"recorder.every": 7})
    for steps in (3, 4, 10, 483):
        assert instance.step(steps * STEP) == OK, instance.said
    ended(instance)
    found = recorded(tmp_path / "rows")
    np.testing.assert_array_equal(found.pop("time"), np.arange(72) * (7 * 100_000 * 1e-9))
    for name, rows in found.items():
        np.testing.assert_array_equal(straight[name][::7], rows, name)


def test_equal_states_have_equal_bytes(tmp_path: Path) -> None:
    pair = [Instance(NAME, 3).initialize({}) for _ in range(2)]
    for instance in pair:
        assert instance.step(20 * STEP) == OK
    one, other = (instance.serialize(instance.save()) for instance in pair)
    assert one == other
    for instance in pair:
        instance.free()


@pytest.mark.parametrize(
    ("name", "value", "told"),
    [
        ("scope.period", 3.3e-8, "scope: period = 3.3e-08 s is not a whole number of 25 ns"),
        ("scope.file", "/nowhere/trace", "scope: cannot write /nowhere/trace.real.npy: "),
        ("recorder.folder", "/nowhere/rows", "recorder: cannot write /nowhere/rows"),
    ],
)
def test_what_cannot_start_says_why(name: str, value: Any, told: str) -> None:
    instance = Instance(NAME, 3)
    assert (instance.set(name, value), instance.enter()) == (OK, OK)
    assert instance.call("ExitInitializationMode") == ERROR
    assert instance.said.startswith(f"one: {told}"), instance.said
    instance.free()


def test_without_an_end_nothing_is_left(tmp_path: Path) -> None:
    instance = started(tmp_path)
    assert instance.step(10 * STEP) == OK
    instance.free()
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("fmi", (2, 3))
def test_a_part_that_fails_ends_the_run_in_its_own_words(fmi: int, tmp_path: Path) -> None:
    instance = Instance(NAME, fmi)
    assert instance.set("machine.force", 1e308) == OK
    assert (instance.enter(), instance.call("ExitInitializationMode")) == (OK, OK)
    while instance.step(STEP) == OK:
        assert instance.time < 1.0
    text = instance.said.removeprefix("one: ")
    assert text.startswith("drives: phase[1] = 6.57474e+299: "), text
    assert instance.step(STEP) == ERROR and instance.call("Terminate") == ERROR
    instance.free()


def test_steps_that_are_none_of_the_systems_are_refused() -> None:
    instance = Instance(NAME, 3)
    assert instance.set("system.step", 3.3e-8) == OK
    assert (instance.enter(), instance.call("ExitInitializationMode")) == (OK, ERROR)
    assert "system.step = 3.3e-08 s is not a whole number of 25 ns" in instance.said
    instance.free()
    instance = Instance(NAME, 3).initialize({"system.strict_step": True})
    assert instance.step(1.5 * STEP) == ERROR
    assert "communicationStepSize 0.00015 s is not a whole number of steps of 0.0001 s" in (
        instance.said
    )
    instance.free()


@pytest.mark.parametrize("fmi", (2, 3))
def test_a_step_between_two_of_the_systems_shows_the_latest_that_is_over(fmi: int) -> None:
    """Inputs are read where one begins, whatever step of the importer that falls into."""
    inputs = runs.random_inputs(Instance(NAME, fmi), 3, 120)
    whole, other = Instance(NAME, fmi).initialize({}), Instance(NAME, fmi).initialize({})
    shown, k = [repr(whole.outputs())], 0
    for n, row in enumerate(inputs):
        for name, values in row.items():
            assert other.set(name, values) == OK
        state, time = other.save(), other.time
        for _ in range(2):
            assert other.restore(state, time) == OK
            assert other.step(STEP / 3, n * STEP / 3) == OK, other.said
        other.free_state(state)
        while k * STEP < (n + 1) * STEP / 3 * (1 - 1e-9):  # begins within this step
            assert runs.run(whole, [row], STEP)
            shown.append(repr(whole.outputs()))
            k += 1
        assert repr(other.outputs()) == shown[(n + 1) // 3]
    assert len(set(shown)) > 30 and "do not divide each other" not in str(other.messages)
    whole.free(), other.free()


SMALL: dict[str, Any] = {
    "stop": 0.01,
    "step": STEP,
    "leave": ["one.*", "two.*"],
    "component": {"one": "epcio", "two": "epcio"},
    "connect": {"two.host_dda_length": "one.overflows"},
    "record": {"signals": ["two.stock"]},
}


def test_a_gain_counts_from_the_first_step_that_begins_behind_its_setting() -> None:
    """Also behind a step that began before, in the same communication step."""
    gains = {"drives.velocity_gain": [0.9] * 6}
    torques = []
    for at in (STEP, 1.5 * STEP, 2 * STEP):
        instance = Instance(NAME, 3).initialize({})
        assert instance.step(at) == OK
        for name, values in gains.items():
            assert instance.set(name, values) == OK
        assert instance.step(5 * STEP - at) == OK
        torques.append(instance.get("drives.torque"))
        instance.free()
    assert torques[1] == torques[2] != torques[0]


def small(name: str, tables: dict[str, Any], folder: Path, **values: Any) -> Instance:
    """An instance of a small system, as an FMU of this name in a folder."""
    with pytest.MonkeyPatch.context() as patch:
        patch.delenv("MOTIONFMU_FMUS")
        made = fused.program(*system_of(SMALL | tables))
    packed(made, folder / f"{name}.fmi3.fmu")
    with pytest.MonkeyPatch.context() as patch:
        patch.setenv("MOTIONFMU_FMUS", str(folder))
        return Instance(name, 3).initialize({"system.step": STEP} | values)


def test_what_a_wire_brings_is_within_limits_or_ends_the_run(tmp_path: Path) -> None:
    wired = {
        "component": {"one": "epcio", "two": "network_card"},
        "connect": {"two.command": "one.irq_seq"},
        "record": {"signals": ["one.stock"]},
    }
    instance = small("wired_scalar", wired, tmp_path)
    assert instance.step(STEP) == ERROR
    assert instance.said == "one: two: command = 0 is below its minimum 32"
    instance.free()


def test_each_element_that_a_wire_brings_is_within_limits(tmp_path: Path) -> None:
    """Of six motors the fourth turns, back by more than the turn that the other end takes."""
    wired = {
        "component": {"one": "ball_screw_axes", "two": "soft_controller"},
        "connect": {"two.jog": "one.motor_phase"},
        "record": {"signals": ["one.motor_phase"]},
    }
    pushed = {"one.active": [True] * 6, "one.torque_command": [0.0, 0.0, 0.0, -5.0, 0.0, 0.0]}
    instance = small("wired_array", wired, tmp_path, **pushed)
    steps = 0
    while (told := instance.step(STEP)) == OK and steps < 100:
        steps += 1
    phase = instance.get("one.motor_phase")
    assert told == ERROR and steps > 10 and phase[3] < -1.0
    about = re.fullmatch(r"one: two: jog element 4 = (\S+) is below its minimum -1", instance.said)
    assert about and float(about[1]) == pytest.approx(phase[3], rel=1e-12)
    instance.free()


def test_a_program_depends_on_structure_only(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("MOTIONFMU_FMUS")
    made: list[str] = []

    def kept(kind: str, key: str, make: Any) -> Path:
        made.append(key)
        return Path(key)

    monkeypatch.setattr("motionfmu.base.disk_cache.kept", kept)
    changes: list[dict[str, Any]] = [
        {},
        {"set": {"one.loop_period": 2e-4}},
        {"step": 2e-4},
        {"stop": 0.02},
        {"record": {"every": 5, "signals": ["two.stock"]}},
        {"record": {"signals": ["two.stock", "one.stock"]}},
        {"connect": {"two.reg_seq": "one.irq_seq"}},
        {"component": {"one": "epcio", "two": "epcio", "more": "epcio"}, "leave": ["*"]},
    ]
    for change in changes:
        fused.program(*system_of(SMALL | change))
    assert len(set(made[:5])) == 1 and len(set(made[4:])) == 4


def test_an_fmu_without_a_part_for_this_machine_is_compiled(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.delenv("MOTIONFMU_FMUS")
    own = fmu_parts.part("servo_drives")
    with zipfile.ZipFile(fmus.fmu_path("servo_drives")) as whole:
        files = {n: whole.read(n) for n in whole.namelist() if not n.endswith(".o")}
    monkeypatch.setenv("MOTIONFMU_FMUS", str(tmp_path))
    with zipfile.ZipFile(tmp_path / "servo_drives.fmi3.fmu", "w") as less:
        for name, data in files.items():
            less.writestr(name, data)
    made = fmu_parts.part("servo_drives")
    assert (made.identifier, made.size, made.room) == (own.identifier, own.size, own.room)
    (tmp_path / "part.o").write_bytes(made.code)
    line = ["nm", "-g", "--defined-only", tmp_path / "part.o"]
    listed = subprocess.run(line, capture_output=True, text=True, check=True).stdout
    assert [row.split()[-1] for row in listed.splitlines()] == ["motionfmu_part_ServoDrives"]

    with zipfile.ZipFile(tmp_path / "foreign.fmi3.fmu", "w") as foreign:
        for name, data in files.items():
            if not name.startswith("sources/"):
                foreign.writestr(name, data)
    with pytest.raises(fused.NotFused, match="foreign carries no part"):
        fmu_parts.part("foreign")


def test_an_objcopy_that_fails_is_told(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """One for another processor, as beside a compiler that compiles for it."""
    monkeypatch.delenv("MOTIONFMU_FMUS")
    fake = tmp_path / "objcopy"
    fake.write_text("#!/bin/sh\necho 'objcopy: unknown format' >&2\nexit 1\n")
    fake.chmod(0o755)
    monkeypatch.setenv("PATH", f"{tmp_path}{os.pathsep}{os.environ['PATH']}")
    found = compiler.compiler()
    assert found is not None
    with pytest.raises(compiler.NotCompiled, match=r"^objcopy failed: objcopy: unknown format$"):
        fmu_parts._compile("servo_drives", found, tmp_path)
    assert not (tmp_path / "part.o").exists()
