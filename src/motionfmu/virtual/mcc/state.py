"""One library: start, program, control and status."""

import ctypes
from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.gcode.program import Texts, judged
from motionfmu.base.binding import Struct, whole
from motionfmu.base.errors import InputError
from motionfmu.virtual.mcc.axes import Axes
from motionfmu.virtual.mcc.calls import Calls
from motionfmu.virtual.mcc.library import AXES
from motionfmu.virtual.mcc.manual import Manual
from motionfmu.virtual.mcc.moves import Moves
from motionfmu.virtual.mcc.protection import Protection
from motionfmu.virtual.mcc.settings import Settings

# Answers of task_status.
RUNNING, STOPPED, HOLD, DELAY, BLOCK, WHEEL = range(6)
_FRAMES = 65536  # DDA times for which there is room at a time


def configuration(settings: dict[str, Any]) -> Struct:
    """Settings as the C library takes them, names as in `defaults`; one value goes to all axes."""
    config = Struct("config")
    config_library = Calls(config.pointer, config)
    config_library._library.binding_defaults(config.pointer)
    for name, value in settings.items():
        config[name] = value
    return config


def defaults() -> dict[str, tuple[Any, str]]:
    """Every setting of a library and a card with its start value.

    Returns
    -------
    dict
        Value and unit by name, those of the FMU mcc's parameters; arrays have an element an axis
        (irq_sources and irq_priority: a page of sources).
    """
    config = configuration({})
    return {name: (config[name], unit) for name, unit in config.units.items()}


