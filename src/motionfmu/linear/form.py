"""Formulas over numbers and over quantities that move, kept linear."""

import ast
import functools
import math
from collections.abc import Mapping
from types import CodeType
from typing import Any, TypeAlias

import numpy as np
from numpy.typing import NDArray

_ALLOWED = (
    *(ast.Expression, ast.BinOp, ast.UnaryOp, ast.BoolOp, ast.Compare, ast.IfExp, ast.Call),
    *(ast.Name, ast.Load, ast.Constant, ast.operator, ast.unaryop, ast.boolop, ast.cmpop),
)


class Form:
    """A linear form: one coefficient for each quantity that moves.

    Parameters
    ----------
    row : ndarray, shape (n,)
        Coefficients.
    """

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
        return Form(self.row * float(other))

    __rmul__ = __mul__

    def __truediv__(self, other: Any) -> "Form":
        if isinstance(other, Form):
            raise ValueError("a quotient of two quantities that move is not linear")
        return Form(self.row / float(other))

    def _compared(self, *_: Any) -> bool:
        raise ValueError("a comparison of what moves is not linear")

    __eq__ = __lt__ = __le__ = __gt__ = __ge__ = _compared
    __bool__ = _compared
    __hash__ = None  # type: ignore[assignment]


Quantity: TypeAlias = Form | float


def _bit(value: float, place: float) -> int:
    return int(value) >> int(place) & 1


_KNOWN: dict[str, Any] = {"pi": math.pi, "bit": _bit, "true": True, "false": False}


def evaluate(text: str, names: Mapping[str, Any]) -> Quantity:
    """Value of a formula.

    Parameters
    ----------
    text : str
        Numbers, names, ``+ - * / ** %``, comparisons, ``a if b else c``, ``and or not``, ``pi``
        and ``bit(value, place)``.
    names : mapping
        Number or `Form` by name; asked only for what is used.

    Returns
    -------
    Form or float

    Raises
    ------
    ValueError
        The formula is wrong, or not linear.
    """
    code = _compiled(text)
    try:
        found = eval(code, {"__builtins__": {}}, _Scope(names))
    except (TypeError, ArithmeticError, ValueError) as error:
        raise ValueError(f"{text!r}: {error}") from None
    return found if isinstance(found, Form) else float(found)


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
