"""The signals that a scenario records for its moving picture only."""

from collections.abc import Iterable

from motionfmu.base.errors import InputError
from motionfmu.scenarios import recording, tool_signals
from motionfmu.scenarios.agreement import COMMAND, quantities
from motionfmu.scenarios.iso9283_signals import check_position
from motionfmu.scenarios.system import Resolver

TABLE = "view"
# Names that tell a tool, joint angles of an arm and commanded ones by themselves.
TOOLS = ("tool_position", "table_position")
JOINTS, COMMANDED = "link_angle", "joint_command"


def wanted(resolver: Resolver) -> list[str]:
    """Signals of the [view] table, and the joint angles of an arm whose tool is shown."""
    body = resolver.document.body
    view, found = body.view, []
    if not view.show:
        return []
    if view.tool is not None:
        check_position(resolver, view.tool, TABLE, "tool")
        found.append(view.tool)
    if view.works is not None:
        works = recording.output(resolver, view.works, TABLE, "works").port
        if works.shape or works.type == "String":
            text = f"works = {view.works!r}: a single number wanted"
            raise resolver.document.error(text, TABLE, "works")
        found.append(view.works)
    if view.joints is not None:
        if recording.output(resolver, view.joints, TABLE, "joints").port.shape != (recording.AXES,):
            text = f"joints = {view.joints!r}: six angles wanted"
            raise resolver.document.error(text, TABLE, "joints")
        return [*found, view.joints]
    tool = shown_tool(resolver, _recorded(resolver))
    joints = joint_angles(resolver, tool)[:1] if tool else []
    return [*found, *joints, *(b for j in joints if (b := standing(resolver, j)))]


def _recorded(resolver: Resolver) -> list[str]:
    """Outputs that are recorded as asked for, and tools with their commands."""
    try:
        asked = recording.chosen(resolver, resolver.document.body.record.signals)
    except InputError:  # told where the list itself is looked up
        asked = []
    return [*(end.name for end in asked), *tool_signals.wanted(resolver)]


def shown_tool(resolver: Resolver, recorded: Iterable[str]) -> str | None:
    """The output that is the tool's position: a named one, else a recorded one, an arm's first."""
    body = resolver.document.body
    if body.view.tool:
        return body.view.tool
    if body.iso9283:
        return body.iso9283.position
    names = list(recorded)
    found = [n for ending in TOOLS for n in names if _is_tool(resolver, n, ending)]
    if found:
        return min(found, key=lambda n: f"{n.partition('.')[0]}.{JOINTS}" not in _six(resolver, n))
    return body.contour.position if body.contour else None


def _is_tool(resolver: Resolver, name: str, ending: str) -> bool:
    component, _, variable = name.partition(".")
    return variable == ending and resolver.ports[component][variable].shape in ((3,), (6,))


def joint_angles(resolver: Resolver, tool: str) -> list[str]:
    """Outputs of six joint angles of the arm that has this tool, the best one first.

    Without angles of its own an arm is drawn at those that its controller commands.
    """
    pairs = [t.position for t in tool_signals.tools(resolver)]
    return _six(resolver, tool, *(command for command, actual in pairs if actual == tool))


def _six(resolver: Resolver, *tools: str) -> list[str]:
    """Outputs of six joint angles of the components of these tools."""
    found = []
    for component in (tool.partition(".")[0] for tool in tools):
        for variable in (JOINTS, COMMANDED):
            port = resolver.ports.get(component, {}).get(variable)
            if port and port.causality == "output" and port.shape == (recording.AXES,):
                found.append(f"{component}.{variable}")
    return found


def standing(resolver: Resolver, joints: str) -> str | None:
    """The output that says where an arm stands whose joint angles are commanded; None: at 0."""
    component, _, variable = joints.partition(".")
    if variable != COMMANDED:
        return None
    return tool_signals.base_of(resolver, component)


def of_arm(resolver: Resolver, tool: str) -> bool:
    """Whether a tool is an arm's, by what its FMU states."""
    fmu = resolver.document.body.component.get(tool.partition(".")[0])
    stated = quantities(fmu) if fmu else {}
    return tool_signals.TOOL in stated or tool_signals.TOOL + COMMAND in stated
