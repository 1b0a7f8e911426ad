"""Solve a coupled block of linear equations symbolically, as sparse as it is."""

from collections.abc import Sequence
from dataclasses import dataclass

import casadi as ca
import numpy as np
from numpy.typing import NDArray

_Numbers = NDArray[np.float64]

# Number and range of random points at which pivots are tested; the first also tests the solution.
_POINTS, _REACH, _SEED, _COMPARED = 64, 3.0, 1, 8
# At the points parameters differ from their values by this share at most. A parameter of 0 is
# sometimes a little above it, because some models switch there.
_NEAR, _LITTLE = 0.2, 1e-9
# A pivot that is at some point smaller than this share of its largest value may vanish nearby.
_SMALL = 1e-6
# Largest difference from a numeric solution, as a share of the largest unknown.
_EXACT = 1e-8


@dataclass(frozen=True)
class _Entry:
    """A coefficient, and its values at the points."""

    e: ca.SX
    at: _Numbers
    constant: bool
    idle: bool = False  # the coefficient is 0 while parameters have their start values


_Row = dict[int, _Entry]


class NoPivot(ValueError):
    """No coefficient is left that can be divided by without a loss of digits."""


def solve(a: ca.SX, b: ca.SX, values: dict[str, float], labels: Sequence[str]) -> ca.SX:
    """Solve A x = b by constant pivots first, then by those with the least fill (Markowitz 1957).

    `values` has the parameters by name; all other symbols may have any value. A pivot has the same
    sign at all points; NoPivot names the unknowns that have none. A coefficient that is
    a parameter, whose whole array is 0, by itself is no fill: such an array may come to a model
    without another order of pivots, and so without another rounding of what the model was before.
    """
    idle = _idle(a, values)
    numbers = _points([a, b], values, idle)
    rows, right = _rows(a, numbers[0], idle), [b[i] for i in range(b.numel())]
    order: list[tuple[int, int]] = []
    left = list(range(len(rows)))
    while left:
        i, j = _pivot(rows, left, labels)
        order.append((i, j))
        left.remove(i)
        for k in left:
            if j in rows[k]:
                factor = _eliminate(rows[k], rows[i], j)
                right[k] = right[k] - factor * right[i]
    x = [ca.SX(0.0)] * len(rows)
    for i, j in reversed(order):
        for k, v in rows[i].items():
            if k != j:
                right[i] = right[i] - v.e * x[k]
        x[j] = _over(right[i], rows[i][j])
    solution = ca.vertcat(*x)
    _check(solution, numbers, _points([solution], values, idle)[0], labels)
    return solution


def _idle(a: ca.SX, values: dict[str, float]) -> set[str]:
    """Parameters, of arrays of 0, that are coefficients by themselves, with either sign."""
    some = {name.partition("[")[0] for name, value in values.items() if value != 0.0}
    found = set()
    for i, j in zip(*a.sparsity().get_triplet(), strict=True):
        for e in (a[i, j], -a[i, j]):
            name = str(e) if e.is_symbolic() else ""
            if name in values and name.partition("[")[0] not in some:
                found.add(name)
    return found


def _points(expressions: list[ca.SX], values: dict[str, float], idle: set[str]) -> list[_Numbers]:
    """Values of expressions at random points; a symbol has one value in all expressions."""
    symbols = ca.symvar(ca.veccat(*expressions))
    columns: list[_Numbers] = []
    for s in symbols:
        draw = np.random.default_rng([_SEED, *str(s).encode()])
        value = values.get(str(s))
        if value is None:
            columns.append(draw.uniform(-_REACH, _REACH, _POINTS))
        elif str(s) in idle:
            columns.append(np.zeros(_POINTS))
        elif value == 0.0:
            columns.append(_LITTLE * draw.integers(0, 2, _POINTS).astype(np.float64))
        else:
            columns.append(value * draw.uniform(1 - _NEAR, 1 + _NEAR, _POINTS))
    f = ca.Function("f", [ca.vertcat(ca.SX(0, 1), *symbols)], [ca.densify(e) for e in expressions])
    at = np.array(columns).reshape(len(symbols), _POINTS)
    rows = [f.call([ca.DM(at[:, k])]) for k in range(_POINTS)]
    return [np.array([r[n].full() for r in rows]) for n in range(len(expressions))]


