"""The operations of a CasADi function, in order of evaluation."""

from dataclasses import dataclass

import casadi as ca

# Operations that jump or switch where an operand crosses a value, which their derivative hides.
STEPS = frozenset(
    {ca.OP_LT, ca.OP_LE, ca.OP_EQ, ca.OP_NE, ca.OP_SIGN, ca.OP_FLOOR, ca.OP_CEIL, ca.OP_NOT}
    | {ca.OP_AND, ca.OP_OR}
)


@dataclass(frozen=True)
class Node:
    """One operation."""

    op: int  # CasADi's operation code
    args: tuple[int, ...] = ()  # positions of the operands in the list
    value: float = 0.0  # value of a constant
    input: tuple[int, int] = (-1, -1)  # argument and element of an input


@dataclass(frozen=True)
class Operations:
    """All operations of a function."""

    nodes: tuple[Node, ...]
    # for each output of the function the node of each of its elements; dense
    results: tuple[tuple[int, ...], ...]

    def depends(self, arguments: set[int]) -> list[bool]:
        """Whether each node depends on any of these arguments."""
        found: list[bool] = []
        for n in self.nodes:
            own = n.op == ca.OP_INPUT and n.input[0] in arguments
            found.append(own or any(found[a] for a in n.args))
        return found


def program(arguments: list[ca.SX], results: list[ca.SX]) -> Operations:
    """List the operations that compute these expressions of columns of symbols, and no others."""
    f = ca.Function("f", arguments, [ca.densify(r) for r in results], {"cse": True})
    nodes: list[Node] = []
    register: dict[int, int] = {}  # the function reuses registers; each node stays
    outputs: list[list[int]] = [[-1] * r.numel() for r in results]
    for k in range(f.n_instructions()):
        op, source, target = (
            f.instruction_id(k),
            f.instruction_input(k),
            f.instruction_output(k),
        )
        if op == ca.OP_OUTPUT:
            outputs[target[0]][target[1]] = register[source[0]]
            continue
        if op == ca.OP_CONST:
            node = Node(op, value=f.instruction_constant(k))
        elif op == ca.OP_INPUT:
            node = Node(op, input=(source[0], source[1]))
        else:
            node = Node(op, tuple(register[s] for s in source))
        register[target[0]] = len(nodes)
        nodes.append(node)
    return Operations(tuple(nodes), tuple(map(tuple, outputs)))


def steps_on(expression: ca.SX, variables: ca.SX) -> bool:
    """Whether a comparison, sign or rounding depends on a column of symbols."""
    whole = ca.Function("f", ca.symvar(expression), [expression])
    if STEPS.isdisjoint(map(whole.instruction_id, range(whole.n_instructions()))):
        return False  # most equations compare nothing: nodes need not be made for them
    others = [s for s in ca.symvar(expression) if not ca.depends_on(s, variables)]
    p = program([variables, ca.vertcat(*others)], [expression])
    depends = p.depends({0})
    return any(n.op in STEPS and d for n, d in zip(p.nodes, depends, strict=True))
