"""The sampled law that an FMU carries, and the linear block that is made of it."""

import functools
import tomllib
from collections import ChainMap
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.analysis.linear.block import Sampled
from motionfmu.analysis.linear.linear_form import Form, Gain, Quantity, evaluate
from motionfmu.fmu.modelica import equation_text
from motionfmu.fmu.modelica.ode import Ode
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import nanoseconds

LAW = "linear.toml"
# Decimal periods are not exact in binary, but their quotients are wrong by far less than this.
_WHOLE = 1e-9


class MovingMean(BaseModel):
    """The mean of a quantity at the latest instants of the grid, this one among them."""

    model_config = ConfigDict(extra="forbid", strict=True)
    of: str
    samples: str


class Law(BaseModel):
    """The tables of a linear.toml: formulas by name, as in the README."""

    model_config = ConfigDict(extra="forbid", strict=True)
    period: str  # sampling period [s]
    cycle: str = "1"  # instants after which the law begins again
    inputs: list[str]  # ports that move
    prompt: str = "0"  # if it holds, outputs are early ones
    commands: list[str] = Field(default_factory=list)
    let: dict[str, str] = Field(default_factory=dict)
    mean: dict[str, MovingMean] = Field(default_factory=dict)
    state: dict[str, str] = Field(default_factory=dict)
    output: dict[str, str] = Field(default_factory=dict)
    early: dict[str, str] = Field(default_factory=dict)
    direct: dict[str, str] = Field(default_factory=dict)
    constant: dict[str, str] = Field(default_factory=dict)
    grain: dict[str, str] = Field(default_factory=dict)
    gain: dict[str, str] = Field(default_factory=dict)
    limit: dict[str, str] = Field(default_factory=dict)
    still: dict[str, bool | int | float | str] = Field(default_factory=dict)
    refuse: dict[str, str] = Field(default_factory=dict)
    point: dict[str, str] = Field(default_factory=dict)
    speed: dict[str, str] = Field(default_factory=dict)
    worst: dict[str, str] = Field(default_factory=dict)


class LawRefusal(ValueError):
    """A law does not hold for the values given."""


def parse(text: str, file: str = LAW) -> Law:
    """Read a linear.toml; the ValueError begins with the file's name."""
    try:
        return Law.model_validate(tomllib.loads(text))
    except tomllib.TOMLDecodeError as error:
        raise ValueError(f"{file}: {error}") from None
    except ValidationError as error:
        first = error.errors()[0]
        where = ".".join(str(p) for p in first["loc"])
        raise ValueError(f"{file}: {where}: {first['msg'].lower()}") from None


@functools.cache
def carried(fmu: str) -> Law | Ode | None:
    """The sampled law or the plant's equation in an FMU's archive; None if it has neither."""
    # A ValueError if the law is wrong, an InputError if there is no such FMU.
    if (law := fmus.extra(fmu, LAW)) is not None:
        return parse(law, f"{fmu}: {LAW}")
    plant = fmus.extra(fmu, equation_text.FILE)
    return None if plant is None else equation_text.from_json(plant)


class _LawNames(Mapping[str, Any]):
    """Names in a law's formulas: moving quantities, then formulas of `let`, then variables."""

    def __init__(self, law: Law, given: Mapping[str, Any], moving: dict[str, Quantity]) -> None:
        self._law, self._given, self._moving = law, given, moving

    def __getitem__(self, name: str) -> Any:
        if name not in self._moving:
            if name in self._law.mean:
                said = self._law.mean[name]
                kept = [self[n] for n in _kept(name, said, self)]
                self._moving[name] = sum(kept, evaluate(said.of, self)) / (len(kept) + 1.0)
            elif name in self._law.let:
                self._moving[name] = evaluate(self._law.let[name], self)
            else:
                return self._given[name]
        return self._moving[name]

    def __iter__(self) -> Iterator[str]:
        return iter((*self._moving, *self._law.mean, *self._law.let, *self._given))

    def __len__(self) -> int:
        return sum(1 for _ in self)


def _kept(name: str, said: MovingMean, names: Mapping[str, Any]) -> list[str]:
    """States of a moving mean: what it averages, at earlier instants, the latest of them first."""
    count = float(evaluate(said.samples, names))  # type: ignore[arg-type]
    return [f"{name}_{back}" for back in range(1, round(count))]


