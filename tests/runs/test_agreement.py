"""FMUs that describe the same machine and do not agree: told before the run, with both values."""

import math
from collections.abc import Sequence
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import ROOT
from typer.testing import CliRunner

from motionfmu import load, scenario
from motionfmu.base.errors import InputError
from motionfmu.base.units import parse
from motionfmu.cli import app
from motionfmu.fmu import fmu_toml
from motionfmu.run import Scenario
from motionfmu.scenarios import agreement, fmus
from motionfmu.scenarios.agreement import quantities
from motionfmu.scenarios.values import start_values

LINE = ROOT / "scenarios/robot_line"
# Each quantity of which controller, drives or arm could be told another value.
OTHER = {
    "arm.a1": (0.2, "soft.a1 = 0.15 m but arm.a1 = 0.2 m: both mean arm.a1"),
    "arm.joint_sign": (
        [1, 1, -1, 1, 1, 1],
        "soft.joint_sign[3] = 1 but arm.joint_sign[3] = -1: both mean arm.joint_sign",
    ),
    "arm.joint_offset": (
        [0, 0, -90, 0, 0, 5],
        "soft.joint_offset[6] = 0° but arm.joint_offset[6] = 5°: both mean arm.joint_offset",
    ),
    "soft.gear_ratio": (
        [100, 120, 121, 100, 100, 80],
        "soft.gear_ratio[3] = 121 but arm.gear_ratio[3] = 120: both mean arm.gear_ratio",
    ),
    "drives.pulses_per_turn": (
        10000,
        "soft.pulses_per_turn[1] = 2500 but drives.pulses_per_turn[1] = 10000 and 5 more of its"
        " elements: both mean motor.pulses",
    ),
}


def own(**set_: object) -> Scenario:
    """The chain of robot_line with the values of its own, and the rest as the FMUs have it."""
    line = load(LINE).document.body
    given = {k.replace("__", "."): v for k, v in set_.items()}
    return scenario(
        {
            "stop": 0.01,
            "step": 5e-5,
            "leave": [*line.leave],
            "component": dict(line.component),
            "connect": dict(line.connect),
            "set": {"drives.mode": 1, "drives.pulses_per_turn": 2500} | given,
            "record": {"signals": ["arm.tool_position"]},
        },
        folder=LINE,
    )


def apart(warnings: Sequence[str]) -> list[str]:
    """Those of them that are about values that two FMUs have."""
    return [w for w in warnings if "both mean" in w]


def test_an_arm_and_its_controller_start_alike_by_default() -> None:
    assert own().disagreements({}) == [] == apart(own().run().warnings)


def test_another_start_is_told_with_both_values() -> None:
    (told,) = apart(own(arm__start_joint=[0.0, 0.0, 0.0, 0.0, 0.0, 0.0]).run().warnings)
    assert told == (
        "soft.start_joint[5] = 90° but arm.start_joint[5] = 0°: both mean arm.start"
    )  # 231 mm beside the command
    told = own().disagreements({"arm.start_joint": [1.0, 2.0, 0.0, 0.0, 90.0, 0.0]})
    assert told == [
        "soft.start_joint[1] = 0° but arm.start_joint[1] = 1° and 1 more of its elements: both"
        " mean arm.start"
    ]
    # Closer than a machine repeats is alike; a thousandth of a degree, 25 um at the tool, is not.
    assert own().disagreements({"arm.start_joint": [1e-5, 0.0, 0.0, 0.0, 90.0, 0.0]}) == []
    assert len(own().disagreements({"arm.start_joint": [1e-3, 0.0, 0.0, 0.0, 90.0, 0.0]})) == 1


@pytest.mark.parametrize("name", OTHER)
def test_every_quantity_is_compared(name: str) -> None:
    value, told = OTHER[name]
    assert load(LINE).disagreements({name: value}) == [told]


