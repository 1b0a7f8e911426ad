"""A run in short: overrides, times, lengths, gains and the speed of its tool."""

import contextlib
from collections.abc import Sequence
from dataclasses import dataclass, replace
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.cycle_time import CommandedMotion, driven, planned
from motionfmu.analysis.linear import LoopGain, gain_of
from motionfmu.analysis.linear.gains import in_lines
from motionfmu.base.columns import ROWS
from motionfmu.base.errors import InputError
from motionfmu.base.extras import Missing
from motionfmu.report.html_page import Page
from motionfmu.report.html_tables import facts
from motionfmu.report.limit_section import LimitUse
from motionfmu.report.report_input import ReportInput
from motionfmu.report.time_charts import Speeds, speed_chart
from motionfmu.report.view.scene import STANDS, position, tool_signal
from motionfmu.run import Scenario
from motionfmu.run.axis_figures import AxisFigure, axis_figures
from motionfmu.run.decimate import Read, at, blocks, reader
from motionfmu.run.figures import Chart
from motionfmu.run.limit_shares import cycle_bounds, limit_shares
from motionfmu.run.tool_gap import ToolGap, tool_gaps

Array = NDArray[np.float64]
# The speed of the tool is its mean over twice this time [s], or over two samples.
OVER, OVER_PULSES = 1e-3, 5e-3
# A step of the tool this long [mm], and so much longer than those beside it, is another tool's
# tip: a motion takes samples to come up and to end.
LEAP, LEAP_RATIO = 1.0, 100.0
# Fewer points are no curve.
_LEAST = 3
# What a library has of its axes: pulses per turn, gear, lead [mm]; and its speed along the path.
PLANNED = "path_feed"
AXIS = ("ppr", "gear_ratio", "lead", PLANNED)
# Feeds of part programs are in mm/min, speeds of other tools in mm/s.
MINUTE = 60.0
AS_WRITTEN = "Note of the scenario as written: "


@dataclass(frozen=True)
class RunSummary:
    """How a run went, for its page and for result.json."""

    began: float | None  # first command of the program, else first motion of the tool [s]
    done: float | None  # [s]
    distance: float | None  # way of the tool [mm]
    programmed: tuple[float, float] | None  # of it, as programmed: cutting and rapids [mm]
    speeds: Speeds | None
    gains: tuple[LoopGain, ...]
    tools: tuple[ToolGap, ...]  # each beside its command
    axes: tuple[AxisFigure, ...] = ()  # of a machine whose limits are known
    plan: CommandedMotion | None = None  # of its program, if the machine names its axes
    use: LimitUse | None = None  # how it uses the limits of its axes

    @property
    def cycle(self) -> float | None:
        """Time of the program [s]."""
        known = self.began is not None and self.done is not None
        return self.done - self.began if known else None  # type: ignore[operator]

    def numbers(self) -> dict[str, Any]:
        """The summary as numbers for JSON."""
        gains = [{"name": g.name, "axis": g.axis, "value": g.value, "kp": g.kp} for g in self.gains]
        bounds = self.use and self.use.bounds
        return {
            "began_at": self.began,
            "cycle_time": self.cycle,
            "distance": self.distance,
            "position_gains": gains,
            "tools": [tool.numbers() for tool in self.tools],
            "axes": [axis.numbers() for axis in self.axes],
            "bounds": bounds and bounds.numbers(),
            "program": None if self.plan is None else self.plan.numbers(),
        }


def summary_of(result: ReportInput, contour: ContourResult | None) -> RunSummary:
    """Find out how a run went."""
    scenario, given = result.scenario, result.options.get("set", {})
    axes: tuple[AxisFigure, ...] = ()
    plan, use = None, None
    if isinstance(scenario, Scenario) and scenario.document.body.axis:
        limits = scenario.axis_limits(given)
        axes = tuple(axis_figures(result, limits))
        shares = limit_shares(result, limits)
        use = LimitUse(shares, cycle_bounds(result, shares), axes)
        plan = driven(result)
        with contextlib.suppress(InputError):  # none of its components plans a part program
            plan = plan or planned(scenario, given)
    return replace(_motion_of(result, contour), axes=axes, plan=plan, use=use)


