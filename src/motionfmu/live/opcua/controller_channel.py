"""The controllers of a live machine that tell what they do: channels of its machine tool."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.opcua.channel_watch import ChannelSample, ChannelWatch, ProgramState
from motionfmu.live.panel import Monitor, OperatorPanel, panel_of
from motionfmu.scenarios import fmus
from motionfmu.scenarios.fault_advice import meanings

# [journal actions] A frame's worth of what many hands do between two looks.
_ACTIONS_MAX = 1000


def words(fmu: str, variable: str) -> dict[int, str]:
    """What the values of a variable mean, in words."""
    return meanings(fmus.ports(fmu)[variable])


@dataclass(frozen=True)
class Alarm:
    """Why a controller has stopped: a code, and what it means."""

    code: str
    text: str


@dataclass
class ControllerChannel:
    """A controller with a panel that has a [monitor]."""

    component: str
    fmu: str
    panel: OperatorPanel
    variables: Mapping[str, Any]  # those that can be read, as the machine tells of them
    values: dict[str, Any] = field(default_factory=dict)
    alarm: Alarm | None = None

    def __post_init__(self) -> None:
        assert self.panel.monitor is not None and self.panel.state is not None
        self.monitor: Monitor = self.panel.monitor
        self.watch = ChannelWatch(self.monitor)
        self._state: str = self.panel.state
        self._states = words(self.fmu, self._state)
        self._codes = words(self.fmu, self.panel.alarm) if self.panel.alarm else {}

    def readable(self, *names: str | None) -> list[str]:
        """Those of the variables that can be read."""
        return [n for n in names if n is not None and n in self.variables]

    @property
    def names(self) -> list[str]:
        """Signals that are to be read of it."""
        panel, monitor, jog = self.panel, self.monitor, self.panel.jog
        readout = panel.readout
        wanted = (
            *(panel.state, panel.alarm, panel.line, jog.way if jog else None),
            *(monitor.feed, monitor.rapid, monitor.spindle),
            *(readout.machine, readout.feed, readout.spindle, readout.tool),
        )
        return [f"{self.component}.{n}" for n in dict.fromkeys(self.readable(*wanted))]

    def look(
        self, frame: Mapping[str, Any], actions: Sequence[tuple[str, Sequence[Any]]]
    ) -> list[tuple[ProgramState, ProgramState]]:
        """Take a frame and what was done since the one before; transitions of the program."""
        begin = f"{self.component}."
        read: Mapping[str, list[Any]] = frame["values"]
        self.values = {n.removeprefix(begin): v for n, v in read.items() if n.startswith(begin)}
        jog, alarm = self.panel.jog, self.panel.alarm
        state = int(self.values[self._state][0])
        code = int(self.values[alarm][0]) if alarm else 0
        own = [(n.removeprefix(begin), v) for n, v in actions if n.startswith(begin)]
        increment = bool(jog and jog.way and any(self.values.get(jog.way, ())))
        made = self.watch.look(ChannelSample(frame["time"], state, code, increment, own))
        self.alarm = self._alarm(state, code) if self.watch.fault else None
        return made

    def _alarm(self, state: int, code: int) -> Alarm:
        if code:
            return Alarm(str(code), self._codes.get(code, f"error {code}"))
        return Alarm(f"state {state}", self._states.get(state, f"state {state}"))

    def value(self, name: str | None) -> Any:
        """The present value of a scalar; None if there is none."""
        found = self.values.get(name) if name is not None else None
        return None if found is None else found[0]


def channels_of(about: Mapping[str, Any]) -> list[ControllerChannel]:
    """The channels of a machine that describes itself; `InputError` if it has none."""
    found = list(_channels(about))
    if not found:
        raise InputError(f"OPC UA: no FMU of {about['name']} has a panel.toml with [monitor]")
    return found


def _channels(about: Mapping[str, Any]) -> Iterator[ControllerChannel]:
    for component, told in about["components"].items():
        panel = panel_of(told["fmu"])
        if panel is not None and panel.monitor is not None and panel.state is not None:
            yield ControllerChannel(component, told["fmu"], panel, told["variables"])


class ActionReader:
    """Reads what was done at a machine since it was looked at last."""

    def __init__(self) -> None:
        self._known = 0

    def wanted(self, frame: Mapping[str, Any]) -> int:
        """How many of the latest actions are to be asked for."""
        count = frame["actions"]
        new = count - self._known if count >= self._known else count
        self._known = count
        return min(new, _ACTIONS_MAX)
