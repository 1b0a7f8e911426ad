"""What a page or a program must know of a live machine to work it."""

import ctypes
import itertools
import math
from pathlib import Path
from typing import Any

from motionfmu.base.binding import library
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.live_scene import scene
from motionfmu.live.panel import panel_of
from motionfmu.live.sample_ring import CHANNELS
from motionfmu.scenarios.fault_advice import advice, meanings
from motionfmu.scenarios.port import Port

LINES_MAX = 200_000  # of a program, that a page is given


def about(machine: LiveMachine) -> dict[str, Any]:
    """The machine, its variables by component, panels, program: all of it plain JSON."""
    scenario = machine.scenario
    outputs, settable = (set(names) for names in machine.names)
    components: dict[str, Any] = {}
    for component, ports in scenario.resolver.ports.items():
        fmu = scenario.document.body.component[component]
        panel, told = panel_of(fmu), advice(fmu)
        components[component] = {
            "fmu": fmu,
            "panel": panel.model_dump(exclude_none=True) if panel else None,
            "variables": {
                port.name: _variable(port, name in settable, told.get(port.name, {}))
                for port in ports.values()
                for name in [f"{component}.{port.name}"]
                if name in outputs or name in settable
            },
            "parameters": {
                port.name: _parameter(machine, component, port)
                for port in ports.values()
                if port.causality == "parameter" and port.type != "String"
            },
        }
        if panel and panel.mdi and panel.mdi.fault:
            components[component]["variables"][panel.mdi.fault]["words"] = _faults()
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
        "scene": scene(machine),
    }


def _parameter(machine: LiveMachine, component: str, port: Port) -> list[Any]:
    """The elements of a parameter as the machine began."""
    values = machine.parameter(f"{component}.{port.name}")
    return list(values * port.count if len(values) == 1 else values)


def _variable(port: Port, settable: bool, told: dict[int, str]) -> dict[str, Any]:
    return {
        "type": port.type,
        "shape": list(port.shape),
        "unit": port.unit,
        "doc": port.doc,
        "low": port.low if math.isfinite(port.low) else None,
        "high": port.high if math.isfinite(port.high) else None,
        "causality": port.causality,
        "set": settable,
        "tunable": port.tunable,
        "words": meanings(port),
        "advice": told,
    }


def _faults() -> dict[int, str]:
    """Why a line of a part program is refused, by number."""
    texts = (library().fault_text(ctypes.c_int32(k)).decode() for k in itertools.count())
    return dict(enumerate(itertools.takewhile(bool, texts)))


def _program(machine: LiveMachine) -> dict[str, Any] | None:
    """The program's file and its text, if a controller has one."""
    name = machine.scenario.document.body.signals.program
    file = None if name is None else machine.text(name)
    if name is None or not file:
        return None
    try:
        text = Path(file).read_text(encoding="utf-8-sig", errors="replace")
    except OSError:
        return None
    lines = [] if "\0" in text else text.splitlines()[:LINES_MAX]  # a job file has no lines
    tools = machine.text(f"{name.partition('.')[0]}.tool_table")
    return {"file": Path(file).name, "path": file, "tools": tools, "lines": lines}
