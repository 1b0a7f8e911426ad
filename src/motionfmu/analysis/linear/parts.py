"""Parts of the linear model of an axis: values, blocks and wires of its components."""

import functools
import itertools
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

from motionfmu.analysis.linear import coupled_plant, law
from motionfmu.analysis.linear.axis_values import AxisValues
from motionfmu.analysis.linear.block import Block, Plant, Sampled
from motionfmu.analysis.linear.linear_form import Gain
from motionfmu.analysis.linear.plant import Linearised, Point
from motionfmu.analysis.linear.wiring import Port
from motionfmu.base.errors import InputError
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.run import Options, Scenario
from motionfmu.scenarios.fmus import Port as Declared
from motionfmu.scenarios.system import System, Wire
from motionfmu.scenarios.values import settings


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
    values: Mapping[str, AxisValues]
    blocks: Mapping[str, Block]
    points: Mapping[str, Point]
    others: tuple[int, ...]  # axes that a plant couples with this one
    keys: Mapping[str, Any]  # all on which the block of each plant depends

    @property
    def left_out(self) -> tuple[str, ...]:
        """Components without a linear law."""
        return tuple(c for c, fmu in self.system.components.items() if law.carried(fmu) is None)

    def wires(self) -> dict[Port, Port]:
        """Source by target of the wires between the blocks."""
        found = {}
        for w, of in itertools.product(self.system.wires, elements(self.others)):
            target = w.target.component, f"{w.target.port.name}{of}"
            from_ = w.source.component, f"{w.source.port.name}{of}"
            b, a = self.blocks.get(target[0]), self.blocks.get(from_[0])
            if b is not None and a is not None and target[1] in b.inputs and from_[1] in a.ports:
                found[target] = from_
        return found


def elements(others: Iterable[int]) -> list[str]:
    """Ends of the names of elements: none for the axis itself, else ``[3]``."""
    return ["", *(f"[{k}]" for k in others)]


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
    said = {c: law.carried(fmu) for c, fmu in system.components.items()}
    others = coupled_plant.others(system.wires, said, axis)
    wide = {
        k: {c: AxisValues(system, scenario, c, k) for c in system.components}
        for k in (axis, *others)
    }
    gains = {n: (v,) * axis for n, v in set_.items() if isinstance(v, Gain)}
    for k, every in wide.items():
        _complete(system, every, gains if k == axis else {})
    _check_axis(scenario, axis, wide[axis])
    _check_point(scenario, at, wide[axis])
    return _blocks(scenario, system, at, wide, before)


def _complete(
    system: System, every: Mapping[str, AxisValues], gains: Mapping[str, tuple[Gain, ...]]
) -> None:
    """Add open gains, and values that the laws give for the other ends of wires."""
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
    wide: Mapping[int, Mapping[str, AxisValues]],
    before: Parts | None,
) -> Parts:
    components = system.components
    axis, *others = wide
    every = wide[axis]
    said = {c: law.carried(f) for c, f in components.items()}
    blocks: dict[str, Block] = {}
    points: dict[str, Point] = {}
    # plants come first, because a law may need their outputs at the operating point
    for c in sorted(components, key=lambda c: isinstance(said[c], law.Law)):
        own = said[c]
        try:
            if isinstance(own, law.Law):
                made = law.block(own, every[c], _fed(system.wires, c, points))
                rest = _beside(own, c, (wide, scenario.resolver.ports[c]), (system.wires, points))
                blocks[c] = coupled_plant.beside(made, rest) if rest else made
            elif own is not None:
                found = _plant(c, components[c], (at, every[c]), (system.wires, before))
                if coupled_plant.couples(own) and (
                    before is None or found[0] is not before.blocks[c]
                ):
                    name = coupled_plant.named(axis, tuple(others), scenario.resolver.ports[c])
                    found = coupled_plant.renamed(*found, name)
                blocks[c], points[c] = found
        except ValueError as error:
            raise InputError(f"{scenario.document.file}: {c}: {error}") from None
    blocks = {c: blocks[c] for c in components if c in blocks}
    keys = _keys(blocks, components, at, every)
    return Parts(system, every, blocks, points, tuple(others), keys)


def _beside(
    said: law.Law,
    component: str,
    given: tuple[Mapping[int, Mapping[str, AxisValues]], Mapping[str, Declared]],
    fed: tuple[Iterable[Wire], Mapping[str, Point]],
) -> dict[int, Sampled]:
    """Laws of the other axes of a component, where a plant couples them and they are active."""
    (_, *others), (wide, ports) = given[0], given
    if not all(ports[name].shape for name in said.inputs):
        return {}
    found = {}
    for k in others:
        own = wide[k][component]
        if "active" not in ports or own["active"]:
            found[k] = law.block(said, own, _fed(fed[0], component, fed[1], f"[{k}]"))
    return found


