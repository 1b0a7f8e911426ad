"""Formulas of docs/theory/kernel.md: response times, bounds of the load, waits of interrupts."""

from collections.abc import Mapping, Sequence

import numpy as np


def longest_response(
    cycle: Sequence[int], time: Sequence[int], task: int, more: int = 0, switch: int = 0
) -> int:
    """Joseph and Pandya's R of a task, the most urgent first; -1 if it is longer than the cycle.

    Parameters
    ----------
    cycle, time : sequence of int
        Of all tasks.
    task : int
        Whose response.
    more, switch : int
        Blocking; what a preemption takes beside the time of the task that preempts.
    """
    own = time[task] + more
    r = own
    while r <= cycle[task]:
        rest = sum(-(-r // cycle[j]) * (time[j] + switch) for j in range(task))
        if own + rest == r:
            return r
        r = own + rest
    return -1


def rate_monotonic_bound(tasks: int) -> float:
    """Load up to which tasks with rate monotonic priorities hold whatever their cycles."""
    return float(tasks * (2.0 ** (1.0 / tasks) - 1.0))


def tight_set(tasks: int, scale: int) -> tuple[list[int], list[int]]:
    """Cycles and times of a set that only just holds at that bound."""
    cycle = [round(scale * 2.0 ** (i / tasks)) for i in range(tasks)]
    time = [b - a for a, b in zip(cycle, [*cycle[1:], 2 * cycle[0]], strict=True)]
    return cycle, time


def share_late(budget: np.ndarray, mean: float, most: float, rare: float) -> np.ndarray:
    """Probability that an interrupt waits more than its least time and `budget`."""
    return (1.0 - rare) * np.exp(-budget / mean) + rare * np.clip(1.0 - budget / most, 0.0, None)


def handover(phase: int, own: int, times: Mapping[str, int], yields: bool) -> int:
    """From an interrupt, `phase` > 0 behind a tick, to the first step of the task that it wakes.

    Parameters
    ----------
    phase, own : int
        Up to a tick's period; time of the interrupt before it ends.
    times : mapping
        The kernel's `tick`, `tick_time`, `switch_time` and `entry_time`.
    yields : bool
        The interrupt ends with a yield; else the kernel chooses at the next tick.
    """
    busy, switch = times["tick_time"], times["switch_time"]
    done = max(phase, busy) + times["entry_time"] + own
    if yields:
        end = done + switch
        return end + busy * (end >= times["tick"]) - phase
    return max(done, times["tick"]) + busy + switch - phase
