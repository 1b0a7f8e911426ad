"""Every sampled law that an FMU carries is what the FMU does, at every communication point."""

import ast
import random
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import OK, Instance

from motionfmu import fmus
from motionfmu.linear import law
from motionfmu.linear.form import Form, evaluate

LAWS = sorted(p.parent.name for p in ROOT.glob("fmus/*/linear.toml"))
AXIS = 2
TRIALS = 12
STEPS = 60


def used(said: law.Law) -> set[str]:
    """Variables that any formula names."""
    tables = (said.let, said.state, said.output, said.early, said.direct, said.constant, said.grain)
    texts = [said.period, *said.refuse, *(t for table in tables for t in table.values())]
    return {n.id for t in texts for n in ast.walk(ast.parse(t)) if isinstance(n, ast.Name)}


def draw(port: fmus.Port, rng: random.Random) -> Any:
    """A value for all elements: any of a few, else near the start value."""
    if port.type == "Boolean":
        return rng.random() < 0.8
    start = float((port.start or "0").split()[0])
    if port.type == "Int32":
        if port.high - port.low <= 16:
            return rng.randint(int(port.low), int(port.high))
        return round(min(max(start * rng.uniform(0.5, 2.0), port.low), port.high))
    return min(max(start * rng.choice([0.5, 1.0, 1.7]), port.low), port.high)


def set_up(name: str, said: law.Law, rng: random.Random) -> tuple[Instance, dict[str, Any]]:
    """A started FMU with values that it accepts, and these values."""
    ports = fmus.ports(name)
    chosen = sorted((used(said) & ports.keys()) - {*said.inputs, *said.output})
    period = rng.choice([1e-4, 5e-5, 2e-4])
    while True:
        values = {n: draw(ports[n], rng) for n in chosen} | {said.period: period}
        fmu = Instance(name, 3)
        try:
            fmu.initialize(values)
            return fmu, values
        except AssertionError:
            fmu.free()


@pytest.mark.parametrize("name", LAWS)
def test_a_law_is_what_its_fmu_does(name: str) -> None:
    said = law.carried(name)
    assert isinstance(said, law.Law)
    rng = random.Random(5)
    moved = dict.fromkeys([*said.output, *said.early], False)
    for _ in range(TRIALS):
        fmu, values = set_up(name, said, rng)
        block = law.block(said, values)
        step = round(values[said.period] * 1e9) // rng.choice([1, 1, 2, 5])
        u = np.zeros((len(block.inputs) + len(block.commands), 1))
        work = block.begin(np.zeros((len(block.memory), 1)))
        for k in range(STEPS):
            if k % rng.randint(1, 4) == 0 and k:
                for row, port in enumerate(block.inputs):
                    # whole counts and codes, few of them: nothing is rounded, nothing limited;
                    # an eighth of a count more keeps clear of the edge
                    grain = block.grain.get(port, 0.01)
                    u[row] = rng.randint(-30, 30) * grain
                    whole = fmus.ports(name)[port].type == "Int32"
                    value = int(u[row, 0]) if whole else float(u[row, 0]) + 0.125 * grain
                    assert fmu.set(port, value if port in block.grain else float(u[row, 0])) == OK
            assert fmu.step(step * 1e-9) == OK, fmu.said
            work = block.run(work, u, (k * step, (k + 1) * step))
            for port, (value,) in zip(block.ports, block.shown(work, u), strict=True):
                real = fmu.get(port)[AXIS - 1]
                near = 0.5001 * block.grain.get(port, 0.0)
                assert real == pytest.approx(value, rel=1e-9, abs=near + 1e-12), (port, k, values)
                if port in moved:
                    moved[port] |= abs(value) > near
        for port in said.constant:
            told = law.constant(said, values, port)
            assert fmu.get(port)[AXIS - 1] == told, (port, values)
        fmu.free()
    assert all(moved.values()), moved


def test_formulas_know_numbers_and_quantities_that_move() -> None:
    names = {"x": Form(np.array([1.0, 0.0])), "y": Form(np.array([0.0, 1.0])), "n": 5, "on": True}
    found = evaluate("2 * x - y / 4 + (n % 3) * (x if on and n > 4 else y)", names)
    assert isinstance(found, Form)
    assert found.row.tolist() == [4.0, -0.25]
    assert evaluate("bit(n, 0) + bit(n, 1) + 2**n", names) == 33.0


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ("x * y", "product"),
        ("1 / x", "unsupported"),
        ("x + 1", "number is added"),
        ("y if x > 0 else x", "comparison"),
        ("z", "'z' is not known"),
        ("x.row", "Attribute is not allowed"),
        ("x +", "'x +'"),
        ("n / 0", "division by zero"),
    ],
)
def test_a_wrong_formula_is_named(text: str, told: str) -> None:
    names = {"x": Form(np.ones(2)), "y": Form(np.ones(2)), "n": 1}
    with pytest.raises(ValueError, match=r".") as caught:
        evaluate(text, names)
    assert told in str(caught.value) and text[:3] in str(caught.value)


def test_a_wrong_law_is_named() -> None:
    with pytest.raises(ValueError, match=r"linear.toml: inputs: field required"):
        law.parse('period = "1"')
    with pytest.raises(ValueError, match=r"linear.toml: \w+"):
        law.parse('period = "1')