def test_it_is_told_before_the_run_and_once(tmp_path: Path) -> None:
    given = ["--set", "arm.c3=0.8", "--stop", "0.01", "--out", str(tmp_path / "out")]
    shown = CliRunner().invoke(app, ["run", str(LINE), *given]).output
    told = "soft.c3 = 0.795 m but arm.c3 = 0.8 m: both mean arm.c3"
    plain = " ".join(shown.split())
    assert plain.count(told) == 1
    assert plain.index(told) < plain.index("found asked")


def test_what_an_arm_cannot_have_is_told() -> None:
    """A palletizer's controller before an arm whose links no linkage keeps level."""
    line = load(LINE).document.body
    tables = {
        "stop": 0.01,
        "step": 5e-5,
        "leave": [*line.leave],
        "component": {**line.component, "arm": "axes_arm"},
        "connect": dict(line.connect),
        "set": {"drives.mode": 1, "drives.pulses_per_turn": 2500, "soft.arm_by": 1},
        "record": {"signals": ["arm.tool_position"]},
    }
    plain = scenario(tables, folder=LINE)
    assert not [w for w in plain.disagreements({}) if "level" in w or "hand" in w]
    given = {"soft.joint_level": [0, 0, 0, 2, 0, 0], "soft.hand_offset": [0.2, 0, -0.1]}
    told = [w for w in plain.disagreements(given) if "level" in w or "hand" in w]
    assert told == [
        "soft.joint_level[4] = 2 but arm.joint_level[4] = 0: both mean arm.joint_level",
        "soft.hand_offset[1] = 0.2 m but arm.hand_offset[1] = 0 m and 1 more of its elements:"
        " both mean arm.hand_offset",
    ]


def test_robots_side_by_side_are_compared_with_their_own() -> None:
    """Two chains in a scenario: each arm with the controller whose wires reach it."""
    line = load(LINE).document.body

    def twice(name: str) -> tuple[str, str]:
        part, dot, rest = name.partition(".")
        return part + dot + rest, part + "2" + dot + rest

    connect = {
        a: b
        for left, right in line.connect.items()
        for a, b in zip(twice(left), twice(right), strict=True)
    }
    tables = {
        "stop": 0.01,
        "step": 5e-5,
        "leave": [n for name in line.leave for n in twice(name)],
        "component": {n: f for c, f in line.component.items() for n in twice(c)},
        "connect": connect,
        "set": {"drives.pulses_per_turn": 2500, "drives2.pulses_per_turn": 2500},
        "record": {"signals": ["arm.tool_position"]},
    }
    both = scenario(tables, folder=LINE)
    assert both.disagreements({}) == []
    pose = [0.0, 10.0, 0.0, 0.0, 80.0, 0.0]
    assert both.disagreements({"soft2.start_joint": pose, "arm2.start_joint": pose}) == []
    (told,) = both.disagreements({"soft2.c1": 0.5})
    assert told == "soft2.c1 = 0.5 m but arm2.c1 = 0.445 m: both mean arm.c1"


def system(wires: str, **said: str) -> SimpleNamespace:
    """Components by name, the first letter of which is their FMU; `said` sets their values."""
    pairs = [wire.split(">") for wire in wires.split()]
    made = [SimpleNamespace(component=c) for pair in pairs for c in pair]
    return SimpleNamespace(
        components={c: c[0] for pair in pairs for c in pair},
        wires=[
            SimpleNamespace(source=a, target=b) for a, b in zip(made[::2], made[1::2], strict=True)
        ],
        settings=[
            SimpleNamespace(end=SimpleNamespace(name=f"{c}.x"), values=v.split(","))
            for c, v in said.items()
        ],
    )


# FMU by its letter: what its x is; i knows nothing of it, f alone has 1.5 m.
PORTS = {
    "p": SimpleNamespace(causality="parameter", count=1, shape=(), unit="m", start=[1.0]),
    "q": SimpleNamespace(causality="parameter", count=1, shape=(), unit="mm", start=[1000.0]),
    "r": SimpleNamespace(causality="parameter", count=2, shape=(2,), unit="m", start=[1.0]),
    "s": SimpleNamespace(causality="parameter", count=2, shape=(2,), unit="mm", start=[1000.0]),
    "f": SimpleNamespace(),
    "i": SimpleNamespace(causality="parameter", count=1, shape=(), unit="", start=[7.0]),
}


