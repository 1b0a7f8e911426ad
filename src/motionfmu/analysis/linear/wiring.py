"""Blocks and wires, stepped as the master does, as one linear map over a period."""

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.linear.block import Block, Matrix, Plant, nonzero, reaches
from motionfmu.base.errors import InputError

# If a period has more communication steps than this, its grids do not fit together.
STEPS_MAX = 20_000

Port = tuple[str, str]  # component, variable


@dataclass(frozen=True)
class Net:
    """Linear blocks and the wires between them."""

    blocks: Mapping[str, Block]  # by component
    wires: Mapping[Port, Port]  # source by target
    step_ns: int  # communication step [ns]
    delays: Mapping[Port, int]  # communication steps that a wire takes, by target; else 0
    # A target whose wire ends before it, after its delay: an exit of this name shows what it
    # brings.
    opened: Port | None = None

    def used(self, entries: list[Port], exits: list[Port]) -> set[str]:
        """Components on a path from an entry to an exit."""
        forward: dict[Port, set[Port]] = {}
        for component, block in self.blocks.items():
            reach = reaches(block)
            for k, name in enumerate((*block.inputs, *block.commands)):
                shown = [p for p, there in zip(block.ports, reach[:, k], strict=True) if there]
                forward[component, name] = {(component, p) for p in shown}
        for target, source in self.wires.items():
            forward.setdefault(source, set()).add(self._end(target))
        backward: dict[Port, set[Port]] = {}
        for source, targets in forward.items():
            for target in targets:
                backward.setdefault(target, set()).add(source)
        on = _closure(forward, entries) & _closure(backward, [self._end(p) for p in exits])
        return {component for component, _ in on}

    def _end(self, port: Port) -> Port:
        """The end of a wire: its target, or the exit in place of an opened target."""
        return (port[0], f"{port[1]} opened") if port == self.opened else port


def _closure(arrows: Mapping[Port, set[Port]], start: list[Port]) -> set[Port]:
    found, left = set(start), list(start)
    while left:
        for port in arrows.get(left.pop(), ()):
            if port not in found:
                found.add(port)
                left.append(port)
    return found


@dataclass(frozen=True)
class PeriodMap:
    """A system over the common period of all grids."""

    # x' = A x + B u, y = C x + D u.
    a: Matrix
    b: Matrix
    c: Matrix
    d: Matrix
    states: tuple[Port, ...]  # component and name of each
    period_ns: int


# CCN 20: memories, delays and entries share one row of unit vectors, whose order each part relies
# on.
def period_map(net: Net, entries: list[Port], exits: list[Port]) -> PeriodMap:
    """Step linear blocks through one period as the master does.

    Entries are what u is added to, held over the period. Exits are what y shows at its beginning:
    outputs, or the opened input. A ValueError if the grids have no common period within reason.
    """
    grids = [net.step_ns, *(b.cycle_ns for b in net.blocks.values())]
    period = math.lcm(*grids)
    if period // net.step_ns > STEPS_MAX:
        told = ", ".join(f"{g * 1e-9:g} s" for g in sorted(set(grids)))
        raise ValueError(f"the grids {told} have a common period of {period * 1e-9:g} s only")
    names: list[Port] = [(c, n) for c, b in net.blocks.items() for n in b.memory]
    chains = {t: n for t, n in net.delays.items() if n > 0 and t in net.wires}
    names += [(t[0], f"{t[1]} delay {k + 1}") for t, n in chains.items() for k in range(n)]
    width = len(names) + len(entries)
    unit = np.eye(len(names), width, dtype=_kind(net))
    place, work = 0, {}
    for component, block in net.blocks.items():
        work[component] = block.begin(unit[place : place + len(block.memory)])
        place += len(block.memory)
    queue = {}
    for target, n in chains.items():
        queue[target] = list(unit[place : place + n])
        place += n
    injected: dict[Port, Matrix] = {}
    for k, entry in enumerate(entries):
        row = np.zeros(width, dtype=unit.dtype)
        row[len(names) + k] = 1.0
        injected[entry] = injected.get(entry, 0.0) + row
    first = None
    for start in range(0, period, net.step_ns):
        fed, shows = exchange(net, work, queue, injected)
        first = first if first is not None else np.vstack([shows[port] for port in exits])
        for component, block in net.blocks.items():
            span = start, start + net.step_ns
            work[component] = block.run(work[component], fed[component], span)
    assert first is not None
    parts = [block.end(work[component]) for component, block in net.blocks.items()]
    parts += [np.array(rows, dtype=unit.dtype).reshape(-1, width) for rows in queue.values()]
    after = np.vstack([np.zeros((0, width), dtype=unit.dtype), *parts])
    n = len(names)
    return PeriodMap(after[:, :n], after[:, n:], first[:, :n], first[:, n:], tuple(names), period)


def period_of(net: Net, entries: list[Port], exits: list[Port], file: Path) -> PeriodMap:
    """The period map of what lies between entries and exits of a net."""
    # Its matrices are of objects if a law holds expressions of gains.
    used = net.used(entries, exits) | {c for c, _ in (*entries, *exits)}
    joined = {t: s for t, s in net.wires.items() if t[0] in used and s[0] in used}
    blocks = {c: b for c, b in net.blocks.items() if c in used}
    try:
        return pruned(period_map(replace(net, blocks=blocks, wires=joined), entries, exits))
    except ValueError as error:
        raise InputError(f"{file}: {error}") from None


def _kind(net: Net) -> np.dtype[Any]:
    """Type of the matrices: objects if a law holds expressions of gains, else floats."""
    laws = [
        m for b in net.blocks.values() for m in (b.show[:1] if isinstance(b, Plant) else b.laws)
    ]
    return np.result_type(float, *laws)


def exchange(
    net: Net, work: dict[str, Matrix], queue: dict[Port, list[Matrix]], injected: dict[Port, Matrix]
) -> tuple[dict[str, Matrix], dict[Port, Matrix]]:
    """Inputs of all blocks and values of all ports at a communication point."""
    width = next(iter(work.values())).shape[1] if work else 0
    fed: dict[str, Matrix] = {}
    shows: dict[Port, Matrix] = {}
    for component, block in net.blocks.items():
        names = (*block.inputs, *block.commands)
        u = np.zeros((len(names), width), dtype=_kind(net))
        for k, name in enumerate(names):
            if (component, name) in injected:
                u[k] = injected[component, name]
        fed[component] = u
        seen = block.shown(work[component], u)
        shows |= {(component, p): row for p, row in zip(block.ports, seen, strict=True)}
    for target, source in net.wires.items():
        component, name = target
        row = shows[source]
        if target in queue:
            queue[target].append(row)
            row = queue[target].pop(0)
        if target == net.opened:
            shows[target] = row
        else:
            fed[component][net.blocks[component].inputs.index(name)] += row
    return fed, shows


def pruned(whole: PeriodMap) -> PeriodMap:
    """Leave out states that no input reaches or no output sees."""
    a = nonzero(whole.a)
    reached, seen = nonzero(whole.b).any(axis=1), nonzero(whole.c).any(axis=0)
    for _ in range(len(a)):
        reached = reached | a[:, reached].any(axis=1)
        seen = seen | a[seen].any(axis=0)
    keep = np.flatnonzero(reached & seen)
    return PeriodMap(
        whole.a[np.ix_(keep, keep)],
        whole.b[keep],
        whole.c[:, keep],
        whole.d,
        tuple(whole.states[k] for k in keep),
        whole.period_ns,
    )
