"""Plants that couple axes: one axis is studied while the others are held by their own loops."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from motionfmu.analysis.linear.block import Matrix, Plant, Sampled
from motionfmu.analysis.linear.plant import Point
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import Wire

# Fields of a law with names in order, and fields with values by name.
_NAMES = "inputs", "commands", "states", "outputs", "early", "direct"
_TABLES = "grain", "speed"


def couples(said: Any) -> bool:
    """Whether an FMU's equation has arrays as inputs, so that its axes act on one another."""
    return isinstance(said, Ode) and any("[" in d.name for d in said.inputs)


def others(wires: Iterable[Wire], said: Mapping[str, Any], axis: int) -> tuple[int, ...]:
    """The axes, from 1, that plants couple with an axis."""
    counts = [w.target.port.count for w in wires if couples(said[w.target.component])]
    return tuple(k for k in range(1, max(counts, default=0) + 1) if k != axis)


def named(axis: int, rest: tuple[int, ...], ports: Mapping[str, Port]) -> Any:
    """Function from an element's name to its name in a model of an axis.

    An array with an element for each axis has its element of this axis under the name of the array:
    torque[2] is torque in the model of axis 2, force[2] stays what it is.
    """
    own = {f"{n}[{axis}]": n for n, p in ports.items() if p.shape == (len(rest) + 1,)}
    return lambda name: own.get(name, name)


def renamed(block: Plant, point: Point, name: Any) -> tuple[Plant, Point]:
    """A plant and its point with other names of their inputs and outputs."""
    inputs, outputs = (tuple(map(name, ports)) for ports in (block.inputs, block.outputs))
    values, rates, held = (
        {name(n): v for n, v in table.items()} for table in (point.values, point.rates, point.held)
    )
    return (
        replace(block, inputs=inputs, outputs=outputs),
        replace(point, values=values, rates=rates, held=held),
    )


def beside(own: Sampled, rest: Mapping[int, Sampled]) -> Sampled:
    """The law of an axis, with those of others beside it as element names."""
    every = [own, *(_element(block, k) for k, block in rest.items())]
    count = max(len(b.laws) for b in every)  # whole cycles of equal grids
    if any(b.grid_ns != own.grid_ns or count % len(b.laws) for b in every):
        raise ValueError("axes that a plant couples have unequal grids")
    changed: dict[str, Any] = {f: _chain(every, f) for f in _NAMES}
    for table in _TABLES:
        changed[table] = {n: v for b in every for n, v in getattr(b, table).items()}
    laws = tuple(_together(every, [b.laws[k % len(b.laws)] for b in every]) for k in range(count))
    return replace(own, **changed, now=_diagonal([b.now for b in every]), laws=laws)


def _diagonal(blocks: Sequence[Matrix]) -> Matrix:
    """A block diagonal matrix."""
    made = np.zeros(np.sum([b.shape for b in blocks], axis=0))
    row = column = 0
    for b in blocks:
        made[row : row + b.shape[0], column : column + b.shape[1]] = b
        row, column = row + b.shape[0], column + b.shape[1]
    return made


def _element(block: Sampled, axis: int) -> Sampled:
    changed: dict[str, Any] = {f: tuple(f"{n}[{axis}]" for n in getattr(block, f)) for f in _NAMES}
    for table in _TABLES:
        changed[table] = {f"{n}[{axis}]": v for n, v in getattr(block, table).items()}
    return replace(block, **changed)


def _chain(blocks: list[Sampled], field: str) -> tuple[str, ...]:
    return tuple(name for b in blocks for name in getattr(b, field))


def _together(blocks: list[Sampled], laws: list[Any]) -> Any:
    """Laws side by side: rows are states, outputs, early; columns states, inputs, commands."""
    wholes = []
    for sides in ("states", "outputs", "early"), ("states", "inputs", "commands"):
        sizes = [[len(getattr(b, side)) for side in sides] for b in blocks]
        wholes.append(np.array(sizes))
    rows, columns = (_places(sizes) for sizes in wholes)
    found = np.zeros([int(s.sum()) for s in wholes], dtype=np.result_type(*laws))
    for law, r, c in zip(laws, rows, columns, strict=True):
        found[np.ix_(r, c)] = law
    return found


def _places(sizes: Any) -> list[Any]:
    """Where each block's elements go, if kinds (columns of sizes) come one after the other."""
    starts = np.concatenate([[0], np.cumsum(sizes.T.ravel())[:-1]]).reshape(sizes.T.shape).T
    return [
        np.concatenate([np.arange(a, a + n) for a, n in zip(start, size, strict=True)])
        for start, size in zip(starts, sizes, strict=True)
    ]
