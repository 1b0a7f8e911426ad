"""Pulses, counts and stock of a card, and times of tasks, by the cores of the FMUs."""

import ctypes
import os
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
# enum step_what of tests/clocks/clock_batch.c.
COMPUTE, TAKE, GIVE, MARK, UNTIL, END = range(6)
# enum kernel_what and enum kernel_kind of kernel.h.
RUNS, INTERRUPT, GIVEN, FULL, TAKEN, PRIORITY, MARKED = range(7)
BINARY, COUNTING, MUTEX = range(3)
TASKS, INTERRUPTS, QUEUES, STEPS, CYCLIC_TASKS = 15, 12, 16, 8, 8
CYCLIC = np.dtype(
    [("tasks", np.int32), ("priority", np.int32, CYCLIC_TASKS)]
    + [(name, np.int64, CYCLIC_TASKS) for name in ("cycle", "offset")],
    align=True,
)
KERNEL = np.dtype(
    [("tasks", np.int32), ("priority", np.int32, TASKS), ("level", np.int32, INTERRUPTS)]
    + [("kernel_level", np.int32)]
    + [(name, np.int64) for name in ("tick", "tick_time", "switch_time", "entry_time")]
    + [("queue", np.int32, (QUEUES, 3))],
    align=True,
)
EVENT = np.dtype(
    [("clock", np.int64), ("what", np.int32), ("number", np.int32), ("value", np.int32)],
    align=True,
)

LIBRARY = ctypes.CDLL(os.environ.get("CLOCK_BATCH", str(ROOT / "build/lib/clock_batch.so")))
_I32, _I64 = (np.ctypeslib.ndpointer(t, flags="C_CONTIGUOUS") for t in (np.int32, np.int64))
_INT32, _INT64, _DOUBLE = ctypes.c_int32, ctypes.c_int64, ctypes.c_double
LIBRARY.clock_batch_ticks.argtypes = [_INT32, _INT32, _I32]
LIBRARY.clock_batch_slot.argtypes = [_INT32, _INT32, _I32]
LIBRARY.clock_batch_counts.argtypes = [_INT32, _DOUBLE, _DOUBLE, _INT64, _I32]
LIBRARY.clock_batch_stock.argtypes = [_INT32, _INT32, _INT64, _INT64, _INT64, _I32]
LIBRARY.clock_batch_waits.argtypes = [*[_DOUBLE] * 4, ctypes.c_uint64, _INT64, _I64]
LIBRARY.clock_batch_cyclic.argtypes = [
    np.ctypeslib.ndpointer(CYCLIC, flags="C_CONTIGUOUS"),
    _I64, _INT64, _INT64, _I64, _I64, _I64, _I32,
]  # fmt: skip
LIBRARY.clock_batch_kernel.argtypes = [
    np.ctypeslib.ndpointer(KERNEL, flags="C_CONTIGUOUS"),
    _I32, _I64, _INT64, _I64, _I32, _INT64, _INT64,
    np.ctypeslib.ndpointer(EVENT, flags="C_CONTIGUOUS"),
    _I64,
]  # fmt: skip
for each in (LIBRARY.clock_batch_counts, LIBRARY.clock_batch_stock, LIBRARY.clock_batch_kernel):
    each.restype = ctypes.c_int64


def pulse_ticks(command: int, ticks: int) -> np.ndarray:
    """Tick of each pulse of a command > 0 within its DDA time."""
    tick = np.zeros(command, np.int32)
    LIBRARY.clock_batch_ticks(command, ticks, tick)
    return tick


def slot_clocks(pulses: int, slot: int) -> np.ndarray:
    """Clock of each pulse in a slot of the FPGA card."""
    clock = np.zeros(pulses, np.int32)
    LIBRARY.clock_batch_slot(pulses, slot, clock)
    return clock


def played(
    speed: float, period: int, count: int, spread: Callable[[int], np.ndarray]
) -> np.ndarray:
    """Clock of each pulse of a uniform motion, in periods that get whole pulses each.

    Parameters
    ----------
    speed : float
        [pulses/clock]
    period, count : int
        Clocks of a period; number of periods.
    spread : callable
        Clocks within a period of so many pulses.
    """
    place = np.floor(speed * period * np.arange(count + 1) + 0.5).astype(int)
    parts = [k * period + spread(n) for k, n in enumerate(np.diff(place)) if n > 0]
    return np.concatenate(parts) if parts else np.zeros(0)