def _states(law: Law, given: Mapping[str, Any]) -> dict[str, str]:
    """The formula of each state's next value: of the law's own, then of its moving means."""
    found, names = dict(law.state), _LawNames(law, given, {})
    for name, said in law.mean.items():
        kept = _kept(name, said, names)
        found |= dict(zip(kept, [said.of, *kept], strict=False))
    return found


def block(law: Law, values: Mapping[str, Any], point: Mapping[str, float] | None = None) -> Sampled:
    """Make the block of one axis from its values that stay.

    `point` has the outputs at the operating point, 0 where nothing is said. A wrong or not linear
    formula is a ValueError, as is `LawRefusal`.
    """
    at = {name: (point or {}).get(output, 0.0) for name, output in law.point.items()}
    given = ChainMap(dict(at), values)  # type: ignore[arg-type]
    for formula, reason in law.refuse.items():
        if number(law, given, formula):
            raise LawRefusal(reason)
    count = number(law, given, law.cycle)
    if not (round(count) >= 1 and abs(count - round(count)) <= _WHOLE * count):
        raise ValueError(f"cycle: {law.cycle!r} is {count:g}, a whole number is wanted")
    made = [_instant(law, given, (k, round(count))) for k in range(round(count))]
    nothing = _LawNames(law, given, {})
    late = not number(law, given, law.prompt)
    return Sampled(
        inputs=tuple(law.inputs),
        commands=tuple(law.commands),
        states=tuple(_states(law, given)),
        outputs=tuple(law.output) if late else (),
        early=tuple(law.early) if late else (*law.output, *law.early),
        direct=tuple(law.direct),
        grid_ns=nanoseconds(law.period, number(law, given, law.period)),
        laws=tuple(m for m, _ in made),
        now=made[0][1],
        grain={n: float(evaluate(text, nothing)) for n, text in law.grain.items()},  # type: ignore[arg-type]
        speed={n: float(evaluate(text, nothing)) for n, text in law.speed.items()},  # type: ignore[arg-type]
    )


def _instant(
    law: Law, given: Mapping[str, Any], place: tuple[int, int]
) -> tuple[np.ndarray[Any, np.dtype[np.float64]], np.ndarray[Any, np.dtype[np.float64]]]:
    """Matrices of the law at one instant of its cycle, and those of direct outputs."""
    states = _states(law, given)
    moving = [*states, *law.inputs, *law.commands]
    known: dict[str, Quantity] = dict(zip(("instant", "instants"), place, strict=True))
    for name, unit in zip(moving, np.eye(len(moving)), strict=True):
        known[name] = Form(unit)
    names = _LawNames(law, given, known)
    later = [*states.items(), *law.output.items(), *law.early.items()]
    rows = [_row(text, names, len(moving)) for _, text in later]
    now = [_row(text, names, len(moving)) for text in law.direct.values()]
    first = len(moving) - len(law.commands)
    for name, row in zip(law.direct, now, strict=True):
        if row[:first].any():
            raise ValueError(f"{name} is shown at once and may depend on commands only")
    empty = np.zeros((0, len(moving)))
    return np.vstack([empty, *rows]), np.vstack([empty, *now])[:, first:]


def _row(text: str, names: _LawNames, count: int) -> np.ndarray[Any, np.dtype[np.float64]]:
    found = evaluate(text, names)
    if isinstance(found, Form):
        return found.row
    if found != 0.0:
        raise ValueError(f"{text!r} is the number {found:g}: only deviations are meant here")
    return np.zeros(count)


def constant(law: Law, values: Mapping[str, Any], name: str) -> float | None:
    """Value of an output that stays; None if the law does not give it."""
    if name not in law.constant:
        return None
    found = evaluate(law.constant[name], _LawNames(law, values, {}))
    return found if isinstance(found, Gain) else float(found)  # type: ignore[arg-type]


def number(law: Law, values: Mapping[str, Any], formula: str) -> float:
    """Value of a formula in which nothing moves."""
    return float(evaluate(formula, _LawNames(law, values, {})))  # type: ignore[arg-type]
