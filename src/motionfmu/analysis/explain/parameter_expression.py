"""Arithmetic on an FMU's parameters, as causes.toml writes it."""

import ast
import math
import operator
from collections.abc import Callable, Mapping
from typing import Any

import numpy as np

_BINARY: dict[type, Callable[[Any, Any], Any]] = {
    ast.Add: operator.add,
    ast.Sub: operator.sub,
    ast.Mult: operator.mul,
    ast.Div: operator.truediv,
    ast.Pow: operator.pow,
    ast.Eq: operator.eq,
}


def evaluate(text: str, values: Mapping[str, Any]) -> Any:
    """Value of an expression of parameters; arrays hold one element per axis.

    It has numbers, pi, names in `values`, ``+ - * / **``, ``a if b == c else d``; anything else is
    a ValueError with name and text.
    """
    try:
        return _value(ast.parse(text, mode="eval").body, values)
    except (SyntaxError, ValueError) as error:
        raise ValueError(f"{text!r}: {error}") from None


def _value(node: ast.expr, values: Mapping[str, Any]) -> Any:
    match node:
        case ast.Constant(value=int() | float()):
            return node.value
        case ast.Name():
            if node.id not in values and node.id != "pi":
                raise ValueError(f"no parameter {node.id!r}")
            return values.get(node.id, math.pi)
        case ast.BinOp() if type(node.op) in _BINARY:
            both = _value(node.left, values), _value(node.right, values)
            with np.errstate(divide="ignore", invalid="ignore"):
                return _BINARY[type(node.op)](*both)
        case ast.Compare(ops=[ast.Eq()], comparators=[other]):
            return _value(node.left, values) == _value(other, values)
        case ast.IfExp():
            parts = (_value(part, values) for part in (node.test, node.body, node.orelse))
            return np.where(*parts)
    raise ValueError(f"{ast.unparse(node)!r} is not understood")
