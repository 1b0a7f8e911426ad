"""Simulated time against a clock that the test turns."""

import errno
import math
import os
import sys
from typing import Any

import pytest

from motionfmu.live import Pace, machine_process


class Wall:
    """A clock that goes on only while somebody sleeps, and may wake him too late."""

    def __init__(self) -> None:
        self.now, self.late = 100.0, 0.0

    def sleep(self, seconds: float) -> None:
        self.now += seconds + self.late


@pytest.mark.parametrize("factor", [0.01, 0.5, 1.0, 100.0])
def test_so_many_seconds_pass_for_each_on_the_wall(factor: float) -> None:
    wall = Wall()
    pace = Pace(factor, lambda: wall.now, wall.sleep)
    for k in range(1001):
        pace.wait(5.0 + k * 1e-3)
    assert wall.now - 100.0 == pytest.approx(1.0 / factor, rel=1e-9)
    assert pace.lateness.woken == 1000 and pace.lateness.worst < 1e-9


def test_as_fast_as_it_goes_waits_for_nothing() -> None:
    wall = Wall()
    pace = Pace(math.inf, lambda: wall.now, wall.sleep)
    for k in range(100):
        pace.wait(k * 1.0)
    assert wall.now == 100.0 and not pace.lateness.woken


def test_lateness_does_not_add_up_and_is_counted() -> None:
    wall = Wall()
    pace = Pace(1.0, lambda: wall.now, wall.sleep)
    pace.wait(0.0)
    for k in range(1, 1001):
        wall.late = 3e-3 if k % 100 == 0 else 1e-4
        pace.wait(k * 1e-2)
    assert wall.now - 100.0 == pytest.approx(10.0 + wall.late)
    seen = pace.lateness
    assert seen.woken == 1000 and seen.worst == pytest.approx(3e-3)
    # classes end at powers of two of 1/64 ms
    assert seen.below(0.98) == pytest.approx(0.125e-3) and seen.below(0.995) == seen.worst
    assert seen.given_up == 0.0


def test_a_machine_that_was_held_up_does_not_race() -> None:
    wall = Wall()
    pace = Pace(1.0, lambda: wall.now, wall.sleep)
    pace.wait(0.0)
    wall.now += 5.0  # somebody halted the process
    pace.wait(0.01)
    begun = wall.now
    pace.wait(0.02)
    assert wall.now - begun == pytest.approx(0.01)
    assert pace.lateness.given_up == pytest.approx(4.99)


def test_a_pause_is_no_lateness() -> None:
    wall = Wall()
    pace = Pace(1.0, lambda: wall.now, wall.sleep)
    pace.wait(0.0)
    pace.halt()
    wall.now += 60.0
    pace.wait(0.01)
    pace.wait(0.02)
    assert pace.lateness.worst < 1e-9 and wall.now == pytest.approx(160.01)


@pytest.mark.parametrize("factor", [0.0, 0.001, 101.0, -1.0, math.nan])
def test_paces_that_are_none_are_refused(factor: float) -> None:
    pace = Pace()
    with pytest.raises(ValueError, match=r"0\.01 to 100, or inf"):
        pace.set(factor)
    assert pace.factor == 1.0


@pytest.mark.skipif(sys.platform != "linux", reason="SCHED_FIFO is Linux's")
def test_a_machine_that_may_not_run_before_others_says_what_it_takes(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    def refused(pid: int, policy: int, priority: Any) -> None:
        raise PermissionError(errno.EPERM, "")

    asked = []
    monkeypatch.setattr(machine_process.os, "sched_setscheduler", lambda *a: asked.append(a[:2]))
    assert not machine_process.before_others() and asked == [(0, os.SCHED_FIFO)]
    monkeypatch.setattr(machine_process.os, "sched_setscheduler", refused)
    told = machine_process.before_others()
    assert told.startswith("Operation not permitted: it takes root") and "rtprio 49" in told
