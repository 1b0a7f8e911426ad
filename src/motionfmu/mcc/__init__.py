"""The MCC library and a virtual card, from Python.

The same C code as in the FMUs; see src/controllers: mcc/README.md and station/station.h.
"""

from motionfmu.binding import CLOCK_HZ, Station
from motionfmu.mcc.card import LOOP, PULSES, SOFTWARE, CardError, Reading, VirtualCard
from motionfmu.mcc.library import CODES, MccError
from motionfmu.mcc.moves import CCW, CW
from motionfmu.mcc.state import BLOCK, DELAY, HOLD, RUNNING, STOPPED, WHEEL, Mcc, defaults

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
    "Mcc",
    "MccError",
    "Reading",
    "Station",
    "VirtualCard",
    "defaults",
]
