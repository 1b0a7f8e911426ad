"""Every FMU at the ends of its parameters and inputs: numbers on all outputs, or one message."""

import math
from typing import Any

import pytest
from conftest import ROOT
from few_cases import few
from fmi_tools import ERROR, OK, Instance, unpacked

NAMES = sorted(t.parent.name for t in (ROOT / "fmus").glob("*/fmu.toml"))
HUGE = 1e308
STEP = 1e-3  # [s]


def ends(variable: Any) -> list[float]:
    """The bounds of a variable, or as far as a number goes, and what is nearly nothing."""
    least = -HUGE if variable.min is None else variable.min
    most = HUGE if variable.max is None else variable.max
    if variable.type == "i32":
        return [max(least, -(2**31)), min(most, 2**31 - 1)]
    return [least, most, *(x for x in (-1e20, 1e-300, 1e20) if least <= x <= most)]


def odd(fmu: Instance) -> list[str]:
    """Outputs that are no numbers."""
    real = [n for n, v in fmu.variables.items() if (v.causality, v.type) == ("output", "f64")]
    return [n for n in real if not all(map(math.isfinite, fmu.get(n)))]


def told(fmu: Instance) -> str | None:
    """The message of the call that was refused among a start and some steps; None: all OK."""
    if (fmu.enter() or fmu.call("ExitInitializationMode")) == OK:
        assert odd(fmu) == []
        while fmu.step(STEP) == OK:
            assert odd(fmu) == []
            if fmu.time > 4.5 * STEP:
                return None
    texts = [text for status, _, text in fmu.messages if status == ERROR]
    assert len(texts) == 1, fmu.messages
    return texts[0]


@pytest.mark.parametrize("name", few(NAMES[::-1], 2))
def test_an_output_is_a_number_or_the_call_says_why_not(name: str) -> None:
    for key, v in unpacked(name, 3)[2].items():
        if v.type not in ("f64", "i32") or v.causality not in ("parameter", "input"):
            continue
        for value in ends(v):
            fmu = Instance(name, 3)
            assert fmu.set(key, int(value) if v.type == "i32" else value) == OK, fmu.said
            try:
                told(fmu)
            except AssertionError as error:
                raise AssertionError(f"{key} = {value:g}: {error}") from None
            fmu.free()


# Set before the start or after a step; the time of the message is that of the first odd output.
CASES = [
    ("hydraulic_axis", "scale_offset", 0, "axis 1: table_phase is -inf at 0.000000000 s"),
    ("hydraulic_axis", "valve_leakage", 0, "axis 1: flow_a is nan at 0.000000000 s"),
    ("velocity_axes", "voltage", 0, "axis 1: motor_speed is inf at 0.000000000 s"),
    ("velocity_axes", "voltage", 1, "axis 1: motor_angle is inf at 0.002000000 s"),
    ("ball_screw_axes", "lead_error_amplitude", 0, "axis 1: table_speed is nan at 0.000000000 s"),
]


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize(("name", "key", "steps", "message"), CASES)
def test_the_output_that_is_no_number_is_named(
    name: str, key: str, steps: int, message: str, fmi: int
) -> None:
    fmu = Instance(name, fmi)
    if steps:
        assert (fmu.enter() or fmu.call("ExitInitializationMode") or fmu.step(STEP)) == OK
    assert fmu.set(key, HUGE) == OK, fmu.said
    text = told(fmu) if not steps else fmu.said if fmu.step(STEP) == ERROR else ""
    assert str(text).removeprefix("one: ") == message
    fmu.free()