def _fed(
    wires: Iterable[Wire], component: str, points: Mapping[str, Point], of: str = ""
) -> dict[str, float]:
    """Outputs of a component as the operating points of the plants have them."""
    found = {}
    for w in wires:
        if w.source.component == component and w.target.component in points:
            values = points[w.target.component].values
            found[w.source.port.name] = values[f"{w.target.port.name}{of}"]
    return found


def _keys(
    blocks: Mapping[str, Block],
    components: Mapping[str, str],
    at: Mapping[str, float],
    every: Mapping[str, AxisValues],
) -> dict[str, Any]:
    return {c: _key(c, components[c], at, every[c]) for c in blocks if _is_plant(components[c])}


def _is_plant(fmu: str) -> bool:
    return isinstance(law.carried(fmu), Ode)


def _key(component: str, fmu: str, at: Mapping[str, float], own: AxisValues) -> Any:
    names = [d.name for d in equation(fmu).ode.parameters]
    asked = sorted((n, v) for n, v in at.items() if n.startswith(f"{component}."))
    return fmu, asked, own["micro_step"], [float(own[n]) for n in names]


def _plant(
    component: str,
    fmu: str,
    given: tuple[Mapping[str, float], AxisValues],
    found: tuple[Iterable[Wire], "Parts | None"],
) -> tuple[Plant, Point]:
    """A plant about its point; the one of an earlier model if nothing of it has changed."""
    (at, own), (wires, before) = given, found
    if before is not None and before.keys.get(component) == _key(component, fmu, at, own):
        block = before.blocks[component]
        assert isinstance(block, Plant)
        return block, before.points[component]
    parts = equation(fmu)
    p = parts.parameters({d.name: own[d.name] for d in parts.ode.parameters})
    inputs = {}
    for d in parts.ode.inputs:
        if d.name.partition("[")[0] not in own.wired:
            inputs[d.name] = float(own[d.name])
    mine = {n.partition(".")[2]: v for n, v in at.items() if n.startswith(f"{component}.")}
    if coupled_plant.couples(parts.ode):
        ends = _ends(wires, component, parts.ode)
        left = {n: v for n, v in inputs.items() if n not in mine}
        point = parts.rest(p, ends, mine, left)
    else:
        point = parts.point(p, mine, inputs)
    return parts.block(p, point, float(own["micro_step"])), point


def _ends(wires: Iterable[Wire], component: str, ode: Ode) -> tuple[list[str], list[str]]:
    """Outputs of a plant that are fed back, and inputs that are wired, by element."""
    shown = {w.source.port.name for w in wires if w.source.component == component}
    fed = {w.target.port.name for w in wires if w.target.component == component}
    ends = (ode.outputs, shown), (ode.inputs, fed)
    held, free = ([d.name for d in of if d.name.partition("[")[0] in names] for of, names in ends)
    return held, free


def _constant(said: Any, own: AxisValues, name: str) -> Any:
    found = law.constant(said, own, name.partition(".")[2]) if isinstance(said, law.Law) else None
    if found is None:
        raise ValueError(f"it depends on {name}, of which no law says a value")
    return found


def _check_axis(scenario: Scenario, axis: int, every: Mapping[str, AxisValues]) -> None:
    """Refuse an axis that a component does not have, or that is not active in it."""
    for c, own in every.items():
        switch = scenario.resolver.ports[c].get("active")
        if switch is None:
            continue
        count = switch.count
        of_axis = switch.shape or not coupled_plant.couples(
            law.carried(scenario.document.body.component[c])
        )
        if of_axis and not 1 <= axis <= count:
            raise InputError(f"axis = {axis}: {c} has axes 1 to {count}")
        if not own["active"]:
            raise InputError(f"axis = {axis}: it is not active in {c} ({c}.active)")


def _check_point(
    scenario: Scenario, at: Mapping[str, float], every: Mapping[str, AxisValues]
) -> None:
    """Refuse an operating point that names what no plant has, or what its loops hold."""
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
        fixed = variable not in [d.name for d in known.inputs]
        if coupled_plant.couples(known) and (
            fixed or variable.partition("[")[0] in every[component].wired
        ):
            raise InputError(
                f"at {name} = {value!r}: the loops of {fmu} hold it where it starts; set where"
                " that is, or state an input that has no wire"
            )
