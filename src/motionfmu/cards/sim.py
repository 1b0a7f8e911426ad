"""Virtual network cards: the card's C core in real time, which connects by TCP as a card does.

The machine behind it counts pulses and has an origin switch for each axis.
"""

import asyncio
import ctypes
import os
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from motionfmu.base.binding import Struct, library
from motionfmu.base.errors import InputError
from motionfmu.cards.keys import write_whole
from motionfmu.cards.messages import State
from motionfmu.cards.wire import OPEN_KEY

if TYPE_CHECKING:
    import ssl

FLASH_BYTES = 2_097_152
ORIGIN = 5000  # [pulses] from the start position to the origin switch, in homing's direction
TICK = 0.01  # [s] from one look at the clock to the next
AHEAD_NS = 1_000_000  # a card may be so far ahead of the clock, so that it answers at once
MOST_NS = 100_000_000  # a card that is later than this does not catch up
CHUNK = 4096  # [byte]
UP = 4  # SESSION_UP of src/controllers/netcard/session.h
CALL = 5.0  # [s] for a connection to come about
SAVE = 1.0  # [s] between two looks at the flash


class VirtualNetCard:
    """A card of src/controllers/netcard with its machine; its time is in ns since power came."""

    def __init__(
        self, card: int, key: bytes = OPEN_KEY, flash: bytes = b"", **parameters: Any
    ) -> None:
        self._sim = Struct("netcard_sim")
        self._c, at = library(), self._sim.pointer
        self._c.binding_netcard_settings(at)
        for name, value in (parameters | {"card_id": card, "key": list(key)}).items():
            self._sim[name] = value
        self._sim["origin"] = [ORIGIN if plus else -ORIGIN for plus in self._sim["home_plus"]]
        words, size = ctypes.create_string_buffer(200), ctypes.c_size_t(200)
        begun = self._c.binding_netcard_start(at, os.urandom(32), flash or None, words, size)
        if not begun:
            raise InputError(words.value.decode())
        self._card = ctypes.c_void_p(self._c.binding_netcard_card(at))
        self._room = ctypes.create_string_buffer(CHUNK)

    def __getitem__(self, name: str) -> Any:
        """A figure or a setting by its name in src/python."""
        return self._sim[name]

    @property
    def now(self) -> int:
        """Time up to which the card has run [ns]."""
        return int(self._sim["now"])

    @property
    def state(self) -> State:
        """The card's state."""
        return State(self._c.binding_netcard_state(self._sim.pointer))

    @property
    def pulses(self) -> list[int]:
        """Pulses put out, forward less backward."""
        counts = (ctypes.c_int64 * 4)()
        self._c.binding_netcard_pulses(self._sim.pointer, counts)
        return list(counts)

    @property
    def flash(self) -> bytes:
        """Its flash as it is now."""
        room = ctypes.create_string_buffer(FLASH_BYTES)
        self._c.binding_netcard_flash(self._sim.pointer, room)
        return room.raw

    @property
    def online(self) -> bool:
        """Whether it has a connection whose handshake is over."""
        return bool(self._sim["phase"] == UP)

    @property
    def wants(self) -> bool:
        """Whether it wants a connection, or to keep the one it has."""
        return bool(self._c.netcard_wants_connection(self._card))

    def run(self, until: int) -> None:
        """All events up to this time [ns]."""
        self._c.binding_netcard_run(self._sim.pointer, ctypes.c_int64(until))

    def power_cycle(self) -> None:
        """Power off and on again."""
        self._c.binding_netcard_power(self._sim.pointer)

    def set_inputs(self, levels: int) -> None:
        """Levels of its 16 inputs, a bit each."""
        self._c.netcard_set_inputs(self._card, ctypes.c_uint32(levels))

    def connected(self, yes: bool) -> None:
        """The connection stands, or is cut."""
        self._c.netcard_connected(self._card, ctypes.c_bool(yes))

    def receive(self, data: bytes) -> int:
        """Hand it bytes of the connection; returns how many it has taken."""
        return int(self._c.netcard_receive(self._card, data, ctypes.c_size_t(len(data))))

    def send(self) -> bytes:
        """Bytes that it wants to send, taken out."""
        n = self._c.netcard_send(self._card, self._room, ctypes.c_size_t(CHUNK))
        return self._room.raw[:n]


