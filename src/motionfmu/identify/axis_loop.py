"""One axis of a scenario as identification simulates it: its plant, and the laws around it.

The laws are the sampled ones that drives and cards carry, stepped as the master steps FMUs. From
one communication point to the next they are one linear map, of which there is one for each point
of their common cycle:

    seen = [driven inputs; plant outputs that are fed back]
    plant inputs = take W + pass seen,   shown = show W + direct seen,
    W' = keep W + read seen
"""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import coupled_plant, law
from motionfmu.analysis.linear.axis_values import AxisValues
from motionfmu.analysis.linear.block import Sampled
from motionfmu.analysis.linear.parts import Parts, parts
from motionfmu.analysis.linear.wiring import Net, Port, exchange
from motionfmu.base.errors import InputError, suggestion
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.run import Scenario

Array = NDArray[np.float64]
# Longest common cycle of all laws, in communication steps.
_LONGEST = 10_000


@dataclass(frozen=True)
class HeldLaws:
    """The laws around a plant between communication points, for each point of their cycle."""

    memory: tuple[str, ...]  # what W is
    keep: Array  # (cycle, n_w, n_w)
    read: Array  # (cycle, n_w, n_v)
    take: Array  # (cycle, n_u, n_w)
    through: Array  # (cycle, n_u, n_v)
    show: Array  # (cycle, n_shown, n_w)
    direct: Array  # (cycle, n_shown, n_v)

    @property
    def cycle(self) -> int:
        """Communication steps after which the laws begin again."""
        return len(self.keep)


@dataclass(frozen=True)
class AxisLoop:
    """An axis' plant and the laws around it."""

    scenario: Scenario
    axis: int
    component: str  # of the plant
    ode: Ode
    step: float  # communication step [s]
    driven: tuple[str, ...]  # inputs that the record drives, in the order of `seen`
    fed: tuple[str, ...]  # outputs of the plant that laws read
    shown: tuple[str, ...]  # signals of laws that are compared with the record
    laws: HeldLaws
    wired: tuple[int, ...]  # inputs of the plant that wires or the record set
    sources: Mapping[int, str]  # what sets each of them, component.variable
    p: Array  # parameters of the plant as the scenario has them
    u: Array  # its inputs that stay
    values: Mapping[str, AxisValues]  # of the axis, by component
    grain: dict[str, float]  # rounding step of driven and fed ports, in their units

    @property
    def fmu(self) -> str:
        """The FMU of the plant."""
        return self.scenario.document.body.component[self.component]


# CCN 22: most of it sorts ports and wires into what is driven, fed and shown, by comprehensions.
def axis_loop(
    scenario: Scenario,
    axis: int,
    set_: Mapping[str, Any],
    signals: tuple[Sequence[str], Sequence[str]],
) -> AxisLoop:
    """Make it; `signals` are the inputs that the record drives and what is compared with it."""
    driven, compared = signals
    made = parts(scenario, axis, {}, set_, None)
    component, ode = _plant(scenario, made, driven, compared)
    blocks = {c: b for c, b in made.blocks.items() if isinstance(b, Sampled)}
    seen = [_known(scenario, made, n, "input") for n in driven]
    for n in compared:
        _known(scenario, made, n, "output")
    wires = {t: s for t, s in made.wires().items() if t not in seen}
    feeds = {t: s for t, s in wires.items() if t[0] in blocks and s[0] == component}
    fed = list(dict.fromkeys(s[1] for s in feeds.values()))
    inputs = [d.name for d in ode.inputs]
    ends = _ends(component, inputs, wires, seen)
    shown = [n for n in compared if _port(n)[0] != component]
    inner = {t: s for t, s in wires.items() if t[0] in blocks and s[0] in blocks}
    laws = _laws(
        (blocks, inner),
        made.system.step_ns,
        (seen, fed, feeds, component),
        (ends, len(inputs), [_port(n) for n in shown]),
    )
    own = made.values[component]
    return AxisLoop(
        scenario=scenario,
        axis=axis,
        component=component,
        ode=ode,
        step=made.system.step_ns * 1e-9,
        driven=tuple(driven),
        fed=tuple(fed),
        shown=tuple(shown),
        laws=laws,
        wired=tuple(ends),
        sources={k: ".".join(port) for k, port in ends.items()},
        p=np.array([float(own[d.name]) for d in ode.parameters]),
        u=np.array([0.0 if k in ends else float(own[n]) for k, n in enumerate(inputs)]),
        values=made.values,
        grain=_grains(blocks, feeds),
    )


def _ends(
    plant: str, inputs: Sequence[str], wires: Mapping[Port, Port], driven: Sequence[Port]
) -> dict[int, Port]:
    """Where each input of the plant comes from, by its place: a law, the plant, or the record."""
    found = {inputs.index(t[1]): s for t, s in wires.items() if t[0] == plant}
    found |= {inputs.index(port[1]): port for port in driven if port[0] == plant}
    return {k: found[k] for k in sorted(found)}


