"""What a picture of a live machine shows: its tool, where it is commanded, the arm if it is one."""

from dataclasses import asdict
from typing import Any

from motionfmu.base import units
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.panel import panel_of
from motionfmu.scenarios.arm_lengths import arm_of
from motionfmu.scenarios.system import Resolver
from motionfmu.scenarios.tool_signals import tools
from motionfmu.scenarios.view_signals import TOOLS, joint_angles


def scene(machine: LiveMachine) -> dict[str, Any] | None:
    """Names of outputs, factors to mm and rad, lengths of the arm; None if no tool is known."""
    resolver, outputs = machine.scenario.resolver, set(machine.names[0])
    found = next(iter(tools(resolver)), None)
    command, tool = found.position if found else (_commanded(resolver), _tool(resolver))
    base = found and found.base
    if tool is None or tool not in outputs:
        return None
    named = resolver.document.body.view.joints
    joints = named or next(iter(joint_angles(resolver, tool)), None)
    arm = arm_of(resolver, machine.parameter, joints) if joints and joints in outputs else None
    return {
        "tool": [tool, _factor(resolver, tool, "mm")],
        "base": [base, _factor(resolver, base, "mm")] if base in outputs else None,
        "command": [command, _factor(resolver, command, "mm")] if command in outputs else None,
        "joints": [joints, _factor(resolver, joints, "rad")] if arm else None,
        "arm": arm and asdict(arm),
    }


def _tool(resolver: Resolver) -> str | None:
    """The signal that is the tool's position."""
    body = resolver.document.body
    named = body.view.tool or (body.iso9283 and body.iso9283.position)
    if named:
        return str(named)
    for ending in TOOLS:
        for component, ports in resolver.ports.items():
            if ending in ports and ports[ending].shape in ((3,), (6,)):
                return f"{component}.{ending}"
    return body.contour.position if body.contour else None


def _commanded(resolver: Resolver) -> str | None:
    """The position that a panel shows as the machine's."""
    for component, fmu in resolver.document.body.component.items():
        panel = panel_of(fmu)
        name = panel and panel.readout.machine
        port = resolver.ports[component].get(name or "")
        if port is not None and port.shape in ((3,), (6,)):
            return f"{component}.{name}"
    return None


def _factor(resolver: Resolver, name: str | None, to: str) -> float:
    component, _, variable = (name or "").partition(".")
    port = resolver.ports.get(component, {}).get(variable)
    unit = units.parse((port and port.unit) or to)
    return unit.factor / units.parse(to).factor
