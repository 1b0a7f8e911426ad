"""A virtual robot: soft controller, card and an ideal arm, exact to the clock."""

import ctypes
import warnings
from typing import TYPE_CHECKING, Any

import numpy as np

from motionfmu.base.binding import CLOCK_HZ, Reading, Station, Struct, dtype, library
from motionfmu.base.errors import InputError
from motionfmu.virtual.robot.commands import Commands
from motionfmu.virtual.robot.kinematics import configuration, switched_on
from motionfmu.virtual.robot.refusal import RobotError, message, whole_within

if TYPE_CHECKING:
    from motionfmu.analysis.collisions import Cell

# Answers of reading.status.
IDLE, RUNNING, HOLD, WAITING, DELAY, PAUSED, JOG, ERROR, STOPPED = range(9)
# Frames of a jog.
JOINTS, BASE, TOOL = range(3)
_ROWS = 4096  # of a trace that are made at once


def defaults() -> dict[str, tuple[Any, str]]:
    """Every setting of a virtual robot with its start value.

    Returns
    -------
    dict
        Value and unit by name: the parameters of the FMU soft_controller (their meanings are in its
        fmu.toml), and of the card irq_every, input_irq_mask, follow_mask, stop_mask, stop_low,
        alarm_stops, stop_servo_off.
    """
    config = configuration({})
    return {name: (config[name], unit) for name, unit in config.units.items()}


class RobotReading(Reading):
    """What there is to see at one clock.

    Attributes
    ----------
    clock : int
        [25 ns]; `time` is the same in seconds.
    pulses : (6,) ndarray of int
        Put out [pulses].
    joint, pose : (6,) ndarray of float
        Where the arm is [deg], its tip X Y Z A B C [mm], [deg].
    joint_command, pose_command : (6,) ndarray of float
        At the end of the pulses written.
    configuration : int
        Branch of the joints: a sum of 1 (wrist flipped), 2 (elbow down), 4 (shoulder back).
    factors : (3,) ndarray of float
        From singular: wrist centre from axis 1 [mm], sine of the elbow, sine of joint 5.
    path_feed, path_length : float
        [mm/s], [mm] of the tip.
    inputs, outputs : int
        Digital ones, a bit each; ai, ao : (8,) ndarray [V].
    status : int
        IDLE, RUNNING, HOLD, WAITING, DELAY, PAUSED, JOG, ERROR, STOPPED.
    error, error_line : int
        Why the program was ended: 0 it was not, 1 a move is refused, 2 a fault of its own, 3 out of
        reach on the path; `words` says it.
    line, move, reached : int
        Line of the program that moves; moves given, moves whose points are passed.
    done, stopped, rests : bool
        The program has ended; a stop of the card acts; nothing is left to do.
    irq_wait, cycle_time, spare_time, busy, line_latency : float
        Of the driver's latest cycle: interrupt to begin, to mark, mark to its pulses; in all; a
        line's way to its first slot [s]; the longest are irq_wait_most, cycle_time_most,
        line_latency_most.
    ... :
        All names: ``dir(reading)``; meanings in src/controllers/robot_controller/controller.h
        and src/devices/fpga/fpga.h.
    """


