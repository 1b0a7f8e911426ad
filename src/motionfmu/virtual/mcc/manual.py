"""Calls that move single axes: asynchronous rapid, jog, hand wheel, homing."""

import ctypes
from collections.abc import Sequence

from motionfmu.virtual.mcc.calls import Calls, Numbers, doubles, integers, letters, real, whole


class Manual(Calls):
    """Axes that move independently of each other; an axis is 0 .. 5.

    Jog, hand wheel and homing are taken only while no command is under way or waits.
    """

    def ptp_asyn(self, target: Numbers) -> int:
        """Rapid, each axis for itself, to X Y Z U V W [mm]; returns the index of the command."""
        return self._do("MCC_ptp_asyn", doubles(target))

    def jog_c(self, axis: int, direction: int, percent: float) -> None:
        """Jog on until stopped: direction -1, +1, 0 stops; > 0 .. 100 % of the safe motor speed."""
        self._do("MCC_jog_c", whole(axis), whole(direction), real(percent))

    def jog_i(self, axis: int, distance: float, percent: float) -> None:
        """Jog a way [mm] at > 0 .. 100 % of the safe motor speed."""
        self._do("MCC_jog_i", whole(axis), real(distance), real(percent))

    def jog_s(self, axis: int, pulses: int) -> None:
        """Jog some pulses."""
        self._do("MCC_jog_s", whole(axis), whole(pulses))

    def MPG_set(self, axis: int, encoder: int, ratio: float) -> None:
        """Let an axis follow a hand wheel: counter 0 .. 8, ratio [pulses/count]."""
        self._do("MCC_MPG_set", whole(axis), whole(encoder), real(ratio))

    def MPG_disable(self) -> None:
        """Bring the axes that follow a hand wheel to rest."""
        self._do("MCC_MPG_disable")

    def go_home(self, order: Sequence[int]) -> None:
        """Search the origins (settings ``home_*``): axes with 1 together, then 2, ..., 0 not."""
        self._do("MCC_go_home", integers(order))

    def check_homef(self) -> int:
        """Whether the search ended well: 1 or, under way, 0; MccError: none (-10), failed (-14)."""
        return self._do("MCC_check_homef")

    def set_ptp_asyn_acc_type(self, kinds: str) -> None:
        """Kind of acceleration of axes that move alone, a letter an axis: T or S."""
        self._do("MCC_set_ptp_asyn_acc_type", letters(kinds))

    def get_ptp_asyn_acc_type(self) -> str:
        """Kind of acceleration of axes that move alone, a letter an axis."""
        return b"".join(self._get("MCC_get_ptp_asyn_acc_type", ctypes.c_char)).decode()

    def set_ptp_asyn_acc_step(self, ms: Numbers) -> None:
        """Time from rest to the speed of axes that move alone [ms]."""
        self._do("MCC_set_ptp_asyn_acc_step", doubles(ms))

    def get_ptp_asyn_acc_step(self) -> list[float]:
        """Time from rest to the speed of axes that move alone [ms]."""
        return self._get("MCC_get_ptp_asyn_acc_step", ctypes.c_double)

    def set_ptp_asyn_decc_type(self, kinds: str) -> None:
        """Kind of deceleration of axes that move alone, a letter an axis: T or S."""
        self._do("MCC_set_ptp_asyn_decc_type", letters(kinds))

    def get_ptp_asyn_dec_type(self) -> str:
        """Kind of deceleration of axes that move alone, a letter an axis."""
        return b"".join(self._get("MCC_get_ptp_asyn_dec_type", ctypes.c_char)).decode()

    def set_ptp_asyn_dec_step(self, ms: Numbers) -> None:
        """Time from the speed to rest of axes that move alone [ms]."""
        self._do("MCC_set_ptp_asyn_dec_step", doubles(ms))

    def get_ptp_asyn_dec_step(self) -> list[float]:
        """Time from the speed to rest of axes that move alone [ms]."""
        return self._get("MCC_get_ptp_asyn_dec_step", ctypes.c_double)
