"""What an operator has of an FMU: the panel.toml that its archive carries."""

import functools
import tomllib
from typing import Literal

from pydantic import BaseModel, ConfigDict, Field, ValidationError

from motionfmu.base.errors import InputError
from motionfmu.scenarios import fmus

FILE = "panel.toml"


class _PanelTable(BaseModel):
    model_config = ConfigDict(extra="forbid", strict=True)


class Key(_PanelTable):
    """A key: pressed for a moment, or a switch that stays."""

    label: str  # text on the key
    kind: Literal["press", "switch"]  # whether it stays
    seconds: float = Field(0.01, gt=0.0, le=10.0)  # that a press is down, simulated


class Dial(_PanelTable):
    """A number that an operator turns, between the variable's limits or its own."""

    label: str  # text below the dial
    low: float | None = None  # least value
    high: float | None = None  # largest value


class Lamp(_PanelTable):
    """A truth that is shown."""

    label: str  # text beside the lamp


class Jog(_PanelTable):
    """Motion by hand: an array of directions, its speed, an increment."""

    direction: str  # input: a direction for each axis
    speed: str | None = None  # input: how fast
    way: str | None = None  # input: length of an increment
    frame: str | None = None  # input: frame of the directions


class Readout(_PanelTable):
    """Outputs that are numbers of the machine."""

    machine: str | None = None  # output: positions in machine coordinates
    low: str | None = None  # ends of its travel: parameters
    high: str | None = None  # see low
    limited: str | None = None  # whether they are in force
    offset: str | None = None  # machine less this is the work coordinate
    to_go: str | None = None  # output: way that is left of the block
    feed: str | None = None  # output: feed along the path
    spindle: str | None = None  # output: speed of the spindle
    tool: str | None = None  # output: number or place of the tool
    modes: str | None = None  # output: codes in force


class Mdi(_PanelTable):
    """Lines that are typed: the line, its number, the last number taken, refusals."""

    line: str  # input: the line as typed
    number: str  # input: a new number takes the line
    taken: str  # output: number of the latest line taken, or refused
    room: str | None = None  # output: how many bytes are free for lines
    lines: str | None = None  # output: how many lines were read so far
    done: str | None = None  # output: how many of these have ended their motion
    fault: str | None = None  # output: number of what is wrong with a line
    refused: str | None = None  # output: how many lines were refused


class ToolWindow(_PanelTable):
    """A window of the tool table: the number of its first row, tools, offsets, diameters."""

    rows: str  # how many there are
    first: str  # from 1
    number: str  # outputs: numbers of the tools
    offset: str  # outputs: lengths of the tools
    diameter: str  # outputs: diameters of the tools


class PanelCommand(_PanelTable):
    """Commands by number: the code is set, then a new number takes it once."""

    code: str  # input: what is to be done
    number: str  # input: a new number takes the code
    codes: dict[str, int]  # by label


# What a channel of a machine tool may be doing by hand, in the words of OPC 40501-1.
ByHand = Literal[
    "MdaMdi", "JogManual", "JogIncrement", "TeachingHandle", "Remote", "Reference", "Other"
]


class Monitor(_PanelTable):
    """What the values of `state` are to who looks at a controller from outside.

    The program moves, waits, is being ended, has failed, an axis moves by hand; any other value
    is rest.
    """

    running: list[int]  # values of `state`: a program moves
    interrupted: list[int] = Field(default_factory=list)  # values of `state`: a program waits
    aborting: list[int] = Field(default_factory=list)  # values of `state`: a program is being ended
    fault: list[int] = Field(default_factory=list)  # values of `state`: a program has failed
    # values of `state` by the motion by hand
    by_hand: dict[ByHand, list[int]] = Field(default_factory=dict)
    # Where `running` does not tell: inputs whose new value begins a motion, and what it is then.
    begins: dict[str, ByHand | Literal["Automatic"]] = Field(default_factory=dict)
    abort: str | None = None  # its rising edge ends the program
    feed: str | None = None  # overrides, 1 is 100 %
    rapid: str | None = None  # see feed
    spindle: str | None = None  # see feed

    def names(self) -> list[str]:
        """All variables that it names."""
        single = (self.abort, self.feed, self.rapid, self.spindle)
        return [*self.begins, *(n for n in single if n is not None)]


class OperatorPanel(_PanelTable):
    """The tables of a panel.toml; all names are of variables of its FMU."""

    title: str  # heading of the panel
    state: str | None = None  # output: what the controller is doing
    alarm: str | None = None  # output: number of the fault
    line: str | None = None  # output: line of the program
    readout: Readout = Field(default_factory=Readout)
    jog: Jog | None = None
    mdi: Mdi | None = None
    tools: ToolWindow | None = None
    command: PanelCommand | None = None
    monitor: Monitor | None = None
    stop: str | None = None  # the emergency stop: true while it acts
    key: dict[str, Key] = Field(default_factory=dict)
    dial: dict[str, Dial] = Field(default_factory=dict)
    lamp: dict[str, Lamp] = Field(default_factory=dict)
    fault: dict[str, Lamp] = Field(default_factory=dict)

    def names(self) -> list[str]:
        """All variables that it names."""
        parts = (self.readout, self.jog, self.mdi, self.tools)
        single = [self.state, self.alarm, self.line, self.stop]
        single += [v for p in parts if p is not None for v in p.model_dump().values()]
        if self.command:
            single += [self.command.code, self.command.number]
        single += self.monitor.names() if self.monitor else []
        tables = (self.key, self.dial, self.lamp, self.fault)
        return [n for n in (*single, *(n for t in tables for n in t)) if n is not None]


@functools.cache
def panel_of(fmu: str) -> OperatorPanel | None:
    """The panel that an FMU carries; None if it has none."""
    text = fmus.extra(fmu, FILE)
    if text is None:
        return None
    where = f"fmus/{fmu}/{FILE}"
    try:
        panel = OperatorPanel.model_validate(tomllib.loads(text))
    except (tomllib.TOMLDecodeError, ValidationError) as error:
        raise InputError(f"{where}: {' '.join(str(error).split())}") from None
    ports = fmus.ports(fmu)
    if unknown := [n for n in panel.names() if n not in ports]:
        raise InputError(f"{where}: {fmu} has no variable {unknown[0]!r}")
    return panel
