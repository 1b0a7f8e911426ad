"""Signals of a live machine exchanged with another program or device by UDP.

A datagram, little endian, is the same both ways. It begins with ``MFX1`` and a number that grows by
one with each. Then come the number of the latest datagram from the other side, 0 none yet, and the
simulated time [ns]. Flags, how many values follow and the values as doubles end it. What is late,
repeated, too short or of another count is not taken. README.md shows a peer in C and in Python.
"""

import math
import socket
import struct
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any
from urllib.parse import urlsplit

from motionfmu.base.errors import InputError
from motionfmu.live.live_machine import LiveMachine

MAGIC = b"MFX1"
HEAD = struct.Struct("<4sIIQHH")
VALUES_MAX = 180  # of a datagram that no network has to cut
LOST = 1  # flag of ours: the peer is lost, its inputs have their safe values
BUFFER = 2048  # [bytes]
WATCHDOG = 0.1  # [s] of simulated time
_WRAP = 1 << 32


@dataclass(frozen=True)
class ExchangePlan:
    """What goes over the wire.

    Attributes
    ----------
    peer : str
        ``udp://HOST:PORT``.
    send : sequence of str
        Elements of outputs, ``component.variable[i]``.
    take : mapping
        Elements of inputs, and the value of each while the peer is lost.
    every : int
        Of so many communication steps one exchanges.
    watchdog : float
        Simulated time without a datagram after which the peer is lost [s].
    bind : str
        Address and port that the peer sends to, ``HOST:PORT``; port 0: the system chooses.
    """

    peer: str
    send: Sequence[str] = ()
    take: Mapping[str, float] = field(default_factory=dict)
    every: int = 1
    watchdog: float = WATCHDOG
    bind: str = "127.0.0.1:0"


@dataclass
class ExchangeCount:
    """What has happened on the wire."""

    sent: int = 0
    taken: int = 0
    late: int = 0  # overtaken by a later one, or sent twice
    wrong: int = 0  # no datagram of this kind
    lost: int = 0  # times the peer was


class Exchange:
    """The machine's side of an exchange.

    What comes in acts when the communication step begins, and is in the journal as if a person had
    set it.

    Parameters
    ----------
    machine : LiveMachine
    plan : ExchangePlan

    Attributes
    ----------
    counts : ExchangeCount
    lost : bool
        The peer has not been heard for longer than the watchdog's time, or never.
    port : int
        To which the peer sends.

    Raises
    ------
    InputError
        An address, a name or a number of the plan is wrong.
    """

    def __init__(self, machine: LiveMachine, plan: ExchangePlan) -> None:
        if len(plan.send) > VALUES_MAX or len(plan.take) > VALUES_MAX:
            raise InputError(f"exchange: {VALUES_MAX} values each way are the most")
        if plan.every < 1:
            raise InputError(f"exchange every {plan.every} steps: 1 or more wanted")
        if not (math.isfinite(plan.watchdog) and plan.watchdog > 0.0):
            raise InputError(f"watchdog {plan.watchdog:g} s: more than 0 wanted")
        self._machine, self.plan = machine, plan
        self._read_all = machine.reading(plan.send)
        self._given = {name: machine[name] for name in plan.take}
        self._patience = max(1, round(plan.watchdog / machine.step_seconds))
        self._number = self._heard = 0
        self._heard_at = machine.steps
        self.counts, self.lost = ExchangeCount(), True
        self._peer = _address(plan.peer)
        self._body = struct.Struct(f"<{len(plan.take)}d")
        self._socket = _bound(plan.bind)
        try:
            for name, safe in plan.take.items():
                machine.set(name, _of(self._given[name], safe))
        except BaseException:
            self._socket.close()
            raise
        self._given = {name: machine[name] for name in plan.take}

    @property
    def port(self) -> int:
        """Where the peer sends to."""
        return int(self._socket.getsockname()[1])

    def step(self) -> None:
        """Take what has come, send what is, before a communication step."""
        self._receive()
        if not self.lost and self._machine.steps - self._heard_at > self._patience:
            self._lose()
        self._send()

    def _lose(self) -> None:
        self.lost = True
        self.counts.lost += 1
        self._apply(list(self.plan.take.values()))

    def _send(self) -> None:
        self._number = (self._number + 1) % _WRAP
        values = self._read_all()
        time = round(self._machine.time * 1e9)
        flags = LOST if self.lost else 0
        head = HEAD.pack(MAGIC, self._number, self._heard, time, flags, len(values))
        try:
            self._socket.sendto(head + values.tobytes(), self._peer)
            self.counts.sent += 1
        except OSError:  # nobody listens there (yet), or the network is full
            pass

    def _receive(self) -> None:
        """Take the latest of what has come."""
        newest = None
        while True:
            try:
                data = self._socket.recv(BUFFER)
            except BlockingIOError:
                break
            except OSError:  # of an earlier datagram that nobody took
                continue
            values = self._read(data)
            newest = newest if values is None else values
        if newest is not None:
            self.counts.taken += 1
            self._heard_at, self.lost = self._machine.steps, False
            self._apply(newest)

    def _read(self, data: bytes) -> list[float] | None:
        """Values of a datagram; None if it is none, or not a new one."""
        size = HEAD.size + self._body.size
        if len(data) != size or data[:4] != MAGIC:
            self.counts.wrong += 1
            return None
        _, number, _, _, _, count = HEAD.unpack_from(data)
        values = list(self._body.unpack_from(data, HEAD.size))
        if count != len(values) or not all(map(math.isfinite, values)):
            self.counts.wrong += 1
            return None
        # A peer that begins anew begins at 1.
        ahead = (number - self._heard) % _WRAP
        if not (self.lost or 0 < ahead < _WRAP // 2):
            self.counts.late += 1
            return None
        self._heard = number
        return values

    def _apply(self, values: Sequence[float]) -> None:
        """Set the inputs that change; one that its FMU refuses keeps its value."""
        for name, value in zip(self.plan.take, values, strict=True):
            had = self._given[name]
            now = _of(had, value)
            if had == now:
                continue
            try:
                self._machine.set(name, now)
            except InputError:
                self.counts.wrong += 1
            else:
                self._given[name] = now

    def state(self) -> dict[str, Any]:
        """Whether the peer is lost, and what has happened on the wire."""
        return {"peer": self.plan.peer, "lost": self.lost, **vars(self.counts)}

    def close(self) -> None:
        """Free the port."""
        self._socket.close()


def _of(had: Any, value: float) -> Any:
    """A number as the variable has it: whole numbers are rounded, truths are not 0."""
    if isinstance(had, bool):
        return value != 0.0
    return round(value) if isinstance(had, int) else value


def _address(url: str) -> tuple[str, int]:
    parts = urlsplit(url)
    try:
        host, port = parts.hostname, parts.port
    except ValueError:
        host, port = None, None
    if parts.scheme != "udp" or not host or not port:
        raise InputError(f"exchange {url}: udp://HOST:PORT wanted")
    try:
        found = socket.getaddrinfo(host, port, socket.AF_INET, socket.SOCK_DGRAM)
    except OSError as error:
        raise InputError(f"exchange {url}: {error.strerror}") from None
    return found[0][4][0], port  # type: ignore[return-value]


def _bound(place: str) -> socket.socket:
    host, _, port = place.rpartition(":")
    if not host or not port.isdecimal() or int(port) > 65535:
        raise InputError(f"exchange: {place}: HOST:PORT wanted")
    made = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
    try:
        made.bind((host, int(port)))
    except OSError as error:
        made.close()
        raise InputError(f"exchange: {place}: {error.strerror}") from None
    made.setblocking(False)
    return made
