"""A card on the side of the server: its connection, its commands, the job that it gets."""

import asyncio
import time
from collections import deque
from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field, replace

from motionfmu.cards import messages as m
from motionfmu.cards.card_settings import Key, at_power_up, in_order, numbers
from motionfmu.cards.connection import CardConnection, ConnectionLimits
from motionfmu.cards.outbox import Outbox
from motionfmu.cards.transfer import JobFile, Transfer
from motionfmu.cards.views import (
    EVENTS_KEPT,
    FLEETING,
    TEXTS,
    CardView,
    Code,
    CommandResult,
    ConfigurationResult,
    Event,
    SettingResult,
    Upload,
)

BURST = 4  # frames of a job before other cards have their turn
PROGRESS = 0.1  # [s] between two events of an upload


@dataclass
class _Order:
    """A command that waits for its result."""

    message: m.Message
    result: "asyncio.Future[CommandResult]"
    frame: int = 0  # in which it was sent last


@dataclass
class _Question:
    """A setting that a card was asked for; the answer is a code and a value."""

    message: m.ConfigGet
    frame: int
    answer: "asyncio.Future[tuple[int, int]]"

    def end(self, code: int, value: int = 0) -> None:
        """Take the answer, or the reason why there will be none."""
        if not self.answer.done():
            self.answer.set_result((code, value))


@dataclass
class _NextJob:
    """The job that a card shall get."""

    file: JobFile
    waits: "asyncio.Future[CommandResult] | None" = None
    upload: Upload = field(init=False)

    def __post_init__(self) -> None:
        self.upload = Upload(self.file.digest.hex(), self.file.pages)


