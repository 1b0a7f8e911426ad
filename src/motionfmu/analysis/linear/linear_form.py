"""Formulas of numbers and of moving quantities, whose results are linear forms."""

import ast
import functools
import math
from collections.abc import Mapping
from types import CodeType
from typing import Any, TypeAlias

import casadi as ca
import numpy as np
from numpy.typing import NDArray

_ALLOWED = (
    *(ast.Expression, ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.Call),
    *(ast.Name, ast.Load, ast.Constant, ast.operator, ast.unaryop, ast.boolop, ast.cmpop),
)


class Gain(float):
    """A number that is also a CasADi expression of gains.

    Comparisons take the number; sums, products and powers give both.
    """

    symbol: ca.SX  # scalar
    plain: Any  # the number as a scenario takes it, if that is no float

    def __new__(cls, value: float, symbol: ca.SX, plain: Any = None) -> "Gain":
        """Keep the number in the float itself."""
        made = super().__new__(cls, value)
        made.symbol = symbol
        made.plain = float(value) if plain is None else plain
        return made


def _both(name: str) -> Any:
    on_number = getattr(float, name)

    def operation(self: Gain, *others: Any) -> Any:
        if others and not isinstance(others[0], int | float):
            return NotImplemented
        value = on_number(float(self), *(float(x) for x in others))
        symbol = getattr(self.symbol, name)(*(coefficient(x) for x in others))
        return Gain(value, symbol)

    return operation


for _name in ("add", "sub", "mul", "truediv", "pow"):
    setattr(Gain, f"__{_name}__", _both(f"__{_name}__"))
    setattr(Gain, f"__r{_name}__", _both(f"__r{_name}__"))
Gain.__neg__ = _both("__neg__")  # type: ignore[method-assign]


def coefficient(value: Any) -> Any:
    """An element of a matrix: the expression of a `Gain`, else a float."""
    return value.symbol if isinstance(value, Gain) else float(value)


def _scaled(row: NDArray[Any], factor: Any) -> NDArray[Any]:
    if isinstance(factor, float) and row.dtype != object:
        return row * factor
    found = np.empty(len(row), dtype=object)  # element by element: CasADi would take the whole row
    found[:] = [x * factor for x in row.tolist()]
    return found


class Form:
    """A linear form: one coefficient for each quantity that moves."""

    # A row of objects has expressions among its coefficients.

    __array_priority__ = 1000

    def __init__(self, row: NDArray[np.float64]) -> None:
        self.row = row

    def __add__(self, other: Any) -> "Form":
        if isinstance(other, Form):
            return Form(self.row + other.row)
        if other == 0:
            return self
        raise ValueError("a number is added to what moves: only deviations are meant here")

    __radd__ = __add__

    def __neg__(self) -> "Form":
        return Form(-self.row)

    def __sub__(self, other: Any) -> "Form":
        return self + (-other)

    def __rsub__(self, other: Any) -> "Form":
        return -self + other

    def __mul__(self, other: Any) -> "Form":
        if isinstance(other, Form):
            raise ValueError("a product of two quantities that move is not linear")
        return Form(_scaled(self.row, coefficient(other)))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Form":
        if isinstance(other, Form):
            raise ValueError("a quotient of two quantities that move is not linear")
        divisor = coefficient(other)
        if isinstance(divisor, float) and self.row.dtype != object:
            return Form(self.row / divisor)
        return Form(_scaled(self.row, 1.0 / divisor))

    def _compared(self, *_: Any) -> bool:
        raise ValueError("a comparison of what moves is not linear")

    __eq__ = __lt__ = __le__ = __gt__ = __ge__ = _compared
    __bool__ = _compared
    __hash__ = None  # type: ignore[assignment]


Quantity: TypeAlias = Form | float


def _bit(value: float, place: float) -> int:
    return int(value) >> int(place) & 1


_KNOWN: dict[str, Any] = {"pi": math.pi, "bit": _bit, "round": round, "true": True, "false": False}


def evaluate(text: str, names: Mapping[str, Any]) -> Quantity:
    """Value of a formula; a ValueError if it is wrong or not linear.

    It has numbers, names, ``+ - * / ** %``, comparisons, ``a if b else c``, ``and or not``, ``pi``,
    ``round(value)`` and ``bit(value, place)``; `names` is asked only for what is used.
    """
    code = _compiled(text)
    try:
        found = eval(code, {"__builtins__": {}}, _Scope(names))
    except (TypeError, ArithmeticError, ValueError) as error:
        raise ValueError(f"{text!r}: {error}") from None
    return found if isinstance(found, Form | Gain) else float(found)


@functools.cache
def _compiled(text: str) -> CodeType:
    try:
        tree = ast.parse(text, mode="eval")
    except SyntaxError as error:
        raise ValueError(f"{text!r}: {error.msg}") from None
    for node in ast.walk(tree):
        if not isinstance(node, _ALLOWED):
            raise ValueError(f"{text!r}: {type(node).__name__} is not allowed in a formula")
    return compile(tree, "<formula>", "eval")


class _Scope(dict[str, Any]):
    """Names of a formula: own functions, then the caller's."""

    def __init__(self, names: Mapping[str, Any]) -> None:
        super().__init__()
        self._names = names

    def __missing__(self, name: str) -> Any:
        if name in _KNOWN:
            return _KNOWN[name]
        try:
            return self._names[name]
        except KeyError:
            raise ValueError(f"{name!r} is not known") from None