@pytest.mark.parametrize(
    ("wired", "told"),
    [
        (system("p1>q1"), []),
        (system("p1>q1", q1="1001"), ["p1.x = 1 m but q1.x = 1001 mm: both mean t.x"]),
        (system("p1>q1", p1="2", q1="2000"), []),
        (system("q1>p1", p1="2"), ["q1.x = 1000 mm but p1.x = 2 m: both mean t.x"]),
        # Through one that does not know it, and in a circle once.
        (system("p1>i1 i1>q1", q1="5"), ["p1.x = 1 m but q1.x = 5 mm: both mean t.x"]),
        (system("p1>q1 q1>p1", q1="5"), ["p1.x = 1 m but q1.x = 5 mm: both mean t.x"]),
        # Not beyond one that knows it, nor with one of the same kind.
        (system("p1>q1 q1>s1", s1="1000,5"), ["q1.x has 1 elements, s1.x has 2: both mean t.x"]),
        (system("p1>p2", p2="5"), []),
        (system("p1>i1 p2>i2", p2="5"), []),
        # A value that is no variable, in SI.
        (system("f1>q1", q1="1500"), []),
        (system("f1>f2"), []),
        (
            system("s1>f1"),
            ["s1.x[1] = 1000 mm but f1.x[1] = 1500 mm and 1 more of its elements: both mean t.x"],
        ),
        # One value is that of each element.
        (system("r1>s1"), []),
        (system("r1>s1", s1="1000,3"), ["r1.x[2] = 1 m but s1.x[2] = 3 mm: both mean t.x"]),
        (
            system("r1>s1", r1="2"),
            ["r1.x[1] = 2 m but s1.x[1] = 1000 mm and 1 more of its elements: both mean t.x"],
        ),
    ],
)
def test_who_is_compared_with_whom(wired, told: list[str], monkeypatch) -> None:
    stated = {"i": {}, "f": {"t.x": 1.5}}
    monkeypatch.setattr(agreement, "_stated", lambda fmu: stated.get(fmu, {"t.x": "x"}))
    monkeypatch.setattr(agreement.fmus, "ports", lambda fmu: {"x": PORTS[fmu]})
    monkeypatch.setattr(agreement, "start_values", lambda port: port.start)
    assert agreement.warnings(wired) == told


def test_defaults_of_all_fmus_agree_on_the_arm() -> None:
    """Any two FMUs that describe an arm, in SI."""
    said: dict[str, list[list[float]]] = {}
    for fmu in fmus.fmu_names():
        for quantity, name in quantities(fmu).items():
            port = fmus.ports(fmu)[name]
            if port.causality != "parameter":
                continue
            factor = parse(port.unit or "1").factor
            values = [factor * float(x) for x in start_values(port)]
            values = values * port.count if len(values) == 1 else values
            said.setdefault(quantity, []).append(values)
    # A controller by lengths has its axes at 0; an arm by its axes no lengths.
    arm = {q: v for q, v in said.items() if q.startswith("arm.") and ".axis_" not in q}
    assert len(arm) == 15 and all(2 <= len(v) <= 4 for v in arm.values())
    assert len(arm["arm.start"]) == 4
    for quantity, (one, *others) in arm.items():
        for other in others:
            assert one == pytest.approx(other, rel=1e-12, abs=1e-12), quantity
    assert said["arm.start"][0][4] == pytest.approx(math.pi / 2)


def test_a_wrong_table_is_told_with_its_line() -> None:
    text = (ROOT / "fmus/soft_controller/fmu.toml").read_text()
    line = text[: text.index("[agree.motor]")].count("\n") + 1
    wrong = text.replace('pulses       = "pulses_per_turn"', 'pulses = "pulses_per_turns"')
    with pytest.raises(InputError) as error:
        fmu_toml.parse(wrong, "fmu.toml")
    assert error.value.args == (
        f"fmu.toml:{line}: agree motor: pulses = 'pulses_per_turns': no such numeric parameter or"
        " output; did you mean 'pulses_per_turn'?",
    )
