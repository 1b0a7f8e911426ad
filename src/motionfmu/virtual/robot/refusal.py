"""The error that a refused call of the robot raises, made of what C says of it."""

import contextlib
import ctypes
import math
from collections.abc import Iterable
from typing import Any

import numpy as np

from motionfmu.base.binding import Struct
from motionfmu.base.errors import InputError

# Of enum robot_status.
STATUS = (
    "OK",
    "BUSY",
    "PARAMETER",
    "FAR",
    "OUTSIDE",
    "SINGULAR",
    "OTHER_BRANCH",
    "OTHER_TURN",
    "NO_CIRCLE",
    "OFF_PLANE",
    "NO_UNIT",
    "NO_SPLINE",
    "TILTED",
    "NO_JOINT",
    "BESIDE",
)
_IN_RADIANS = ("OUTSIDE", "TILTED")
_LENGTH = 420
# Of places [mm], angles [deg], directions.
MOST = 1e6


class RobotError(InputError):
    """A call that is refused; it has changed nothing.

    Attributes
    ----------
    status : str
        Why: BUSY, PARAMETER, FAR, OUTSIDE, SINGULAR, OTHER_BRANCH, OTHER_TURN, NO_CIRCLE,
        OFF_PLANE, NO_UNIT, NO_SPLINE, TILTED, NO_JOINT, BESIDE of a move;
        COLLISION; VALUE of an argument; PROGRAM of a text.
    value, limit : float
        What is wrong and how far it may go [deg] [mm]; NaN: no number decides.
    which : int
        Joint from 0 (OUTSIDE, OTHER_TURN), factor 0 shoulder 1 elbow 2 wrist (SINGULAR), or -1.
    part : float
        Of the path, 0 .. 1; NaN: it is no matter of the path.
    """

    def __init__(
        self,
        text: str,
        status: str = "VALUE",
        value: float = math.nan,
        limit: float = math.nan,
        *,
        more: Iterable[str] = (),
    ) -> None:
        super().__init__(text, *more)
        self.status, self.value, self.limit = status, value, limit
        self.which, self.part = -1, math.nan


def message() -> Any:
    """Room for a message of C."""
    return ctypes.create_string_buffer(_LENGTH)


def refused(call: str, code: int, why: Struct, words: Any) -> RobotError:
    """The error for a move or jog that C has refused."""
    status = STATUS[code]
    error = RobotError(f"{call}: {words.value.decode()}", status)
    if status not in ("BUSY", "PARAMETER"):
        scale = math.degrees(1.0) if status in _IN_RADIANS else 1.0
        scale = 1e3 if why["slides"] else scale
        error.value, error.limit = why["value"] * scale, why["limit"] * scale
        error.which, error.part = why["which"], why["part"]
    return error


def within(name: str, value: float, low: float, high: float) -> float:
    """Check that a number is within a range; a RobotError if it is not."""
    if not isinstance(value, int | float | np.number) or not low <= value <= high:
        limit = high if isinstance(value, int | float) and value > high else low
        number = math.nan
        if isinstance(value, int | float | np.number):
            with contextlib.suppress(OverflowError):  # an int that is beyond all floats
                number = float(value)
        text = f"{name} = {value!r:.80}: {low:g} to {high:g} is wanted"
        raise RobotError(text, "VALUE", number, limit)
    return float(value)


def whole_within(name: str, value: float, low: int, high: int) -> int:
    """Take a whole number of a range; RobotError if it is none."""
    number = within(name, value, low, high)
    if number != int(number):
        raise RobotError(f"{name} {value}: a whole number is wanted", "VALUE", number)
    return int(number)


def bounded(name: str, values: np.ndarray, most: float = MOST) -> np.ndarray:
    """Check an array of numbers against a limit; a RobotError names the first beyond it."""
    for k in np.flatnonzero(~(np.abs(values) <= most).ravel()):
        within(f"{name}[{k}]", float(values.flat[k]), -most, most)
    return values


def numbers(name: str, values: Any, *shape: int) -> np.ndarray:
    """Take an array of finite numbers whose last axes have a shape; RobotError if it is none."""
    try:
        given = np.asarray(values)
        array = np.ascontiguousarray(given, np.float64) if given.dtype.kind != "c" else np.empty(0)
    except (TypeError, ValueError, OverflowError):
        array = np.empty(0)
    if array.shape[max(0, array.ndim - len(shape)) :] != shape or not np.isfinite(array).all():
        text = f"{name}: finite numbers of shape {shape} are wanted, got {values!r:.200}"
        raise RobotError(text)
    return array
