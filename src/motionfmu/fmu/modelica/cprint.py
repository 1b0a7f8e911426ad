"""Print the operations of a Program as C statements."""

import math
from collections.abc import Callable, Iterable

import casadi as ca

from motionfmu.fmu.modelica.nodes import Node, Program

_TEMPLATES = {
    ca.OP_ASSIGN: "{0}",
    ca.OP_ADD: "{0} + {1}",
    ca.OP_SUB: "{0} - {1}",
    ca.OP_MUL: "{0} * {1}",
    ca.OP_DIV: "{0} / {1}",
    ca.OP_NEG: "-{0}",
    ca.OP_INV: "1.0 / {0}",
    ca.OP_SQ: "{0} * {0}",
    ca.OP_TWICE: "{0} + {0}",
    # Not fmin and fmax: a comparison is one instruction, also for several lanes at once.
    ca.OP_FMIN: "{0} < {1} ? {0} : {1}",
    ca.OP_FMAX: "{0} > {1} ? {0} : {1}",
    ca.OP_LT: "{0} < {1} ? 1.0 : 0.0",
    ca.OP_LE: "{0} <= {1} ? 1.0 : 0.0",
    ca.OP_EQ: "{0} == {1} ? 1.0 : 0.0",
    ca.OP_NE: "{0} != {1} ? 1.0 : 0.0",
    ca.OP_NOT: "{0} == 0.0 ? 1.0 : 0.0",
    ca.OP_AND: "{0} != 0.0 && {1} != 0.0 ? 1.0 : 0.0",
    ca.OP_OR: "{0} != 0.0 || {1} != 0.0 ? 1.0 : 0.0",
    ca.OP_IF_ELSE_ZERO: "{0} != 0.0 ? {1} : 0.0",
    ca.OP_SIGN: "{0} > 0.0 ? 1.0 : {0} < 0.0 ? -1.0 : 0.0",
    ca.OP_FABS: "fabs({0})",
    ca.OP_POW: "pow({0}, {1})",
    ca.OP_CONSTPOW: "pow({0}, {1})",
    ca.OP_ATAN2: "atan2({0}, {1})",
}
_LIBRARY = "sqrt floor ceil sin cos tan asin acos atan sinh cosh tanh exp log"
_TEMPLATES.update({getattr(ca, f"OP_{f.upper()}"): f + "({0})" for f in _LIBRARY.split()})


def literal(value: float) -> str:
    """C text of a double, exact."""
    if math.isnan(value):
        return "NAN"
    text = "INFINITY" if math.isinf(value) else repr(abs(value))
    return f"(-{text})" if value < 0 else text


def statements(
    program: Program, roots: Iterable[int], leaf: Callable[[int, Node], str | None]
) -> list[str]:
    """Statements ``const double aN = ...;`` that the nodes `roots` need, in order of evaluation.

    `leaf` gives the C text of a node that stands for something already known, else None; it must
    know all inputs. An operation without a form in C is a ValueError.
    """
    needed, stack, known = set(roots), list(roots), {}
    while stack:
        k = stack.pop()
        known[k] = leaf(k, program.nodes[k])
        fresh = [] if known[k] is not None else set(program.nodes[k].args) - needed
        needed.update(fresh)
        stack.extend(fresh)
    lines = []
    for k in sorted(needed):
        node = program.nodes[k]
        text = known[k]
        if text is None and node.op == ca.OP_CONST:
            text = literal(node.value)
        if text is None:
            if node.op not in _TEMPLATES:
                raise ValueError(f"CasADi operation {node.op} has no form in C here")
            text = _TEMPLATES[node.op].format(*(f"a{a}" for a in node.args))
        lines.append(f"const double a{k} = {text};")
    return lines
