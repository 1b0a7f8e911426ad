"""What a Grbl session sees of a machine, and what it may do to it: values of inputs, lines."""

from dataclasses import dataclass
from typing import Any, Protocol

from motionfmu.live.grbl.grbl_block import ORIGIN, Point

RUNNING, STOPPED, RESTS, DELAYS, BLOCK = range(5)  # the library's `status`


@dataclass(frozen=True)
class MachineView:
    """A look at the machine.

    Attributes
    ----------
    time : float
        Simulated [s].
    orders : int
        Orders that had been carried out by then.
    status, error : int
        Of the library.
    position, offset, probed : tuple of float
        Commanded place, the work's zero, the latest contact, in the machine [mm].
    feed : float
        [mm/min].
    speed : float
        Of the spindle [rpm].
    lines, done : int
        Lines that the library has read, refused or dropped; those of them that are over.
    fault, refused : int
        Of the latest line that the library has refused, and its number.
    pins : str
        Inputs that are on, as Grbl names them.
    """

    time: float = 0.0
    orders: int = 0
    status: int = STOPPED
    error: int = 0
    position: Point = ORIGIN
    offset: Point = ORIGIN
    probed: Point = ORIGIN
    found: bool = False  # the latest probing has ended at a contact
    feed: float = 0.0
    speed: float = 0.0
    coolant: int = 0
    homed: bool = False
    lines: int = 0
    done: int = 0
    fault: int = 0
    refused: int = 0
    pins: str = ""


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
