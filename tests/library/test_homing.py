"""Homing of ball-screw axes: from wherever they start, the same place of the machine."""

from typing import Any

import numpy as np
from conftest import ROOT

import motionfmu

COUNT = 1e-6  # [m] table travel of an encoder count
INDEX = 10e-3  # [m] between two index marks; one is at 0
SWITCH = -0.0537  # [m] the home switch is on from here downwards
LIMIT = -0.07  # [m]
OFFSET = 5.0  # [mm] from the place found to the origin
STARTS = np.array([0.03, 0.012345, -0.0300004, -0.0536, -0.0538, -0.0571])  # [m]


def run(stop: float, **settings: Any) -> motionfmu.Result:
    """Six axes search at once, without a program; times in s."""
    everywhere = {f"{c}.active": True for c in ("mcc", "card", "drives", "machine")}
    values = everywhere | {
        "mcc.program": "",
        "mcc.home_order": 1,
        "machine.start_position": STARTS.tolist(),
        "machine.home_position": SWITCH,
    }
    values |= {k.replace("__", "."): v for k, v in settings.items()}
    return motionfmu.load(ROOT / "scenarios" / "homing").run(set=values, stop=stop)


def origins(result: motionfmu.Result) -> np.ndarray:
    """Table positions at the end [m], at rest at the origin."""
    assert result["mcc.homed"][-1] and result["mcc.done"][-1]
    assert not result["mcc.error"].any() and not result["drives.alarm"].any()
    assert np.array_equal(result["mcc.position"][-1], np.zeros(6))
    table = result["machine.table_position"]
    assert np.ptp(table[-1000:], axis=0).max() < COUNT  # it stands
    return table[-1]


def test_index_behind_the_switch_from_many_starts() -> None:
    found = np.concatenate(
        [
            origins(run(9.0)),
            origins(run(9.0, machine__start_position=(STARTS * 0.9 - 2.22e-3).tolist())),
        ]
    )
    assert np.ptp(found) < COUNT
    mark = np.ceil(SWITCH / INDEX) * INDEX
    assert np.abs(found - (mark + OFFSET * 1e-3)).max() < 2 * COUNT  # with the screw's wind-up


def test_level_at_which_the_index_is_on() -> None:
    """The index is one count wide and met upwards: ON when low it begins a count later. An encoder
    that shows it low, told to the library so, is found where the other one is."""
    high = origins(run(9.0))
    low = origins(run(9.0, mcc__index_on=False))
    inverted = origins(run(9.0, mcc__index_on=False, card__enc_wiring=8))
    np.testing.assert_allclose(low - high, COUNT, rtol=0, atol=0.1 * COUNT)
    np.testing.assert_array_equal(inverted, high)


def test_switch_alone_repeats_as_well_as_it_is_sampled() -> None:
    found = origins(run(7.0, mcc__home_mode=1))
    # Sampled by the card every 0.1 ms: 0.4 um at 4 mm/s, so the edge lies between two counts.
    assert np.ptp(found) < 2 * COUNT
    assert np.abs(found - (SWITCH + OFFSET * 1e-3)).max() < 3 * COUNT


def test_limit_switch_and_index() -> None:
    found = origins(run(9.0, mcc__home_mode=3, machine__lower_limit_position=-0.0665))
    assert np.ptp(found) < COUNT
    assert np.abs(found - (-0.06 + OFFSET * 1e-3)).max() < 2 * COUNT


def test_a_switch_that_is_not_there_is_told() -> None:
    result = run(4.0, mcc__home_search=20.0)
    assert not result["mcc.homed"].any() and not result["mcc.done"][-1]
    assert result["mcc.error"][-1] & ~0xF == 0xF710  # which axis is first depends on the starts
    speed = np.diff(result["machine.table_position"][-500:], axis=0) / 1e-4
    assert np.abs(speed).max() < 1e-4  # all have come to rest
