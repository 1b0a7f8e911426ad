"""Evaluate flat Modelica expressions to CasADi SX scalars."""

import math
import operator
from collections.abc import Callable, Mapping
from typing import Any

import casadi as ca

from motionfmu.fmu.modelica.arrays import element_name, subscripts
from motionfmu.fmu.modelica.flat import Expression, Flat, Unsupported

_UNARY: dict[str, Callable[[ca.SX], ca.SX]] = {
    "Abs": ca.fabs,
    "Sign": ca.sign,
    "Sqrt": ca.sqrt,
    "Floor": ca.floor,
    "Ceil": ca.ceil,
    "Sin": ca.sin,
    "Cos": ca.cos,
    "Tan": ca.tan,
    "Asin": ca.asin,
    "Acos": ca.acos,
    "Atan": ca.atan,
    "Sinh": ca.sinh,
    "Cosh": ca.cosh,
    "Tanh": ca.tanh,
    "Exp": ca.exp,
    "Log": ca.log,
    "Log10": lambda x: ca.log(x) / math.log(10.0),
    "NoEvent": lambda x: x,
}
_BINARY: dict[str, Callable[[ca.SX, ca.SX], ca.SX]] = {
    "Add": operator.add,
    "Sub": operator.sub,
    "Mul": operator.mul,
    "Div": operator.truediv,
    "Exp": operator.pow,
    "Lt": operator.lt,
    "Le": operator.le,
    "Gt": operator.gt,
    "Ge": operator.ge,
    "Eq": operator.eq,
    "Neq": operator.ne,
    "And": ca.logic_and,
    "Or": ca.logic_or,
}
_PAIR = {"Min": ca.fmin, "Max": ca.fmax, "Atan2": ca.atan2}
_SIGN: dict[str, Callable[[ca.SX], ca.SX]] = {
    "Minus": operator.neg,
    "Plus": operator.pos,
    "Not": ca.logic_not,
}


class Evaluator:
    """Evaluates expressions of one flat class, with SX scalars of its names and derivatives."""

    def __init__(
        self, flat: Flat, lookup: Callable[[str], ca.SX], derivative: Callable[[str], ca.SX]
    ):
        self._flat = flat
        self._lookup = lookup
        self._derivative = derivative

    def _refuse(self, what: str) -> Unsupported:
        return Unsupported(f"{self._flat.name}: {what} is not supported")

    def __call__(self, e: Expression, local: Mapping[str, ca.SX] | None = None) -> ca.SX:
        """Value of an expression, a scalar; Booleans are 0 and 1.

        `local` has the variables of a function that is being inlined; Unsupported names the
        construct.
        """
        ((kind, d),) = e.items()
        if kind == "Literal":
            ((_, value),) = d["value"].items()
            if isinstance(value, str):
                raise self._refuse(f'string "{value}"')
            return ca.SX(float(value))
        if kind == "VarRef":
            return self._reference(d, local)
        if kind == "Unary" and d["op"] in _SIGN:
            return _SIGN[d["op"]](self(d["rhs"], local))
        if kind == "Binary" and d["op"] in _BINARY:
            return _BINARY[d["op"]](self(d["lhs"], local), self(d["rhs"], local))
        if kind == "If":
            value = self(d["else_branch"], local)
            for condition, branch in reversed(d["branches"]):
                value = _choose(self(condition, local), self(branch, local), value)
            return value
        if kind == "BuiltinCall":
            return self._builtin(d["function"], d["args"], local)
        if kind == "FunctionCall":
            return self._call(d, local)
        raise self._refuse(f"expression {kind} {d.get('op', '')}".strip())

    def _reference(self, d: dict[str, Any], local: Mapping[str, ca.SX] | None) -> ca.SX:
        name = d["name"]["name"]
        index = subscripts(d)
        if index is None or (index and local is not None):
            raise self._refuse(f"subscript of {name}")
        name = element_name(name, index)
        if local is not None:
            if name in local:
                return local[name]
            raise self._refuse(f"function variable {name} that is used before it is assigned")
        return self._lookup(name)

    def _builtin(
        self, name: str, args: list[Expression], local: Mapping[str, ca.SX] | None
    ) -> ca.SX:
        if name == "Der":
            index = subscripts(args[0]["VarRef"]) if "VarRef" in args[0] else None
            if index is None or local is not None:
                raise self._refuse("der() of an expression")
            return self._derivative(element_name(args[0]["VarRef"]["name"]["name"], index))
        if name == "Smooth":
            return self(args[1], local)
        if name in _UNARY and len(args) == 1:
            return _UNARY[name](self(args[0], local))
        if name in _PAIR and len(args) == 2:
            return _PAIR[name](self(args[0], local), self(args[1], local))
        raise self._refuse(f"built-in function {name.lower()}")

    def _call(self, d: dict[str, Any], local: Mapping[str, ca.SX] | None) -> ca.SX:
        """Inline a function: assignments in order, one output."""
        name = d["name"]["name"]
        f = self._flat.functions.get(name)
        if f is None or f["external"] or len(f["outputs"]) != 1:
            raise self._refuse(f"function {name} (unknown, external or of several outputs)")
        names = self._arguments(f["inputs"], d, local)
        for port in f["locals"] + f["outputs"]:
            if port["default"] is not None:
                names[port["name"]] = self(port["default"], names)
        for statement in f["body"]:
            ((kind, body),) = statement.items()
            if kind == "Empty":
                continue
            if kind != "Assignment" or len(body["comp"]["parts"]) != 1:
                raise self._refuse(f"{kind.lower()} statement in function {name}")
            part = body["comp"]["parts"][0]
            if part["subs"]:
                raise self._refuse(f"array {part['ident']} in function {name}")
            names[part["ident"]] = self(body["value"], names)
        return names[f["outputs"][0]["name"]]

    def _arguments(
        self, ports: list[dict[str, Any]], d: dict[str, Any], local: Mapping[str, ca.SX] | None
    ) -> dict[str, ca.SX]:
        """Values of the inputs of a called function, by name: given by place, or their defaults."""
        names: dict[str, ca.SX] = {}
        for i, port in enumerate(ports):
            given = d["args"][i] if i < len(d["args"]) else None
            if given is not None and "NamedArgument" in given:
                raise self._refuse(f"named argument of {d['name']['name']}")
            if given is None and port["default"] is None:
                raise self._refuse(f"function {d['name']['name']} without argument {port['name']}")
            names[port["name"]] = (
                self(port["default"], names) if given is None else self(given, local)
            )
        return names


def _choose(condition: ca.SX, then: ca.SX, otherwise: ca.SX) -> ca.SX:
    if condition.is_constant():
        return then if float(condition) else otherwise
    return ca.if_else(condition, then, otherwise)
