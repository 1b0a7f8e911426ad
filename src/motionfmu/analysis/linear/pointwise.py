"""CasADi's expressions evaluated by numpy at many points, or quickly at one."""

import threading
from collections.abc import Callable
from typing import Any, cast

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.fmu.modelica.nodes import program

Array = NDArray[np.float64]
# Points of a block, so few that intermediate values stay in the processor's cache.
_BLOCK = 4096
_SAME = {
    "ASSIGN": "positive",
    "ADD": "add",
    "SUB": "subtract",
    "MUL": "multiply",
    "DIV": "divide",
    "NEG": "negative",
    "INV": "reciprocal",
    "SQ": "square",
    "FMIN": "fmin",
    "FMAX": "fmax",
    "SIGN": "sign",
    "FABS": "fabs",
    "POW": "power",
    "CONSTPOW": "power",
    "ATAN2": "arctan2",
    "ASIN": "arcsin",
    "ACOS": "arccos",
    "ATAN": "arctan",
    **{f.upper(): f for f in "sqrt floor ceil sin cos tan sinh cosh tanh exp log".split()},
}
_OPERATIONS: dict[int, Callable[..., Any]] = {
    getattr(ca, f"OP_{name}"): getattr(np, own) for name, own in _SAME.items()
}


_TRUTHS = {
    "LT": "less",
    "LE": "less_equal",
    "EQ": "equal",
    "NE": "not_equal",
    "NOT": "logical_not",
    "AND": "logical_and",
    "OR": "logical_or",
}


def _number(truth: Callable[..., Any]) -> Callable[..., Any]:
    """A comparison that gives 1.0 and 0.0, which is quicker than numpy's own conversion."""

    def operation(*operands: Any, out: Array | None = None) -> Any:
        found = truth(*operands)
        if out is None:
            return float(found)
        out[...] = found
        return out

    return operation


def _selected(condition: Any, value: Any, out: Array | None = None) -> Any:
    found = np.where(condition != 0.0, value, 0.0)
    if out is None:
        return float(found)
    out[...] = found
    return out


_OPERATIONS |= {
    getattr(ca, f"OP_{name}"): _number(getattr(np, own)) for name, own in _TRUTHS.items()
}
_OPERATIONS[ca.OP_IF_ELSE_ZERO] = _selected
_OPERATIONS[ca.OP_TWICE] = lambda x, out=None: np.add(x, x, out=out)


class Pointwise:
    """Expressions of a column of symbols, at many values of it at once.

    Each of CasADi's operations is one of numpy's over a block of points. A ValueError tells of an
    operation that has none.
    """

    # CCN 17: one walk over the operations, in which a place is free again behind its last reader.
    def __init__(self, x: ca.SX, results: list[ca.SX]) -> None:
        made = program([x], results)
        depends = made.depends({0})
        last = {a: k for k, n in enumerate(made.nodes) for a in n.args}
        self._results = made.results
        self._known: list[Any] = [0.0] * len(made.nodes)  # values that do not depend on x
        self._inputs: list[tuple[int, int]] = []  # node, element of x
        # operation, operands, node, place of its values
        self._steps: list[tuple[Callable[..., Any], tuple[int, ...], int, int]] = []
        kept = {k for r in made.results for k in r}
        places: dict[int, int] = {}
        free: list[int] = []
        self._places = 0
        for k, node in enumerate(made.nodes):
            if node.op == ca.OP_INPUT:
                self._inputs.append((k, node.input[1]))
                continue
            if node.op == ca.OP_CONST:
                self._known[k] = node.value
                continue
            if node.op not in _OPERATIONS:
                raise ValueError(f"CasADi operation {node.op} has no form in numpy here")
            operation = _OPERATIONS[node.op]
            if not depends[k]:
                with np.errstate(all="ignore"):
                    values = [np.float64(self._known[a]) for a in node.args]
                    self._known[k] = float(operation(*values))
                continue
            if not free:
                free.append(self._places)
                self._places += 1
            places[k] = free.pop()
            self._steps.append((operation, node.args, k, places[k]))
            over = {a for a in node.args if a in places and last[a] == k and a not in kept}
            free += [places[a] for a in over]

    def __call__(self, x: Array) -> list[Array]:
        """Values (elements, count) of each result at x (n, count); elements by columns."""
        count = x.shape[1]
        found = [np.empty((len(r), count)) for r in self._results]
        work = np.empty((self._places, min(count, _BLOCK)))
        with np.errstate(all="ignore"):
            for begin in range(0, count, _BLOCK):
                part = slice(begin, min(begin + _BLOCK, count))
                self._block(x[:, part], [f[:, part] for f in found], work)
        return found

    def _block(self, x: Array, found: list[Array], work: Array) -> None:
        values, wide = list(self._known), x.shape[1]
        for k, element in self._inputs:
            values[k] = x[element]
        for operation, operands, k, place in self._steps:
            out = work[place, :wide]
            operation(*[values[a] for a in operands], out=out)
            values[k] = out
        for target, nodes in zip(found, self._results, strict=True):
            for row, k in zip(target, nodes, strict=True):
                row[:] = values[k]


class Quick:
    """A CasADi function with dense results whose arguments and results are plain arrays."""

    def __init__(self, name: str, arguments: list[ca.SX], results: list[ca.SX]) -> None:
        self._function = ca.Function(name, arguments, [ca.densify(r) for r in results])
        self._buffer, self._run = self._function.buffer()
        f, buffer, self._lock = self._function, cast(Any, self._buffer), threading.Lock()
        self._inputs = [np.zeros(f.numel_in(k)) for k in range(f.n_in())]
        self._outputs = [np.zeros(f.size_out(k)[::-1]).T for k in range(f.n_out())]
        for k, array in enumerate(self._inputs):
            buffer.set_arg(k, memoryview(cast(Any, array)))
        for k, found in enumerate(self._outputs):
            buffer.set_res(k, memoryview(cast(Any, found.T.reshape(-1))))

    def __call__(self, *arguments: Array) -> list[Array]:
        """Results, each with rows and columns as the expression has them."""
        with self._lock:
            for array, value in zip(self._inputs, arguments, strict=True):
                array[:] = value
            self._run()
            return [array.copy() for array in self._outputs]
