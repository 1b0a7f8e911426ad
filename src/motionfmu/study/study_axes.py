"""The axes of a study: the variables that it varies, and the points at which it runs."""

import math
import sys
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from statistics import NormalDist
from typing import Any

import numpy as np
from numpy.typing import NDArray
from pydantic import BaseModel, ConfigDict, Field

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import word
from motionfmu.scenarios.system import End

Value = float | int | bool | str
Point = tuple[Value, ...]
AxisValues = (
    list[Value] | NDArray[Any]
)  # one value for each value of a grid's axis, or for each run
SAMPLINGS = ("grid", "random", "latin")
RUNS_MAX = 10_000_000  # some hours on a hundred cores
VALUES_MAX = 50_000_000  # runs times axes: 8 bytes for each that is drawn
BLOCK = 10_000  # points made at a time
STANDARD = NormalDist()
_STRICT = ConfigDict(extra="forbid", allow_inf_nan=False)


class Span(BaseModel):
    """A range: n even values of a grid, or a uniform distribution."""

    model_config = _STRICT
    low: float = Field(alias="from", strict=True)  # least value
    high: float = Field(alias="to", strict=True)  # largest value
    n: int | None = Field(default=None, ge=2, le=RUNS_MAX, strict=True)  # values in a grid
    log: bool = Field(default=False, strict=True)  # even in the logarithm


class Normal(BaseModel):
    """A normal distribution."""

    model_config = _STRICT
    mean: float = Field(strict=True)  # mean of the draws
    deviation: float = Field(gt=0, strict=True)  # standard deviation of the draws


class ListedValues(BaseModel):
    """Values one by one; each equally likely where points are drawn."""

    model_config = _STRICT
    values: list[Value] = Field(min_length=1)  # of any type, one by one


Source = Span | Normal | ListedValues


