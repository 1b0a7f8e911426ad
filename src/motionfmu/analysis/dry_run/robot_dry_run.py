"""A robot's program without arm and drives: refusals, times, limits of each move."""

import re
from collections.abc import Callable, Mapping, Sequence
from dataclasses import asdict, dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.collisions import Approach, ArmParts, Cell, approaches
from motionfmu.analysis.cycle_time import CommandedMotion
from motionfmu.base.binding import CLOCK_HZ, dtype
from motionfmu.base.errors import InputError
from motionfmu.base.motion_rows import NUMBER_OF, ROW
from motionfmu.base.program_endings import ROBOT_JOBS
from motionfmu.run import Scenario
from motionfmu.run.run_plan import Options
from motionfmu.scenarios.values import values_in
from motionfmu.virtual.robot import RobotError, VirtualRobot, defaults

AXES = ("J1", "J2", "J3", "J4", "J5", "J6")
INPUTS, DIGITAL = 32, "di"  # digital inputs of the card, and their name
# The longest memory of the card, with which its driver works as seldom as it may; its lines.
MOST_SLOTS, MOST_LINES = 128, 1000
PIECE = 5.0  # [s] that are run at once
# A program that has waited so long for an input, with none to come, waits for ever [s].
PATIENCE = 60.0
LONGEST = 100_000.0  # [s] of a program
# Parameters by which a soft controller is known among components.
KNOWN = {"program", "points", "joint_low", "singular", "pulse_format"}
WAIT = NUMBER_OF["waiting"]


@dataclass(frozen=True)
class InputChange:
    """A digital input that changes.

    Attributes
    ----------
    time : float
        [s] after the start.
    number : int
        1 .. 32, as IN# in programs.
    on : bool
    """

    time: float
    number: int
    on: bool


@dataclass(frozen=True)
class DryMove:
    """One pass of a line that moves the arm.

    Attributes
    ----------
    line : int
    begin, end : float
        [s]
    way : float
        Of the tip [mm].
    joint : int
        The joint that comes nearest to an end of its range, from 1.
    left : float
        How far it is from there [deg].
    fastest : int
        The joint with the largest share of its speed, from 1.
    share : float
        That share.
    factors : tuple of float
        Least distance from singular: wrist centre from axis 1 [mm], sine of the elbow from
        stretched, sine of joint 5.
    """

    line: int
    begin: float
    end: float
    way: float
    joint: int
    left: float
    fastest: int
    share: float
    factors: tuple[float, float, float]


@dataclass(frozen=True)
class LineReserve:
    """All passes of a line together.

    Attributes
    ----------
    line, passes : int
    time, way : float
        [s], [mm] in all.
    nearest, fastest : DryMove
        The pass in which a joint comes nearest to an end of its range; in which one has the largest
        share of its speed.
    singular : tuple of float
        Least distances from singular: wrist centre from axis 1 [mm], elbow from stretched or
        folded, joint 5 from straight [deg].
    """

    line: int
    passes: int
    time: float
    way: float
    nearest: DryMove
    fastest: DryMove
    singular: tuple[float, float, float]


