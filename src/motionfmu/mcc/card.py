"""A virtual card with its library and ideal motors, exact to the clock."""

import ctypes
from typing import Any

import numpy as np

from motionfmu.errors import InputError
from motionfmu.mcc.library import CLOCK_HZ, Struct, library
from motionfmu.mcc.state import Mcc, configuration

# What the motor of an axis follows: setting output_mode.
PULSES, LOOP, SOFTWARE = 0, 1, 2
_SECOND_MAX = 2**62 // CLOCK_HZ
_MILLISECOND = CLOCK_HZ // 1000
# Of enum station_status.
_MOTOR_LOST = 6


class CardError(RuntimeError):
    """The run cannot go on; the message says why."""


class Reading:
    """What there is to see at one clock.

    Attributes
    ----------
    clock : int
        [25 ns]; `time` is the same in seconds.
    pulses, counts, errors : (6,) ndarray of int
        Put out [pulses], encoder and error counters [counts].
    volts : (6,) ndarray of float
        DAC [V].
    motor, table, position : (6,) ndarray of float
        Motors [counts] and [mm]; position of the library [mm].
    stock, underflows : (6,) ndarray of int
        Of the FIFOs.
    status, error, line, command : int
        Of the library.
    stopped : bool
        All commands done and every pulse put out.
    ... :
        All names: ``dir(reading)``; meanings in src/station/station.h.
    """

    def __init__(self, values: dict[str, Any]) -> None:
        self.__dict__.update(values, time=values["clock"] / CLOCK_HZ)

    def __getattr__(self, name: str) -> Any:
        raise AttributeError(f"no reading {name!r} (there are: {', '.join(self.__dict__)})")

    def __repr__(self) -> str:
        return f"Reading({', '.join(f'{k}={v}' for k, v in self.__dict__.items())})"


