"""Where a controller commands its tool and where the machine has it: which outputs say so."""

from dataclasses import dataclass

from motionfmu.base.errors import InputError
from motionfmu.scenarios.agreement import COMMAND, commanded, quantities
from motionfmu.scenarios.system import Resolver, wires

TOOL, ATTITUDE, BASE = "arm.tool", "arm.attitude", "arm.base" + COMMAND


@dataclass(frozen=True)
class Tool:
    """Outputs of one tool, commanded and actual: positions, orientations if both have them.

    The actual position is in the arm's base, whose place the controller commands if it knows one.
    """

    position: tuple[str, str]
    attitude: tuple[str, str] | None
    base: str | None


def tools(resolver: Resolver) -> list[Tool]:
    """Each tool of which FMUs of the scenario have both the command and the actual position."""
    try:
        joined = wires(resolver)
        found = commanded(resolver.document.body.component, joined, (TOOL, ATTITUDE))
    except InputError:  # told where components and wires are checked
        return []
    turns = {pair[0].partition(".")[0]: pair for pair in found[ATTITUDE]}
    made = []
    for pair in found[TOOL]:
        controller = pair[0].partition(".")[0]
        made.append(Tool(pair, turns.get(controller), base_of(resolver, controller)))
    return made


def base_of(resolver: Resolver, controller: str) -> str | None:
    """The output with the place that a controller commands its arm's base to; None if none has."""
    fmu = resolver.document.body.component.get(controller)
    base = quantities(fmu).get(BASE) if fmu else None
    return base and f"{controller}.{base}"


def wanted(resolver: Resolver) -> list[str]:
    """Outputs that are recorded so that a page can compare each tool with its command."""
    return [name for tool in tools(resolver) for name in outputs(tool)]


def outputs(tool: Tool) -> list[str]:
    """All outputs of a tool."""
    return [*tool.position, *(tool.attitude or ()), *([tool.base] if tool.base else [])]