class _Link(asyncio.Protocol):
    """The TCP connection of a card, for as long as it lasts."""

    def __init__(self, run: "RealTimeRun") -> None:
        self._run = run
        self._waits = b""  # what the card has not taken yet
        self.transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        self.transport = cast(asyncio.Transport, transport)
        self._run.card.connected(True)
        self._run.turn()

    def data_received(self, data: bytes) -> None:
        self._waits += data
        self.carry()
        self._run.turn(AHEAD_NS)

    def carry(self) -> None:
        """Hand on what the card takes, and take what it has to say."""
        if self.transport is None:
            return
        while self._waits and (taken := self._run.card.receive(self._waits)):
            self._waits = self._waits[taken:]
        if self._waits:
            self.transport.pause_reading()
        else:
            self.transport.resume_reading()
        while self.transport.get_write_buffer_size() < CHUNK and (data := self._run.card.send()):
            self.transport.write(data)

    def connection_lost(self, exc: Exception | None) -> None:
        self.transport = None
        self._run.card.connected(False)


class RealTimeRun:
    """A card on the clock of the wall, `speed` times as fast."""

    def __init__(
        self,
        card: VirtualNetCard,
        place: tuple[str, int],
        speed: float,
        tls: "ssl.SSLContext | None" = None,
        failed: Callable[[str], None] = lambda why: None,
    ) -> None:
        self.card, self._place, self._speed, self._tls = card, place, speed, tls
        self._failed = failed
        self._clock = asyncio.get_running_loop().time
        self._zero = self._clock() - card.now * 1e-9 / speed
        self._link: _Link | None = None
        self._calls: asyncio.Task[None] | None = None

    def turn(self, ahead: int = 0) -> None:
        """Run up to now, or a little ahead, and carry bytes both ways."""
        card = self.card
        now = int((self._clock() - self._zero) * self._speed * 1e9)
        if now - card.now > MOST_NS:
            late = now - card.now - MOST_NS
            self._zero += late * 1e-9 / self._speed
            now -= late
        card.run(max(now + ahead, card.now))
        if self._link:
            self._link.carry()
            if self._link.transport is None:
                self._link = None
            elif not card.wants:
                self._link.transport.abort()
        elif card.wants and self._calls is None:
            self._calls = asyncio.create_task(self._call())

    async def _call(self) -> None:
        loop = asyncio.get_running_loop()
        try:
            async with asyncio.timeout(CALL):
                _, self._link = await loop.create_connection(
                    lambda: _Link(self), *self._place, ssl=self._tls
                )
        except TimeoutError:
            self._failed(f"no answer within {CALL:g} s")
        except OSError as error:
            from motionfmu.cards.tls import refused

            self._failed(refused(error))
        if self._link is None:  # the card itself waits longer each time
            while self.card.wants:
                await asyncio.sleep(TICK)
        self._calls = None


@dataclass(frozen=True)
class Watch:
    """Functions that are called while cards run."""

    each: Callable[[], None] = lambda: None  # each second
    failed: Callable[[str], None] = lambda why: None  # a connection did not come about


async def simulate(
    cards: list[VirtualNetCard],
    place: tuple[str, int],
    speed: float = 1.0,
    watch: Watch = Watch(),
    tls: "ssl.SSLContext | None" = None,
) -> None:
    """Run cards as clients of a server until this is cancelled."""
    runs = [RealTimeRun(card, place, speed, tls, watch.failed) for card in cards]
    clock = asyncio.get_running_loop().time
    due = clock() + SAVE
    while True:
        for run in runs:
            run.turn()
        if clock() >= due:
            due = clock() + SAVE
            watch.each()
        await asyncio.sleep(TICK)


class FlashFile:
    """A file that keeps the flash of a card."""

    def __init__(self, file: Path) -> None:
        self._file = file
        self._kept = (0, 0, 0)

    def load(self) -> bytes:
        """What is kept; empty if nothing is."""
        try:
            data = self._file.read_bytes()
        except FileNotFoundError:
            return b""
        except OSError as error:
            raise InputError(f"{self._file}: {error.strerror}") from None
        if len(data) != FLASH_BYTES:
            raise InputError(f"{self._file}: {len(data)} bytes, a flash has {FLASH_BYTES}")
        return data

    def save(self, card: VirtualNetCard) -> None:
        """Keep it, if anything was written since."""
        done = (card["programs"], card["sector_erases"], card["block_erases"])
        if done != self._kept:
            self._file.parent.mkdir(parents=True, exist_ok=True)
            write_whole(self._file, card.flash)
            self._kept = done
