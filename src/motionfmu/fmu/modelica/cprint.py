"""Print the operations of a function as C statements."""

import math
from collections.abc import Callable, Iterable

import casadi as ca

from motionfmu.fmu.modelica.nodes import Node, Operations

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
    # Comparisons take the place of fmin and fmax: one instruction each, for several lanes, too.
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
    ca.OP_POW: "el_pow({0}, {1})",
    ca.OP_CONSTPOW: "el_pow({0}, {1})",
    ca.OP_ATAN2: "el_atan2({0}, {1})",
}
_EXACT = "sqrt floor ceil"
_ELEMENTARY = "sin cos tan asin acos atan sinh cosh tanh exp log"
_TEMPLATES.update({getattr(ca, f"OP_{f.upper()}"): f + "({0})" for f in _EXACT.split()})
_TEMPLATES.update({getattr(ca, f"OP_{f.upper()}"): f"el_{f}({{0}})" for f in _ELEMENTARY.split()})
# Operations on an angle, and the name of each in C.
TURNS = {ca.OP_SIN: "sine", ca.OP_COS: "cosine"}


def literal(value: float) -> str:
    """C text of a double, exact."""
    if math.isnan(value):
        return "NAN"
    text = "INFINITY" if math.isinf(value) else repr(abs(value))
    return f"(-{text})" if value < 0 else text


def turned(program: Operations, roots: Iterable[int]) -> list[int]:
    """Nodes whose sine or cosine the nodes `roots` need and that need none themselves."""
    needed = _needed(program, roots)
    deep: set[int] = set()  # nodes that need a sine or cosine
    angles: dict[int, None] = {}
    for k in sorted(needed):
        node = program.nodes[k]
        if node.op in TURNS and node.args[0] not in deep:
            angles[node.args[0]] = None
        if node.op in TURNS or deep.intersection(node.args):
            deep.add(k)
    return list(angles)


def _needed(
    program: Operations, roots: Iterable[int], leaf: Callable[[int, Node], str | None] | None = None
) -> dict[int, str | None]:
    """Nodes that the nodes `roots` need, each with the text of a leaf."""
    stack = list(roots)
    found: dict[int, str | None] = {}
    while stack:
        k = stack.pop()
        if k in found:
            continue
        found[k] = leaf(k, program.nodes[k]) if leaf else None
        if found[k] is None:
            stack.extend(program.nodes[k].args)
    return found


def _sine_and_cosine(program: Operations, nodes: Iterable[int]) -> dict[tuple[int, ...], int]:
    """The first node of each argument of which both are needed."""
    found: dict[tuple[int, ...], list[int]] = {}
    for k in sorted(nodes):
        if program.nodes[k].op in TURNS:
            found.setdefault(program.nodes[k].args, []).append(k)
    return {a: ks[0] for a, ks in found.items() if len({program.nodes[k].op for k in ks}) == 2}


def statements(
    program: Operations, roots: Iterable[int], leaf: Callable[[int, Node], str | None]
) -> list[str]:
    """Statements ``const double aN = ...;`` that the nodes `roots` need, in order of evaluation.

    `leaf` gives the C text of a node that stands for something already known, else None; it must
    know all inputs. An operation without a form in C is a ValueError.
    """
    known = _needed(program, roots, leaf)
    lines: list[str] = []
    both = _sine_and_cosine(program, (k for k, text in known.items() if text is None))
    for k in sorted(known):
        node = program.nodes[k]
        text = known[k]
        if text is None and node.args[:1] in both and node.op in TURNS:
            a = node.args[0]
            if both[node.args[:1]] == k:
                lines.append(f"const struct el_turn t{a} = el_sincos(a{a});")
            text = f"t{a}.{TURNS[node.op]}"
        if text is None and node.op == ca.OP_CONST:
            text = literal(node.value)
        if text is None:
            if node.op not in _TEMPLATES:
                raise ValueError(f"CasADi operation {node.op} has no form in C here")
            text = _TEMPLATES[node.op].format(*(f"a{a}" for a in node.args))
        lines.append(f"const double a{k} = {text};")
    return lines