class VirtualCard:
    """PC, library, card and ideal motors in one loop.

    Parameters
    ----------
    **settings
        As in `defaults`; one value goes to all axes.

    Attributes
    ----------
    mcc : Mcc
        The library; call it between two runs.

    Raises
    ------
    InputError
        A setting is unknown, has the wrong type, or is refused.

    Examples
    --------
    >>> card = VirtualCard(feed=20.0)
    >>> index = card.mcc.line([10, 5, 0, 0, 0, 0])
    >>> card.run_until_stop().pulses[:2].tolist()
    [10000, 5000]
    """

    def __init__(self, **settings: Any) -> None:
        self._library, self._state = library(), Struct("station")
        config = configuration(settings)
        status = self._library.station_start(self._state.pointer, config.pointer)
        if status:
            raise InputError(_refused(settings))
        inner = ctypes.c_void_p(self._library.binding_mcc(self._state.pointer))
        self.mcc = Mcc._of_card(inner, self._state)

    @property
    def clock(self) -> int:
        """Everything up to here has happened [25 ns]."""
        return self.read().clock

    def read(self) -> Reading:
        """What there is to see now."""
        reading = Struct("reading")
        self._library.station_read(self._state.pointer, reading.pointer)
        return Reading({name: reading[name] for name in reading})

    def run_to(self, clock: int) -> Reading:
        """Run up to and including a clock.

        Parameters
        ----------
        clock : int
            [25 ns]; nothing happens if it has passed.

        Raises
        ------
        CardError
            The card takes no frame any more, or a motor is beyond what an encoder can follow.
        """
        text, length = self.mcc._program()
        until = ctypes.c_int64(clock)
        status = self._library.binding_run(self._state.pointer, until, text, length)
        if status:
            raise CardError(
                "a motor is beyond what its encoder can follow"
                if status == _MOTOR_LOST
                else "the card takes no frame any more"
            )
        return self.read()

    def run(self, seconds: float) -> Reading:
        """Run on.

        Parameters
        ----------
        seconds : float
            [s], rounded to 25 ns.

        Raises
        ------
        InputError
            It is no length of time.
        CardError
            See `run_to`.
        """
        if not 0 <= seconds <= _SECOND_MAX:
            raise InputError(f"{seconds} s cannot be run")
        return self.run_to(self.clock + round(seconds * CLOCK_HZ))

    def run_until_stop(self, limit: float = 60.0) -> Reading:
        """Run until all commands are done and every pulse is out.

        Parameters
        ----------
        limit : float
            [s] at most.

        Returns
        -------
        Reading
            At the first millisecond at which it has stopped, or at the limit.

        Raises
        ------
        CardError
            See `run_to`.
        """
        last = self.clock + round(limit * CLOCK_HZ)
        reading = self.run_to(min(last, self.clock + _MILLISECOND))
        while not reading.stopped and reading.clock < last:
            reading = self.run_to(min(last, reading.clock + _MILLISECOND))
        return reading

    def record(self, seconds: float, step: float, *names: str) -> dict[str, np.ndarray]:
        """Run on and keep readings.

        Parameters
        ----------
        seconds : float
            [s]
        step : float
            [s] between two readings, rounded to 25 ns.
        *names : str
            Attributes of Reading.

        Returns
        -------
        dict
            ``time`` (n,) [s] and an array for each name, a row a reading, the first before
            anything runs.

        Raises
        ------
        InputError
            There is no such reading, or no such time.
        CardError
            See `run_to`.
        """
        clocks = round(step * CLOCK_HZ)
        if clocks < 1 or not 0 <= seconds <= _SECOND_MAX:
            raise InputError(f"step {step} s, {seconds} s: cannot be run")
        first = self.read()
        if unknown := [n for n in names if n not in first.__dict__]:
            raise InputError(f"no reading {unknown[0]!r} (there are: {', '.join(first.__dict__)})")
        rows = [first]
        for k in range(1, round(seconds * CLOCK_HZ) // clocks + 1):
            rows.append(self.run_to(first.clock + k * clocks))
        return {n: np.array([getattr(r, n) for r in rows]) for n in ("time", *names)}

    def set_switches(self, name: str, *axes: int) -> None:
        """Switches of the axes at the card's terminals.

        Parameters
        ----------
        name : str
            ``home``, ``up`` or ``down`` (over-travel at the positive, negative end).
        *axes : int
            Those whose switch is closed, 0 .. 5; all others are open.

        Raises
        ------
        InputError
            There is no such switch or axis.
        """
        if name not in ("home", "up", "down") or not set(axes) <= set(range(6)):
            raise InputError(f"switch {name!r} of axes {axes}: home, up or down of 0 .. 5 wanted")
        self._state[name] = sum(1 << a for a in set(axes))

    def set_encoder(self, encoder: int, counts: float) -> None:
        """Turn a spare encoder, a hand wheel for one.

        Parameters
        ----------
        encoder : int
            6 .. 8.
        counts : float
            Where it stands at the next instant [counts], four a line period.

        Raises
        ------
        InputError
            There is no such encoder.
        """
        if encoder not in (6, 7, 8):
            raise InputError(f"encoder {encoder}: 6 .. 8 wanted; 0 .. 5 are the motors'")
        phase = self._state["phase"]
        phase[encoder] = counts / 4.0
        self._state["phase"] = phase

    def set_stop(self, pressed: bool) -> None:
        """Emergency stop at the card's terminal.

        Parameters
        ----------
        pressed : bool
        """
        self._state["stop"] = bool(pressed)


def _refused(settings: dict[str, Any]) -> str:
    """Which setting the library or the station refuses, found by trying each alone."""
    state = Struct("station")
    for name, value in settings.items():
        alone = configuration({name: value})
        if library().station_start(state.pointer, alone.pointer):
            return f"{name} = {value!r} is out of range"
    together = ", ".join(f"{n} = {v!r}" for n, v in settings.items())
    return f"these settings do not fit together: {together}"