class RemoteCard:
    """One card, with or without a connection."""

    def __init__(
        self, card: int, outbox: Outbox, limits: ConnectionLimits, tell: Callable[[Event], None]
    ) -> None:
        self.id = card
        self.line: CardConnection | None = None
        self._outbox, self._limits, self._tell = outbox, limits, tell
        self._events: deque[Event] = deque(maxlen=EVENTS_KEPT)
        self._hello: m.Hello | None = None
        self._status: m.Status | None = None
        self._state, self._in_flash, self._done = "", "", 0
        self._orders: dict[int, _Order] = {}
        self._transfer: Transfer | None = None
        self._shown = self._progress = self._retry = 0.0
        self._pumping = False
        self._loop = asyncio.get_running_loop()
        job = outbox.load()
        self._job = _NextJob(JobFile(job)) if job else None
        self._keeping = asyncio.Lock()
        self._question: _Question | None = None
        self._disk = ""  # fault of the disk, which is told once
        self._configuring = asyncio.Lock()

    @property
    def idle(self) -> bool:
        """Whether the server can forget the card without losing anything."""
        return not (self.line or self._job or self._orders)

    def view(self) -> CardView:
        """The card's state for users of the server."""
        return CardView(
            self.id,
            self.line is not None,
            f"{self.line.address}:{self.line.port}" if self.line else "",
            self._state,
            self._status,
            self._hello,
            self._in_flash,
            replace(self._job.upload) if self._job else None,
            self._events.copy(),
        )

    def tell(self, kind: str, text: str) -> None:
        """Pass on an event."""
        event = Event(kind, self.id, text, time.time())
        if kind not in FLEETING:
            self._events.append(event)
        self._tell(event)

    # The connection.

    def join(self, line: CardConnection, hello: m.Hello) -> None:
        """Take a connection whose handshake is over; an older one is closed."""
        old, self.line, self._transfer = self.line, line, None
        if old:
            old.drop(f"the card came again from {line.address}:{line.port}")
        before, self._hello, self._done = self._hello, hello, hello.done
        self._see(hello.state)
        self._in_flash = hello.job.hex() if any(hello.job) else ""
        self.tell("connected", f"from {line.address}:{line.port}")
        for number in sorted(self._orders):
            order = self._orders[number]
            if before and before.life == hello.life:
                order.frame = line.send(order.message)
            elif not order.result.done():  # its power failed: nobody knows what it has done
                order.result.set_result(CommandResult.of(Code.NO_ANSWER, self._state))
        self._offer()

    def left(self, line: CardConnection, why: str) -> None:
        """Note that a connection has ended."""
        self.tell("closed", why)
        if self._question:
            self._question.end(Code.OFFLINE)
        if line is self.line:
            self.line = self._transfer = None

    def heard(self, line: CardConnection, sequence: int, message: m.Message) -> None:
        """Take a message."""
        if line is not self.line:
            return
        if isinstance(message, m.Status):
            self._status = message
            self._see(message.state)
            self.tell("status", self._state)
            self._offer()
        elif isinstance(message, m.ResultMessage):
            self._answer(message.number, message.code, message.state)
        elif isinstance(message, m.Config) and self._question:
            if self._question.message == m.ConfigGet(message.id, message.index):
                self._question.end(Code.DONE, message.value)
        elif isinstance(message, m.Ack) and self._transfer:
            self._transfer.ack(message)
            self._moved()
        elif isinstance(message, m.Nak):
            for number, order in list(self._orders.items()):
                if order.frame == message.sequence:
                    self._answer(number, message.code, None)
            if self._question and self._question.frame == message.sequence:
                self._question.end(message.code)
            if self._transfer:
                self._transfer.nak(message)
                self._moved()

    def watch(self) -> None:
        """Ask the card again if an upload makes no progress."""
        now = self._loop.time()
        if self._transfer and now - self._progress > self._limits.stall:
            self._progress = now
            self._transfer.again()

    def _see(self, state: int) -> None:
        self._state = m.State(state).name if state in m.State.__members__.values() else str(state)

    # Commands.

    async def command(self, make: Callable[[int], m.Message], name: str) -> CommandResult:
        """Send a command and wait for its result, over a new connection too if need be."""
        number = self._number()
        if self.line is None or not number:
            return self._ended(name, CommandResult.of(Code.RANGE if self.line else Code.OFFLINE))
        self.tell("command", f"{name} {number}")
        return self._ended(f"{name} {number}", await self._do(number, make(number), self.line))

    def _number(self) -> int:
        """Number of the next command; 0 if all are used up."""
        number, before = self._outbox.number(self._done), self._disk
        self._disk = self._outbox.wrong
        if self._disk and self._disk != before:
            self.tell("disk", f"{self._disk}; commands go on, jobs cannot be kept")
        return number

    async def _do(self, number: int, message: m.Message, line: CardConnection) -> CommandResult:
        order = self._orders[number] = _Order(message, self._loop.create_future())
        order.frame = line.send(message)
        try:
            async with asyncio.timeout(self._limits.answer):
                return await order.result
        except TimeoutError:
            return CommandResult.of(Code.NO_ANSWER, self._state)
        finally:
            del self._orders[number]

    def _ended(self, what: str, result: CommandResult) -> CommandResult:
        self.tell("result", f"{what}: {result.text}")
        return result

    def _answer(self, number: int, code: int, state: int | None) -> None:
        self._done = max(self._done, number)
        if state is not None:
            self._see(state)
        if (order := self._orders.get(number)) and not order.result.done():
            order.result.set_result(CommandResult.of(code, self._state))

    # Settings.

    async def settings(self, keys: Iterable[Key]) -> tuple[CommandResult, dict[Key, int]]:
        """Ask for settings, one after the other; those that were told before one was not."""
        async with self._configuring:
            return await self._settings(keys)

    async def _settings(self, keys: Iterable[Key]) -> tuple[CommandResult, dict[Key, int]]:
        found: dict[Key, int] = {}
        for key in keys:
            code, value = await self._get(m.ConfigGet(numbers()[key[0]][0], key[1]))
            if code:
                return CommandResult.of(code, self._state), found
            found[key] = value
        return CommandResult.of(Code.DONE, self._state), found

    async def _get(self, message: m.ConfigGet) -> tuple[int, int]:
        if self.line is None:
            return Code.OFFLINE, 0
        answer: asyncio.Future[tuple[int, int]] = self._loop.create_future()
        self._question = _Question(message, self.line.send(message), answer)
        try:
            async with asyncio.timeout(self._limits.answer):
                return await answer
        except TimeoutError:
            return Code.NO_ANSWER, 0
        finally:
            self._question = None

    async def configure(self, wanted: Mapping[Key, int]) -> ConfigurationResult:
        """Send the settings that differ, one after the other, to the first that is not taken."""
        async with self._configuring:
            end, has = await self._settings(wanted)
            changed: list[SettingResult] = []
            for name, index in in_order(wanted, has) if end.ok else ():
                value, number = wanted[name, index], self._number()
                if self.line is None or not number:
                    end = CommandResult.of(Code.RANGE if self.line else Code.OFFLINE, self._state)
                else:
                    message = m.ConfigSet(number, numbers()[name][0], index, value)
                    end = await self._do(number, message, self.line)
                before, later = has[name, index], at_power_up(name)
                changed.append(SettingResult(name, index, before, value, later, end))
                if not end.ok:
                    break
        done = sum(s.result.ok for s in changed)
        self._ended(f"configure, {done} settings changed", end)
        return ConfigurationResult(end, tuple(changed))

    # The job.

    async def upload(self, file: bytes) -> CommandResult:
        """Bring a job; what waits in the folder is on disk before anything is sent."""
        async with self._keeping:
            await asyncio.to_thread(self._outbox.keep, file)
            if self._job:
                self._finish(Code.REPLACED)
            self._job = _NextJob(await asyncio.to_thread(JobFile, file), self._loop.create_future())
        waits, self._retry = self._job.waits, 0.0
        assert waits
        self._offer()
        return await waits

    def _offer(self) -> None:
        """Begin to send the job if there is one, and a card that could take it."""
        now = self._loop.time()
        if not self._job or not self.line or self._transfer or now < self._retry:
            return
        if self._job.upload.job == self._in_flash:
            self._job.upload.taken = self._job.upload.pages
            self._finish(Code.DONE)
            return
        self._job.upload.waits = ""
        self._progress = now
        self._transfer = Transfer(self._job.file, self.line.send)

    def room(self) -> None:
        """The line can take more."""
        self._pump()

    def _pump(self) -> None:
        self._pumping = False
        if self._transfer and self.line and self.line.room and self._transfer.pump(BURST):
            self._pumping = True
            self._loop.call_soon(self._pump)

    def _moved(self) -> None:
        """Something came for the transfer."""
        if not self._transfer or not self._job:
            return
        now, upload = self._loop.time(), self._job.upload
        upload.sent = self._transfer.sent
        if self._transfer.taken != upload.taken:
            upload.taken, self._progress = self._transfer.taken, now
            if now - self._shown >= PROGRESS:
                self._shown = now
                self.tell("progress", f"{upload.taken} of {upload.pages} pages")
        code = self._transfer.code
        if code is None:
            if not self._pumping:
                self._pump()
            return
        self._transfer = None
        if code == Code.BUSY and (self._job.waits is None or self._job.waits.done()):
            upload.waits, self._retry = TEXTS[Code.BUSY], now + self._limits.retry
            return
        if code == Code.DONE:
            self._in_flash = upload.job
        self._finish(code)

    def _finish(self, code: int) -> None:
        """The job is in the card, refused, or replaced."""
        job, self._job, self._transfer = self._job, None, None
        if job is None:
            return
        if not self._keeping.locked():  # else the file is already the next one
            self._outbox.drop()
        result = CommandResult.of(code)
        self.tell("upload", f"{job.upload.pages} pages: {result.text}")
        if job.waits and not job.waits.done():
            job.waits.set_result(result)
