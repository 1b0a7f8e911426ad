"""Messages between PC and card: fields, and their bytes, little-endian."""

import enum
import struct
from dataclasses import dataclass, fields
from typing import Any, ClassVar

PAGE = 256  # [byte]
PAGES_MAX = 4  # of one JobData
NO_PAGE = 0xFFFF


class WireError(Exception):
    """The peer broke the protocol: the connection has to be closed."""


class State(enum.IntEnum):
    """States of a card."""

    EMPTY = 0
    READY = 1
    RUNNING = 2
    PAUSING = 3
    PAUSED = 4
    STOPPING = 5
    HOMING = 6
    FAULT = 7


@dataclass(frozen=True)
class Message:
    """A message; LAYOUT has one struct format for each field, and padding."""

    TYPE: ClassVar[int]
    LAYOUT: ClassVar[str] = ""

    def payload(self) -> bytes:
        """The message as bytes."""
        given = iter(fields(self))
        parts = []
        for form in self.LAYOUT.split():
            value: Any = () if form.endswith("x") else getattr(self, next(given).name)
            parts.append(
                struct.pack(f"<{form}", *(value if isinstance(value, tuple) else (value,)))
            )
        return b"".join(parts)

    @classmethod
    def read(cls, payload: bytes) -> "Message":
        """From its bytes; WireError if there are too few or too many."""
        values: list[Any] = []
        at = 0
        for form in cls.LAYOUT.split():
            size = struct.calcsize(f"<{form}")
            if at + size > len(payload):
                raise WireError(f"{cls.__name__} of {len(payload)} bytes")
            row = struct.unpack_from(f"<{form}", payload, at)
            at += size
            if not form.endswith("x"):
                values.append(row[0] if form.endswith("s") or form.isalpha() else row)
        if at != len(payload):
            raise WireError(f"{cls.__name__} of {len(payload)} bytes")
        return cls(*values)


@dataclass(frozen=True)
class Hello(Message):
    """The card's first message."""

    TYPE = 1
    LAYOUT = "I H H 16s I B B H I 32s B x H"
    card: int
    oldest: int  # protocol
    newest: int
    nonce: bytes
    firmware: int
    slots: int
    axes: int
    credit: int  # [pages]
    done: int  # last command number
    job: bytes  # SHA-256 of the job in flash; zeros: none
    state: int
    life: int  # drawn at power-up: another one, results of commands are lost


@dataclass(frozen=True)
class Challenge(Message):
    """The PC's answer, which proves that it has the key."""

    TYPE = 2
    LAYOUT = "H 2x 16s 32s"
    protocol: int
    nonce: bytes
    proof: bytes


@dataclass(frozen=True)
class Auth(Message):
    """The card's proof that it has the key."""

    TYPE = 3
    LAYOUT = "32s"
    proof: bytes


@dataclass(frozen=True)
class Welcome(Message):
    """The card is let in."""

    TYPE = 4
    LAYOUT = "H 2x"
    interval: int  # [ms] of status; 0 none


@dataclass(frozen=True)
class JobBegin(Message):
    """A job file comes."""

    TYPE = 16
    LAYOUT = "I 32s I"
    length: int  # [byte]
    digest: bytes  # SHA-256 of the file
    crc: int


@dataclass(frozen=True)
class JobData(Message):
    """One to four pages of it."""

    TYPE = 17
    page: int
    data: bytes

    def payload(self) -> bytes:
        """The message as bytes."""
        return struct.pack("<HH", self.page, len(self.data) // PAGE) + self.data

    @classmethod
    def read(cls, payload: bytes) -> "JobData":
        """From its bytes; WireError if the pages are not as many as it says."""
        if len(payload) < 4:
            raise WireError(f"JobData of {len(payload)} bytes")
        page, count = struct.unpack_from("<HH", payload)
        if not 1 <= count <= PAGES_MAX or len(payload) != 4 + PAGE * count:
            raise WireError(f"JobData of {count} pages in {len(payload)} bytes")
        return cls(page, payload[4:])


@dataclass(frozen=True)
class JobEnd(Message):
    """The whole job file was sent."""

    TYPE = 18
    LAYOUT = "I"
    crc: int


@dataclass(frozen=True)
class Ack(Message):
    """Acknowledges received pages and says how many more the card can take."""

    TYPE = 19
    LAYOUT = "I H H"
    sequence: int
    credit: int  # [pages]
    missing: int  # first missing page; NO_PAGE: no transfer, or all there


@dataclass(frozen=True)
class Nak(Message):
    """A frame that the card refused."""

    TYPE = 20
    LAYOUT = "I H H"
    sequence: int
    code: int
    detail: int


@dataclass(frozen=True)
class Start(Message):
    """Start or go on."""

    TYPE = 32
    LAYOUT = "I"
    number: int


@dataclass(frozen=True)
class Pause(Message):
    """Come to rest on the path."""

    TYPE = 33
    LAYOUT = "I"
    number: int


@dataclass(frozen=True)
class Stop(Message):
    """Come to rest, the job is over."""

    TYPE = 34
    LAYOUT = "I"
    number: int


@dataclass(frozen=True)
class Home(Message):
    """Home these axes."""

    TYPE = 35
    LAYOUT = "I B 3x"
    number: int
    axes: int = 15  # bits


@dataclass(frozen=True)
class Reset(Message):
    """Leave the state FAULT."""

    TYPE = 36
    LAYOUT = "I"
    number: int


@dataclass(frozen=True)
class Output(Message):
    """Set or pulse outputs."""

    TYPE = 37
    LAYOUT = "I H B B I"
    number: int
    pins: int  # bits
    mode: int  # 0 level, 1 pulse
    level: int  # 1 high active
    width: int  # [us] of a pulse


@dataclass(frozen=True)
class ResultMessage(Message):
    """How a command ended."""

    TYPE = 48
    LAYOUT = "I H H"
    number: int
    code: int
    state: int


@dataclass(frozen=True)
class ConfigGet(Message):
    """Ask for a setting."""

    TYPE = 64
    LAYOUT = "H H"
    id: int
    index: int


@dataclass(frozen=True)
class ConfigSet(Message):
    """Change a setting."""

    TYPE = 65
    LAYOUT = "I H H q"
    number: int
    id: int
    index: int
    value: int


@dataclass(frozen=True)
class Config(Message):
    """A setting."""

    TYPE = 66
    LAYOUT = "H H q"
    id: int
    index: int
    value: int


@dataclass(frozen=True)
class Status(Message):
    """The present status of the card."""

    TYPE = 80
    LAYOUT = "B B H H H I I 4i I I 7H H I"
    state: int
    error: int
    inputs: int  # bits
    outputs: int
    stock: int  # [frames]
    job: int  # id
    frame: int
    position: tuple[int, ...]  # [pulses]
    underflows: int
    switches: int  # limits, home, alarm, bits
    load: tuple[int, ...]  # [1/1000] six tasks, interrupts
    rate: int  # [1/1000]
    wear: int  # most erases of a sector


@dataclass(frozen=True)
class Ping(Message):
    """Asks whether somebody is there."""

    TYPE = 96
    LAYOUT = "I"
    token: int


@dataclass(frozen=True)
class Pong(Message):
    """Says yes."""

    TYPE = 97
    LAYOUT = "I"
    token: int


KINDS = {kind.TYPE: kind for kind in Message.__subclasses__()}
