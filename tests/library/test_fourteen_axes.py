"""Voltage groups beside a group of pulses: every axis against its program, at every sample."""

from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import ERROR, OK, Instance
from numpy.typing import NDArray

import motionfmu

T = 1.024e-3  # [s] DDA time: the first frame begins one behind the start
TL, KP, RAMP = 1e-4, 50.0, 0.1  # [s] grid of PC and card, [1/s] position gain, [s] ramps
BELTS = np.array([30.0, -24.0, 18.0, 12.0, -6.0, 36.0])  # [mm] first line of belts.ngc
BACK = np.array([10.0, -8.0, 6.0, 4.0, -2.0, 12.0])  # [mm] and the end of the second
OTHERS = {1: "card.pulse_count", 2: "card.dac", 3: "card.dac_8"}  # what each group moves


def run(**values: Any) -> motionfmu.Result:
    settings = {f"groups.{k}": v for k, v in values.items()}
    return motionfmu.load(ROOT / "scenarios" / "fourteen_axes").run(set=settings)


@pytest.fixture(scope="module")
def together() -> motionfmu.Result:
    return run()


def share(t: NDArray[Any], length: float, feed: float) -> NDArray[Any]:
    """Part of a straight way done at times [s] behind its start: ramps of 0.1 s."""
    end, acc = length / feed + RAMP, feed / RAMP
    way = np.where(t < RAMP, acc * t**2 / 2, feed * (t - RAMP / 2))
    way = np.where(t > end - RAMP, length - acc * (end - t) ** 2 / 2, way)
    return np.clip(np.where(t > end, length, way) * (t > 0) / length, 0.0, 1.0)


def test_belts_follow_their_program_by_the_sampled_law(together: motionfmu.Result) -> None:
    """The motor x(k+1) = x(k) + Kp T (c - x)(k-3), c the two lines: within 2 um all the way."""
    t = together.time
    lengths = [np.linalg.norm(v[:3]) for v in (BELTS, BELTS - BACK)]
    first = share(t - T, lengths[0], 80.0)
    # The second line begins at the clock at which the first ends.
    second = share(t - T - lengths[0] / 80.0 - RAMP, lengths[1], 80.0)
    c = np.outer(first, BELTS) - np.outer(second, BELTS - BACK)
    x = np.zeros_like(c)
    for k in range(3, len(t) - 1):
        x[k + 1] = x[k] + KP * TL * (c[k - 3] - x[k - 3])
    assert np.abs(together["groups.card1_dac_command"] - c * 1e3).max() < 1.1  # [counts]
    assert np.abs(together["belts.table_position"] * 1e3 - x).max() < 2e-3
    assert np.abs(x).max() > 30.0


def test_a_voltage_axis_is_commanded_as_a_pulse_channel(
    together: motionfmu.Result, tmp_path: Any
) -> None:
    program = str(ROOT / "scenarios/fourteen_axes/belts.ngc")
    pulses = run(group1_program=program, group2_program="")["card.pulse_count"]
    assert np.ptp(pulses, axis=0).min() > 5000
    assert np.array_equal(together["groups.card1_dac_command"], pulses)


@pytest.mark.parametrize("group", [1, 2, 3])
def test_each_group_moves_as_it_does_alone(group: int, together: motionfmu.Result) -> None:
    alone = run(**{f"group{n}_program": "" for n in OTHERS if n != group})
    for number, signal in OTHERS.items():
        if number == group:
            assert np.array_equal(alone[signal], together[signal])
        assert alone[signal].any() == (number == group)
    assert not all(check.within for check in alone.checks)


@pytest.mark.parametrize(("plant", "axis"), [("mill", 4), ("belts", 5), ("feeders", 2)])
def test_a_check_of_each_axis_fails_if_it_stands(plant: str, axis: int) -> None:
    active = [n != axis and (plant != "feeders" or n < 3) for n in range(1, 7)]
    scenario = motionfmu.load(ROOT / "scenarios" / "fourteen_axes")
    result = scenario.run(set={f"{plant}.active": active})
    failed = {check.name for check in result.checks if not check.within}
    assert f"{plant}.table_position[{axis}]" in failed
    assert not any(name.startswith(plant) and f"[{axis}]" not in name for name in failed)


