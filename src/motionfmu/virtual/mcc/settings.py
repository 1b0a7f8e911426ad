"""Calls that set and read how the library moves."""

import ctypes
from collections.abc import Sequence

from motionfmu.base.binding import real, whole
from motionfmu.virtual.mcc.calls import Calls, Numbers, doubles, integers, letter


class Settings(Calls):
    """Coordinates, speeds, accelerations, limits and gains.

    Each call that sets something raises MccError if it is refused.
    """

    def set_abs(self) -> None:
        """Targets are absolute from the next command on."""
        self._do("MCC_set_abs")

    def set_inc(self) -> None:
        """Targets are incremental from the next command on."""
        self._do("MCC_set_inc")

    def get_pos_type(self) -> int:
        """Kind of targets: 1 absolute, 0 incremental."""
        return self._do("MCC_get_pos_type")

    def set_fspd(self, feed: float) -> None:
        """Feed of lines, arcs and circles [mm/s]."""
        self._do("MCC_set_fspd", real(feed))

    def set_ptp_spd(self, percent: float) -> None:
        """Speed of rapids, > 0 .. 100 % of the safe motor speed."""
        self._do("MCC_set_ptp_spd", real(percent))

    def enable_quit(self) -> None:
        """Continuous path from the next command on."""
        self._do("MCC_enable_quit")

    def disable_quit(self) -> None:
        """Exact stop from the next command on."""
        self._do("MCC_disable_quit")

    def check_quit(self) -> int:
        """Whether the path is continuous: 0 it is, 1 it is not: the library's answer."""
        return self._do("MCC_check_quit")

    def set_acc_type(self, kind: str) -> None:
        """Kind of acceleration: T at a constant rate, S S-shaped."""
        self._do("MCC_set_acc_type", letter(kind))

    def get_acc_type(self) -> str:
        """Kind of acceleration, T or S."""
        return self._one("MCC_get_acc_type").decode()

    def set_dec_type(self, kind: str) -> None:
        """Kind of deceleration: T at a constant rate, S S-shaped."""
        self._do("MCC_set_dec_type", letter(kind))

    def get_dec_type(self) -> str:
        """Kind of deceleration, T or S."""
        return self._one("MCC_get_dec_type").decode()

    def set_acc_step(self, ms: float) -> None:
        """Time from rest to the commanded feed [ms]."""
        self._do("MCC_set_acc_step", real(ms))

    def get_acc_step(self) -> float:
        """Time from rest to the commanded feed [ms]."""
        return self._one("MCC_get_acc_step")

    def set_dec_step(self, ms: float) -> None:
        """Time from the commanded feed to rest [ms]."""
        self._do("MCC_set_dec_step", real(ms))

    def get_dec_step(self) -> float:
        """Time from the commanded feed to rest [ms]."""
        return self._one("MCC_get_dec_step")

    def set_dda(self, ms: float) -> None:
        """DDA time [ms], at standstill only; the nearest that the card can do is taken."""
        self._do("MCC_set_dda", real(ms))

    def get_dda(self) -> float:
        """DDA time the card has [ms]."""
        return self._one("MCC_get_dda")

    def set_max_dda_spd(self, values: Sequence[int]) -> None:
        """Most pulses of an axis in a DDA time."""
        self._do("MCC_set_max_dda_spd", integers(values))

    def get_max_dda_spd(self) -> list[int]:
        """Most pulses of an axis in a DDA time."""
        return self._get("MCC_get_max_dda_spd")

    def set_P_gain(self, values: Sequence[int]) -> None:
        """P gain of the card's position loop, 0 .. 65535, one an axis."""
        self._do("MCC_set_P_gain", integers(values))

    def get_P_gain(self) -> list[int]:
        """P gain of the card's position loop, 0 .. 65535, one an axis."""
        return self._get("MCC_get_P_gain")

    def set_over_spd(self, percent: float) -> None:
        """Override of lines, arcs and circles, 0 .. 200 %, at once."""
        self._do("MCC_set_over_spd", real(percent))

    def get_over_spd(self) -> float:
        """Override of lines, arcs and circles [%]."""
        return self._one("MCC_get_over_spd")

    def set_ptp_ospd(self, percent: float) -> None:
        """Override of rapids, 0 .. 200 %, at once; never above the safe motor speed."""
        self._do("MCC_set_ptp_ospd", real(percent))

    def get_ptp_ospd(self) -> float:
        """Override of rapids [%]."""
        return self._one("MCC_get_ptp_ospd")

    def set_tolerance(self, mm: float) -> None:
        """Look-ahead from here on: corners are rounded by at most this [mm]; 0 switches it off."""
        self._do("mcc_set_tolerance", real(mm))

    def set_curve(self, on: bool, merge: float = 0.0) -> None:
        """Look-ahead as a curve; runs of short commands merge within so much [mm]."""
        self._do("mcc_set_curve", ctypes.c_bool(on), real(merge))

    def task_set_origin(self, system: int, origin: Numbers) -> None:
        """Origin [mm] a part program begins with; the system is 1 for G54 .. 6 for G59."""
        self._do("task_set_origin", whole(system), doubles(origin))
