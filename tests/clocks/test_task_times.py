"""The formulas of docs/theory/kernel.md against the cores' tasks, interrupts and waits."""

import math

import numpy as np
import pytest
from clock_runs import (
    BINARY,
    COMPUTE,
    END,
    GIVE,
    MARK,
    MUTEX,
    TAKE,
    UNTIL,
    CyclicRun,
    KernelRun,
    waits,
)
from task_theory import handover, longest_response, rate_monotonic_bound, share_late, tight_set

DICE = np.random.default_rng(11)


@pytest.mark.parametrize("tasks", [2, 3, 5, 8])
def test_the_bound_of_liu_and_layland_is_tight(tasks: int) -> None:
    """The set at the bound holds; a thousandth more of any time breaks it."""
    cycle, time = tight_set(tasks, 100_000)
    load = sum(c / t for c, t in zip(time, cycle, strict=True))
    assert load == pytest.approx(rate_monotonic_bound(tasks), abs=1e-4)
    run = CyclicRun(cycle, time, 2 * cycle[-1])
    assert not run.missed.any() and run.response[-1] == cycle[0]
    for i in range(tasks):
        more = [c + 100 * (i == j) for j, c in enumerate(time)]
        assert CyclicRun(cycle, more, 2 * cycle[-1]).missed.any()


def test_no_set_below_the_bound_misses() -> None:
    for _ in range(400):
        tasks = int(DICE.integers(2, 7))
        share = DICE.dirichlet(np.ones(tasks)) * rate_monotonic_bound(tasks) * 0.999
        cycle = np.sort(DICE.integers(1000, 20_000, tasks))
        time = np.maximum(np.floor(share * cycle), 1).astype(int)
        run = CyclicRun(list(cycle), list(time), int(cycle[-1]) * 10)
        assert not run.missed.any()


def test_offsets_make_no_response_longer() -> None:
    """All due together is the worst case."""
    cycle, time = [500, 1000, 2000], [120, 200, 300]
    bounds = [longest_response(cycle, time, i) for i in range(3)]
    assert (CyclicRun(cycle, time, 140_000).response == bounds).all()
    shorter = 0
    for _ in range(200):
        offset = [int(o) for o in DICE.integers(0, 500, 3)]
        found = CyclicRun(cycle, time, 140_000, offset).response
        assert (found <= bounds).all()
        shorter += bool((found < bounds).any())
    assert shorter > 0


def test_the_load_is_the_sum_of_the_shares() -> None:
    cycle, time = [50, 100, 200, 250], [10, 30, 20, 25]
    run = CyclicRun(cycle, time, 1000)
    assert (run.busy == [1000 // t * c for t, c in zip(cycle, time, strict=True)]).all()


TIMES = {"tick": 10_000, "tick_time": 150, "switch_time": 250, "entry_time": 100}


def periodic(cycle: list[int], time: list[int]) -> list[tuple[int, list[tuple[int, int]]]]:
    """Tasks of the kernel that wait for their next cycle [ticks]; a mark at each end."""
    own = zip(cycle, time, strict=True)
    return [(len(cycle) - i, [(UNTIL, t), (COMPUTE, c), (MARK, 0)]) for i, (t, c) in enumerate(own)]


def test_responses_with_the_kernels_own_times() -> None:
    """At most 2 s + C, and two switches for each preemption, and the ticks; nearly reached."""
    near = 0
    for _ in range(150):
        cycle = sorted(int(t) for t in DICE.integers(2, 30, 4))
        time = [int(DICE.integers(100, t * 10_000 * 0.28)) for t in cycle]
        clocks = [TIMES["tick"], *(t * TIMES["tick"] for t in cycle)]
        # The tick is one more task, which no switch comes with.
        use = [TIMES["tick_time"] - 2 * TIMES["switch_time"], *time]
        bounds = [
            longest_response(clocks, use, i + 1, 2 * TIMES["switch_time"], 2 * TIMES["switch_time"])
            for i in range(4)
        ]
        run = KernelRun(periodic(cycle, time), 3_000_000, **TIMES)
        for i, bound in enumerate(bounds):
            if bound < 0:
                break
            end = run.marks(i)
            due = (np.arange(len(end)) + 1) * cycle[i] * TIMES["tick"]
            assert (end - due).max() <= bound
            near += int((end - due).max() > 0.9 * bound)
    assert near > 100


def woken(phase: int, yields: bool) -> int:
    """From an interrupt, `phase` behind a tick, to the task that it wakes; another one computes."""
    tasks = [(2, [(TAKE, 0), (MARK, 0)]), (1, [(COMPUTE, 1_000_000)])]
    interrupt = [(COMPUTE, 400), (GIVE, 0), (END, int(yields))]
    run = KernelRun(tasks, 60_000, [interrupt], [(30_000 + phase, 0)], **TIMES)
    return int(run.marks(0)[0]) - 30_000 - phase


@pytest.mark.parametrize("yields", [True, False])
def test_from_an_interrupt_to_its_task(yields: bool) -> None:
    """To the clock; with a yield at most entry, own time, switch and a tick."""
    found = []
    for phase in [1, 50, 149, 150, 151, 9249, 9250, 9500, 9501, 10_000, *range(500, 9999, 173)]:
        found.append(woken(phase, yields))
        assert found[-1] == handover(phase, 400, TIMES, yields), phase
    most = 400 + TIMES["entry_time"] + TIMES["switch_time"] + TIMES["tick_time"]
    assert max(found) == most if yields else max(found) > 9_000


def shared(kind: int, lends: int, own: int, waits_from: int, between: int) -> KernelRun:
    """A low task holds a semaphore, a high one wants it, one in the middle computes."""
    tasks = [
        (1, [(TAKE, 5), (TAKE, 0), (COMPUTE, lends), (GIVE, 0), (MARK, 0)]),
        (2, [(TAKE, 6), (COMPUTE, between), (MARK, 0)]),
        (3, [(TAKE, 7), (COMPUTE, 50), (TAKE, 0), (COMPUTE, own), (GIVE, 0), (MARK, 0)]),
    ]
    give = [[(GIVE, k), (END, 1)] for k in (5, 6, 7, 0)]
    pends = [(5, 3)] * (kind == BINARY) + [(10, 0), (waits_from, 2), (waits_from + 20, 1)]
    return KernelRun(tasks, 20_000, give, pends, [kind])


def test_priority_inheritance_bounds_what_a_lock_costs() -> None:
    """The rest of the low task's section, and with a mutex nothing of the one in the middle."""
    for _ in range(100):
        lends, own, between = (int(x) for x in DICE.integers(100, 3000, 3))
        waits_from = int(DICE.integers(11, 10 + lends))
        blocked = lends - (waits_from - 10)
        for kind, more in ((MUTEX, 0), (BINARY, between)):
            end = shared(kind, lends, own, waits_from, between).marks(2)[0]
            assert end - waits_from == 50 + blocked + more + own


@pytest.mark.parametrize(("mean", "most", "rare"), [(300.0, 40_000.0, 0.02), (50.0, 3000.0, 0.5)])
def test_share_of_interrupts_that_wait_too_long(mean: float, most: float, rare: float) -> None:
    count = 200_000
    wait = waits(20.0, mean, 20.0 + most, rare, count)
    for budget in (10.0, 100.0, 700.0, 2500.0):
        share = share_late(np.array(budget), mean, most, rare)
        bound = 5.0 * math.sqrt(share * (1.0 - share) / count)
        assert (wait > 20.0 + budget).mean() == pytest.approx(
            float(share), abs=bound + 2e-3 * share
        )