# Clocks of a period that gets whole pulses, clocks of a tick within it, and where its pulses lie.
CARDS: dict[str, tuple[int, int, Callable[[int], np.ndarray]]] = {
    "EPCIO": (40_960, 10, lambda n: 10 * pulse_ticks(n, 4096)),
    "FPGA card": (200, 1, lambda n: slot_clocks(n, 200)),
    "network card": (50_000, 1, lambda n: pulse_ticks(n, 50_000)),
}


def lateness(share: float) -> float:
    """Most that a pulse of a uniform motion is early or late [pulses], of the pulses a period."""
    n = int(share)
    part = share - n
    after = (1.0 - part) / (n + 1)
    return 0.5 - 0.5 * (min(part / n, after) if n else after)


def counted(start: float, end: float, clocks: int, filter_clocks: int) -> tuple[int, bool]:
    """Counts of an encoder that turns from start to end [line periods]; whether edges were lost."""
    too_fast = np.zeros(1, np.int32)
    counts = LIBRARY.clock_batch_counts(filter_clocks, start, end, clocks, too_fast)
    return counts, bool(too_fast[0])


def stock(minimum: int, batch: int, late: float, boundaries: int) -> tuple[np.ndarray, int]:
    """Stock behind each boundary, and how many found none; `late` in DDA times of 1000 clocks."""
    found = np.zeros(boundaries, np.int32)
    dry = LIBRARY.clock_batch_stock(minimum, batch, 1000, round(1000 * late), boundaries, found)
    return found, dry


def waits(least: float, mean: float, most: float, rare: float, count: int) -> np.ndarray:
    """Random waits of interrupts [clocks]."""
    wait = np.zeros(count, np.int64)
    LIBRARY.clock_batch_waits(least, mean, most, rare, 1, count, wait)
    return wait


class CyclicRun:
    """Tasks with a cycle each, the most urgent first, from their first run on."""

    def __init__(
        self,
        cycle: Sequence[int],
        time: Sequence[int],
        until: int,
        offset: Sequence[int] = (),
        seen: int = 0,
    ) -> None:
        n = len(cycle)
        config = np.zeros(1, CYCLIC)
        config["tasks"] = n
        config["priority"][0, :n] = np.arange(n)
        config["cycle"][0, :n] = cycle
        config["offset"][0, : len(offset)] = offset
        self.response, self.missed, self.busy = (np.zeros(n, np.int64) for _ in range(3))
        self.running = np.zeros(max(seen, 1), np.int32)
        LIBRARY.clock_batch_cyclic(
            config, np.array(time, np.int64), until, seen,
            self.response, self.missed, self.busy, self.running,
        )  # fmt: skip


class KernelRun:
    """Tasks and interrupts of the kernel, which repeat their steps (what, value)."""

    def __init__(
        self,
        tasks: Sequence[tuple[int, Sequence[tuple[int, int]]]],
        until: int,
        interrupts: Sequence[Sequence[tuple[int, int]]] = (),
        pends: Sequence[tuple[int, int]] = (),
        kinds: Sequence[int] = (),
        **times: int,
    ) -> None:
        config = np.zeros(1, KERNEL)
        config["tasks"] = len(tasks)
        config["priority"][0, : len(tasks)] = [priority for priority, _ in tasks]
        config["level"] = np.arange(INTERRUPTS)
        config["queue"][0, : len(kinds), 0] = kinds
        for name, value in times.items():
            config[name] = value
        step = np.zeros((TASKS + INTERRUPTS, STEPS, 2), np.int64)
        count = np.ones(TASKS + INTERRUPTS, np.int32)
        programs = [(i, steps) for i, (_, steps) in enumerate(tasks)]
        programs += [(TASKS + i, steps) for i, steps in enumerate(interrupts)]
        for i, steps in programs:
            step[i, : len(steps)] = steps
            count[i] = len(steps)
        event = np.zeros(200_000, EVENT)
        overhead = np.zeros(1, np.int64)
        clock = np.array([c for c, _ in pends], np.int64)
        which = np.array([i for _, i in pends], np.int32)
        found = LIBRARY.clock_batch_kernel(
            config, count, step.ravel(), len(pends), clock, which, until, len(event), event,
            overhead,
        )  # fmt: skip
        assert 0 <= found < len(event)
        self.event, self.overhead = event[:found], int(overhead[0])

    def marks(self, task: int, value: int = 0) -> np.ndarray:
        """Clocks of a task's marks."""
        e = self.event
        own = (e["what"] == MARKED) & (e["number"] == task) & (e["value"] == value)
        return e["clock"][own]