@dataclass(frozen=True)
class DryRun:
    """A program as its controller commands it.

    Attributes
    ----------
    file : Path
        The program.
    samples : (n,) structured ndarray
        ``time`` [s], ``joint`` (6,) [deg], ``rate`` (6,) [deg/s], ``place`` (3,) [mm], ``base``
        (3,) [mm] where a track has the arm, ``speed`` [mm/s], ``factors`` (3,) (`DryMove`),
        ``line`` that moves, ``at`` that a job reads next.
    low, high, top : (6,) ndarray
        Range [deg] and highest speed [deg/s] of the joints.
    fault : str
        Why it was refused or ended, with the line; empty: it runs through.
    fault_line : int
        0: none.
    axes : tuple of str
        Names of the joints.
    approaches : tuple of Approach
        How near the arm comes to itself and to its cell, by line.
    settings : mapping
        Of the virtual robot that ran it.
    cell : Cell
        What stood around it.
    """

    file: Path
    samples: NDArray[Any]
    low: NDArray[np.float64]
    high: NDArray[np.float64]
    top: NDArray[np.float64]
    fault: str
    fault_line: int
    axes: tuple[str, ...]
    approaches: tuple[Approach, ...] = ()
    settings: Mapping[str, Any] = field(default_factory=dict)
    cell: Cell = field(default_factory=Cell)

    @property
    def collisions(self) -> list[Approach]:
        """What comes too near, by line and time."""
        return [a for a in self.approaches if a.near]

    @cached_property
    def nearest(self) -> dict[int, Approach]:
        """Of each line the two that come nearest to each other."""
        found: dict[int, Approach] = {}
        for a in self.approaches:
            if a.line not in found or a.distance < found[a.line].distance:
                found[a.line] = a
        return found

    @property
    def faults(self) -> list[str]:
        """Why it cannot run as it is: a refusal, then collisions."""
        refused = self.fault.split("\n") if self.fault else []
        near = [f"line {a.line}: {a.words}" if a.line else a.words for a in self.collisions]
        return refused + near

    @property
    def time(self) -> float:
        """Cycle time with its waits [s], up to a refusal."""
        return float(self.samples["time"][-1]) if len(self.samples) else 0.0

    @property
    def waits(self) -> float:
        """Of it waiting for inputs [s]."""
        return float((self.samples["by"] == WAIT).sum() * self.frame)

    @property
    def frame(self) -> float:
        """Time from sample to sample [s]."""
        time = self.samples["time"]
        return float(time[1] - time[0]) if len(time) > 1 else self.time

    @cached_property
    def motion(self) -> CommandedMotion:
        """The same as rows that say what limits it."""
        runs = self.samples[self.samples["by"] != 0]
        rows = np.zeros(len(runs), ROW)
        rows["time"] = np.arange(1, len(runs) + 1) * self.frame
        rows["place"][:, :3] = runs["place"]
        for name in ("speed", "feed", "line", "axis"):
            rows[name] = runs[name]
        rows["cause"] = runs["by"]
        return CommandedMotion(self.frame, rows, self.axes, driven=True)

    @property
    def left(self) -> NDArray[np.float64]:
        """Room of each joint to an end of its range, (n, 6) [deg]."""
        joint = self.samples["joint"]
        return np.minimum(joint - self.low, self.high - joint)

    @cached_property
    def moves(self) -> list[DryMove]:
        """Each pass of each line that moves the arm, in order."""
        found = []
        s = self.samples
        moving = (np.abs(s["rate"]) > 0.0).any(axis=1)
        key = np.where(moving, s["line"], 0)
        cuts = np.flatnonzero(np.diff(key)) + 1
        left, share = self.left, np.abs(s["rate"]) / self.top
        steps = s["speed"] * self.frame  # the place leaps when another tool is taken
        for a, b in zip([0, *cuts], [*cuts, len(s)], strict=True):
            if key[a:b].size and key[a]:
                joint = int(left[a:b].min(axis=0).argmin())
                fastest = int(share[a:b].max(axis=0).argmax())
                shoulder, elbow, wrist = map(float, np.abs(s["factors"][a:b]).min(axis=0))
                found.append(
                    DryMove(
                        int(key[a]),
                        float(s["time"][a] - self.frame),
                        float(s["time"][b - 1]),
                        float(steps[a:b].sum()),
                        joint + 1,
                        float(left[a:b, joint].min()),
                        fastest + 1,
                        float(share[a:b, fastest].max()),
                        (shoulder, elbow, wrist),
                    )
                )
        return found

    @cached_property
    def lines(self) -> list[LineReserve]:
        """The lines that move the arm, by their numbers."""
        passes: dict[int, list[DryMove]] = {}
        for move in self.moves:
            passes.setdefault(move.line, []).append(move)
        found = []
        for line, moves in sorted(passes.items()):
            least = np.array([m.factors for m in moves]).min(axis=0)
            elbow, wrist = np.degrees(np.arcsin(np.minimum(1.0, least[1:])))
            time, way = sum(m.end - m.begin for m in moves), sum(m.way for m in moves)
            nearest = min(moves, key=lambda m: m.left)
            fastest = max(moves, key=lambda m: m.share)
            singular = (float(least[0]), float(elbow), float(wrist))
            found.append(LineReserve(line, len(moves), time, way, nearest, fastest, singular))
        return found

    def numbers(self) -> dict[str, Any]:
        """Verdict, cycle time, where it goes, all moves, for JSON."""
        found = {"fault": self.fault, "fault_line": self.fault_line, "waits": self.waits}
        moves = [asdict(m) for m in self.moves]
        near = {
            "collisions": [asdict(a) for a in self.collisions],
            "nearest": [asdict(a) for a in self.nearest.values()],
        }
        return found | self.motion.numbers() | {"time": self.time, "moves": moves} | near


