"""Geometry of a machine tool from positioning and circular tests.

A measured reversal value is not the backlash alone: friction winds the screw up, and a servo that
overshoots pushes the table on. So the same tests are run on the machine with its FMUs and what was
found, and by how much the run's figures differ from the record's, the values are corrected. What
the record shows is then shown by the machine, with its own servo.
"""

import math
import tempfile
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.calibrate.circle_errors import CircleErrors, circle_errors
from motionfmu.calibrate.circle_record import CircleRecord
from motionfmu.calibrate.compensation import (
    CompensationTable,
    compensation_table,
    compensation_tables,
    compensation_text,
)
from motionfmu.calibrate.estimate import Estimate
from motionfmu.calibrate.lead_error import LeadError, lead_error
from motionfmu.calibrate.machine_tests import MachineTests
from motionfmu.calibrate.plant_geometry import (
    AxisErrors,
    MachineGeometry,
    axis_rows,
    row_of_axis,
)
from motionfmu.calibrate.position_record import PositionRecord
from motionfmu.run.machine_program import Machine
from motionfmu.run.run_plan import RunPlan

Told = Callable[[str, float], None]
# Runs by which values are corrected at most, and a correction that is none [mm, 1, rad].
ROUNDS, SMALL = 3, {"mm": 5e-5, "1": 2e-7, "rad": 2e-7}
# From figures of an axis to the unit of its parameters: m, 1, rad.
TO_PLANT = {"mm": (1e-3, "m"), "1": (1.0, "1"), "rad": (1.0, "rad")}


@dataclass(frozen=True)
class GeometryParameter:
    """A parameter of the plant that records tell.

    Attributes
    ----------
    name : str
        ``component.variable[i]``.
    part : str
        What it is, such as ``X: backlash``.
    before : float
        As the machine has it.
    found : Estimate
        In the parameter's unit.
    record : str
        Name of the file that tells it.
    """

    name: str
    part: str
    before: float
    found: Estimate
    record: str


@dataclass(frozen=True)
class AxisCalibration:
    """An axis that was measured.

    Attributes
    ----------
    name : str
    row : int
        From 1.
    record : PositionRecord
    error : LeadError
        In the record.
    run : LeadError or None
        By the FMUs with what was found.
    after : LeadError or None
        By the FMUs with what was found and the compensation.
    table : CompensationTable or None
    pulse : float
        Length of a pulse of the table [mm].
    """

    name: str
    row: int
    record: PositionRecord
    error: LeadError
    run: LeadError | None = None
    after: LeadError | None = None
    table: CompensationTable | None = None
    pulse: float = math.nan


@dataclass(frozen=True)
class CircleCalibration:
    """A plane that was measured.

    Attributes
    ----------
    record : CircleRecord
    errors : CircleErrors
        In the record.
    run : CircleErrors or None
        By the FMUs with what was found.
    """

    record: CircleRecord
    errors: CircleErrors
    run: CircleErrors | None = None


@dataclass(frozen=True)
class MachineCalibration:
    """What records tell of a machine.

    Attributes
    ----------
    machine, about : str
    parameters : tuple of GeometryParameter
    axes : tuple of AxisCalibration
    circles : tuple of CircleCalibration
    settings : dict
        Values of the plant by name, for ``--set``.
    compensation : str
        Text of the tables; empty without.
    compensated : str
        Name of the parameter that takes their file.
    notes : tuple of str
    """

    machine: str
    about: str
    parameters: tuple[GeometryParameter, ...]
    axes: tuple[AxisCalibration, ...]
    circles: tuple[CircleCalibration, ...]
    settings: Mapping[str, float]
    compensation: str = ""
    compensated: str = ""
    notes: tuple[str, ...] = ()

    def parameter(self, name: str) -> GeometryParameter:
        """One parameter by its name.

        Parameters
        ----------
        name : str
        """
        found = {p.name: p for p in self.parameters}
        if name not in found:
            raise InputError(f"no parameter {name!r} was found{suggestion(name, found)}")
        return found[name]

    def numbers(self) -> dict[str, Any]:
        """Every figure, ready for JSON."""
        axes = {}
        for a in self.axes:
            sides = {"record": a.error, "run": a.run, "compensated": a.after}
            axes[a.name] = {k: e.numbers() for k, e in sides.items() if e is not None}
        circles = {}
        for c in self.circles:
            both = {"record": c.errors, "run": c.run}
            circles[c.record.plane] = {k: e.numbers() for k, e in both.items() if e is not None}
        rows = {
            p.name: {"part": p.part, "before": p.before, "record": p.record} | p.found.numbers()
            for p in self.parameters
        }
        return {
            "machine": self.machine,
            "parameters": rows,
            "axes": axes,
            "circles": circles,
            "settings": dict(self.settings),
            "notes": list(self.notes),
        }


