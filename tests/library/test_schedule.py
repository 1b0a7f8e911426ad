"""The modules of the PC in the scenarios `schedule`: response times against the closed form."""

from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmi_tools import OK, Instance

import motionfmu

CLOCK = 25  # [ns]
NAMES = ("interpreter", "interpolation", "position control", "process control")
# Longest run and cycle [ns] of the scenario: two commands, one point, four frames.
RUN = {"interpreter": 1_200_000, "position control": 180_000, "process control": 200_000}
CYCLE = dict(zip(NAMES, (4_096_000, 1_024_000, 4_096_000, 2_048_000), strict=True))
ORDER = ("position control", "process control", "interpolation", "interpreter")


def run(name: str = "schedule", stop: float | None = None, **values: Any) -> motionfmu.Result:
    settings = {f"mcc.{k}": v for k, v in values.items()}
    return motionfmu.load(ROOT / "scenarios" / name).run(set=settings, stop=stop)


def analysis(name: str, point: int) -> int | None:
    """Joseph and Pandya 1986: R = C + sum of ceil(R / T_j) C_j; None if above the cycle. [ns]"""
    runs = {**RUN, "interpolation": 100_000 + point}
    urgent = ORDER[: ORDER.index(name)]
    r, last = runs[name], 0
    while r != last:
        last = r
        r = runs[name] + sum(-(-r // CYCLE[j]) * runs[j] for j in urgent)
        if r > CYCLE[name]:
            return None
    return r


@pytest.mark.parametrize("point", [240_000, 300_000, 321_025, 420_000, 479_000, 544_000])
def test_longest_response_is_the_closed_form_to_the_clock(point: int) -> None:
    result = run(module_unit_time=[5e-4, point * 1e-9, 3e-5, 0.0])
    for k, name in enumerate(NAMES[:2]):
        found = round(result["mcc.module_response"][-1, k] * 1e9)
        theory = analysis(name, point)
        missed = result["mcc.module_missed"][-1, k]
        assert (found, missed) == (theory, 0) if theory else found > CYCLE[name] and missed > 0
    assert result["card.pulse_count"][-1, :2].tolist() == [24000, 0]


@pytest.mark.parametrize(("name", "last"), [("interpreter", 479_000), ("interpolation", 544_000)])
def test_one_clock_more_and_the_deadline_breaks(name: str, last: int) -> None:
    missed = []
    assert analysis(name, last) == CYCLE[name] and analysis(name, last + CLOCK) is None
    for point in (last, last + CLOCK):
        result = run(module_unit_time=[5e-4, point * 1e-9, 3e-5, 0.0])
        missed.append(result["mcc.module_missed"][-1, NAMES.index(name)])
    assert missed[0] == 0 and missed[1] > 20


def test_who_runs_is_shown_clock_by_bus_period() -> None:
    """The share of the samples that show a module is its load; the more urgent one interrupts."""
    result = run()
    module, load = result["mcc.module"], result["mcc.module_load"][-1]
    for k in range(4):
        assert np.mean(module == k + 1) == pytest.approx(load[k], abs=0.01)
    assert load[4] == pytest.approx(load[:4].sum(), abs=1e-12)
    runs = result["mcc.module_runs"][-1]
    # Cycles begun up to 0.864 s and ended; position control: one service in four DDA times.
    assert runs[:4].tolist() == [211, 844, 211, 422] and runs[4] == runs[:4].sum()
    assert result["mcc.services"][-1] == runs[2] - 1  # the first run primes the FIFO
    followed = set(zip(module[:-1].tolist(), module[1:].tolist(), strict=True))
    assert {(1, 2), (1, 3)} <= followed  # the interpreter is interrupted
    assert (4, 1) not in followed and (3, 1) not in followed  # interpolation is due then too


def test_an_interpolation_that_is_too_slow_starves_the_interpreter() -> None:
    good, slow = run(), run("schedule_overload")
    finish = [r.time[np.flatnonzero(r["mcc.done"])[0]] for r in (good, slow)]
    assert 1.5 * finish[0] < finish[1]
    assert slow["mcc.starved"][-1] > 100 and good["mcc.starved"][-1] == 0
    per_second = [r["mcc.module_runs"][np.searchsorted(r.time, 0.7), 0] for r in (good, slow)]
    assert per_second[1] < per_second[0] / 5
    for result in (good, slow):
        assert result["card.pulse_count"][-1, :2].tolist() == [24000, 0]
        assert not result["card.underflows"].any()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"ipo_period": 1.024e-3}, ""),
        ({"ipo_period": 1.02405e-3}, "0.00102405 s is longer than the DDA time 0.001024 s"),
        ({"module_unit_time": [0.0, 1e-3, 0.0, 0.0]}, ""),
        ({"module_unit_time": [0.0, 1.00005e-3, 0.0, 0.0]}, "0.001 s is shorter than a run that"),
    ],
)
def test_cycle_of_the_interpolation_outside_the_rule_is_told(
    values: dict[str, Any], said: str
) -> None:
    instance = Instance("mcc", 3)
    assert instance.call("SetDebugLogging", True, 0, None) == OK
    instance.initialize(values)
    warnings = [text for _, kind, text in instance.messages if kind == "logStatusWarning"]
    assert [said in text for text in warnings] == [True] * bool(said)


def test_an_event_makes_up_for_a_slow_timer() -> None:
    """Queue of 8, cycle of 20 ms: 8 points a cycle, or more whenever the card has taken some."""
    slow = {"ipo_period": 20e-3, "queue_depth": 8, "module_units": 0}
    every, timer, event = (run(stop=2.0, **k) for k in ({}, slow, slow | {"ipo_event": True}))
    ends = [r.time[r["mcc.done"].argmax()] for r in (every, timer, event)]
    assert 1.9 * ends[0] < ends[1] and ends[0] <= ends[2] < 1.05 * ends[0]
    assert timer["mcc.starved"][-1] > 500 and event["mcc.starved"][-1] < 50
    for result in (timer, event):
        np.testing.assert_array_equal(result["card.pulse_count"][-1], every["card.pulse_count"][-1])
