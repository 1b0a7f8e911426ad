"""The MCC library and a virtual card, from Python.

The same C code as in the FMUs; see src/controllers: mcc/README.md and station/station.h.
"""

from motionfmu.base.binding import CLOCK_HZ, Station
from motionfmu.virtual.mcc.library import CODES, MccError
from motionfmu.virtual.mcc.moves import CCW, CW
from motionfmu.virtual.mcc.state import BLOCK, DELAY, HOLD, RUNNING, STOPPED, WHEEL, Mcc, defaults
from motionfmu.virtual.mcc.virtual_card import (
    LOOP,
    PULSES,
    SOFTWARE,
    CardError,
    CardReading,
    VirtualCard,
)

__all__ = [
    "BLOCK",
    "CCW",
    "CLOCK_HZ",
    "CODES",
    "CW",
    "DELAY",
    "HOLD",
    "LOOP",
    "PULSES",
    "RUNNING",
    "SOFTWARE",
    "STOPPED",
    "WHEEL",
    "CardError",
    "CardReading",
    "Mcc",
    "MccError",
    "Station",
    "VirtualCard",
    "defaults",
]