def dry_run(
    scenario: Scenario,
    inputs: Sequence[InputChange] = (),
    set: Mapping[str, Any] | None = None,
    progress: Callable[[float], None] = lambda seconds: None,
    cell: Cell | None = None,
) -> DryRun:
    """Run a robot's program without arm and drives.

    Moves are planned and refused by the code that drives the arm, in the same order; the modelled
    PC needs no time, and its driver works as seldom as the card's memory lets it.

    Parameters
    ----------
    scenario : Scenario
        With a soft controller; what drives the card's ``di`` comes as the scenario says.
    inputs : sequence of InputChange, optional
        Instead of what the scenario drives.
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.
    progress : callable, optional
        Called with the time simulated so far [s].
    cell : Cell, optional
        What the arm may not touch, and how thick it is; without one it is looked at by itself.

    Returns
    -------
    DryRun
        A program that is refused is one, too, up to there.

    Raises
    ------
    InputError
        There is no soft controller with a program, a setting is wrong, or the program waits for an
        input that does not come.
    """
    _, value = _values(scenario, set or {})
    settings = _settings(value)
    try:
        robot = VirtualRobot(**settings)
    except RobotError as error:
        raise InputError(f"{scenario.name}: {error}") from None
    file = Path(str(value("program")))
    fault = _start(robot, file, value)
    samples = np.zeros(0, dtype("robot_sample"))
    if not fault:
        changes = sorted(inputs, key=lambda c: c.time)
        changes = changes or _driven(scenario, set or {}, value("start_delay"))
        cycle = 2.0 * settings["bus_period"]
        try:
            samples = _traced(robot, cycle, changes, progress)
        except InputError as error:
            raise InputError(f"{file}: {error}") from None
        seen = robot.read()
        fault = f"line {seen.error_line}: {seen.words}" if seen.error else ""
    number = re.match(r"line (\d+): ", fault)
    low, high, top = (np.array(settings[f"joint_{n}"], float) for n in ("low", "high", "speed"))
    count = int(settings["joints"])
    low[count:], high[count:] = -360.0, 360.0  # places without a joint stand far from any end
    line = int(number[1]) if number else 0
    cell = cell or Cell()
    near = approaches(samples, ArmParts.of(settings, cell.radii), cell) if len(samples) else []
    return DryRun(file, samples, low, high, top, fault, line, AXES, tuple(near), settings, cell)


def program_files(
    scenario: Scenario, set: Mapping[str, Any] | None = None
) -> tuple[str, Path, Path | None]:
    """Where the program of a soft controller is.

    Parameters
    ----------
    scenario : Scenario
    set : mapping, optional
        Values by ``component.variable``, stronger than the scenario's.

    Returns
    -------
    tuple
        The component, its program, its points or None.

    Raises
    ------
    InputError
        There is no soft controller with a program.
    """
    name, value = _values(scenario, set or {})
    points = str(value("points"))
    return name, Path(str(value("program"))), Path(points) if points else None


