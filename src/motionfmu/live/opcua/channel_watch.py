"""What a controller's channel and its program do, told by samples of its outputs."""

from collections import deque
from collections.abc import Sequence
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

from motionfmu.live.panel import Monitor


class ChannelMode(IntEnum):
    """The enumeration of this name of OPC 40501-1."""

    Automatic = 0
    MdaMdi = 1
    JogManual = 2
    JogIncrement = 3
    TeachingHandle = 4
    Remote = 5
    Reference = 6
    Other = 7


class ChannelState(IntEnum):
    """The enumeration of this name of OPC 40501-1."""

    Active = 0
    Interrupted = 1
    Reset = 2


class ProgramState(IntEnum):
    """States of a ProductionProgramStateMachineType, by their numbers."""

    Initializing = 0
    Running = 1
    Ended = 2
    Interrupted = 3
    Aborted = 4


_FOLLOWING: dict[ProgramState, tuple[ProgramState, ...]] = {
    ProgramState.Initializing: (ProgramState.Running, ProgramState.Aborted),
    ProgramState.Running: (ProgramState.Ended, ProgramState.Interrupted, ProgramState.Aborted),
    ProgramState.Ended: (ProgramState.Initializing,),
    ProgramState.Interrupted: (ProgramState.Running, ProgramState.Aborted),
    ProgramState.Aborted: (ProgramState.Initializing,),
}


def way(begin: ProgramState, end: ProgramState) -> list[ProgramState]:
    """The states through which a program comes from one to another; empty if it is there."""
    ways = deque([[begin]])
    while ways:
        found = ways.popleft()
        if found[-1] is end:
            return found[1:]
        ways.extend([*found, n] for n in _FOLLOWING[found[-1]] if n not in found)
    raise AssertionError(f"no way from {begin} to {end}")


@dataclass(frozen=True)
class ChannelSample:
    """A controller at an instant."""

    time: float  # [s] of the simulation
    state: int  # value of the panel's state
    code: int = 0  # of its alarm, 0 none
    increment: bool = False  # axes are jogged by increments
    # What was set since the sample before: variables and their values.
    actions: Sequence[tuple[str, Sequence[Any]]] = ()


class ChannelWatch:
    """Follows a channel by samples; a program that begins and ends between two is not seen."""

    def __init__(self, monitor: Monitor) -> None:
        self._monitor = monitor
        self.mode = ChannelMode.Automatic  # while nothing moves that of the latest motion
        self.state = ChannelState.Reset
        self.program = ProgramState.Initializing
        self.fault = False
        self.run_time = 0.0  # [s] of the simulation that the program has been running
        self._time = 0.0
        self._begins = ChannelMode.Automatic  # what the latest action that begins something begins
        self._cause = ChannelMode.Automatic  # what has begun, while something moves
        self._rests = True
        self._aborted = False

    def look(self, sample: ChannelSample) -> list[tuple[ProgramState, ProgramState]]:
        """The transitions that the program has made since the sample before."""
        if sample.time < self._time:  # the machine was taken back
            self._rests, self._aborted = True, False
            self._begins = ChannelMode.Automatic
        monitor, passed = self._monitor, sample.time - self._time
        self._note(sample)
        self._time = sample.time
        self.fault = sample.code != 0 or sample.state in monitor.fault
        hand = [ChannelMode[n] for n, states in monitor.by_hand.items() if sample.state in states]
        moves = bool(hand) or sample.state in monitor.running
        waits = sample.state in monitor.interrupted
        ends = sample.state in monitor.aborting
        self._set_mode(sample, hand, moves or waits or ends)
        self.state = (
            ChannelState.Active
            if moves or ends
            else ChannelState.Interrupted
            if waits
            else ChannelState.Reset
        )
        self._aborted |= ends
        made = self._go(self._wanted(moves, waits, ends))
        if self.program is ProgramState.Running and not made:
            self.run_time += max(passed, 0.0)
        return made

    def _note(self, sample: ChannelSample) -> None:
        """Keep what was done last that begins or ends a motion."""
        for name, values in sample.actions:
            if not any(values):
                continue
            if (begins := self._monitor.begins.get(name)) is not None:
                self._begins = ChannelMode[begins]
            self._aborted |= name == self._monitor.abort

    def _set_mode(self, sample: ChannelSample, hand: list[ChannelMode], busy: bool) -> None:
        """The mode is that of what has begun, until everything rests again."""
        if busy and self._rests:
            self._cause = self._begins
        if busy:
            self.mode = hand[0] if hand else self._cause
        if busy and self.mode is ChannelMode.JogManual and sample.increment:
            self.mode = ChannelMode.JogIncrement
        self._rests = not busy

    def _wanted(self, moves: bool, waits: bool, ends: bool) -> ProgramState:
        """The state in which the program is now."""
        under_way = self.program in (ProgramState.Running, ProgramState.Interrupted)
        if self.fault:
            return ProgramState.Aborted if under_way else self.program
        if self.mode is ChannelMode.Automatic:
            if moves:
                return ProgramState.Running
            if waits:
                return ProgramState.Interrupted
        if under_way and not (moves or waits or ends):
            return ProgramState.Aborted if self._aborted else ProgramState.Ended
        # A fault that has gone leaves a program that can be run anew.
        if self.program is ProgramState.Aborted and not self._aborted:
            return ProgramState.Initializing
        return self.program

    def _go(self, wanted: ProgramState) -> list[tuple[ProgramState, ProgramState]]:
        made = []
        for following in way(self.program, wanted):
            made.append((self.program, following))
            if self.program is ProgramState.Initializing:
                self._aborted, self.run_time = False, 0.0
            self.program = following
        return made
