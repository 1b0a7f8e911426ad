"""The data sheet of a machine."""

import tempfile
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionfmu.analysis.contour.circles import CircularTest
from motionfmu.analysis.data_sheet.robot_sheet import RobotSheet, robot_test
from motionfmu.analysis.data_sheet.sheet_axes import SheetAxis, sheet_axes
from motionfmu.analysis.data_sheet.sheet_loops import POSITION, LoopSheet, axis_model, loops
from motionfmu.analysis.data_sheet.sheet_programs import PLANES, circle_program
from motionfmu.analysis.data_sheet.sheet_runs import (
    READ,
    SheetMachine,
    circle,
    positioner,
    positioning,
)
from motionfmu.analysis.positioning import PositioningTest
from motionfmu.base.errors import InputError
from motionfmu.base.units import parse
from motionfmu.run.machine_program import Machine
from motionfmu.run.run_plan import Options
from motionfmu.run.runner import Scenario
from motionfmu.scenarios.machine_limits import AxisLimit
from motionfmu.study.tune.choice import operating_point, speed_output

Told = Callable[[str, float], None]
# A rest lasts so many settling times of the position loop, at least and at most so long [s],
# before what is read begins.
SETTLED, SHORTEST, LONGEST = 3.0, 1.0, 4.0
# A positioner's loop is looked at where it moves by this share of its travel in a second, so that
# it does not come to its end, or as fast as its motions are in the mean.
SLOW = 0.1


@dataclass(frozen=True)
class AxisSheet:
    """What the tests of an axis gave.

    Attributes
    ----------
    axis : SheetAxis
        Its name, unit, and the ends between which it was moved.
    positioning : PositioningTest or None
        ISO 230-2, in the axis' unit; None if it was not measured.
    unrest : float or None
        How far the axis moves while it rests at a target and is read, at the most.
    loops : tuple of LoopSheet
        Outer loops first.
    """

    axis: SheetAxis
    positioning: PositioningTest | None = None
    unrest: float | None = None
    loops: tuple[LoopSheet, ...] = ()


@dataclass(frozen=True)
class DataSheet:
    """The figures of a machine.

    Attributes
    ----------
    name, about : str
        Of the machine.
    set : dict
        Values stronger than the machine's.
    limits : tuple of AxisLimit
        Each figure of each axis with its limits.
    axes : tuple of AxisSheet
    point : dict
        Operating point of the loops, by ``component.variable``; empty at rest.
    circles : dict
        Circular tests (ISO 230-4) by the two axes of the plane, such as ``XY``.
    robot : RobotSheet or None
        ISO 9283, of a robot.
    left_out : dict
        Why the machine has no such figure, by what is left out.
    programs : dict
        Text of the programs that were run, by file name.
    """

    name: str
    about: str
    set: Mapping[str, Any]
    limits: tuple[AxisLimit, ...]
    axes: tuple[AxisSheet, ...]
    point: Mapping[str, float] = field(default_factory=dict)
    circles: Mapping[str, CircularTest] = field(default_factory=dict)
    robot: RobotSheet | None = None
    left_out: Mapping[str, str] = field(default_factory=dict)
    programs: Mapping[str, str] = field(default_factory=dict)

    def numbers(self) -> dict[str, Any]:
        """Every figure for JSON, in mm, degrees and s.

        Returns
        -------
        dict
        """
        axes = {}
        for a in self.axes:
            test = a.positioning
            axes[a.axis.name] = {
                "kind": a.axis.axis.kind,
                "low": a.axis.low,
                "high": a.axis.high,
                "iso230_2": None if test is None else test.figures() | _targets(test),
                "unrest": a.unrest,
                "loops": [loop.numbers() for loop in a.loops],
            }
        limits = [
            {"axis": x.axis.name, "figure": x.figure, "unit": x.unit}
            | {k: getattr(x, k) for k in ("limit", "low", "high", "continuous", "overload")}
            for x in self.limits
        ]
        return {
            "machine": self.name,
            "about": self.about,
            "set": dict(self.set),
            "limits": limits,
            "operating_point": dict(self.point),
            "axes": axes,
            "iso230_4": {k: c.numbers() for k, c in self.circles.items()},
            "iso9283": None if self.robot is None else self.robot.numbers(),
            "left_out": dict(self.left_out),
        }


