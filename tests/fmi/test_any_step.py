"""Communication steps of any size: every FMU, and the demo's coupled with steps of 1 ms / 3."""

import random
from collections.abc import Iterator
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from few_cases import few
from fmi_tools import ERROR, OK, Instance, random_inputs, start_values, unpacked
from fmpy import simulate_fmu
from numpy.typing import NDArray

import motionfmu
from motionfmu.run.engines import lean
from motionfmu.run.engines.slave import Slave
from motionfmu.run.run_plan import Options
from motionfmu.scenarios.fmus import fmu_names, fmu_path

ROOT = Path(__file__).parents[2]
ROWS = 30
STOP = 0.15  # [s] the demo's first motion
THIRD = 1e-3 / 3  # [s]
both = pytest.mark.parametrize("fmi", (2, 3))


def parts(chance: random.Random, begin: float, end: float) -> Iterator[float]:
    """Points up to a common one: at random, close behind each other, or thirds."""
    size = end - begin
    between = chance.choice(
        [
            [begin + size / 3, begin + 2 * size / 3],
            sorted(begin + size * chance.random() for _ in range(4)),
            [begin + 3e-9, begin + 6e-9, begin + 0.7 * size],
            [end - 12.4e-9],
        ]
    )
    yield from (*between, end)


@both
@pytest.mark.parametrize("name", few(fmu_names(), 6))
def test_at_common_points_any_steps_give_the_same_bits(name: str, fmi: int, tmp_path: Path) -> None:
    """Inputs change at common points; in between an FMU may be saved and restored."""
    size = float(unpacked(name, 3)[0].defaultExperiment.stepSize)
    whole, other = (Instance(name, fmi).initialize(start_values(name, tmp_path)) for _ in range(2))
    chance = random.Random(f"{name} {fmi}")
    for k, row in enumerate(random_inputs(whole, 11, ROWS)):
        for instance in (whole, other):
            for key, values in row.items():
                assert instance.set(key, values) == OK, instance.said
        assert whole.step(size, k * size) == OK, whole.said
        time = k * size
        for point in parts(chance, k * size, (k + 1) * size):
            assert other.step(point - time, time) == OK, other.said
            time = point
            if chance.random() < 0.1:
                state = other.save()
                assert other.step(size, time) == OK, other.said
                assert other.restore(state, time) == OK, other.said
                other.free_state(state)
        assert repr(other.outputs()) == repr(whole.outputs()), k
    whole.free()
    other.free()


@both
def test_a_strict_fmu_refuses_them_and_runs_on(fmi: int) -> None:
    instance = Instance("velocity_axes", fmi).initialize({"strict_step": True})
    assert instance.step(THIRD) == ERROR
    words = "communicationStepSize 0.000333333333333333 s is not a positive whole multiple of 25 ns"
    assert words in instance.said
    assert instance.step(1e-4) == OK
    instance.free()


@both
def test_what_is_told_of_steps(fmi: int) -> None:
    """A step that does not divide the grid is named as it is."""
    instance = Instance("velocity_axes", fmi)
    assert instance.call("SetDebugLogging", True, 0, None) == OK
    instance.initialize({})
    assert instance.step(1e-4 / 3) == OK
    told = "communicationStepSize 3.33333333e-05 s and micro_step = 2.5e-05 s do not divide"
    assert told in instance.said
    instance.free()
    description = unpacked("velocity_axes", fmi)[0]
    assert description.coSimulation.canHandleVariableCommunicationStepSize
    strict = next(v for v in description.modelVariables if v.name == "strict_step")
    assert (strict.start, strict.variability) == ("false", "fixed")


@both
@pytest.mark.parametrize("name", ("mcc", "network_card", "robot_arm"))
def test_fmpy_runs_thirds_of_a_millisecond(name: str, fmi: int, tmp_path: Path) -> None:
    found = simulate_fmu(
        str(fmu_path(name, fmi)),
        stop_time=0.1,
        output_interval=THIRD,
        start_values=start_values(name, tmp_path),
    )
    assert len(found) == 301


def coupled(fmi: int, size: float) -> tuple[NDArray[Any], NDArray[Any]]:
    """Times and pulses of the demo's FMUs under a Jacobi master that steps by `size`."""
    system = motionfmu.load(ROOT / "scenarios/circle").resolved(Options())
    told: list[str] = []
    with ExitStack() as stack:
        slaves = {
            n: Slave(n, lean.unpacked(f, fmi), fmi, told) for n, f in system.components.items()
        }
        for slave in slaves.values():
            stack.callback(slave.free)
        for s in system.settings:
            slaves[s.end.component].assign(s.end.port.type, s.end.port.reference, s.values)
        for slave in slaves.values():
            slave.initialize()
            slave.start()
        gets, sets = [], []
        for w in system.wires:
            port, source = w.source.port, slaves[w.source.component]
            buffer = source.buffer(port.type, port.count)
            gets.append(source.access("Get", port.type, port.reference, buffer))
            end = w.target
            reference = end.port.reference
            sets.append(slaves[end.component].access("Set", port.type, reference, buffer))
        card = slaves["card"]
        pulses = card.buffer("Int32", 6)
        look = card.access(
            "Get", "Int32", card.references["pulse_count" + "[1]" * (fmi == 2)], pulses
        )
        times, seen, count = [], [], round(STOP / size)
        for k in range(count + 1):
            for call in (look, *gets, *sets):
                call()
            times.append(k * size)
            seen.append(list(pulses))
            for slave in slaves.values() if k < count else ():
                slave.step(k * size, (k + 1) * size - k * size)
        for slave in slaves.values():
            slave.end()
    assert not told
    return np.array(times), np.array(seen)


@both
def test_the_demo_in_thirds_of_a_millisecond(fmi: int) -> None:
    """Pulses at common instants are those of steps of 0.1 ms: the FIFO hides a step's delay."""
    times, fine = coupled(fmi, 1e-4)
    thirds, pulses = coupled(fmi, THIRD)
    assert times[::10] == pytest.approx(thirds[::3], abs=1e-15) and len(times) == 1501
    assert (fine[::10] == pulses[::3]).all() and np.ptp(fine, axis=0).max() > 500
