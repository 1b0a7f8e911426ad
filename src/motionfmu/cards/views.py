"""The states and events that the server of network cards shows to its users."""

import enum
from collections import deque
from dataclasses import asdict, dataclass, field
from typing import Any

from motionfmu.cards import messages

EVENTS_KEPT = 100
# Kinds of events that are too frequent to be kept.
FLEETING = ("status", "progress")


class Code(enum.IntEnum):
    """How a command or an upload ended: the card's codes, and from 100 on the server's."""

    DONE = 0
    UNKNOWN = 1
    BUSY = 2
    STATE = 3
    NO_JOB = 4
    TOO_LONG = 5
    RANGE = 6
    BAD_JOB = 7
    FLASH = 8
    NOT_HOMED = 9
    ALARM = 10
    LIMIT = 11
    PAGE = 12
    OFFLINE = 100
    NO_ANSWER = 101
    REPLACED = 102


TEXTS = {
    Code.DONE: "done",
    Code.UNKNOWN: "the card does not know this",
    Code.BUSY: "the card is busy: it moves, or writes its flash",
    Code.STATE: "not in this state",
    Code.NO_JOB: "there is no job in the card",
    Code.TOO_LONG: "the job is longer than the card's flash",
    Code.RANGE: "a value is out of its range",
    Code.BAD_JOB: "the job is damaged, or no job",
    Code.FLASH: "the card's flash failed",
    Code.NOT_HOMED: "the card is not homed",
    Code.ALARM: "a drive's alarm or the emergency stop is on",
    Code.LIMIT: "a limit switch is on",
    Code.PAGE: "the card had no room for a page",
    Code.OFFLINE: "the card is not connected",
    Code.NO_ANSWER: "no answer: whether it was done is not known",
    Code.REPLACED: "another job took its place",
}


def advice_on(code: int) -> str:
    """What to do about a code of a card, as its FMU says it; empty if there is nothing to do."""
    from motionfmu.scenarios.fault_advice import advice

    return advice("network_card")["result"].get(code, "")


@dataclass(frozen=True)
class CommandResult:
    """How a command or an upload ended."""

    code: int  # see Code
    text: str
    state: str = ""  # of the card, a name of messages.State; empty: not known

    @property
    def ok(self) -> bool:
        """Whether it was done."""
        return self.code == Code.DONE

    @property
    def advice(self) -> str:
        """What to do about a refusal of the card; empty if it has done what it was told."""
        return advice_on(self.code)

    @classmethod
    def of(cls, code: int, state: str = "") -> "CommandResult":
        """With the text of its code."""
        known = code in Code.__members__.values()
        return cls(code, TEXTS[Code(code)] if known else f"code {code}", state)


@dataclass(frozen=True)
class SettingResult:
    """A setting that was sent to a card."""

    name: str
    index: int
    before: int
    value: int
    later: bool  # acts from the next power-up on only
    result: CommandResult


@dataclass(frozen=True)
class ConfigurationResult:
    """The result of sending a configuration: that of the first setting that failed, if any."""

    result: CommandResult
    changed: tuple[SettingResult, ...] = ()  # that differed and were sent


@dataclass(frozen=True)
class Event:
    """Something that happened; `kind` is one of the words below."""

    # connected, closed, status, command, result, upload, progress
    kind: str
    card: int
    text: str
    time: float  # [s] since 1970


@dataclass
class Upload:
    """A job on its way to a card."""

    job: str  # SHA-256 of the file, hexadecimal
    pages: int
    taken: int = 0  # pages that the card has
    sent: int = 0  # pages that were sent, those sent again too
    waits: str = ""  # why nothing is sent now


@dataclass
class CardView:
    """A card as the server knows it; a copy, which does not change."""

    id: int
    connected: bool = False
    address: str = ""  # host:port of the connection
    state: str = ""  # a name of messages.State; empty: never heard
    status: messages.Status | None = None  # the last one heard
    hello: messages.Hello | None = None  # firmware, slots, axes
    job: str = ""  # SHA-256 of the job in its flash, hexadecimal; empty: none
    upload: Upload | None = None
    events: deque[Event] = field(default_factory=lambda: deque(maxlen=EVENTS_KEPT))

    def outline(self) -> dict[str, Any]:
        """A card's main values, as JSON, for every place that shows a card."""
        names = ("id", "connected", "address", "state", "job")
        return {n: getattr(self, n) for n in names} | {
            "upload": asdict(self.upload) if self.upload else None
        }