def _targets(test: PositioningTest) -> dict[str, Any]:
    return {"targets": test.targets.tolist(), "up": test.up.tolist(), "down": test.down.tolist()}


def data_sheet(
    machine: Machine | str | Path,
    set: Mapping[str, Any] | None = None,
    progress: Told = lambda what, share: None,
) -> DataSheet:
    """Measure a machine by runs of its FMUs.

    Parameters
    ----------
    machine : Machine, str or Path
    set : mapping, optional
        Values by ``component.variable``, stronger than the machine's.
    progress : callable
        Called with what is measured next and the share done, 0 to 1.

    Returns
    -------
    DataSheet
        What the machine has not, or cannot do, is left out, and the reason given.

    Raises
    ------
    InputError
        There is no such machine, or something in its file or in `set` is wrong.
    """
    own = machine if isinstance(machine, Machine) else Machine(machine)
    with tempfile.TemporaryDirectory(prefix="motionfmu.") as folder:
        return _Measuring(SheetMachine(own, Path(folder), dict(set or {})), progress).sheet()


Positions = dict[str, tuple[SheetAxis, PositioningTest | None, float | None]]


class _Measuring:
    """The tests of a machine, one after another."""

    def __init__(self, tested: SheetMachine, told: Told) -> None:
        self.tested, self.told = tested, told
        self.plan: Scenario = tested.machine.plan()
        self.plan.resolved(Options(set=tested.set))
        self.limits = self.plan.axis_limits(tested.set)
        self.axes = sheet_axes(tested.machine, self.limits)
        self.left_out: dict[str, str] = {}
        self.point: dict[str, float] = {}
        self.done, self.tests = 0, 2 * len(self.axes) + len(PLANES) + 1

    def _next(self, what: str) -> None:
        self.told(what, self.done / self.tests)
        self.done += 1

    @property
    def reads_gcode(self) -> bool:
        """Whether the controller reads part programs, in words of the axes."""
        signals = self.tested.machine.signals
        if signals.program is None:
            return False
        component = signals.program.partition(".")[0]
        return signals.config is not None or "tool_table" in self.plan.resolver.ports[component]

    def sheet(self) -> DataSheet:
        """All of them."""
        circles, on = self._circles()
        if self.tested.machine.signals.target is not None:  # its motions tell the speed of loops
            found = self._by_targets(self.axes[0])
            listed = {a.name: self._loops(a, on) for a in self.axes}
        else:
            listed = {a.name: self._loops(a, on) for a in self.axes}
            found = self._by_programs(listed)
        robot = self._robot()
        document = self.plan.document
        return DataSheet(
            self.tested.machine.name,
            document.about,
            self.tested.set,
            tuple(self.limits),
            tuple(AxisSheet(*found[a.name], tuple(listed[a.name])) for a in self.axes),
            self.point,
            circles,
            robot,
            self.left_out,
            {f.name: f.read_text(encoding="utf-8") for f in sorted(self.tested.folder.iterdir())},
        )

    def _circles(self) -> tuple[dict[str, CircularTest], Scenario]:
        """Circular tests of the planes, and the scenario on which loops are looked at."""
        known = {a.name: a for a in self.axes if a.word and not a.rotary}
        planes = [p for p in PLANES if p[1] in known and p[2] in known]
        found: dict[str, CircularTest] = {}
        on = self.plan
        if self.plan.document.body.contour is None or not planes or not self.reads_gcode:
            self.left_out["ISO 230-4"] = (
                "no two linear axes that a part program moves with a [contour] table"
            )
            return found, on
        for plane in planes:
            name = "".join(sorted(plane[1:]))
            self._next(f"circle in {name}")
            text = circle_program(known, plane)
            file = f"iso230_4_{name}.ngc"
            try:
                found[name], result = circle(self.tested, file, text)
            except InputError as error:
                self.left_out[f"ISO 230-4, {name}"] = _first(error)
                continue
            if on is self.plan:
                on = self.tested.scenario(file, text)
                self.point = self._speed(on, result)
        return found, on

    def _speed(self, on: Scenario, result: Any) -> dict[str, float]:
        """The mean feed of the circle as an operating point, as `motionfmu margins` has it."""
        linear = axis_model(on, self.axes[0].row, {}, self.tested.set)
        contour = on.document.body.contour
        if contour is None or linear.others or not speed_output(linear, contour.position):
            return {}
        return operating_point(linear, result)

    def _loops(self, axis: SheetAxis, on: Scenario) -> list[LoopSheet]:
        """Margins and steps of an axis."""
        self._next(f"loops of {axis.name}")
        try:
            return loops(axis_model(on, axis.row, self.point, self.tested.set))
        except InputError as error:
            self.left_out[f"loops of {axis.name}"] = _first(error)
            return []

    def _by_targets(self, axis: SheetAxis) -> Positions:
        """ISO 230-2 of an axis that goes where a target says."""
        found: Positions = {a.name: (a, None, None) for a in self.axes}
        self._next(f"positioning of {axis.name}")
        try:
            run = positioner(self.tested, axis)
        except InputError as error:
            self.left_out[f"ISO 230-2, {axis.name}"] = _first(error)
            return found
        assert axis.travel is not None
        linear = axis_model(self.plan, axis.row, {}, self.tested.set)
        signal = axis.travel.signal
        if speed := speed_output(linear, signal.name):
            unit = parse("mm").factor / parse(signal.port.unit or "1").factor
            slow = min(run.speed, SLOW * (run.axis.high - run.axis.low))
            self.point = {speed: float(slow * unit)}
        return found | {axis.name: (run.axis, run.test, run.unrest)}

    def _by_programs(self, listed: Mapping[str, list[LoopSheet]]) -> Positions:
        """ISO 230-2 of each axis that goes where a program says."""
        found: Positions = {a.name: (a, None, None) for a in self.axes}
        if not self.reads_gcode:
            self.left_out["ISO 230-2"] = "its controller reads no part programs and has no target"
            return found
        for axis in self.axes:
            if axis.follows:
                continue
            if not axis.word or axis.travel is None:
                why = "no word of a part program" if not axis.word else "[limits] has no travel"
                self.left_out[f"ISO 230-2, {axis.name}"] = why
                continue
            self._next(f"positioning of {axis.name}")
            together = [axis, *(a for a in self.axes if a.follows and a.word == axis.word)]
            try:
                tests = positioning(self.tested, together, _dwell(listed[axis.name]))
            except InputError as error:
                self.left_out[f"ISO 230-2, {axis.name}"] = _first(error)
                continue
            found |= {a.name: (a, t.test, t.unrest) for a, t in zip(together, tests, strict=True)}
        return found

    def _robot(self) -> RobotSheet | None:
        """ISO 9283 of a robot."""
        try:
            found = robot_test(self.tested)
        except InputError as error:
            self.left_out["ISO 9283"] = _first(error)
            return None
        if found is None:
            return None
        self._next("ISO 9283")
        return found


def _dwell(listed: list[LoopSheet]) -> float:
    """How long an axis rests at a target [s]; no whole number, which may count milliseconds."""
    slowest = max((x.step.settling for x in listed if x.kind == POSITION), default=0.0)
    return round(min(max(SETTLED * slowest, SHORTEST), LONGEST), 1) + READ + 0.05


def _first(error: InputError) -> str:
    """The first line of a message."""
    return str(error).splitlines()[0]
