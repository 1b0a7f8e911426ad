"""What a record may tell of a plant: the identify.toml that its FMU carries, and its equation."""

import functools
import tomllib
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import InputError, suggestion
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.scenarios import fmus

Array = NDArray[np.float64]
FILE = "identify.toml"
# Where a search begins for what is above another quantity, as a share of that one.
_EXCESS = 0.2


class FrictionLaw(BaseModel):
    """An extension of the plant's law: what becomes free with it."""

    model_config = ConfigDict(extra="forbid", strict=True)
    title: str  # what a page calls it
    free: list[str]  # parameters, of which the first says how much of the law there is


class Identifiable(BaseModel):
    """The tables of an identify.toml."""

    model_config = ConfigDict(extra="forbid", strict=True)
    free: list[str] = Field(default_factory=list)  # parameters that a record of a motion can tell
    # parameters that another one limits from below, with which they move
    ties: dict[str, str] = Field(default_factory=dict)
    law: dict[str, FrictionLaw] = Field(default_factory=dict)
    # values of other parameters that are tried, unless the scenario says them
    other: dict[str, list[bool | int | float]] = Field(default_factory=dict)
    gap: str = ""  # parameter that is the width of the gap between parts


@functools.cache
def carried(fmu: str) -> Identifiable:
    """The tables that an FMU carries; empty if it has none."""
    text = fmus.extra(fmu, FILE)
    if text is None:
        return Identifiable()
    try:
        return Identifiable.model_validate(tomllib.loads(text))
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{fmu}: {FILE}: {str(error).splitlines()[0]}") from None


@dataclass(frozen=True)
class FreeParameters:
    """Free quantities of a plant, and how its parameters and inputs follow them.

    p = p0 + `of_parameters` (free - start), and u likewise; a quantity that is limited by another
    one from below is told by how far it is above it.
    """

    ode: Ode
    names: tuple[str, ...]  # parameters, or inputs that stay
    moved: tuple[str, ...]  # parameters to which there are derivatives; some follow them
    of_parameters: Array  # (moved, free)
    of_inputs: Array  # (n_u, free)
    p: Array  # parameters where all free quantities are 0
    u: Array  # inputs likewise
    start: Array  # (free,)
    low: Array
    high: Array
    units: tuple[str, ...]
    titles: tuple[str, ...]
    above: Mapping[str, str] = field(default_factory=dict)  # told by how far above another one

    @functools.cached_property
    def _places(self) -> NDArray[np.int64]:
        known = [d.name for d in self.ode.parameters]
        return np.array([known.index(n) for n in self.moved], dtype=np.int64)

    def values(self, free: Array) -> tuple[Array, Array, Array, Array]:
        """p, u and their derivatives, as `LoopMotion.run` takes them."""
        p = self.p.copy()
        p[self._places] += self.of_parameters @ free
        return p, self.u + self.of_inputs @ free, self.of_parameters, self.of_inputs

    def settings(self, free: Array) -> dict[str, float]:
        """Values of the plant's own variables, also of those that follow."""
        p, u, _, _ = self.values(free)
        rows = zip(self.moved, self._places, self.of_parameters, strict=True)
        found = {n: float(p[k]) for n, k, row in rows if row.any()}
        inputs = [d.name for d in self.ode.inputs]
        return found | {n: float(u[inputs.index(n)]) for n in self.names if n in inputs}


# CCN 21: a parameter, an input, and what follows either, in the order of the names.
def free_parameters(
    ode: Ode,
    names: Sequence[str],
    given: tuple[Array, Array],
    known: Identifiable,
    moved: Sequence[str],
) -> FreeParameters:
    """Make them of names; `given` are the parameters and inputs as the scenario has them.

    `moved` are all parameters to which there are derivatives.
    """
    p, u = given[0].copy(), given[1].copy()
    parameters, inputs = [d.name for d in ode.parameters], [d.name for d in ode.inputs]
    # what is limited from below by a free one follows it, and counts from it if it is free itself
    ties = {t: s for t, s in known.ties.items() if t in names or s in names}
    of_p, of_u = np.zeros((len(moved), len(names))), np.zeros((len(inputs), len(names)))
    start, low, high, units, titles = [], [], [], [], []
    declared = {d.name: d for d in (*ode.parameters, *ode.inputs)}
    for k, name in enumerate(names):
        least, most, _ = ode.limits.get(name, (None, None, None))
        if name in inputs:
            of_u[inputs.index(name), k] = 1.0
            value = u[inputs.index(name)]
            u[inputs.index(name)] = 0.0
        else:
            of_p[list(moved).index(name), k] = 1.0
            value = given[0][parameters.index(name)]
            if name in ties:
                base = given[0][parameters.index(ties[name])]
                value = max(value - base, _EXCESS * base)  # at 0 nothing would tell its way
                least, most = 0.0, None
        start.append(value)
        low.append(-np.inf if least is None else least)
        high.append(np.inf if most is None else most)
        units.append(declared[name].unit)
        titles.append(declared[name].description)
    for t, s in ties.items():
        if s in names:
            of_p[list(moved).index(t), list(names).index(s)] = 1.0
    for name, row in zip(moved, of_p, strict=True):
        if row.any():
            p[parameters.index(name)] = 0.0
    for t, s in ties.items():
        if t in names and s not in names:  # counts from one that stays
            p[parameters.index(t)] = given[0][parameters.index(s)]
    lowest = np.array(low, dtype=np.float64)
    return FreeParameters(
        ode=ode,
        names=tuple(names),
        moved=tuple(moved),
        of_parameters=of_p,
        of_inputs=of_u,
        p=p,
        u=u,
        start=np.array(start, dtype=np.float64),
        low=lowest,
        high=np.array(high, dtype=np.float64),
        units=tuple(units),
        titles=tuple(titles),
        above={t: s for t, s in ties.items() if t in names},
    )


def movable(known: Identifiable, names: Iterable[str], ode: Ode) -> list[str]:
    """All parameters that may move: those named, those of all laws, and what follows them."""
    every = [*names, *(n for law in known.law.values() for n in law.free)]
    parameters = {d.name for d in ode.parameters}
    follow = [t for t, s in known.ties.items() if s in every]
    return list(dict.fromkeys(n for n in (*every, *follow) if n in parameters))


def checked(ode: Ode, names: Iterable[str], wired: Iterable[int], option: str) -> list[str]:
    """Names that an option gives; an InputError for one that is not the plant's or is wired."""
    inputs = [d.name for d in ode.inputs]
    held = {inputs[k] for k in wired}
    real = [d.name for d in ode.parameters if d.type == "Real"]
    known = [*real, *(n for n in inputs if n not in held)]
    for name in names:
        if name not in known:
            raise InputError(
                f"--{option} {name}: {ode.name} has no such quantity"
                + (suggestion(name, known) or f"; there are: {', '.join(known)}")
            )
    return list(names)