@dataclass(frozen=True)
class MachineRecords:
    """Records of a machine: positioning tests by axis, and circles."""

    positions: Mapping[str, PositionRecord] = field(default_factory=dict)
    circles: Sequence[CircleRecord] = ()


def machine_calibration(
    plan: RunPlan,
    records: MachineRecords,
    machine: Machine | None = None,
    set: Mapping[str, Any] | None = None,
    told: Told = lambda what, share: None,
) -> MachineCalibration:
    """Find the geometry of a machine.

    Parameters
    ----------
    plan : RunPlan
        The machine without a program, or a scenario.
    records : MachineRecords
    machine : Machine, optional
        It also runs the tests, with which the servo's part is taken out of what is found; without
        it that part stays in the backlash.
    set : mapping, optional
        Values by ``component.variable``, stronger than the machine's.
    told : callable
        Called with what is run next and the share done, 0 to 1.

    Returns
    -------
    MachineCalibration

    Raises
    ------
    InputError
        An axis is unknown, or nothing of the plant is described as geometry.
    """
    given = dict(set or {})
    work = _Calibrating(MachineGeometry.of(plan, given), records, given, told)
    if machine is None:
        return work.result()
    with tempfile.TemporaryDirectory(prefix="motionfmu.") as folder:
        work.run(MachineTests.of(machine, Path(folder), given))
    return work.result()


@dataclass
class _GeometryValue:
    """A value that is being found: one parameter of the plant, by figures of a record."""

    part: str
    axis: str
    what: str  # backlash, slope, ...; squareness of a plane
    name: str
    before: float  # in the unit of the parameter
    seen: Estimate  # as the record shows it
    now: float  # in the unit of `seen`
    record: str
    offset: bool = True  # a run of the machine may correct it


