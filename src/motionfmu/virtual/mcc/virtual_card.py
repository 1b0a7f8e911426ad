"""A virtual card with its library and ideal motors, exact to the clock."""

import ctypes
from typing import Any

from motionfmu.base.binding import Reading, Station, Struct, library, real, whole
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc.state import Mcc, configuration

# What the motor of an axis follows: setting output_mode.
PULSES, LOOP, SOFTWARE = 0, 1, 2
# Where an encoder may stand: QUADRATURE_PHASE_MAX of src/pulse, four counts a line period.
_COUNTS_MAX = 2.0**52
# Of enum station_status.
_MOTOR_LOST = 6


class CardError(RuntimeError):
    """The run cannot go on; the message says why."""


class CardReading(Reading):
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
        All names: ``dir(reading)``; meanings in src/controllers/station/station.h.
    """


class VirtualCard(Station[CardReading]):
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
    >>> card = VirtualCard(feed=1200)
    >>> index = card.mcc.line([10, 5, 0, 0, 0, 0])
    >>> card.run_until_stop().pulses[:2].tolist()
    [10000, 5000]
    """

    _at_rest = "stopped"

    def __init__(self, **settings: Any) -> None:
        self._library, self._state = library(), Struct("station")
        config = configuration(settings)
        status = self._library.station_start(self._state.pointer, config.pointer)
        if status:
            raise InputError(_refused(settings))
        inner = ctypes.c_void_p(self._library.binding_mcc(self._state.pointer))
        self.mcc = Mcc._of_card(inner, self._state)

    def _advance(self, until: ctypes.c_int64) -> None:
        status = self._library.binding_run(self._state.pointer, until, *self.mcc._program())
        if status:
            raise CardError(
                "a motor is beyond what its encoder can follow"
                if status == _MOTOR_LOST
                else "the card takes no frame any more"
            )

    def read(self) -> CardReading:
        """What there is to see now.

        Returns
        -------
        CardReading
        """
        reading = Struct("reading")
        self._library.station_read(self._state.pointer, reading.pointer)
        return CardReading({name: reading[name] for name in reading})

    def __repr__(self) -> str:
        return f"<VirtualCard at {self.read().time:.9g} s: {self.mcc!r}>"

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
        if name not in ("home", "up", "down") or not all(a in range(6) for a in axes):
            told = f"switch {name!r:.80} of axes {axes!r:.80}: home, up or down of 0 .. 5 wanted"
            raise InputError(told)
        self._state[name] = sum(1 << a for a in set(map(whole, axes)))

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
            There is no such encoder, or no such place.
        """
        if not abs(real(counts)) <= _COUNTS_MAX:
            raise InputError(f"counts = {counts!r:.80}: at most 2^52 either way wanted")
        if encoder not in (6, 7, 8):
            raise InputError(f"encoder {encoder!r:.80}: 6 .. 8 wanted; 0 .. 5 are the motors'")
        phase = self._state["phase"]
        phase[whole(encoder)] = real(counts) / 4.0
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
