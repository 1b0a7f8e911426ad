"""Where a controller commands its tool and where the machine has it: which outputs say so."""

from dataclasses import dataclass

from motionfmu.base.errors import InputError
from motionfmu.scenarios.agreement import commanded
from motionfmu.scenarios.system import Resolver, wires

TOOL, ATTITUDE = "arm.tool", "arm.attitude"


@dataclass(frozen=True)
class Tool:
    """Outputs of one tool, commanded and actual: positions, attitudes if both have them."""

    position: tuple[str, str]
    attitude: tuple[str, str] | None


def tools(resolver: Resolver) -> list[Tool]:
    """Each tool of which FMUs of the scenario have both the command and the actual position."""
    try:
        joined = wires(resolver)
        found = commanded(resolver.document.body.component, joined, (TOOL, ATTITUDE))
    except InputError:  # told where components and wires are checked
        return []
    turns = {pair[0].partition(".")[0]: pair for pair in found[ATTITUDE]}
    return [Tool(pair, turns.get(pair[0].partition(".")[0])) for pair in found[TOOL]]


def wanted(resolver: Resolver) -> list[str]:
    """Outputs that are recorded so that a page can compare each tool with its command."""
    return [
        name
        for tool in tools(resolver)
        for pair in (tool.position, tool.attitude)
        for name in pair or ()
    ]
