"""The signals that a scenario records for its moving picture only."""

from motionfmu.scenarios import recording
from motionfmu.scenarios.iso9283_signals import check_position
from motionfmu.scenarios.system import Resolver

TABLE = "view"
JOINTS = "link_angle"


def wanted(resolver: Resolver) -> list[str]:
    """Signals of the [view] table, and the joint angles of an arm whose tool they show."""
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
    tool = view.tool or (body.iso9283.position if body.iso9283 else "")
    component = tool.partition(".")[0]
    port = resolver.ports.get(component, {}).get(JOINTS)
    if port is not None and port.causality == "output" and port.shape == (recording.AXES,):
        found.append(f"{component}.{JOINTS}")
    return found
