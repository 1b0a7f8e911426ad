"""Kinematics of the arm on arrays."""

import ctypes
from typing import Any

import numpy as np

from motionfmu.base.binding import Struct, library
from motionfmu.virtual.robot.refusal import RobotError, message, numbers

BRANCHES = 8


def configuration(settings: dict[str, Any]) -> Struct:
    """Settings as C takes them, by the names of `defaults`."""
    config = Struct("robot_config")
    library().binding_robot_defaults(config.pointer)
    for name, value in settings.items():
        config[name] = value
    return config


def switched_on(settings: dict[str, Any]) -> Struct:
    """Make a station at rest; RobotError names a setting that is refused."""
    state, words, value = Struct("robot_seen"), message(), (ctypes.c_double * 2)()
    config = configuration(settings)
    if library().binding_robot_on(state.pointer, config.pointer, value, words):
        raise RobotError(words.value.decode(), "VALUE", *value)
    return state


def _at(array: np.ndarray) -> ctypes.c_void_p:
    return array.ctypes.data_as(ctypes.c_void_p)


def _count(array: np.ndarray, size: int) -> ctypes.c_int64:
    return ctypes.c_int64(array.size // size)


def pose_of(matrix: Any) -> np.ndarray:
    """Poses X Y Z A B C of 4x4 matrices.

    Parameters
    ----------
    matrix : (..., 4, 4) array_like
        Rotation and place [mm].

    Returns
    -------
    (..., 6) ndarray
        [mm], [deg]; R = Rz(C) Ry(B) Rx(A), B in -90 .. 90, C = 0 where only C +- A is known.

    Raises
    ------
    RobotError
        These are no such numbers.
    """
    given = numbers("matrix", matrix, 4, 4)
    out = np.empty((*given.shape[:-2], 6))
    library().binding_robot_pose(_count(given, 16), _at(given), _at(out))
    return out


def matrix_of(pose: Any) -> np.ndarray:
    """4x4 matrices of poses X Y Z A B C.

    Parameters
    ----------
    pose : (..., 6) array_like
        [mm], [deg]; R = Rz(C) Ry(B) Rx(A).

    Returns
    -------
    (..., 4, 4) ndarray
        Rotation and place [mm].

    Raises
    ------
    RobotError
        These are no such numbers.
    """
    given = numbers("pose", pose, 6)
    out = np.empty((*given.shape[:-1], 4, 4))
    library().binding_robot_matrix(_count(given, 6), _at(given), _at(out))
    return out


class Kinematics:
    """Kinematics of six joints, on arrays.

    With a spherical wrist by seven lengths: Brandstoetter, Angerer, Hofbaur, Austrian Robotics
    Workshop 2014; with `arm_by` = 1 any arm by its axes. A branch is a sum of 1 (wrist flipped),
    2 (elbow down) and 4 (shoulder back).

    Parameters
    ----------
    **settings
        As in `defaults`: a1 .. c4, joint_offset, joint_sign, or arm_by, axis_origin,
        axis_direction, flange; joint_low, joint_high, tool.

    Raises
    ------
    InputError
        A setting is unknown or has the wrong type.
    RobotError
        A setting is out of its range.

    Examples
    --------
    >>> arm = Kinematics()
    >>> tip = arm.forward([10, 20, -30, 40, 50, 60])
    >>> joints = arm.inverse(tip)
    >>> joints.shape, bool(abs(joints[0] - [10, 20, -30, 40, 50, 60]).max() < 1e-9)
    ((8, 6), True)
    """

    def __init__(self, **settings: Any) -> None:
        self._library, self._arm = library(), Struct("robot_arm")
        state = switched_on(settings)
        self._library.binding_robot_arm(state.pointer, self._arm.pointer)

    def __repr__(self) -> str:
        where = ", ".join(f"{x:.6g}" for x in pose_of(self.forward(np.zeros(6))).round(6) + 0.0)
        return f"<Kinematics: joints at 0, tip at [{where}]>"

    def forward(self, joints: Any) -> np.ndarray:
        """Where the tip of the tool is.

        Parameters
        ----------
        joints : (..., 6) array_like
            [deg]

        Returns
        -------
        (..., 4, 4) ndarray
            Its frame in the base frame [mm].

        Raises
        ------
        RobotError
            These are no such numbers.
        """
        given = numbers("joints", joints, 6)
        out = np.empty((*given.shape[:-1], 4, 4))
        arm = self._arm.pointer
        self._library.binding_robot_forward(arm, _count(given, 6), _at(given), _at(out))
        return out

    def inverse(self, matrix: Any, near: Any = None) -> np.ndarray:
        """Joints of all eight branches.

        Parameters
        ----------
        matrix : (..., 4, 4) array_like
            Frame of the tip in the base frame [mm].
        near : (..., 6) array_like, optional
            Joint 4 stays as here where axes 4 and 6 are in line [deg].

        Returns
        -------
        (..., 8, 6) ndarray
            By branch, each within half a turn of 0 [deg]; NaN where a branch does not reach it.

        Raises
        ------
        RobotError
            These are no such numbers.
        """
        given, around = self._given(matrix, near)
        out = np.empty((*given.shape[:-2], BRANCHES, 6))
        count = _count(given, 16)
        arm = self._arm.pointer
        self._library.binding_robot_inverse(arm, count, _at(given), _at(around), _at(out))
        return out

    def nearest(self, matrix: Any, near: Any) -> tuple[np.ndarray, np.ndarray]:
        """Joints within their limits whose worst one moves least.

        Whole turns are counted.

        Parameters
        ----------
        matrix : (..., 4, 4) array_like
            Frame of the tip in the base frame [mm].
        near : (..., 6) array_like
            Where the joints are [deg].

        Returns
        -------
        joints : (..., 6) ndarray
            [deg]; NaN where no branch reaches it within the limits.
        branch : (...) ndarray of int
            -1 there.

        Raises
        ------
        RobotError
            These are no such numbers.
        """
        given, around = self._given(matrix, near)
        out = np.empty((*given.shape[:-2], 6))
        branch = np.empty(given.shape[:-2], np.int32)
        places = (_at(given), _at(around), _at(out), _at(branch))
        self._library.binding_robot_nearest(self._arm.pointer, _count(given, 16), *places)
        return out, branch

    def singular(self, joints: Any) -> tuple[np.ndarray, np.ndarray]:
        """How far joints are from singular, and their branch.

        Parameters
        ----------
        joints : (..., 6) array_like
            [deg]

        Returns
        -------
        factors : (..., 3) ndarray
            Wrist centre from axis 1 [mm], sine of the elbow from stretched, sine of joint 5.
        branch : (...) ndarray of int

        Raises
        ------
        RobotError
            These are no such numbers.
        """
        given = numbers("joints", joints, 6)
        out = np.empty((*given.shape[:-1], 3))
        branch = np.empty(given.shape[:-1], np.int32)
        places = (_at(given), _at(out), _at(branch))
        self._library.binding_robot_factors(self._arm.pointer, _count(given, 6), *places)
        return out, branch

    def _given(self, matrix: Any, near: Any) -> tuple[np.ndarray, np.ndarray]:
        given = numbers("matrix", matrix, 4, 4)
        around = numbers("near", np.zeros(6) if near is None else near, 6)
        wanted = (*given.shape[:-2], 6)
        try:
            return given, np.ascontiguousarray(np.broadcast_to(around, wanted))
        except ValueError:
            raise RobotError(f"near: shape {around.shape} beside {wanted}") from None