def _grains(blocks: Mapping[str, Sampled], feeds: Mapping[Port, Port]) -> dict[str, float]:
    """Rounding steps of what the laws read, under the name of its source."""
    return {
        ".".join(feeds.get((c, name), (c, name))): size
        for c, b in blocks.items()
        for name, size in b.grain.items()
    }


def _port(name: str) -> Port:
    component, _, variable = name.partition(".")
    return component, variable


def _plant(
    scenario: Scenario, made: Parts, driven: Sequence[str], compared: Sequence[str]
) -> tuple[str, Ode]:
    """The one plant of the axis, or of those the one that the record names."""
    found = {}
    for c, fmu in made.system.components.items():
        said = law.carried(fmu)
        if isinstance(said, Ode):
            found[c] = said
    named = [c for c in found if any(_port(n)[0] == c for n in (*driven, *compared))]
    chosen = named or list(found)
    file = scenario.document.file
    if len(chosen) != 1:
        told = ", ".join(chosen) or "none"
        raise InputError(f"{file}: one plant with an equation is wanted, there are: {told}")
    if coupled_plant.couples(found[chosen[0]]):
        raise InputError(f"{file}: {chosen[0]} couples axes: a record of one axis tells no arm")
    return chosen[0], found[chosen[0]]


def _known(scenario: Scenario, made: Parts, name: str, kind: str) -> Port:
    """The port of a name; an InputError if the loop has no such input or output."""
    c, variable = _port(name)
    block = made.blocks.get(c)
    names = (
        ()
        if block is None
        else block.ports
        if kind == "output"
        else (*block.inputs, *block.commands)
    )
    if variable not in names:
        every = [
            f"{k}.{n}"
            for k, b in made.blocks.items()
            for n in (b.ports if kind == "output" else (*b.inputs, *b.commands))
        ]
        told = suggestion(name, every) or f"; there are: {', '.join(every)}"
        raise InputError(f"{scenario.document.file}: {name} is no {kind} of the loop{told}")
    return c, variable


# CCN 23: one matrix row for each of memory, plant inputs and what is shown, in one order.
def _laws(
    net: tuple[Mapping[str, Sampled], Mapping[Port, Port]],
    step_ns: int,
    seen: tuple[list[Port], list[str], Mapping[Port, Port], str],
    wanted: tuple[Mapping[int, Port], int, list[Port]],
) -> HeldLaws:
    """Step the blocks with unit vectors from each communication point of their cycle."""
    (blocks, wires), (driven, fed, feeds, plant) = net, seen
    (ends, width, shown) = wanted
    sizes = {c: len(b.memory) + len(b.outputs) for c, b in blocks.items()}
    n, v = sum(sizes.values()), len(driven) + len(fed)
    cycle = math.lcm(step_ns, *(b.cycle_ns for b in blocks.values())) // step_ns
    if cycle > _LONGEST:
        raise InputError(f"the laws begin again only after {cycle} communication steps")
    unit = np.eye(n + v)
    place, first = 0, {}
    for c, size in sizes.items():
        first[c] = unit[place : place + size]
        place += size
    columns = {port: unit[n + k] for k, port in enumerate(driven)}
    columns |= {(plant, name): unit[n + len(driven) + k] for k, name in enumerate(fed)}
    injected = {port: columns[port] for port in driven if port[0] in blocks}
    for target, source in feeds.items():
        injected[target] = injected.get(target, 0.0) + columns[source]
    every: list[tuple[Array, Array, Array]] = []
    for j in range(cycle):
        given, shows = exchange(Net(blocks, wires, step_ns, {}), dict(first), {}, injected)
        span = j * step_ns, (j + 1) * step_ns
        after = [blocks[c].run(first[c], given[c], span) for c in blocks]
        taken = np.zeros((width, n + v))
        for k, source in ends.items():
            taken[k] = shows[source] if source[0] in blocks else columns[source]
        looks = [shows[port] for port in shown]
        every.append(
            (
                np.vstack([np.zeros((0, n + v)), *after]),
                taken,
                np.vstack([np.zeros((0, n + v)), *looks]),
            )
        )
    whole = [np.array(part) for part in zip(*every, strict=True)]
    names = [
        f"{c}.{m}"
        for c, b in blocks.items()
        for m in (*b.memory, *(f"{o} next" for o in b.outputs))
    ]
    halves = [(m[:, :, :n], m[:, :, n:]) for m in whole]
    (keep, read), (take, through), (show, direct) = halves
    used = (take != 0.0).any(axis=(0, 1)) | (show != 0.0).any(axis=(0, 1))
    for _ in range(n):
        used = used | (keep[:, used] != 0.0).any(axis=(0, 1))
    at = np.flatnonzero(used)  # what neither the plant nor the record sees is left out
    pruned = keep[:, at][:, :, at], read[:, at], take[:, :, at], through, show[:, :, at], direct
    return HeldLaws(tuple(names[k] for k in at), *(np.ascontiguousarray(m) for m in pruned))