class Mcc(Moves, Manual, Settings, Axes, Protection):
    """A motion library by itself, without a card.

    The functions are those of the source document, without ``MCC_``. A refused call changes
    nothing and raises MccError. A library of a VirtualCard is its ``mcc``; one by itself plans:
    `take` gives the pulses of each DDA time.

    Parameters
    ----------
    **settings
        As in `defaults`; those of PC and card have no use here.

    Raises
    ------
    InputError
        A setting is unknown or has the wrong type.
    MccError
        The library refuses a value.
    """

    def __init__(self, **settings: Any) -> None:
        state = Struct("mcc")
        super().__init__(state.pointer, state)
        self._texts: Texts | None = None
        self.init_motion(**settings)

    def __repr__(self) -> str:
        names = ("RUNNING", "STOPPED", "HOLD", "DELAY", "BLOCK", "WHEEL")
        where = ", ".join(f"{x:.6g}" for x in self.get_cpos())
        return f"<Mcc {names[self.task_status()]} at [{where}] mm>"

    @classmethod
    def _of_card(cls, pointer: ctypes.c_void_p, owner: object) -> "Mcc":
        mcc = cls.__new__(cls)
        Calls.__init__(mcc, pointer, owner)
        mcc._texts = None
        return mcc

    def init_motion(self, **settings: Any) -> None:
        """Start at rest at the origin; everything is forgotten.

        Parameters
        ----------
        **settings : dict
            As in `defaults`.
        """
        config = configuration(settings)
        machine = ctypes.c_void_p(self._library.binding_machine(config.pointer))
        self._do("MCC_init_motion", machine)

    def close_motion(self) -> None:
        """End, at standstill only."""
        self._do("MCC_close_motion")

    def clear_error(self) -> None:
        """Forget the run-time error; commands are taken again.

        Refused while its cause lasts, and until everything has come to rest.
        """
        self._do("MCC_clear_error")

    def get_errcode(self) -> int:
        """Run-time error.

        Returns
        -------
        int
            0 none; 0xF104, 0xF203, ... as the library numbers them.
        """
        return self._do("MCC_get_errcode")

    def motion_hold(self) -> None:
        """Ramp to rest on the path."""
        self._do("MCC_motion_hold")

    def motion_conti(self) -> None:
        """Go on behind motion_hold."""
        self._do("MCC_motion_conti")

    def motion_abort(self) -> None:
        """Ramp to rest, drop all commands and the program."""
        self._do("MCC_motion_abort")

    def check_stop(self) -> int:
        """Whether all commands are done and every point is written.

        Returns
        -------
        int
            1 they are, 0 not yet.
        """
        return self._do("MCC_check_stop")

    def get_cpos(self) -> np.ndarray:
        """Position of the points the card has taken.

        Returns
        -------
        (6,) ndarray of float
            [mm]
        """
        return np.array(self._get("MCC_get_cpos", ctypes.c_double))

    def get_ppos(self) -> np.ndarray:
        """The same in pulses.

        Returns
        -------
        (6,) ndarray of int
            [pulses]
        """
        return np.array(self._get("MCC_get_ppos"))

    def get_errcnt(self) -> np.ndarray:
        """Error counters of the card as reported last.

        Returns
        -------
        (6,) ndarray of int
            [counts]
        """
        return np.array(self._get("MCC_get_errcnt"))

    def task_check(self, program: str | Path, *, folder: Path | None = None) -> None:
        """Read a whole part program as it would run; nothing moves.

        Parameters
        ----------
        program : str or Path
            Its text; or, as a `pathlib.Path`, the file that holds it.
        folder : Path, optional
            Where the files are that it calls (``o<name> call``); that of a file by default.

        Raises
        ------
        InputError
            All faults, a line each, with their line, text and column.
        """
        self._check(Texts(program, folder))

    def _check(self, texts: Texts) -> None:
        check = self._library.binding_check
        faults, _, more = judged(
            texts.of.__getitem__, lambda *rows: check(self._pointer, *texts.call(), *rows)
        )
        texts.tell()
        if faults:
            raise InputError(*map(str, faults), *(["... and more"] if more else []))

    def task_start(self, program: str | Path, *, folder: Path | None = None) -> None:
        """Check a part program, then start it.

        Parameters
        ----------
        program : str or Path
            Its text; or, as a `pathlib.Path`, the file that holds it.
        folder : Path, optional
            Where the files are that it calls (``o<name> call``); that of a file by default.

        Raises
        ------
        InputError
            The program has a fault; it is not started.
        MccError
            The library does not take it now.
        """
        texts = Texts(program, folder)
        self._check(texts)
        self._do("task_start")
        self._texts = texts

    def task_continue(self) -> None:
        """Go on behind M0 or M1."""
        self._do("task_continue")

    def task_set_single_block(self, on: bool) -> None:
        """Rest before each line of the program, each call of the API.

        Parameters
        ----------
        on : bool
            `task_continue` lets the next one go.
        """
        self._do("task_set_single_block", ctypes.c_bool(on))

    def task_status(self) -> int:
        """The present state of the library.

        Returns
        -------
        int
            RUNNING, STOPPED, HOLD, DELAY, BLOCK (single block waits) or WHEEL.
        """
        return self._do("task_status")

    def _program(self) -> tuple[bytes | None, ctypes.c_int64, Any]:
        """The program that runs, for the calls of binding_mcc.c."""
        return self._texts.call() if self._texts else (None, ctypes.c_int64(0), None)

    def take(self, count: int) -> np.ndarray:
        """Plan, and take points as a card would.

        Not for the library of a VirtualCard, whose card takes them.

        Parameters
        ----------
        count : int
            At most so many DDA times.

        Returns
        -------
        (n, 6) ndarray of int
            Pulses of each DDA time; n < `count` if the axes rest.
        """
        if whole(count) < 0:
            raise InputError(f"count = {count!r}: 0 or more wanted")
        frames = [np.zeros((0, AXES), np.int32)]
        left = whole(count)
        while left > 0:
            part = np.zeros((min(left, _FRAMES), AXES), np.int32)
            where, most = part.ctypes.data_as(ctypes.c_void_p), ctypes.c_int32(len(part))
            n = self._library.binding_take(self._pointer, *self._program(), where, most)
            frames.append(part[:n])
            left = left - n if n == len(part) else 0
        return np.concatenate(frames)
