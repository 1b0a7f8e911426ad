"""What a page or a program must know of a live machine to work it."""

import math
from pathlib import Path
from typing import Any

from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.panel import panel_of
from motionfmu.live.sample_ring import CHANNELS
from motionfmu.scenarios.port import Port

LINES_MAX = 200_000  # of a program, that a page is given


def about(machine: LiveMachine) -> dict[str, Any]:
    """The machine, its variables by component, panels, program: all of it plain JSON."""
    scenario = machine.scenario
    outputs, settable = (set(names) for names in machine.names)
    components: dict[str, Any] = {}
    for component, ports in scenario.resolver.ports.items():
        fmu = scenario.document.body.component[component]
        panel = panel_of(fmu)
        components[component] = {
            "fmu": fmu,
            "panel": panel.model_dump(exclude_none=True) if panel else None,
            "variables": {
                port.name: _variable(port, name in settable)
                for port in ports.values()
                for name in [f"{component}.{port.name}"]
                if name in outputs or name in settable
            },
            "parameters": machine.parameters(component),
        }
    body = scenario.document.body
    return {
        "name": scenario.name,
        "about": scenario.document.about,
        "step": machine.step_seconds,
        "axes": [axis.model_dump() for axis in scenario.document.axes],
        "signals": body.signals.model_dump(exclude_none=True),
        "components": components,
        "channels": CHANNELS,
        "program": _program(machine),
    }


def _variable(port: Port, settable: bool) -> dict[str, Any]:
    return {
        "type": port.type,
        "shape": list(port.shape),
        "unit": port.unit,
        "doc": port.doc,
        "low": port.low if math.isfinite(port.low) else None,
        "high": port.high if math.isfinite(port.high) else None,
        "causality": port.causality,
        "set": settable,
    }


def _program(machine: LiveMachine) -> dict[str, Any] | None:
    """The program's file and its text, if a controller has one."""
    name = machine.scenario.document.body.signals.program
    file = None if name is None else machine.text(name)
    if not file:
        return None
    try:
        text = Path(file).read_text(encoding="utf-8-sig", errors="replace")
    except OSError:
        return None
    return {"file": Path(file).name, "lines": text.splitlines()[:LINES_MAX]}
