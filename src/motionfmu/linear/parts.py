"""What the linear model of an axis is made of: values, blocks and wires of its components."""

import functools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from motionfmu.errors import InputError
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.linear import law
from motionfmu.linear.block import Block
from motionfmu.linear.form import Gain
from motionfmu.linear.given import Values
from motionfmu.linear.plant import Linearised, Point
from motionfmu.linear.wiring import Port
from motionfmu.run import Options, Scenario
from motionfmu.scenario.system import System, Wire
from motionfmu.scenario.values import settings


@functools.cache
def equation(fmu: str) -> Linearised:
    """The functions of a plant's equation, made once."""
    found = law.carried(fmu)
    assert isinstance(found, Ode)
    return Linearised(found)


@dataclass(frozen=True)
class Parts:
    """Blocks of an axis about their operating points, by component."""

    system: System
    values: Mapping[str, Values]
    blocks: Mapping[str, Block]
    points: Mapping[str, Point]
    keys: Mapping[str, Any]  # what the block of a plant was made of

    @property
    def left_out(self) -> tuple[str, ...]:
        """Components without a linear law."""
        return tuple(c for c, fmu in self.system.components.items() if law.carried(fmu) is None)

    def wires(self) -> dict[Port, Port]:
        """Source by target of the wires between the blocks."""
        found = {}
        for w in self.system.wires:
            target = w.target.component, w.target.port.name
            from_ = w.source.component, w.source.port.name
            b, a = self.blocks.get(target[0]), self.blocks.get(from_[0])
            if b is not None and a is not None and target[1] in b.inputs and from_[1] in a.ports:
                found[target] = from_
        return found


def parts(
    scenario: Scenario,
    axis: int,
    at: Mapping[str, float],
    set_: Mapping[str, Any],
    before: Parts | None,
) -> Parts:
    """Make the blocks of an axis; plants that are as before are kept."""
    numbers = {n: v.plain if isinstance(v, Gain) else v for n, v in set_.items()}
    if before is None:
        system = scenario.resolved(Options(set=numbers))
    else:
        given = tuple(settings(scenario.resolver, numbers))
        system = replace(before.system, settings=given)
    every = {c: Values(system, scenario, c, axis) for c in system.components}
    _check(scenario, axis, at, every)
    gains = {n: (v,) * axis for n, v in set_.items() if isinstance(v, Gain)}
    _complete(system, every, gains)
    return _blocks(scenario, system, at, every, before)


def _complete(
    system: System, every: Mapping[str, Values], gains: Mapping[str, tuple[Gain, ...]]
) -> None:
    """Put in open gains, and what the laws say of the other ends of the wires."""
    for name, value in gains.items():
        component, _, variable = name.partition(".")
        every[component].given[variable] = value
    for w in system.wires:
        source, name = w.source.component, w.source.port.name
        said = law.carried(system.components[source])
        every[w.target.component].wired[w.target.port.name] = functools.partial(
            _constant, said, every[source], f"{source}.{name}"
        )


def _blocks(
    scenario: Scenario,
    system: System,
    at: Mapping[str, float],
    every: Mapping[str, Values],
    before: Parts | None,
) -> Parts:
    components = system.components
    said = {c: law.carried(f) for c, f in components.items()}
    blocks: dict[str, Block] = {}
    points: dict[str, Point] = {}
    # plants first: a law may ask for its outputs at their point
    for c in sorted(components, key=lambda c: isinstance(said[c], law.Law)):
        own = said[c]
        try:
            if isinstance(own, law.Law):
                blocks[c] = law.block(own, every[c], _fed(system.wires, c, points))
            elif own is not None:
                blocks[c], points[c] = _plant(c, components[c], (at, every[c]), before)
        except ValueError as error:
            raise InputError(f"{scenario.document.file}: {c}: {error}") from None
    blocks = {c: blocks[c] for c in components if c in blocks}
    return Parts(system, every, blocks, points, _keys(blocks, components, at, every))


def _fed(wires: Iterable[Wire], component: str, points: Mapping[str, Point]) -> dict[str, float]:
    """Outputs of a component as the operating points of the plants have them."""
    found = {}
    for w in wires:
        if w.source.component == component and w.target.component in points:
            found[w.source.port.name] = points[w.target.component].values[w.target.port.name]
    return found


def _keys(
    blocks: Mapping[str, Block],
    components: Mapping[str, str],
    at: Mapping[str, float],
    every: Mapping[str, Values],
) -> dict[str, Any]:
    return {c: _key(c, components[c], at, every[c]) for c in blocks if _is_plant(components[c])}


def _is_plant(fmu: str) -> bool:
    return isinstance(law.carried(fmu), Ode)


def _key(component: str, fmu: str, at: Mapping[str, float], own: Values) -> Any:
    names = [d.name for d in equation(fmu).ode.parameters]
    asked = sorted((n, v) for n, v in at.items() if n.startswith(f"{component}."))
    return fmu, asked, own["micro_step"], [float(own[n]) for n in names]


def _plant(
    component: str,
    fmu: str,
    given: tuple[Mapping[str, float], Values],
    before: "Parts | None",
) -> tuple[Block, Point]:
    """A plant about its point; the one of an earlier model if nothing of it has changed."""
    at, own = given
    if before is not None and before.keys.get(component) == _key(component, fmu, at, own):
        return before.blocks[component], before.points[component]
    parts = equation(fmu)
    p = parts.parameters({d.name: own[d.name] for d in parts.ode.parameters})
    inputs = {}
    for d in parts.ode.inputs:
        if d.name not in own.wired:
            inputs[d.name] = float(own[d.name])
    mine = {n.partition(".")[2]: v for n, v in at.items() if n.startswith(f"{component}.")}
    point = parts.point(p, mine, inputs)
    return parts.block(p, point, float(own["micro_step"])), point


def _constant(said: Any, own: Values, name: str) -> Any:
    found = law.constant(said, own, name.partition(".")[2]) if isinstance(said, law.Law) else None
    if found is None:
        raise ValueError(f"it depends on {name}, of which no law says a value")
    return found


def _check(
    scenario: Scenario, axis: int, at: Mapping[str, float], every: Mapping[str, Values]
) -> None:
    for c, own in every.items():
        switch = scenario.resolver.ports[c].get("active")
        if switch is None:
            continue
        count = switch.count
        if not 1 <= axis <= count:
            raise InputError(f"axis = {axis}: {c} has axes 1 to {count}")
        if not own["active"]:
            raise InputError(f"axis = {axis}: it is not active in {c} ({c}.active)")
    for name, value in at.items():
        component, _, variable = name.partition(".")
        fmu = scenario.document.body.component.get(component)
        if fmu is None or not _is_plant(fmu):
            raise InputError(f"at {name} = {value!r}: {component!r} is no plant of the scenario")
        known = equation(fmu).ode
        if variable not in [d.name for d in (*known.inputs, *known.outputs)]:
            raise InputError(f"at {name} = {value!r}: {fmu} has no such input or output")
        if not isinstance(value, int | float):
            raise InputError(f"at {name} = {value!r}: a number wanted")