def _motion_of(result: ReportInput, contour: ContourResult | None) -> RunSummary:
    """Begin, distance, speeds and gains."""
    scenario, given = result.scenario, result.options.get("set", {})
    gains: tuple[LoopGain, ...] = ()
    with contextlib.suppress(Missing):
        gains = gain_of(scenario, given) if isinstance(scenario, Scenario) else ()
    tools = tuple(tool_gaps(result))
    tool, source, over = _tool(result, contour)
    way, began = None, None
    if contour is not None:
        began = _first(contour.run.command > 0, result.time)
        path = contour.run.path
        cut = float(path.lengths[path.cut].sum())
        way = cut, float(path.offsets[-1]) - cut
    elif tool is not None:
        began = _moves(result.time, tool)
    if tool is None or began is None:
        return RunSummary(began, result.done_at, None, way, None, gains, tools)
    every = max(1, round(over / (result.time[1] - result.time[0])))
    some = np.arange(0, len(result.time), every)
    time, points = result.time[some], without_leaps(at(tool, some))
    distance = float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
    if len(time) < _LEAST:
        return RunSummary(began, result.done_at, distance, way, None, gains, tools)
    speed = np.linalg.norm(np.gradient(points, time, axis=0), axis=1)
    planned, programmed = _planned(result), _programmed(result, contour)
    factor, unit = (1.0, "mm/s") if contour is None else (MINUTE, "mm/min")
    rest = [None if v is None else factor * at(v, some) for v in (planned, programmed)]
    speeds = Speeds(time, factor * speed, rest[0], rest[1], (unit, source), result.done_at)
    return RunSummary(began, result.done_at, distance, way, speeds, gains, tools)


def _tool(result: ReportInput, contour: ContourResult | None) -> tuple[Read | None, str, float]:
    """Positions of the tool (n, 3) [mm], what they are from, and a time for its speed [s]."""
    if contour is not None:
        actual = reader(contour.run.actual)
        return lambda first, last: actual(first, last)[:, :3], "positions", OVER
    name = tool_signal(result)
    if name is not None and name in result.signals:
        tool = position(result, name)
        finite = all(np.isfinite(b).all() for b in blocks(len(result.time), tool))
        return tool if finite else None, "positions", OVER
    pulses = [x for n, x in result.signals.items() if n.endswith(".pulse_count") and x.ndim > 1]
    for component, ports in result.resolver.ports.items():
        if pulses and all(n in ports for n in AXIS) and not ports[PLANNED].shape:
            ppr, gear, lead = (np.array(result.parameter(f"{component}.{n}")) for n in AXIS[:3])
            return _of_pulses(reader(pulses[0]), lead, ppr * gear), "pulses", OVER_PULSES
    return None, "", OVER


def without_leaps(points: Array) -> Array:
    """Positions (n, 3) [mm] moved together where another tool, not a motion, makes them leap."""
    steps = np.diff(points, axis=0)
    way = np.linalg.norm(steps, axis=1)
    beside = np.maximum(np.append(0.0, way[:-1]), np.append(way[1:], 0.0))
    leaps = np.where(((way > LEAP) & (way > LEAP_RATIO * beside))[:, None], steps, 0.0)
    return np.asarray(points - np.vstack([0.0 * points[:1], np.cumsum(leaps, axis=0)]))


def _of_pulses(read: Read, lead: Array, turn: Array) -> Read:
    """Positions of the first three axes [mm] by their pulses."""
    return lambda first, last: (read(first, last) * lead / turn)[:, :3]


def _moves(time: Array, tool: Read) -> float | None:
    """When the tool leaves the place where it was at first [s]."""
    rest = tool(0, 1)
    for k, block in enumerate(blocks(len(time), tool)):
        moved = (np.abs(block - rest) > STANDS).any(axis=1)
        if moved.any():
            return float(time[k * ROWS + int(np.argmax(moved))])
    return None


