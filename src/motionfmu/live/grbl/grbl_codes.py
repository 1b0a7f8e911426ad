"""Numbers by which Grbl 1.1 tells what is wrong, and the texts of its messages."""

from enum import IntEnum


class GrblError(IntEnum):
    """The number behind ``error:``."""

    OK = 0
    LETTER = 1
    NUMBER = 2
    STATEMENT = 3
    NEGATIVE = 4
    NO_HOMING = 5
    STEP_PULSE = 6
    NOT_IDLE = 8
    LOCKED = 9
    SOFT_LIMIT_NEEDS_HOMING = 10
    OVERFLOW = 11
    STEP_RATE = 12
    DOOR = 13
    LINE_LENGTH = 14
    TRAVEL = 15
    JOG = 16
    LASER = 17
    UNSUPPORTED = 20
    GROUP = 21
    NO_FEED = 22
    NOT_INTEGER = 23
    AXIS_CONFLICT = 24
    REPEATED = 25
    NO_AXES = 26
    LINE_NUMBER = 27
    MISSING = 28
    SYSTEM = 29
    G53 = 30
    AXES_UNUSED = 31
    NO_AXES_IN_PLANE = 32
    TARGET = 33
    RADIUS = 34
    NO_OFFSETS_IN_PLANE = 35
    UNUSED = 36
    LENGTH_AXIS = 37
    TOOL = 38


class GrblAlarm(IntEnum):
    """The number behind ``ALARM:``."""

    HARD_LIMIT = 1
    SOFT_LIMIT = 2
    ABORTED = 3
    PROBE_BEFORE = 4
    PROBE_MISSED = 5
    HOMING_RESET = 6
    HOMING_DOOR = 7
    HOMING_PULL_OFF = 8
    HOMING_APPROACH = 9


class GrblRefusal(Exception):
    """A line that is refused."""

    def __init__(self, error: GrblError) -> None:
        super().__init__(error.name)
        self.error = error


VERSION = "1.1h"
BUILD = "20190825"
GREETING = f"\r\nGrbl {VERSION} ['$' for help]\r\n"
HELP = "[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]\r\n"
LOCK = "'$H'|'$X' to unlock"
CRITICAL = "Reset to continue"
UNLOCKED = "Caution: Unlocked"
ENABLED, DISABLED = "Enabled", "Disabled"
DOOR = "Check Door"
END = "Pgm End"
RESTORING = "Restoring defaults"
SPINDLE = "Restoring spindle"
SLEEPING = "Sleeping"
