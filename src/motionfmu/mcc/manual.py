"""Calls that move axes for themselves: asynchronous rapid, jog, hand wheel, homing."""

import ctypes
from collections.abc import Sequence

from motionfmu.mcc.calls import Calls, Numbers, doubles, integers, letters, whole


class Manual(Calls):
    """Axes that move independently of each other; an axis is 0 .. 5.

    Jog, hand wheel and homing are taken only while no command is under way or waits.
    """

    def ptp_asyn(self, target: Numbers) -> int:
        """Rapid, each axis for itself.

        Parameters
        ----------
        target : (6,) sequence of float
            X Y Z U V W [mm].

        Returns
        -------
        int
            Index of the command.
        """
        return self._do("MCC_ptp_asyn", doubles(target))

    def jog_c(self, axis: int, direction: int, percent: float) -> None:
        """Jog on until it is stopped.

        Parameters
        ----------
        axis : int
        direction : int
            -1, +1; 0 stops.
        percent : float
            > 0 .. 100 of the safe motor speed.
        """
        self._do("MCC_jog_c", whole(axis), whole(direction), float(percent))

    def jog_i(self, axis: int, distance: float, percent: float) -> None:
        """Jog a way.

        Parameters
        ----------
        axis : int
        distance : float
            [mm]
        percent : float
            > 0 .. 100 of the safe motor speed.
        """
        self._do("MCC_jog_i", whole(axis), float(distance), float(percent))

    def jog_s(self, axis: int, pulses: int) -> None:
        """Jog some pulses.

        Parameters
        ----------
        axis : int
        pulses : int
            [pulses]
        """
        self._do("MCC_jog_s", whole(axis), whole(pulses))

    def MPG_set(self, axis: int, encoder: int, ratio: float) -> None:
        """Let an axis follow a hand wheel.

        Parameters
        ----------
        axis : int
        encoder : int
            Counter of the wheel, 0 .. 8.
        ratio : float
            [pulses/count]
        """
        self._do("MCC_MPG_set", whole(axis), whole(encoder), float(ratio))

    def MPG_disable(self) -> None:
        """Bring the axes that follow a hand wheel to rest."""
        self._do("MCC_MPG_disable")

    def go_home(self, order: Sequence[int]) -> None:
        """Search the origins; how is in the settings ``home_*``.

        Parameters
        ----------
        order : (6,) sequence of int
            Axes with 1 together, then those with 2, ...; 0: not.
        """
        self._do("MCC_go_home", integers(order))

    def check_homef(self) -> int:
        """Whether the search has ended well.

        Returns
        -------
        int
            1 it has, 0 it is under way. MccError if there is none (-10) or it failed (-14).
        """
        return self._do("MCC_check_homef")

    def set_ptp_asyn_acc_type(self, kinds: str) -> None:
        """Kind of acceleration of axes that move alone.

        Parameters
        ----------
        kinds : str of 6 letters
            A letter an axis: T or S.
        """
        self._do("MCC_set_ptp_asyn_acc_type", letters(kinds))

    def get_ptp_asyn_acc_type(self) -> str:
        """Kind of acceleration of axes that move alone.

        Returns
        -------
        str
            A letter an axis.
        """
        return b"".join(self._get("MCC_get_ptp_asyn_acc_type", ctypes.c_char)).decode()

    def set_ptp_asyn_acc_step(self, ms: Numbers) -> None:
        """Time from rest to the speed of axes that move alone.

        Parameters
        ----------
        ms : (6,) sequence of float
            [ms]
        """
        self._do("MCC_set_ptp_asyn_acc_step", doubles(ms))

    def get_ptp_asyn_acc_step(self) -> list[float]:
        """Time from rest to the speed of axes that move alone.

        Returns
        -------
        list of float
            [ms]
        """
        return self._get("MCC_get_ptp_asyn_acc_step", ctypes.c_double)

    def set_ptp_asyn_decc_type(self, kinds: str) -> None:
        """Kind of deceleration of axes that move alone.

        Parameters
        ----------
        kinds : str of 6 letters
            A letter an axis: T or S.
        """
        self._do("MCC_set_ptp_asyn_decc_type", letters(kinds))

    def get_ptp_asyn_dec_type(self) -> str:
        """Kind of deceleration of axes that move alone.

        Returns
        -------
        str
            A letter an axis.
        """
        return b"".join(self._get("MCC_get_ptp_asyn_dec_type", ctypes.c_char)).decode()

    def set_ptp_asyn_dec_step(self, ms: Numbers) -> None:
        """Time from the speed to rest of axes that move alone.

        Parameters
        ----------
        ms : (6,) sequence of float
            [ms]
        """
        self._do("MCC_set_ptp_asyn_dec_step", doubles(ms))

    def get_ptp_asyn_dec_step(self) -> list[float]:
        """Time from the speed to rest of axes that move alone.

        Returns
        -------
        list of float
            [ms]
        """
        return self._get("MCC_get_ptp_asyn_dec_step", ctypes.c_double)