class VirtualRobot(Commands, Station[RobotReading]):
    """Soft controller, FPGA card and an ideal arm in one loop.

    Parameters
    ----------
    cell : Cell, optional
        Of `motionfmu.analysis.collisions`: moves by calls that would bring the arm too near itself
        or the cell's bodies are refused. None: nobody looks; programs are `motionfmu job`'s.
    **settings
        As in `defaults`; one value goes to all joints.

    Attributes
    ----------
    kinematics : Kinematics
        Of the arm with its tool.

    Raises
    ------
    InputError
        A setting is unknown or has the wrong type.
    RobotError
        A setting is out of its range.

    Examples
    --------
    >>> robot = VirtualRobot()
    >>> robot.move_line([1000, 100, 900, 180, 0, 180], feed=200)
    1
    >>> robot.run_until_stop().pose[:3].round(2).tolist()
    [1000.0, 100.0, 900.0]
    """

    _at_rest = "rests"

    def __init__(self, *, cell: "Cell | None" = None, **settings: Any) -> None:
        state = switched_on(settings)
        Commands.__init__(self, state, settings, cell)

    def __repr__(self) -> str:
        seen = self.read()
        names = "IDLE RUNNING HOLD WAITING DELAY PAUSED JOG ERROR STOPPED".split()
        where = ", ".join(f"{x:.6g}" for x in seen.pose.round(6) + 0.0)
        return f"<VirtualRobot at {seen.time:.9g} s: {names[seen.status]} at [{where}]>"

    def _advance(self, until: ctypes.c_int64) -> None:
        program = self._program.pointer if self._program else None
        before = self._state["underruns"]
        library().binding_robot_run(self._state.pointer, until, program)
        self._tell_underruns(before, 5)

    def _tell_underruns(self, before: int, level: int) -> None:
        """Warn of underruns since there were so many; `level` is the caller's of `warnings`."""
        if missed := self._state["underruns"] - before:
            when, cycle = self._state["clock"] / CLOCK_HZ, self._state["cycle_time_most"] * 1e6
            warnings.warn(
                f"{missed} underruns of the card until {when:.6g} s: cycles of the driver "
                f"take up to {cycle:.4g} µs (ik_time, pitch)",
                RuntimeWarning,
                stacklevel=level,
            )

    def read(self) -> RobotReading:
        """What there is to see now.

        Returns
        -------
        RobotReading
        """
        reading, words = Struct("robot_reading"), message()
        library().robot_station_read(self._state.pointer, reading.pointer)
        library().binding_robot_words(self._state.pointer, words)
        seen = {name: self._state[name] for name in self._state}
        found = {name: reading[name] for name in reading}
        return RobotReading({**seen, **found, "words": words.value.decode()})

    def trace(self, seconds: float, step: float) -> np.ndarray:
        """Run a program on and sample it until the arm rests.

        Parameters
        ----------
        seconds : float
            [s] at most.
        step : float
            [s] between two samples, rounded to 25 ns.

        Returns
        -------
        (n,) structured ndarray
            Commanded are ``joint`` (6,) [deg], ``rate`` (6,) [deg/s], ``place`` (3,) [mm] and
            ``speed`` [mm/s] over ``time`` [s]. ``feed`` is asked for, 0 of joints [mm/s];
            ``factors`` (3,) are as in `RobotReading`. ``line`` moves, ``at`` is the one that a job
            reads next, 0 of a part program. ``by`` and ``axis`` say what limits it
            (`motionfmu.base.motion_rows.CAUSES`).

        Raises
        ------
        RobotError
            No program has been started.
        InputError
            It is no such time.
        """
        if self._program is None:
            raise RobotError("trace: no program has been started")
        clocks = round(step * CLOCK_HZ)
        if clocks < 1:
            raise InputError(f"step = {step} s: 25 ns or more wanted")
        last = int(self._state["clock"]) + round(seconds * CLOCK_HZ)
        before = self._state["underruns"]
        parts: list[np.ndarray] = []
        while not parts or len(parts[-1]) == _ROWS:
            rows = np.zeros(_ROWS, dtype("robot_sample"))
            count = library().binding_robot_trace(
                self._state.pointer,
                self._program.pointer,
                ctypes.c_int64(last),
                ctypes.c_int64(clocks),
                rows.ctypes.data_as(ctypes.c_void_p),
                ctypes.c_int64(_ROWS),
            )
            parts.append(rows[:count])
        self._tell_underruns(before, 3)
        return np.concatenate(parts)

    def set_inputs(self, *numbers: int) -> None:
        """Digital inputs at the card's terminals.

        Parameters
        ----------
        *numbers : int
            Those that are on, 1 .. 32 as IN# in programs; all others are off.

        Raises
        ------
        RobotError
            There is no such input.
        """
        self._panel["inputs"] = sum({1 << (self._number("input", n, 32) - 1) for n in numbers})

    def set_analog_input(self, number: int, volts: float) -> None:
        """Voltage at an analog input of the card.

        Parameters
        ----------
        number : int
            1 .. 8 as AI# in programs.
        volts : float
            [V] -10 .. 10.

        Raises
        ------
        RobotError
            There is no such input or voltage.
        """
        ai = self._panel["ai"]
        ai[self._number("input", number, 8) - 1] = self._volts(volts)
        self._panel["ai"] = np.asarray(ai)

    def set_alarms(self, *joints: int) -> None:
        """Alarms of the drives.

        Parameters
        ----------
        *joints : int
            Those whose drive has an alarm, 0 .. 5; all others have none.

        Raises
        ------
        RobotError
            There is no such joint.
        """
        self._panel["alarm"] = sum({1 << whole_within("joint", j, 0, 5) for j in joints})

    def set_stop(self, pressed: bool) -> None:
        """Emergency stop at the card's terminal.

        Parameters
        ----------
        pressed : bool
            It lasts until `reset` behind its release.
        """
        self._panel["emergency"] = bool(pressed)
