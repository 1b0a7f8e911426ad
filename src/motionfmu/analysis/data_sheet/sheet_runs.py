"""Runs of a machine from which the figures of its data sheet are taken."""

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.data_sheet.sheet_axes import SheetAxis
from motionfmu.analysis.data_sheet.sheet_programs import (
    APPROACHES,
    FREE,
    PositioningProgram,
    positioning_program,
    targets,
)
from motionfmu.analysis.positioning import PositioningTest
from motionfmu.base.errors import NoNumber
from motionfmu.run.machine_program import Machine
from motionfmu.run.result import Result
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario
from motionfmu.scenarios import contour_signals
from motionfmu.scenarios.values import values_in

Array = NDArray[np.float64]
RECORDED = 1e-3  # [s] between two samples that are kept of a positioning run
# The mean over this time at the end of a rest is read [s], as a laser's: an axis with friction and
# an integral never quite rests.
READ = 1.0
# A card's pen makes it rest for at least this long [s]; between two strokes nothing does.
REST = 0.01
# A positioner is watched for so long at a time [s] until it stays within so many counts; a motion
# has half as long again, and what is read follows.
WATCHED, LONGEST, STAYS = 5.0, 160.0, 20.0
PRESS, HELD = 0.1, 0.1  # [s] before `start` becomes 1, and how long it is


@dataclass(frozen=True)
class SheetMachine:
    """A machine under test, with values stronger than its own."""

    machine: Machine
    folder: Path  # of the programs that are run, which are part of the data sheet
    set: Mapping[str, Any] = field(default_factory=dict)

    def scenario(self, name: str, text: str) -> Scenario:
        """A program of this text on the machine."""
        file = self.folder / name
        file.write_text(text, encoding="utf-8")
        return self.machine.scenario(file, set=self.set)

    def run(self, name: str, text: str, every: float | None = None) -> Result:
        """Run a program, with so long [s] between two samples or as the machine records."""
        scenario = self.scenario(name, text)
        rows = None if every is None else max(1, round(every / scenario.document.body.step))
        return sound(scenario.run(every=rows), name)

    def value(self, name: str) -> float:
        """A parameter's value, the first if there are more."""
        plan = self.machine.plan()
        given = {s.end.name: s.values for s in plan.resolved(Options(set=self.set)).settings}
        end = plan.resolver.end(name, "signals", name)
        return float(values_in(given, end.component, end.port)[0])


def sound(result: Result, name: str) -> Result:
    """The same result; one that the machine's own checks refuse has no figures."""
    wrong = [c for c in result.checks if c.ok is False]
    if wrong:
        told = f"{name}: {wrong[0].name} is {wrong[0].value}, {wrong[0].bounds} wanted"
        raise NoNumber(told + (f"; {result.warnings[0]}" if result.warnings else ""))
    return result


@dataclass(frozen=True)
class RestRun:
    """What positioning an axis by a program gave, in its unit."""

    test: PositioningTest
    unrest: float  # how far it moves while it is read, at the most


def positioning(
    tested: SheetMachine,
    axes: Sequence[SheetAxis],
    dwell: float,
    places: Array | None = None,
    approaches: int = APPROACHES,
) -> list[RestRun]:
    """Position the first axis as ISO 230-2 has it, and look at all of them, which go with it."""
    moved, pen = axes[0], tested.machine.signals.config is not None
    program = positioning_program(moved, dwell, pen, places, approaches)
    result = tested.run(f"iso230_2_{moved.name}.ngc", program.text, RECORDED)
    if pen:
        rests = _by_speed(tested, moved, result, program)
    else:
        line = result[f"{contour_signals.library_of(result.resolver)}.line"]
        rests = np.searchsorted(line, program.lines.ravel(), side="right") - 1
        if (line[rests] != program.lines.ravel()).any():
            raise NoNumber(f"{moved.name}: the run has no sample of a rest at each target")
    read = 1 if pen else round(READ / float(result.time[1] - result.time[0]))
    shape = program.lines.shape
    found = []
    for axis in axes:
        place = axis.place(result)
        test = _test(_read(place, rests, read).reshape(shape), program.targets)
        found.append(RestRun(test, _unrest(place, rests, read)))
    return found


def _unrest(place: Array, ends: NDArray[np.intp], count: int) -> float:
    """From the lowest to the highest place within the samples up to an end, the most of all."""
    return max(float(np.ptp(place[k + 1 - count : k + 1])) for k in ends)


def _read(place: Array, ends: NDArray[np.intp], count: int) -> Array:
    """The mean of so many samples up to each end."""
    total = np.concatenate([[0.0], np.cumsum(place - place[0])])
    return np.asarray(place[0] + (total[ends + 1] - total[ends + 1 - count]) / count)


def _test(places: Array, wanted: Array) -> PositioningTest:
    """Deviations at the rests, from the first target's upward mean, where the laser is zeroed."""
    # Targets and position count from the same point only by chance; no figure depends on it.
    deviation = places - wanted
    home = int(np.argmin(np.abs(wanted)))
    deviation = deviation - deviation[:, 0, home].mean()
    return PositioningTest(wanted, deviation[:, 0], deviation[:, 1])


