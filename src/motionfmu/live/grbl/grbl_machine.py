"""What a Grbl session sees of a machine, and what it may do to it: values of inputs, lines."""

from dataclasses import dataclass
from typing import Any, Protocol

from motionfmu.live.grbl.grbl_block import ORIGIN, Point

RUNNING, STOPPED, RESTS, DELAYS, BLOCK = range(5)  # the library's `status`


@dataclass(frozen=True)
class MachineView:
    """A look at the machine."""

    time: float = 0.0  # simulated [s]
    orders: int = 0  # carried out by then
    status: int = STOPPED
    error: int = 0
    position: Point = ORIGIN  # in the machine [mm]
    offset: Point = ORIGIN  # the work's zero [mm]
    probed: Point = ORIGIN  # the latest contact [mm]
    found: bool = False  # the latest probing has ended at a contact
    feed: float = 0.0  # [mm/min]
    speed: float = 0.0  # [rpm]
    coolant: int = 0
    homed: bool = False
    lines: int = 0  # that the library has read, refused or dropped
    done: int = 0  # those of them that are over
    fault: int = 0  # of the latest line that was refused
    refused: int = 0  # its number
    pins: str = ""  # inputs that are on, as Grbl names them


class MachineOrders(Protocol):
    """How a session works the machine; each call is carried out in its turn, none waits."""

    @property
    def count(self) -> int:
        """Orders given so far."""

    def mdi(self, text: str) -> None:
        """Give the library a line, or several with LF between them."""

    def set(self, name: str, value: Any) -> None:
        """Set an input or a parameter of the library."""

    def press(self, name: str) -> None:
        """Press a key of the library."""
