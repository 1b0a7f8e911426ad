"""Saved states have what is in use, and nothing that they lack is missed."""

import random
import zipfile
from ctypes import byref
from pathlib import Path

import pytest
from few_cases import few
from fmi_tools import OK, Instance, start_values

import motionfmu
from motionfmu import fused
from motionfmu.fused import layer
from motionfmu.run.run_plan import Options
from motionfmu.scenarios.fmus import fmu_names

ROOT = Path(__file__).parents[2]
# [byte] at rest, at most, where it is not 40 kB; a network card has 2 MB of flash, erased.
LARGEST = {
    "mcc": 63_000,
    "mcc_groups": 63_000,
    "soft_controller": 48_000,
    "network_card": 65_000,
}
# Before its start, at most, where it is not 14 kB; the library shows ten rows of its tool table.
FRESH = {"mcc": 14_600}
STEP = 1e-3  # [s]
EVERY = 7
# Scenario, and how long it runs [s]: motion one by one with numbered parameters, as a curve; words
# of a program with tools; a law that keeps the commanded path; groups; a robot, whose look-ahead
# is a chain; a robot whose moves flow.
RUNS = {
    "square": 1.0,
    "short_lines": 1.2,
    "pocket": 1.2,
    "control_law": 1.0,
    "fourteen_axes": 1.0,
    "robot_line": 1.5,
    "robot_pick": 3.5,
}
PROGRAM = """G91 F3000
#500 = 1
o1 while [#500 lt 600]
G1 X[#500 / 2000]
G1 Y[#500 / 3000]
#500 = [#500 + 1]
o1 endwhile
M2
"""


@pytest.mark.parametrize("name", fmu_names())
def test_states_are_small_at_rest(name: str, tmp_path: Path) -> None:
    instance = Instance(name, 3)
    fresh = len(instance.serialize(instance.save()))
    instance.initialize(start_values(name, tmp_path))
    size = len(instance.serialize(instance.save()))
    assert fresh <= FRESH.get(name, 14_000), fresh
    assert size <= LARGEST.get(name, 40_000), size
    state, sizes = instance.save(), []
    for _ in range(20):  # one place for all
        assert instance.step(STEP) == OK
        assert instance.call(instance._state("Get"), byref(state)) == OK
        sizes.append(len(instance.serialize(state)))
        data = instance.serialize(state)
        status, again = instance.deserialize(data)
        assert status == OK and instance.serialize(again) == data
        instance.free_state(again)
    assert max(sizes) <= LARGEST.get(name, 40_000) + 150_000
    instance.free_state(state)
    instance.free()


def system(name: str, folder: Path) -> None:
    """A scenario's system as an FMU with its values; what a state lacks is nonsense behind it."""
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    if name == "square":
        (folder / "numbers.ngc").write_text(PROGRAM)
        scenario = scenario.changed(set={"mcc.program": str(folder / "numbers.ngc")})
    if name == "robot_line":
        scenario = scenario.changed(set={"soft.smooth_time": 0.05})
    if name == "robot_pick":
        scenario = scenario.changed(set={"soft.flow": True})
    made = fused.exported(scenario.resolved(Options()), scenario.ends, 3, name.title())
    with zipfile.ZipFile(folder / f"{name}.fmi3.fmu", "w") as archive:
        for file in sorted(f for f in made.folder.rglob("*") if f.is_file()):
            archive.write(file, file.relative_to(made.folder))


def outputs(instance: Instance) -> str:
    return repr(instance.outputs())


def advance(instance: Instance, k: int) -> None:
    """Steps from the k-th saved state to the next."""
    for i in range(k * EVERY, (k + 1) * EVERY):
        assert instance.step(STEP, i * STEP) == OK, instance.said


@pytest.mark.parametrize("name", few(RUNS, 2))
def test_from_any_state_a_run_goes_on(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Restored where nonsense lies in what is not in use."""
    monkeypatch.setattr(layer, "OPTIMIZED", "-DFMI_POISON")
    system(name, tmp_path)
    monkeypatch.setenv("MOTIONFMU_FMUS", str(tmp_path))
    one, other = (Instance(name, 3).initialize({}) for _ in range(2))
    count = round(RUNS[name] / STEP / EVERY)
    seen, states = [outputs(one)], []
    for k in range(count):
        states.append((k, one.save()))
        advance(one, k)
        seen.append(outputs(one))
    assert len(set(seen)) > count / 3
    chance = random.Random(name)
    for n, (k, state) in enumerate(chance.sample(states, count)):
        if n % 3 == 0:
            status, read = other.deserialize(one.serialize(state))
            assert status == OK, other.said
            assert other.restore(read, k * EVERY * STEP) == OK
            other.free_state(read)
        else:
            assert other.restore(state, k * EVERY * STEP) == OK
        assert outputs(other) == seen[k]
        for i in range(k, count if n % 30 == 0 else k + 1):
            advance(other, i)
            assert outputs(other) == seen[i + 1], (k, i)
        again = other.save()
        status, read = other.deserialize(other.serialize(again))
        assert status == OK, other.said
        for made in (again, read):
            other.free_state(made)
    for _, state in states:
        one.free_state(state)
    one.free()
    other.free()


@pytest.mark.more
@pytest.mark.parametrize("name", RUNS)
def test_a_start_reads_nothing_that_is_not_in_use(
    name: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """A first start, and one behind a run and its reset, give what a start on zeroes gives."""
    seen = {}
    for options in ("-O1", "-DFMI_POISON"):
        folder = tmp_path / options
        folder.mkdir()
        monkeypatch.setattr(layer, "OPTIMIZED", options)
        system(name, folder)
        with monkeypatch.context() as here:
            here.setenv("MOTIONFMU_FMUS", str(folder))
            instance = Instance(name, 3)
        for again in (False, True):
            assert not again or instance.call("Reset") == OK
            instance.initialize({})
            found = seen[options, again] = [outputs(instance)]
            for k in range(100):
                advance(instance, k)
                found.append(outputs(instance))
        instance.free()
    (wanted, *others) = seen.values()
    assert len(set(wanted)) > 20 and len(others) == 3
    assert all(other == wanted for other in others)
