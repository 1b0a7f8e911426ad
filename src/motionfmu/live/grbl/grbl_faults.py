"""Grbl's number for what the library refuses of a line that Grbl's own rules let pass."""

import functools

from motionfmu.base.binding import library
from motionfmu.live.grbl.grbl_codes import GrblAlarm, GrblError

OCCUPIED = (
    "no line by hand is taken while a program runs",
    "no line by hand is taken while axes are jogged or homed",
    "no line by hand is taken until the run-time error is cleared",
)
# By the text of the fault; what is not here is an unsupported command.
ERRORS = {
    "unexpected character": GrblError.LETTER,
    "number expected after": GrblError.NUMBER,
    "number of more than 120 digits": GrblError.NUMBER,
    "line longer than 256 characters": GrblError.OVERFLOW,
    "word given twice": GrblError.REPEATED,
    "second word of one modal group": GrblError.GROUP,
    "two codes take the same words": GrblError.AXIS_CONFLICT,
    "word has no use in this line": GrblError.UNUSED,
    "value out of range": GrblError.NEGATIVE,
    "axis word without G0, G1, G2 or G3": GrblError.AXES_UNUSED,
    "G4 without P": GrblError.MISSING,
    "no axis word": GrblError.NO_AXES,
    "G10 needs L2 or L20 and P0 to P9": GrblError.MISSING,
    "G53 needs G0 or G1": GrblError.G53,
    "arc without centre or radius": GrblError.NO_OFFSETS_IN_PLANE,
    "arc with both centre and radius": GrblError.UNUSED,
    "arc of radius zero": GrblError.RADIUS,
    "arc end does not lie on the circle through its start": GrblError.TARGET,
    "arc radius is smaller than half the distance to the end": GrblError.RADIUS,
    "arc is not determined by its points": GrblError.TARGET,
    "no F since G93, G94 or G95; with G93 each line needs one": GrblError.NO_FEED,
    "probing leads nowhere": GrblError.TARGET,
    "a word is missing that goes with": GrblError.MISSING,
    "no such tool in the tool table": GrblError.TOOL,
    "axis is not active": GrblError.UNSUPPORTED,
    **dict.fromkeys(OCCUPIED, GrblError.LOCKED),
}
TRAVEL = "path leaves the software limits"
# Alarms by the library's run-time errors; that of a search is 63232 + 16 * fault + axis.
_LIMITS = range(62209, 62215)
_PROBES = {63361: GrblAlarm.PROBE_BEFORE, 63362: GrblAlarm.PROBE_MISSED}
_HOMING, _HOMING_FAULTS = 63232, 4
_NOT_LEFT = 2


@functools.cache
def fault_text(fault: int) -> str:
    """What the library says of a fault."""
    return str(library().fault_text(fault).decode())


def error_of(fault: int) -> GrblError | None:
    """The number of a fault of a line; None if it is Grbl's soft limit, which is an alarm."""
    text = fault_text(fault)
    return None if text == TRAVEL else ERRORS.get(text, GrblError.UNSUPPORTED)


def alarm_of(error: int) -> GrblAlarm:
    """The number of a run-time error."""
    if error in _PROBES:
        return _PROBES[error]
    if error in _LIMITS:
        return GrblAlarm.HARD_LIMIT
    fault = (error - _HOMING) // 16
    if 1 <= fault <= _HOMING_FAULTS:
        return GrblAlarm.HOMING_PULL_OFF if fault == _NOT_LEFT else GrblAlarm.HOMING_APPROACH
    return GrblAlarm.ABORTED