def _rows(a: ca.SX, at: _Numbers, idle: set[str]) -> list[_Row]:
    rows: list[_Row] = [{} for _ in range(a.size1())]
    for i, j in zip(*a.sparsity().get_triplet(), strict=True):
        e = a[i, j]
        if not e.is_zero():
            alone = bool({str(e), str(-e)} & idle)
            rows[i][j] = _Entry(e, at[:, i, j], e.is_constant(), alone)
    return rows


# CCN 17: counting what fills and choosing by it read the same entries.
def _pivot(rows: list[_Row], left: list[int], labels: Sequence[str]) -> tuple[int, int]:
    """Row and column of the next pivot: constant, least fill, largest in its row."""
    count: dict[int, int] = {}
    for i in left:
        for j, v in rows[i].items():
            count[j] = count.get(j, 0) + (not v.idle)
    width = {i: sum(not v.idle for v in rows[i].values()) for i in left}
    keys = [
        (not v.constant, (width[i] - 1) * (count[j] - 1), i, j)
        for i in left
        for j, v in rows[i].items()
        if not v.idle
    ]
    best: tuple[float, int, int] | None = None
    least = True, 0
    for variable, fill, i, j in sorted(keys):
        if best is not None and (variable, fill) != least:
            break
        if (size := _size(rows[i], j)) > _SMALL and (best is None or size > best[0]):
            best, least = (size, i, j), (variable, fill)
    if best is None:
        unknown = ", ".join(sorted(labels[j] for j in count)) or "no unknown"
        raise NoPivot(f"linear equations for {unknown} have no pivot that never vanishes")
    return best[1:]


def _size(row: _Row, j: int) -> float:
    """Least share of a coefficient in its row at any point; 0 if its sign changes."""
    at = row[j].at
    if not ((at > 0.0).all() or (at < 0.0).all()):
        return 0.0
    largest = np.max([np.abs(v.at) for v in row.values()], axis=0)
    return float((np.abs(at) / largest).min())


def _over(e: ca.SX, pivot: _Entry) -> ca.SX:
    """Divide by a pivot, whose inverse is computed only once."""
    return e / pivot.e if pivot.constant else e * (1.0 / pivot.e)


# CCN 19: whether an entry is idle, constant or gone is decided where it is computed.
def _eliminate(row: _Row, by: _Row, j: int) -> ca.SX:
    """Remove unknown j from a row; returns the factor, which the right side needs as well."""
    gone = row.pop(j)
    factor = _over(gone.e, by[j])
    at = gone.at / by[j].at
    for k, v in by.items():
        if k == j:
            continue
        old = row.get(k)
        e = (old.e if old else ca.SX(0.0)) - factor * v.e
        if e.is_zero():
            row.pop(k, None)
        else:
            none = gone.idle or v.idle
            idle = (old is None or old.idle) and none
            if old is not None and old.idle and not idle:
                del row[k]  # it stands where it would stand if it came now, for sums have an order
            # What is 0 by an idle parameter leaves a constant pivot what it was.
            kept = old is None or old.idle or old.constant
            constant = kept and (none or (gone.constant and by[j].constant and v.constant))
            constant = constant or e.is_constant()
            row[k] = _Entry(e, (old.at if old else 0.0) - at * v.at, constant, idle)
    return factor


def _check(x: ca.SX, numbers: list[_Numbers], found: _Numbers, labels: Sequence[str]) -> None:
    """Refuse a solution that differs from that of the numeric solver at a point."""
    for a, b, mine in list(zip(*numbers, found, strict=True))[:_COMPARED]:
        exact = np.linalg.solve(a, b)
        if not np.abs(mine - exact).max() <= _EXACT * np.abs(exact).max():
            raise NoPivot(f"linear equations for {', '.join(labels)} lose digits")