@dataclass(frozen=True)
class Axis:
    """A variable, or one element of it, and the values it takes."""

    name: str  # component.variable or component.variable[i]
    end: End
    source: Source  # in the variable's unit

    @property
    def unit(self) -> str:
        """Unit of the variable; empty if it has none."""
        return self.end.port.unit or ""

    @property
    def log(self) -> bool:
        """Whether values are spread evenly by their logarithms."""
        return isinstance(self.source, Span) and self.source.log

    def place(self, values: NDArray[np.float64]) -> NDArray[np.float64]:
        """Positions of values between the axis' ends, 0 to 1."""
        if isinstance(self.source, Span):
            low, high = self.source.low, self.source.high
        else:
            low, high = float(values.min()), float(values.max())
        if low == high:
            return np.full(len(values), 0.5)
        if self.log:
            values, low, high = np.log(values), math.log(low), math.log(high)
        # Halves: a difference of two numbers may be beyond all of them.
        return (values / 2 - low / 2) / (high / 2 - low / 2)

    def check(self, sampling: str) -> None:
        """Refuse values that this variable or this sampling, if one is given, cannot take."""
        # Values outside the range that the variable declares are allowed; their runs are errors.
        source, kind = self.source, self.end.port.type
        if isinstance(source, ListedValues):
            self._check_list(source)
        elif kind not in ("Float64", "Int32"):
            raise ValueError(f"{self.name} is {kind}: a list of values wanted")
        elif not isinstance(source, Normal):
            self._check_range(source, sampling)
        elif sampling == "grid":
            raise ValueError(f"{self.name}: a grid has no normal distribution")

    def _check_list(self, source: ListedValues) -> None:
        kind = self.end.port.type
        fits: dict[str, Any] = {"Float64": (int, float), "Int32": int, "Boolean": bool}
        for x in source.values:
            boolean = isinstance(x, bool) and kind != "Boolean"
            if boolean or not isinstance(x, fits.get(kind, str)):
                raise ValueError(f"{self.name} = {x!r}: {kind} wanted")

    def _check_range(self, source: Span, sampling: str) -> None:
        shown = f"{self.name} = {source.low:g} .. {source.high:g}"
        if not source.low < source.high:
            raise ValueError(f"{shown}: from is not below to")
        if source.log and source.low <= 0:
            raise ValueError(f"{shown}: a logarithm wants positive numbers")
        if sampling == "grid" and source.n is None:
            raise ValueError(f"{shown}: a grid wants n, the number of values")
        if sampling not in ("grid", "") and source.n is not None:
            raise ValueError(f"{shown}: n = {source.n} belongs to a grid, not to {sampling}")
        if self.end.port.type == "Int32":
            even = self._even(source)
            if broken := [x for x in (even[0], even[-1]) if x != round(x)]:
                raise ValueError(f"{shown}: {broken[0]:g} is no whole number")
            if len(set(map(round, even))) < len(even):
                raise ValueError(f"{shown}: fewer whole numbers than n = {source.n}")

    def _even(self, source: Span) -> list[float]:
        """Values of a grid or, if points are drawn at random, the two ends of the range."""
        steps = (source.n or 2) - 1
        if source.log:
            ratio = source.high / source.low
            inner = [source.low * ratio ** (k / steps) for k in range(1, steps)]
        else:
            width = source.high - source.low
            inner = [source.low + width * k / steps for k in range(1, steps)]
        return [source.low, *inner, source.high]

    def grid(self) -> list[Value]:
        """All values, in order, in the variable's unit."""
        if isinstance(self.source, ListedValues):
            return [self._typed(x) for x in self.source.values]
        assert isinstance(self.source, Span), "check() has seen it"
        return [self._typed(x) for x in self._even(self.source)]

    def drawn(self, shares: NDArray[np.float64]) -> list[Value]:
        """Values at given shares, 0 to 1, of the distribution."""
        source, whole = self.source, self.end.port.type == "Int32"
        if isinstance(source, ListedValues):
            return [self._typed(source.values[int(u * len(source.values))]) for u in shares]
        if isinstance(source, Normal):
            return [self._typed(source.mean + source.deviation * z) for z in _normal(shares)]
        low, high = source.low, source.high
        if whole:  # every whole number has an interval of the shares of its own
            low, high = low - (0.0 if source.log else 0.5), high + (0.0 if source.log else 0.5)
        if source.log:
            return [self._typed(low * (high / low) ** u) for u in shares]
        inside = [low + (high - low) * u for u in shares]
        return [self._typed(min(max(x, source.low), source.high)) for x in inside]

    def _typed(self, x: Any) -> Value:
        kinds: dict[str, Any] = {"Float64": float, "Int32": round}
        return kinds.get(self.end.port.type, lambda same: same)(x)


def _normal(shares: NDArray[np.float64]) -> list[float]:
    """Quantiles of the standard normal distribution; none is infinite."""
    inside = shares.clip(sys.float_info.min, 1.0 - sys.float_info.epsilon)
    return [STANDARD.inv_cdf(u) for u in inside]


def option(text: str) -> tuple[str, Any]:
    """Name of an axis from the command line, and its value as a file would have it.

    ``comp.var=lo:hi:n``, ``lo:hi``, either with ``:log`` after it, or ``a,b,c``.
    """
    name, _, value = text.partition("=")
    parts = value.split(":")
    log = len(parts) > 2 and parts[-1] == "log"
    try:
        if len(parts) == 1 and value:
            return name.strip(), [_word(v.strip()) for v in value.split(",")]
        low, high, *n = parts[: len(parts) - log]
        spec: dict[str, Any] = {"from": float(low), "to": float(high), "log": log}
        if n:
            (spec["n"],) = map(int, n)
        return name.strip(), spec
    except ValueError:
        wanted = "COMP.VAR=LO:HI:N, LO:HI, :log after either, or a list A,B,C"
        raise InputError(f"--vary {text}: {wanted} wanted") from None


def _word(text: str) -> Value:
    """One value; anything else is text."""
    found = word(text)
    return found if isinstance(found, float | int | str) else text


def count(axes: Sequence[Axis]) -> int:
    """Number of points of a grid."""
    sizes = (
        len(a.source.values) if isinstance(a.source, ListedValues) else a.source.n
        for a in axes
        if not isinstance(a.source, Normal)
    )
    return math.prod(n or 1 for n in sizes)


