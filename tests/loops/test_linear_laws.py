"""Every sampled law that an FMU carries is what the FMU does, at every communication point."""

import ast
import random
from collections.abc import Iterable
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import OK, Instance

from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.block import Sampled, reaches
from motionfmu.analysis.linear.linear_form import Form, evaluate
from motionfmu.scenarios import fmus

LAWS = sorted(p.parent.name for p in ROOT.glob("fmus/*/linear.toml"))
AXIS = 2
TRIALS = 12
STEPS = 60


def used(said: law.Law) -> set[str]:
    """Variables that any formula names."""
    tables = (said.let, said.state, said.output, said.early, said.direct, said.constant, said.grain)
    texts = [said.period, said.cycle, said.prompt, *said.refuse, *said.worst]
    texts += [t for table in (*tables, said.speed) for t in table.values()]
    texts += [t for mean in said.mean.values() for t in (mean.of, mean.samples)]
    return names_in(texts)


def names_in(texts: Iterable[str]) -> set[str]:
    """Names in formulas."""
    return {n.id for t in texts for n in ast.walk(ast.parse(t)) if isinstance(n, ast.Name)}


def draw(port: fmus.Port, rng: random.Random) -> Any:
    """A value for all elements: any of a few, else near the start value."""
    if port.type == "Boolean":
        return rng.random() < 0.8
    start = float((port.start or "0").split()[0])
    if port.type == "Int32":
        if port.high - port.low <= 16:
            return rng.randint(int(port.low), int(port.high))
        return round(min(max(start * rng.choice([0.5, 1.0, 1.25, 2.0]), port.low), port.high))
    if start == 0.0 and port.unit == "s":
        return rng.choice([0.0, 0.0, 0.4e-3, 2.3e-3])
    return min(max(start * rng.choice([0.5, 1.0, 1.7]), port.low), port.high)


def element(values: list[Any]) -> Any:
    """The value of a scalar, or of the axis."""
    return values[AXIS - 1] if len(values) > 1 else values[0]


def reach(block: Sampled, port: str) -> float:
    """Grains that an input may move by within a period."""
    way = block.speed.get(port, np.inf) * block.grid_ns * 1e-9 / block.grain.get(port, 0.01)
    return float(min(way, 60.0)) // 1.0


def set_up(
    name: str, said: law.Law, rng: random.Random
) -> tuple[Instance, Instance, Sampled, dict[str, Any]]:
    """Two started FMUs with values that they and the law accept, the block and these values."""
    ports = fmus.ports(name)
    chosen = sorted((used(said) & ports.keys()) - {*said.inputs, *said.output, *said.still})
    while True:
        values: dict[str, Any] = {n: draw(ports[n], rng) for n in chosen}
        values |= {said.period: rng.choice([1e-4, 5e-5, 2e-4])}
        try:
            block = law.block(said, values)
        except law.LawRefusal:
            continue
        if any(law.number(said, values, formula) for formula in said.worst):
            continue
        if any(reach(block, port) < 1.0 for port in block.speed):
            continue
        pair = Instance(name, 3), Instance(name, 3)
        try:
            for fmu in pair:
                fmu.initialize(values | said.still)
            return *pair, block, values
        except AssertionError:
            for fmu in pair:
                fmu.free()


def cut_off(said: law.Law, ports: Iterable[str], fmu: Instance) -> bool:
    """Whether an output is near its limit."""
    values = {n: element(fmu.get(n)) for n in names_in(said.limit.values()) & {*ports}}
    limits = {n: law.number(said, values, text) for n, text in said.limit.items()}
    return any(abs(element(fmu.get(n))) > 0.9 * most for n, most in limits.items())


@pytest.mark.parametrize("name", LAWS)
def test_a_law_is_what_its_fmu_does(name: str) -> None:
    """The difference of an FMU whose inputs move from one whose inputs do not."""
    said = law.carried(name)
    assert isinstance(said, law.Law)
    rng = random.Random(5)
    moved = dict.fromkeys([*said.output, *said.early], False)
    for _ in range(TRIALS):
        fmu, still, block, values = set_up(name, said, rng)
        step = block.grid_ns // rng.choice([1, 1, 2, 5])
        u = np.zeros((len(block.inputs) + len(block.commands), 1))
        work = block.begin(np.zeros((len(block.memory), 1)))
        grains, latest = dict.fromkeys(block.inputs, 0), dict.fromkeys(block.inputs, 0)
        for k in range(STEPS):
            if k % rng.randint(1, 4) == 0 and k:
                for row, port in enumerate(block.inputs):
                    # whole counts and codes, few of them: nothing is rounded, nothing limited;
                    # an eighth of a count more keeps clear of the edge
                    if port in block.speed and k - latest[port] < 2 * block.grid_ns / step:
                        continue
                    grain, far = block.grain.get(port, 0.01), int(reach(block, port))
                    way = rng.randint(-30, 30) - grains[port]
                    grains[port] += min(max(way, -far), far)
                    latest[port] = k
                    u[row] = grains[port] * grain
                    whole = fmus.ports(name)[port].type == "Int32"
                    value = int(u[row, 0]) if whole else float(u[row, 0]) + 0.125 * grain
                    assert fmu.set(port, value if port in block.grain else float(u[row, 0])) == OK
            assert fmu.step(step * 1e-9) == OK, fmu.said
            assert still.step(step * 1e-9) == OK, still.said
            work = block.run(work, u, (k * step, (k + 1) * step))
            if any(cut_off(said, fmus.ports(name), x) for x in (fmu, still)):
                break
            for port, (value,) in zip(block.ports, block.shown(work, u), strict=True):
                real = element(fmu.get(port)) - element(still.get(port))
                near = 0.5001 * block.grain.get(port, 0.0)
                assert real == pytest.approx(value, rel=1e-9, abs=near + 1e-12), (port, k, values)
                if port in moved:
                    moved[port] |= abs(value) > near
        for port in said.constant:
            told = law.constant(said, values, port)
            assert element(fmu.get(port)) == told, (port, values)
        fmu.free()
        still.free()
    assert all(moved[port] for port in moved if driven(block, port)), moved


def driven(block: Sampled, port: str) -> bool:
    """Whether an input moves it: not what only commands move."""
    return bool(reaches(block)[block.ports.index(port), : len(block.inputs)].any())


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