class _Calibrating:
    """Values, their corrections by runs, and what comes of them."""

    def __init__(
        self,
        geometry: MachineGeometry,
        records: MachineRecords,
        given: dict[str, Any],
        told: Told,
    ) -> None:
        self.geometry, self.given, self.told = geometry, given, told
        self.notes: list[str] = []
        self.rows = axis_rows(geometry.plan)
        self.plant = geometry.find("axis")
        self.controller = geometry.find("compensation")
        self.axes = {n: self._axis(n, r) for n, r in records.positions.items()}
        self.circles = {c.plane: CircleCalibration(c, self._errors(c)) for c in records.circles}
        self.values: list[_GeometryValue] = []
        for a in self.axes.values():
            self._of_axis(a)
        for c in self.circles.values():
            self._of_circle(c)
        if not self.axes and not self.circles:
            raise InputError(f"{geometry.name}: no record")

    def _axis(self, name: str, record: PositionRecord) -> AxisCalibration:
        found = AxisCalibration(
            name, row_of_axis(self.rows, name, record.name), record, lead_error(record.test)
        )
        self.notes += [f"{record.name}: {note}" for note in record.notes]
        if self.controller is None:
            return found
        component, table = self.controller
        pulses = self.geometry.pulse(component, table)
        pulse = float(pulses[found.row - 1 if len(pulses) > 1 else 0])
        before = self._tables().get(found.row)
        return replace(
            found, table=compensation_table(found.error, found.row, pulse, before), pulse=pulse
        )

    def _tables(self) -> Mapping[int, CompensationTable]:
        """Tables that the machine has already, which the records saw."""
        assert self.controller is not None
        component, table = self.controller
        file = str(self.geometry.values(component, table.file)[0])
        if not file:
            return {}
        path = self.geometry.plan.document.beside(file)
        return compensation_tables(path or file)

    def _errors(self, record: CircleRecord) -> CircleErrors:
        for name in record.plane:
            row_of_axis(self.rows, name, record.name)
        return circle_errors(record.test, record.plane)

    def _add(self, axis: str, what: str, variable: str | None, seen: Estimate, record: str) -> None:
        """A figure of an axis; without a parameter it is a note."""
        factor, unit = (1e6, "µrad") if seen.unit == "rad" else (1e6, "µm/m")
        factor, unit = (1e3, "µm") if seen.unit == "mm" else (factor, unit)
        if self.plant is None or variable is None:
            self.notes.append(
                f"{axis}: {what} {seen.text(factor)} {unit}: the plant has no parameter for it"
            )
            return
        component = self.plant[0]
        before = self.geometry.value(component, variable, self.rows[axis])
        now = seen.value if seen.told else before / TO_PLANT[seen.unit][0]
        name = f"{component}.{variable}[{self.rows[axis]}]"
        straight = what in ("backlash", "slope")
        self.values.append(
            _GeometryValue(f"{axis}: {what}", axis, what, name, before, seen, now, record, straight)
        )

    def _names(self) -> AxisErrors:
        return self.plant[1] if self.plant else AxisErrors()

    def _of_axis(self, axis: AxisCalibration) -> None:
        error, names = axis.error, self._names()
        self._add(axis.name, "backlash", names.backlash, error.backlash, axis.record.name)
        self._add(axis.name, "slope", names.slope, error.slope, axis.record.name)
        if not error.amplitude.told:
            short = f"shorter than {error.shortest:.3g} mm none could be seen"
            self.notes.append(f"{axis.name}: no wave: {error.amplitude.why}; {short}")
            return
        if names.wave is None:
            self._add(axis.name, "wave", None, error.amplitude, axis.record.name)
            return
        parts = ("amplitude", error.amplitude), ("period", error.period), ("phase", error.phase)
        for variable, (what, seen) in zip(names.wave, parts, strict=True):
            self._add(axis.name, what, variable, seen, axis.record.name)

    def _of_circle(self, circle: CircleCalibration) -> None:
        errors, record, plane = circle.errors, circle.record, circle.record.plane
        names = self._names()
        frame = self.geometry.find("squareness")
        variable = None if frame is None else frame[1].get(plane)
        if frame is None or variable is None:
            shown = errors.squareness.text(1e6)
            self.notes.append(
                f"{plane}: squareness {shown} µrad: no component of the machine has a parameter"
                " for it (machine_frame has)"
            )
        else:
            before = self.geometry.value(frame[0], variable, 1)
            self.values.append(
                _GeometryValue(
                    f"{plane}: squareness",
                    plane,
                    "squareness",
                    f"{frame[0]}.{variable}",
                    before,
                    errors.squareness,
                    errors.squareness.value,
                    record.name,
                )
            )
        for name, seen in zip(plane, errors.backlash, strict=True):
            if name not in self.axes and not self._has(name, "backlash"):
                self._add(name, "backlash", names.backlash, seen, record.name)
        self._scale(errors, record, names)
        for name, seen in zip(plane, errors.centre, strict=True):
            self.notes.append(
                f"{plane}: centre {name} off by {seen.text(1e3)} µm: set-up, no geometry"
            )
        self.notes.append(
            f"{plane}: mismatch {errors.mismatch.text(1e3)} µm turns with the direction: gains"
            f" and delays; mean radius {errors.radius.text(1e3)} µm: servo, or both scales alike"
        )

    def _has(self, axis: str, what: str) -> bool:
        return any(v.axis == axis and v.what == what for v in self.values)

    def _scale(self, errors: CircleErrors, record: CircleRecord, names: AxisErrors) -> None:
        """A circle tells the difference of two slopes, so one of them must be known."""
        first, second = record.plane[0], record.plane[1]
        known = [n for n in record.plane if n in self.axes]
        scale = errors.scale
        if len(known) == 2:
            slopes = [self.axes[n].error.slope for n in record.plane]
            apart = slopes[0].value - slopes[1].value
            self.notes.append(
                f"{record.plane}: scales differ by {scale.text(1e6)} µm/m on the circle, by"
                f" {apart * 1e6:.1f} in the positioning tests, which count"
            )
            return
        if not known:
            self.notes.append(
                f"{record.plane}: a circle tells only that {first} travels {scale.text(1e6)} µm/m"
                f" more than {second}: half of it is given to either"
            )
            for name, share in ((first, 0.5), (second, -0.5)):
                if not self._has(name, "slope"):
                    self._add(name, "slope", names.slope, _times(scale, share), record.name)
            return
        other, sign = (second, 1.0) if known[0] == first else (first, -1.0)
        slope = self.axes[known[0]].error.slope
        spread = math.hypot(slope.deviation, scale.deviation)
        seen = Estimate(slope.value - sign * scale.value, spread, "1")
        if not self._has(other, "slope"):
            self._add(other, "slope", names.slope, seen, record.name)

    @property
    def settings(self) -> dict[str, float]:
        """Values of the plant as they are now."""
        return {v.name: v.now * TO_PLANT[v.seen.unit][0] for v in self.values if v.seen.told}

    def run(self, tests: MachineTests) -> None:
        """Correct values by the machine's own runs, then look at it with its compensation."""
        changed = {*self.axes, *self.circles}
        for turn in range(ROUNDS):
            due = [n for n in (*self.axes, *self.circles) if self._reached(n, changed)]
            changed = set()
            for k, name in enumerate(due):
                self.told(f"{name}, run {turn + 1}", (turn + k / len(due)) / (ROUNDS + 1))
                try:
                    changed |= self._corrected(tests, name, last=turn == ROUNDS - 1)
                except InputError as error:
                    self.notes.append(f"not run: {str(error).splitlines()[0]}")
                    return
            if not changed:
                break
        self._compensated(tests)

    def _reached(self, name: str, changed: set[str]) -> bool:
        """Whether a test shows what was changed: its own values, a circle those of its axes."""
        return name in changed or (name in self.circles and bool(changed & set(name)))

    def _measured(self, tests: MachineTests, name: str) -> LeadError | CircleErrors:
        given = {**self.given, **self.settings}
        if name in self.axes:
            targets = self.axes[name].error.test.targets
            return lead_error(tests.positioning(name, targets, given))
        record = self.circles[name].record
        assert record.test.ccw is not None
        size = record.test.radius, record.test.ccw.speed or None
        return circle_errors(tests.circle(name, *size, record.centre, given), name)

    def _corrected(self, tests: MachineTests, name: str, last: bool) -> set[str]:
        """Run one test and take the differences; give the axes and planes that they move."""
        found = self._measured(tests, name)
        moved = set()
        if isinstance(found, LeadError):
            self.axes[name] = replace(self.axes[name], run=found)
            own = {(name, "backlash"): found.backlash, (name, "slope"): found.slope}
        else:
            self.circles[name] = replace(self.circles[name], run=found)
            own = {(name, "squareness"): found.squareness}
            own |= self._of_run(name, found)
        for value in self.values:
            seen = own.get((value.axis, value.what))
            if seen is None or not value.offset or not value.seen.told:
                continue
            away = value.seen.value - seen.value
            if abs(away) > max(SMALL[seen.unit], 0.1 * value.seen.deviation) and not last:
                value.now += away
                moved.add(value.axis)
                if value.what == "backlash" and value.now < 0.0:
                    value.now = 0.0
        return moved

    def _of_run(self, name: str, found: CircleErrors) -> dict[tuple[str, str], Estimate]:
        """Figures of a run's circle that values of this circle have."""
        record = self.circles[name].record
        own: dict[tuple[str, str], Estimate] = {}
        for axis, seen in zip(name, found.backlash, strict=True):
            own[axis, "backlash"] = seen
        away = self.circles[name].errors.scale.value - found.scale.value
        own |= self._scales(name, away)
        of_this = {v.axis for v in self.values if v.record == record.name}
        return {k: e for k, e in own.items() if k[0] in of_this and k[0] not in self.axes}

    def _scales(self, name: str, away: float) -> dict[tuple[str, str], Estimate]:
        """Slopes as a run shows them, whose scales differ by so much less than the record's."""
        free = [n for n in name if n not in self.axes]
        found = {}
        for axis in free:
            value = next((v for v in self.values if (v.axis, v.what) == (axis, "slope")), None)
            if value is not None:
                sign = 1.0 if axis == name[0] else -1.0
                found[axis, "slope"] = Estimate(
                    value.seen.value - sign * away / len(free), 0.0, "1"
                )
        return found

    def _compensated(self, tests: MachineTests) -> None:
        """Run the machine with what was found and the tables."""
        tables = [a.table for a in self.axes.values() if a.table is not None]
        if not tables or self.controller is None:
            return
        component, table = self.controller
        file = tests.folder / "compensation.csv"
        file.write_text(compensation_text(tables, "under test"), encoding="utf-8")
        given = {**self.given, **self.settings, f"{component}.{table.file}": str(file)}
        for k, (name, a) in enumerate(list(self.axes.items())):
            self.told(f"{name}, compensated", (ROUNDS + k / len(self.axes)) / (ROUNDS + 1))
            test = tests.positioning(name, a.error.test.targets, given)
            self.axes[name] = replace(a, after=lead_error(test))

    def result(self) -> MachineCalibration:
        """What was found."""
        parameters = []
        for v in self.values:
            factor, unit = TO_PLANT[v.seen.unit]
            shown = replace(v.seen, value=v.now).in_unit(factor, unit)
            parameters.append(GeometryParameter(v.name, v.part, v.before, shown, v.record))
        document = self.geometry.plan.document
        tables = [a.table for a in self.axes.values() if a.table is not None]
        name = self.geometry.plan.name
        text, target = "", ""
        if tables and self.controller is not None:
            about = f"{name}, from " + ", ".join(a.record.name for a in self.axes.values())
            others = [t for k, t in self._tables().items() if k not in {o.axis for o in tables}]
            text = compensation_text([*tables, *others], about)
            target = f"{self.controller[0]}.{self.controller[1].file}"
        return MachineCalibration(
            name,
            document.about,
            tuple(parameters),
            tuple(self.axes.values()),
            tuple(self.circles.values()),
            self.settings,
            text,
            target,
            tuple(self.notes),
        )


def _times(seen: Estimate, share: float) -> Estimate:
    return replace(seen, value=seen.value * share, deviation=seen.deviation * abs(share))