class StudyPoints(Sequence[Point]):
    """The points of a study in the order of its rows, each made when it is asked for.

    Of a grid the values of its axes are kept, of drawn points 8 bytes for each value. So points
    take no room to speak of beside what they are for.
    """

    def __init__(self, columns: Sequence[AxisValues], numeric: Sequence[bool], grid: bool) -> None:
        self._columns, self._numeric, self._grid = tuple(columns), tuple(numeric), grid
        sizes = [len(c) for c in columns]
        self._count = math.prod(sizes) if grid else sizes[0]
        self._strides = [math.prod(sizes[i + 1 :]) for i in range(len(sizes))]

    def __len__(self) -> int:
        return self._count

    def __getitem__(self, which: Any) -> Any:
        if isinstance(which, slice):
            runs = range(*which.indices(self._count))
            return list(zip(*(self.column(i, runs) for i in range(self.width)), strict=True))
        if not -self._count <= which < self._count:
            raise IndexError(which)
        place = which % self._count
        return self[place : place + 1][0]

    def __iter__(self) -> Iterator[Point]:
        for first in range(0, self._count, BLOCK):
            yield from self[first : first + BLOCK]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Sequence) and len(self) == len(other) and [*self] == [*other]

    @property
    def width(self) -> int:
        """Number of values of a point."""
        return len(self._columns)

    def column(self, i: int, runs: Sequence[int] | NDArray[np.int64]) -> list[Value]:
        """Values of one axis at some runs."""
        column = self._columns[i]
        if isinstance(column, np.ndarray):
            found: list[Value] = column[np.asarray(runs, dtype=np.int64)].tolist()
            return found
        if self._grid:
            return [column[run // self._strides[i] % len(column)] for run in runs]
        return [column[run] for run in runs]

    def numbers(self, i: int) -> NDArray[np.float64]:
        """Values of an axis of numbers at all runs."""
        found = np.asarray(self._columns[i], dtype=np.float64)
        if not self._grid:
            return found
        inner = np.repeat(found, self._strides[i])
        return np.tile(inner, self._count // max(len(inner), 1))

    def different(self, i: int) -> list[Value]:
        """The values that an axis takes, each once: numbers in their order, others as they come."""
        column = self._columns[i]
        if isinstance(column, np.ndarray):
            found: list[Value] = np.unique(column).tolist()
            return found
        once = list(dict.fromkeys(column))
        return sorted(once) if self._numeric[i] else once


def points(axes: Sequence[Axis], sampling: str, runs: int, seed: int) -> StudyPoints:
    """All points of a study, in the order of its rows.

    ``grid``: every combination, the last axis fastest, whatever `runs` is; ``random``: independent
    draws; ``latin``: each axis' distribution cut into `runs` parts of equal probability, each taken
    once (Latin hypercube). The same seed draws the same points.
    """
    numeric = [axis.end.port.type in ("Float64", "Int32") for axis in axes]
    if sampling == "grid":
        return StudyPoints([a.grid() for a in axes], numeric, True)
    random = np.random.default_rng(seed)
    if sampling == "latin":
        from scipy.stats import qmc  # takes half a second to import, and no worker needs it

        shares = qmc.LatinHypercube(len(axes), rng=random).random(runs)
    else:
        shares = random.random((runs, len(axes)))
    drawn = [_drawn(*of, shares[:, i]) for i, of in enumerate(zip(axes, numeric, strict=True))]
    return StudyPoints(drawn, numeric, False)


def _drawn(axis: Axis, numeric: bool, shares: NDArray[np.float64]) -> AxisValues:
    """An axis' values at its shares: numbers block by block, as an array."""
    blocks = (shares[first : first + BLOCK] for first in range(0, len(shares), BLOCK))
    if numeric:
        return np.concatenate([np.array(axis.drawn(block)) for block in blocks])
    return [value for block in blocks for value in axis.drawn(block)]
