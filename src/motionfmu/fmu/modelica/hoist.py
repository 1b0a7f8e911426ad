"""Separate the operations of a program whose results stay constant during a run."""

from dataclasses import dataclass

import casadi as ca

from motionfmu.fmu.modelica.nodes import Node, Operations


@dataclass(frozen=True)
class Split:
    """A program in two parts."""

    early: Operations  # all operations; only what `constants` needs is to be computed, once
    # nodes of `early`, and whether the inverse is meant: a division by a constant becomes a
    # multiplication
    constants: tuple[tuple[int, bool], ...]
    late: Operations  # all other operations; constant k is input (group, k) of them
    group: int  # argument position that stands for the constants in `late`


def split(early: Operations, varying: set[int], group: int) -> Split:
    """Split a program by which arguments vary during a run; the constants get position `group`."""
    moving = early.depends(varying)
    places: dict[tuple[int, bool], int] = {}
    late: list[Node] = []
    at: dict[tuple[int, bool], int] = {}  # (old node, inverted) -> node of `late`

    def fetch(k: int, inverted: bool = False) -> int:
        """Position of a node in `late`; a new one is a constant."""
        if (k, inverted) not in at:
            node = early.nodes[k]
            if node.op == ca.OP_CONST:
                late.append(Node(ca.OP_CONST, value=1.0 / node.value if inverted else node.value))
            else:
                place = places.setdefault((k, inverted), len(places))
                late.append(Node(ca.OP_INPUT, input=(group, place)))
            at[k, inverted] = len(late) - 1
        return at[k, inverted]

    for k, node in enumerate(early.nodes):
        if not moving[k]:
            continue
        if node.op == ca.OP_DIV and not moving[node.args[1]]:
            args = (fetch(node.args[0]), fetch(node.args[1], inverted=True))
            node = Node(ca.OP_MUL, args)
        else:
            node = Node(node.op, tuple(fetch(a) for a in node.args), node.value, node.input)
        late.append(node)
        at[k, False] = len(late) - 1
    results = tuple(tuple(fetch(k) for k in result) for result in early.results)
    return Split(early, tuple(places), Operations(tuple(late), results), group)