def _values(scenario: Scenario, set: Mapping[str, Any]) -> tuple[str, Callable[[str], Any]]:
    """The soft controller that has a program, and its values by the parameter."""
    given = {s.end.name: s.values for s in scenario.resolved(Options(set=set)).settings}
    for name, ports in scenario.resolver.ports.items():
        if not ports.keys() >= KNOWN or given.get(f"{name}.program", ("",)) == ("",):
            continue

        def value(key: str, name: str = name, ports: Mapping[str, Any] = ports) -> Any:
            if key not in ports:
                return None
            values = values_in(given, name, ports[key])
            return np.array(values) if ports[key].shape else values[0]

        return name, value
    told = "its machine has no robot's controller with a program; robot6 of motionfmu machines has"
    raise InputError(f"{scenario.name}: {told}")


def _settings(value: Callable[[str], Any]) -> dict[str, Any]:
    """Settings of the virtual robot: the controller's, on a PC that needs no time."""
    found = {key: x for key in defaults() if (x := value(key)) is not None}
    memory = int(found["slot_clocks"]) * MOST_SLOTS  # [clocks]
    lines = int(found["lines"]) * max(1, MOST_SLOTS // int(found["slots"]))
    found |= {"slots": MOST_SLOTS, "irq_every": memory / CLOCK_HZ, "lines": min(MOST_LINES, lines)}
    found |= {"bus_period": memory // 2 / CLOCK_HZ, "ik_time": 0.0, "line_time": 0.0}
    return found | {"start_delay": 0.0}


def _driven(scenario: Scenario, set: Mapping[str, Any], delay: float) -> list[InputChange]:
    """What the scenario drives at the card's inputs, counted from the program's start."""
    system = scenario.resolved(Options(set=set))
    found: list[InputChange] = []
    before = 0
    for s in system.stimuli:
        if s.end.port.name == DIGITAL:
            time = max(0.0, s.step * system.step_ns * 1e-9 - delay)
            now = int(s.values[0])
            found += [
                InputChange(time, n + 1, bool(now >> n & 1))
                for n in range(INPUTS)
                if (now ^ before) >> n & 1
            ]
            before = now
    return found


def _start(robot: VirtualRobot, file: Path, value: Callable[[str], Any]) -> str:
    """Start the program; why it is refused before anything moves, if it is."""
    language = str(value("language"))
    if language == "auto":
        language = "inform" if file.suffix.lower() in ROBOT_JOBS else "gcode"
    points = str(value("points"))
    try:
        text = Path(points).read_text(encoding="utf-8") if points else ""
        robot.start(file, text, language=language, job=str(value("job")))
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{points}: {getattr(error, 'strerror', None) or error}") from None
    except RobotError as error:
        return str(error)
    return ""


def _traced(
    robot: VirtualRobot,
    cycle: float,
    changes: Sequence[InputChange],
    progress: Callable[[float], None],
) -> NDArray[Any]:
    """Samples until the program is over and the arm rests."""
    parts, left, on = [], list(changes), set[int]()
    now = waited = 0.0
    while True:
        while left and left[0].time <= now:
            change = left.pop(0)
            (on.add if change.on else on.discard)(change.number)
            waited = 0.0
        robot.set_inputs(*on)
        until = max(cycle, left[0].time - now) if left else PIECE
        part = robot.trace(min(until, PIECE), cycle)
        parts.append(part)
        seen = robot.read()
        now = seen.time
        progress(now)
        if seen.rests:
            return np.concatenate(parts)
        waited = waited + len(part) * cycle if (part["by"] == WAIT).all() else 0.0
        if waited > PATIENCE and not left:
            line = f"line {part['at'][-1]}" if part["at"][-1] else "the program"
            raise InputError(f"{line} waits for an input that does not come")
        if now > LONGEST:
            raise InputError(f"the program goes on after {LONGEST:.0f} s")