def test_an_axis_turned_round_moves_the_other_way(together: motionfmu.Result) -> None:
    turned = run(card1_dac_pos2encoder_dir=[1, 0, 0, 0, 0, 0, 0, 1])
    for signal, column in (("belts.table_position", 0), ("feeders.table_position", 1)):
        a, b = turned[signal][:, column], together[signal][:, column]
        assert np.abs(a + b).max() < 2e-6
        assert np.ptp(b) > 0.01
    assert np.array_equal(turned["card.dac"][:, 1:], together["card.dac"][:, 1:])


def test_the_following_error_of_a_voltage_axis_is_watched(together: motionfmu.Result) -> None:
    """W lags 1358 counts behind: with a limit of 1200 its group stops, the others do not."""
    result = run(card1_dac_track_error_limit=1200)
    assert result["groups.error"][-1].tolist() == [0, 0xF806, 0, 0, 0, 0]
    assert result["groups.done"][-1, :3].tolist() == [True, False, True]
    told = np.flatnonzero(result["groups.error"][:, 1])[0]
    assert told == np.flatnonzero(together["groups.card1_dac_error"][:, 5] > 1200)[0]


def start(**values: Any) -> Instance:
    """The groups before initialization, with a voltage group on DAC 7 and 8 of card 1."""
    fmu = Instance("mcc_groups", 3)
    two = {
        "group2_card": 1,
        "group2_channel": [7, 8, 0, 0, 0, 0],
        "voltage": [False, True] + [False] * 4,
    }
    for name, value in {**two, **values}.items():
        assert fmu.set(name, value) == OK, fmu.said
    return fmu


@pytest.mark.parametrize(
    ("values", "said"),
    [
        (
            {"group2_channel": [7, 7, 0, 0, 0, 0]},
            "group2_channel: no axis at all, or a DAC of card 1",
        ),
        ({"group2_channel": [0] * 6}, "group2_channel: no axis at all, or a DAC of card 1"),
        (
            {"card1_dac_encoder": [1, 2, 3, 4, 5, 6, 8, 8]},
            "(card1_dac_encoder) closes another loop",
        ),
        (
            {"card1_loop": True, "card1_dac_encoder": [1, 2, 3, 4, 5, 6, 2, 8]},
            "(card1_dac_encoder) closes another loop",
        ),
        (
            {"card1_loop": True, "group2_channel": [3, 8, 0, 0, 0, 0]},
            "card1_loop has the position loop of card 1 at a DAC that is the voltage of an axis",
        ),
        ({"group1_channel": [7, 2, 0, 0, 0, 0]}, "group1_channel: no axis at all, or a channel of"),
        (
            {"card1_dac_output": [0.0] * 7 + [2.0]},
            "card1_dac_output[8] = 2 V: the DAC is the voltage",
        ),
    ],
)
def test_what_cannot_be_at_a_dac_is_named(values: dict[str, Any], said: str) -> None:
    fmu = start(**values)
    assert ERROR in (fmu.enter(), fmu.call("ExitInitializationMode"))
    assert said in fmu.said
    fmu.free()


def test_a_dac_without_an_axis_puts_out_what_is_set() -> None:
    fmu = start(card1_dac_output=[0.0, 2.5, 0.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    assert fmu.enter() == OK and fmu.call("ExitInitializationMode") == OK
    assert fmu.get("card1_dac_volts")[1] == 2.5
    assert fmu.call("SetDebugLogging", True, 0, None) == OK
    assert fmu.set("card1_dac_output", [0.0, -1.0, 4.0, 0.0, 0.0, 0.0, 0.0, 5.0]) == OK
    for _ in range(3):
        assert fmu.step(TL) == OK
    assert fmu.get("card1_dac_volts") == [0.0, -1.0, 4.0, 0.0, 0.0, 0.0]
    assert fmu.get("card1_dac_volts_aux") == [0.0, 0.0]
    told = [text for _, _, text in fmu.messages if "card1_dac_output[8] = 5 V" in text]
    assert len(told) == 1
    fmu.free()
