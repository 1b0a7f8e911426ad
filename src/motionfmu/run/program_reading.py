"""What a machine says of the part programs that it reads, for a look at one without a run."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.gcode.program import text_in
from motionfmu.base.errors import InputError
from motionfmu.run.machine_program import Machine
from motionfmu.run.run_plan import Options
from motionfmu.scenarios.values import values_in

# Parameters of a controller that are settings of the reader, under the same name or another.
SAME = tuple(
    "max_feed feed acc_time dec_time axis_acc axis_jerk arc_tolerance least_increment fanuc "
    "strict_feed block_delete optional_stop".split()
)


def reading_on(name: str, set: Mapping[str, Any]) -> tuple[dict[str, Any], str]:
    """Settings of `motionfmu.analysis.gcode.read` and the tool table of a machine with values."""
    machine = Machine(name)
    plan = machine.plan()
    document = plan.document
    component = (document.body.signals.program or "").partition(".")[0]
    ports = plan.resolver.ports.get(component, {})
    if not {*SAME, "max_rpm", "tool_table"} <= ports.keys():
        raise InputError(f"{machine.file}: it reads no part programs")
    given = {s.end.name: s.values for s in plan.resolved(Options(set=set)).settings}

    def value(key: str) -> Any:
        values = values_in(given, component, ports[key])
        return np.array(values) if ports[key].shape else values[0]

    gear = value("lead") / value("gear_ratio")  # [mm] a motor turn
    s_shaped = [value(key) == "S" for key in ("acc_type", "dec_type")]
    shares = [value("jerk_share") if s else 0.0 for s in s_shaped]
    settings = {key: value(key) for key in SAME}
    settings |= {"axes": value("active"), "used": value("active"), "scale": value("ppr") / gear}
    settings |= {"speed": value("max_rpm") / 60.0 * gear, "bounded": value("check_over_travel")}
    settings |= {"low": value("low_limit") + abs(value("lot_offset"))}
    settings |= {"high": value("high_limit") - abs(value("hot_offset"))}
    settings |= {"axis_speed": settings["speed"] * value("active")}
    settings |= {"acc_share": shares[0], "dec_share": shares[1]}
    # As the library makes the ramps of a chain S-shaped.
    times = (settings["acc_time"], settings["dec_time"])
    settings |= {"smooth": 0.5 * sum(s * t for s, t in zip(shares, times, strict=True))}
    settings |= {"angles": value("rotary_names"), "change_stops": value("tool_change") == "stop"}
    tools = str(value("tool_table"))
    return settings, text_in(Path(document.beside(tools) or tools)) if tools else ""
