"""The MCC library and a virtual card, from Python.

The same C code as in the FMUs; see src/mcc/README.md and src/station/station.h.
"""

from motionfmu.mcc.card import LOOP, PULSES, SOFTWARE, CardError, Reading, VirtualCard
from motionfmu.mcc.library import CLOCK_HZ, CODES, MccError
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
    "VirtualCard",
    "defaults",
]
