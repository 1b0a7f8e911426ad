"""A robot's page shows how far the tool is from its command, whatever the scenario names."""

import json
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT

from motionfmu import load, scenario
from motionfmu.run.tool_gap import tool_gaps
from motionfmu.scenarios.tool_signals import tools

LINE = ROOT / "scenarios/robot_line"
SAID = {
    "arm.tool_position",
    "arm.tool_quaternion",
    "soft.tool_position",
    "soft.tool_quaternion",
    "soft.base_place",
}


def chain(record: list[str], stop: float = 0.3, **set_: object):
    """The chain of robot_line that records what is given."""
    line = load(LINE).document.body
    given = dict(line.set) | {k.replace("__", "."): v for k, v in set_.items()}
    tables = {
        "stop": stop,
        "step": 5e-5,
        "leave": [*line.leave],
        "component": dict(line.component),
        "connect": dict(line.connect),
        "set": given,
        "record": {"signals": record, "every": 20},
    }
    return scenario(tables, folder=LINE)


def turned(quaternions: np.ndarray) -> np.ndarray:
    """Rotation matrices (n, 3, 3) of w, x, y, z."""
    w, x, y, z = quaternions.T
    rows = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)],
    ]
    return np.moveaxis(np.array(rows), -1, 0)


def test_it_is_recorded_and_shown_unasked(tmp_path: Path) -> None:
    start = [-17.81888891, 53.17802569, -26.09704043, 0.0, 62.91901474, -17.81888891]
    moved = [*start[:4], start[4] + 3.0, start[5] - 200.0]
    run = chain(["soft.done"], arm__start_joint=moved).run()
    assert run.signals.keys() == SAID | {"soft.done", "arm.link_angle"}
    (tool,) = tool_gaps(run)
    gap = 1e3 * (run["arm.tool_position"] - run["soft.tool_position"])
    distance = np.sqrt((gap**2).sum(axis=1))
    turn = turned(run["arm.tool_quaternion"]).transpose(0, 2, 1) @ turned(
        run["soft.tool_quaternion"]
    )
    angle = np.degrees(np.arccos(np.clip((np.trace(turn, axis1=1, axis2=2) - 1.0) / 2.0, -1, 1)))
    n = len(run.time)
    assert tool.distance(0, n) == pytest.approx(distance, abs=1e-9)
    assert tool.angle(0, n) == pytest.approx(angle, abs=1e-5)
    assert angle.max() > 120.0 and distance.max() > 5.0
    # As started, and in the folder and the page.
    assert angle[0] == pytest.approx(160.0, abs=0.2)
    page = run.save(tmp_path / "out").read_text()
    assert "<h2>Tool against command</h2>" in page
    (told,) = json.loads((tmp_path / "out/result.json").read_text())["tools"]
    assert (told["command"], told["actual"]) == ("soft.tool_position", "arm.tool_position")
    sizes = {"distance": distance, "angle": angle}
    for name, values in sizes.items():
        assert told[name]["max"] == pytest.approx(values.max(), abs=1e-5)
        assert told[name]["at"] == pytest.approx(run.time[np.argmax(values)], abs=1e-12)
        assert told[name]["rms"] == pytest.approx(np.sqrt((values**2).mean()), abs=1e-5)


def test_each_arm_has_its_own_controller() -> None:
    line = load(LINE).document.body

    def twice(name: str) -> tuple[str, str]:
        part, dot, rest = name.partition(".")
        return part + dot + rest, part + "2" + dot + rest

    wires = line.connect.items()
    connect = {a: b for p, q in wires for a, b in zip(twice(p), twice(q), strict=True)}
    tables = {
        "stop": 0.01,
        "step": 5e-5,
        "leave": [n for name in line.leave for n in twice(name)],
        "component": {n: f for c, f in line.component.items() for n in twice(c)},
        "connect": connect,
        "record": {"signals": ["soft.done"]},
    }
    found = tools(scenario(tables, folder=LINE).resolver)
    assert [tool.position for tool in found] == [
        ("soft.tool_position", "arm.tool_position"),
        ("soft2.tool_position", "arm2.tool_position"),
    ]
    assert [tool.attitude for tool in found] == [
        ("soft.tool_quaternion", "arm.tool_quaternion"),
        ("soft2.tool_quaternion", "arm2.tool_quaternion"),
    ]


def test_a_controller_without_an_arm_has_no_such_section(tmp_path: Path) -> None:
    run = load(ROOT / "scenarios/robot_jog").run(stop=0.05)
    assert tools(run.resolver) == [] == tool_gaps(run)
    assert "Tool against command" not in run.save(tmp_path / "out").read_text()