def _by_speed(
    tested: SheetMachine, axis: SheetAxis, result: Result, program: PositioningProgram
) -> NDArray[np.intp]:
    """The last sample of each rest at a target: where the commanded speed of the axis is 0."""
    limits = tested.machine.plan().axis_limits(tested.set)
    speed = next((x for x in limits if x.axis.name == axis.name and x.figure == "speed"), None)
    if speed is None:
        raise NoNumber(f"{axis.name}: [limits] has no speed, which tells when it rests")
    values = result[speed.signal.name]
    still = np.abs(values if speed.element is None else values[:, speed.element]) == 0.0
    edges = np.flatnonzero(np.diff(np.r_[False, still, False])).reshape(-1, 2)
    long = edges[np.diff(result.time[np.minimum(edges, len(still) - 1)], axis=1)[:, 0] >= REST]
    # The first rest is before the motion, the last behind it; between them rests at turns, too.
    ends = long[1:, 1] - 1
    place = axis.place(result)[ends]
    wanted = program.targets[np.tile(_way(program), len(program.lines))]
    turn = 0.5 * FREE * (axis.high - axis.low)  # where it turns back it rests, too
    near = 0.25 * min(float(np.diff(program.targets).min()), turn)
    found, k = [], 0
    for target in wanted:
        while k < len(ends) and abs(place[k] - target) > near:
            k += 1
        if k == len(ends):
            raise NoNumber(f"{axis.name}: it does not rest at {target:g} {axis.unit}")
        found.append(int(ends[k]))
        k += 1
    rests = np.empty(len(found), np.intp)
    rests[program.order] = found
    return rests


def _way(program: PositioningProgram) -> NDArray[np.intp]:
    """Places of the targets in the order of one approach of all, upwards and downwards."""
    count = len(program.targets)
    return np.concatenate([np.arange(count), np.arange(count)[::-1]])


def circle(tested: SheetMachine, name: str, text: str) -> tuple[CircularTest, Result]:
    """Run a circle and give its circular test, after ISO 230-4."""
    result = tested.run(name, text)
    found = [c for c in result.contour().circles if c.both is not None]
    if not found:
        raise NoNumber(f"{name}: no circle was run steadily both ways")
    return found[0], result


@dataclass(frozen=True)
class PositionerRun:
    """What positioning an axis by targets gave."""

    test: PositioningTest
    unrest: float  # how far it moves while it is read, at the most [mm]
    axis: SheetAxis  # with the travel that its targets have
    speed: float  # mean speed of the longest motion [mm/s]


def positioner(tested: SheetMachine, axis: SheetAxis) -> PositionerRun:
    """Position an axis that gets targets as numbers."""
    signals = tested.machine.signals
    if signals.count is None or signals.start is None:
        raise NoNumber("[signals] target goes with count and start")
    one = signals.count * 1e3  # [mm] of a count
    start = axis.place(_moved(tested, [0.0], 1.0))[0]
    low, high = axis.low, axis.high
    if signals.lowest is not None:
        low = max(low, start + one * tested.value(signals.lowest))
    if signals.highest is not None:
        high = min(high, start + one * tested.value(signals.highest))
    axis = replace(axis, low=low, high=high)
    places = targets(axis)
    turn = 0.5 * (places[0] - low), 0.5 * (high - places[-1])
    ends = round(places[0] - turn[0], 2), round(places[-1] + turn[1], 2)
    route, rests = [ends[0]], list[int]()
    for _ in range(APPROACHES):
        for listed, end in ((places, ends[1]), (places[::-1], ends[0])):
            rests += range(len(route), len(route) + len(listed))
            route += [*listed, end]
    counts = [round((place - start) / one) for place in route]
    used = _takes(tested, axis, [counts[0], round((ends[1] - start) / one)], STAYS * one)
    each = math.ceil(100.0 * (1.5 * used + 2.0 * READ)) / 100.0
    result = _moved(tested, counts, each)
    at = np.searchsorted(result.time, [(k + 1) * each - 1e-9 for k in rests]) - 1
    read = round(READ / float(result.time[1] - result.time[0]))
    place = axis.place(result)
    lag = _read(place, at, read).reshape(APPROACHES, 2, len(places))
    lag[:, 1] = lag[:, 1, ::-1]
    # what is asked for is a whole number of counts
    wanted = np.array([start + one * round((p - start) / one) for p in places])
    test = PositioningTest(wanted, lag[:, 0] - wanted, lag[:, 1] - wanted)
    return PositionerRun(test, _unrest(place, at, read), axis, (ends[1] - ends[0]) / used)


def _takes(tested: SheetMachine, axis: SheetAxis, counts: list[int], stays: float) -> float:
    """How long a motion over the travel takes until it stays within so many mm [s]."""
    each = WATCHED
    while each <= LONGEST:
        result = _moved(tested, counts, each)
        place = axis.place(result)
        part = place[np.searchsorted(result.time, each) :]
        away = np.flatnonzero(np.abs(part - part[-1]) > stays)
        used = result.time[len(place) - len(part) + away[-1]] - each if len(away) else 0.0
        if 0.0 < used < 0.5 * each:
            return float(used - PRESS)
        each *= 2.0
    raise NoNumber(f"{axis.name}: it does not come to rest within {LONGEST:g} s")


def _moved(tested: SheetMachine, counts: Sequence[float], each: float) -> Result:
    """Go to targets one after another, with so long for each [s]."""
    machine = tested.machine
    signals = machine.signals
    assert signals.target is not None and signals.start is not None
    leave = machine.plan().document.body.leave
    names = (signals.target, signals.start)
    begins = [round(k * each, 6) for k in range(len(counts))]
    press = [t for b in begins for t in (round(b + PRESS, 6), round(b + PRESS + HELD, 6))]
    drive = [
        {"input": signals.target, "at": begins, "value": [round(c) for c in counts]},
        {"input": signals.start, "at": press, "value": [True, False] * len(counts)},
    ]
    plan = machine.plan(
        stop=round(len(counts) * each, 6),
        without=[f"leave.{n}" for n in names if n in leave],
        drive=drive,
        set={**signals.homed, **tested.set},
    )
    rows = max(1, round(RECORDED / plan.document.body.step))
    return sound(plan.run(every=rows), "targets")