def _programmed(result: ReportInput, contour: ContourResult | None) -> Read | None:
    """The speed that program or scenario asks for [mm/s], NaN where it asks for none."""
    if contour is not None:
        path, commands, end = contour.run.path, contour.run.command, result.done_at or np.inf

        def of_program(first: int, last: int) -> Array:
            command = commands[first:last]
            on = (command > 0) & (result.time[first:last] <= end)
            return np.where(on, path.feeds[path.segment_of(command)], np.nan)

        return of_program
    asked = result.resolver.document.body.iso9283
    if asked is None or asked.speed is None:
        return None
    cycles = asked.cycles or [[float(result.time[0]), float(result.time[-1])]]
    speed = asked.speed

    def in_cycles(first: int, last: int) -> Array:
        time = result.time[first:last]
        on = np.any([(a <= time) & (time <= b) for a, b in cycles], axis=0)
        return np.where(on, speed, np.nan)

    return in_cycles


def _first(there: NDArray[np.bool_], time: Array) -> float | None:
    return float(time[int(np.argmax(there))]) if there.any() else None


def _planned(result: ReportInput) -> Read | None:
    """The speed along the path as the controller planned it [mm/s], if one recorded says so."""
    for name, values in result.signals.items():
        if name.endswith(f".{PLANNED}") and values.ndim == 1:
            return reader(values)
    return None


def add_summary(page: Page, result: ReportInput, ran: RunSummary) -> None:
    """Add the section that says what was run."""
    options = result.options
    step = options.get("step") or result.resolver.document.body.step
    every = options.get("every") or result.resolver.document.body.record.every
    seen = f", one of {every} recorded" if every > 1 else ""
    rows = [
        ("Overrides", "<br>".join(map(escape, result.overrides)) or "none: as written"),
        (
            "Engine",
            f"{escape(str(options.get('engine', '')))}, FMI {options.get('fmi', '')},"
            f" communication step {step * 1e3:g} ms{seen}",
        ),
        ("Ended by", escape(result.stopped)),
    ]
    if ran.done is not None:
        rows.append(("Program done", f"at {ran.done:.3f} s"))
    elif any(name.endswith(".done") for name in result.signals):
        rows.append(("Program done", "not within the run"))
    if ran.cycle is not None:
        since = "first command" if ran.programmed else "first motion of the tool"
        rows.append(("Cycle time", f"{ran.cycle:.3f} s, from the {since} to done"))
    if ran.distance is not None:
        told = ""
        if ran.programmed:
            cut, rapid = ran.programmed
            told = f"; programmed {cut:.4g} mm of cutting"
            told += f", {rapid:.4g} mm of rapids" if rapid > STANDS else ""
        rows.append(("Way of the tool", f"{ran.distance:.4g} mm{told}"))
    if ran.gains:
        rows.append(("Position gains", "<br>".join(map(escape, in_lines(ran.gains)))))
    told = "Not as the scenario is written: see the overrides." if result.overrides else ""
    page.section("What was run", told, facts(rows))


def add_speed(page: Page, ran: RunSummary) -> None:
    """Add the speed of the tool over time."""
    if ran.speeds is None:
        return
    told = [f"Of the tool, from its {ran.speeds.unit[1]}"]
    if ran.speeds.planned is not None:
        told.append("as the controller planned it")
    if ran.speeds.programmed is not None:
        rapids = ", rapids at their own speed" if ran.programmed else ""
        told.append(f"as programmed{rapids}")
    title = "Feed" if ran.programmed else "Speed of the tool"
    page.section(title, "; ".join(told) + ".", page.place("speed", speed_chart(ran.speeds), True))


def as_written(result: ReportInput, charts: Sequence[Chart]) -> list[Chart]:
    """The figures; where something is overridden, notes are marked as the scenario's."""
    if not result.overrides:
        return list(charts)
    return [replace(c, note=AS_WRITTEN + c.note) if c.note else c for c in charts]
