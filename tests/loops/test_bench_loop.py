"""The loop of a bench in C, against the reference master's order written out in Python."""

import math
from typing import Any

import numpy as np
import pytest
from linear_rigs import DEMO, ROOT

from motionfmu.analysis import freq, linear
from motionfmu.analysis.freq.bench import Array, Bench
from motionfmu.base.errors import InputError
from motionfmu.run.engines.slave import Slave

ROBOT = ROOT / "scenarios/robot_line"
ENC, TORQUE = "card.enc_phase", "machine.torque_command"
SIZES = {ENC: 60.0, TORQUE: 0.4, "machine.force": 50.0, "mcc.card_err_count": 8.0}


# CCN 18: each stage of a step after the other.
def by_hand(bench: Bench, added: Array) -> tuple[Array, Array]:
    """What `Bench.run` does, one call of an FMU after the other."""
    ports = bench.axis.scenario.resolver.ports
    given = {end.name: list(values) for end, values in bench.given}
    late: list[list[float]] = [[] for _ in bench.entries]
    shown, used = np.zeros((len(added), len(bench.exits))), np.zeros(added.shape)
    with bench._slaves() as slaves:

        def at(component: str, name: str) -> tuple[Any, int]:
            port, _, place = name.partition("[")
            of = ports[component][port]
            if place:
                return of, int(place[:-1]) - 1
            return of, bench.axis.axis - 1 if of.shape else 0

        def get(component: str, port: Any) -> list[Any]:
            slave: Slave = slaves[component]
            buffer = slave.buffer(port.type, port.count)
            slave.access("Get", port.type, port.reference, buffer)()
            return list(buffer)

        for k in range(-bench.lead, len(added)):
            share = 0.5 - 0.5 * math.cos(math.pi * (k + bench.lead) / max(bench.lead, 1))
            row = added[k] if k >= 0 else share * added[0]
            if k >= 0:
                found = [(get(c, at(c, n)[0]), at(c, n)[1]) for c, n in bench.exits]
                shown[k] = [values[place] for values, place in found]
            puts = []
            for w in bench.system.wires:
                values = get(w.source.component, w.source.port)
                if (w.target.component, w.target.port.name) not in bench.entries:
                    offset = bench._offset(w) or [0] * len(values)
                    sums = [v + x for v, x in zip(values, offset, strict=True)]
                    puts.append((w.target.component, w.target.port, sums))
            for j, (component, name) in enumerate(bench.entries):
                port, place = at(component, name)
                full = f"{component}.{name}"
                own = bench.own(component, name, float((port.start or "0").split()[-1]))
                values = given.get(full) or list(own)
                brought = float(values[place])
                for w in bench.system.wires:
                    if (w.target.component, w.target.port.name) == (component, name):
                        values = get(w.source.component, w.source.port)
                        factor = bench.setup.gains.get(full, 1.0)
                        late[j].append(factor * values[place])
                        steps = bench.setup.delays.get(full, 0)
                        brought = late[j][-1 - steps] if len(late[j]) > steps else 0.0
                total = brought + row[j]
                values[place] = round(total) if port.type == "Int32" else total
                used[max(k, 0), j] = values[place] - brought
                puts.append((component, port, values))
            for component, port, values in puts:
                slaves[component].assign(port.type, port.reference, values)
            for slave in slaves.values():
                slave.step((k + bench.lead) * bench.step_ns * 1e-9, bench.step_ns * 1e-9)
    return shown, used


def waves(steps: int, *sizes: float) -> Array:
    return np.random.default_rng(7).uniform(-1.0, 1.0, (steps, len(sizes))) * sizes


MOVED = ("machine.motor_speed", "machine.home_switch", "card.enc_count")
CASES = {
    "floats and whole numbers": ((ENC, "mcc.card_err_count"), MOVED, (), {}),
    "multiplied and late": ((ENC,), MOVED, (), {"gains": {ENC: 0.7}, "delays": {ENC: 3}}),
    "a wire that is cut": ((TORQUE,), MOVED[:1], (TORQUE,), {}),
    "an input without a wire": (("machine.force",), MOVED, (), {}),
}


@pytest.mark.parametrize("case", CASES.values(), ids=CASES)
def test_the_loop_is_the_reference_masters_bit_for_bit(case: tuple[Any, ...]) -> None:
    inputs, outputs, cut, more = case
    setup = freq.Setup(linear.model(DEMO, 2), inputs, outputs, cut, **more)
    bench = Bench(setup)
    added = waves(1200, *(SIZES[name] for name in inputs))
    (shown, used), (expected, told) = bench.run(added), by_hand(bench, added)
    assert np.array_equal(shown, expected) and np.array_equal(used, told)
    assert np.ptp(shown[:, 0]) > 0.0 and (used.any(axis=0)).all()


def test_coupled_axes_get_what_holds_them() -> None:
    """Lead in and torques of the balance, as one call after the other gives them."""
    model = linear.model(ROBOT, 2)
    bench = Bench(freq.setup(model, "drives.phase", ["drives.torque", "drives.torque[3]"]))
    added = waves(150, 1e-3) + 2e-3
    (shown, used), (expected, told) = bench.run(added), by_hand(bench, added)
    assert bench.lead > 500 and np.abs(shown).min() > 0.0
    assert np.array_equal(shown, expected) and np.array_equal(used, told)


@pytest.mark.parametrize("last", [1, 499, 500, 501, 777])
def test_a_run_ends_with_the_row_that_is_asked_for(last: int) -> None:
    bench = Bench(freq.setup(linear.model(DEMO, 1), TORQUE, "machine.motor_speed"))
    added = waves(1000, 0.4)
    asked: list[int] = []

    def ends(shown: Array) -> int | None:
        asked.append(len(shown))
        return last if len(shown) >= last else None

    shown, used = bench.run(added, ends)
    whole = bench.run(added)
    assert np.array_equal(shown, whole[0][:last]) and np.array_equal(used, whole[1][:last])
    assert asked == list(range(500, asked[-1] + 1, 500)) and asked[-1] - last < 500


def test_what_an_fmu_refuses_is_told_unless_the_run_ended_before() -> None:
    """A signal that is no number is refused by the plant in step 300, and rows before are whole."""
    bench = Bench(freq.setup(linear.model(DEMO, 1), TORQUE, "machine.motor_speed"))
    added = waves(1000, 0.4)
    good, _ = bench.run(added)
    added[300] = np.nan
    with pytest.raises(InputError, match="torque_command element 1 = nan is not finite"):
        bench.run(added)
    with pytest.raises(InputError, match="torque_command element 1 = nan is not finite"):
        bench.run(added, lambda shown: None if len(shown) < 302 else 302)
    shown, _ = bench.run(added, lambda shown: 301)
    assert np.array_equal(shown, good[:301])
