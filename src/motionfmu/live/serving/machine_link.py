"""The server's side of a machine's process: requests that are awaited."""

import asyncio
import contextlib
import itertools
import json
import signal
from asyncio.subprocess import PIPE, Process
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass, field
from types import TracebackType
from typing import Any

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.live import machine_process
from motionfmu.live.exchange import ExchangePlan
from motionfmu.live.machine_process import HEAD, packed
from motionfmu.live.serving.hand import Hand

# Of a machine that does not end by itself [s]: what was done may have to be saved.
_PATIENCE = 60.0
Told = Callable[[dict[str, Any], bytes], None]


@dataclass(frozen=True)
class MachineStart:
    """How a machine begins.

    Attributes
    ----------
    path : str
        A scenario, or a machine: path or name.
    program : str, optional
        Path of a program that it gets.
    set : mapping
        Values by ``component.variable``.
    pace : float, optional
        See `Pace`; None: as fast as it goes.
    running : bool
        Whether it goes at once.
    save_as : str, optional
        Folder of the scenario that is written when it ends, however that comes about.
    save_last : float, optional
        That scenario begins so long [s] before the end, in a saved state, if the machine has run
        longer.
    exchange : ExchangePlan, optional
        Signals that go to another program, and come from it.
    realtime : bool
        Whether its process runs before all others of the computer (Linux: SCHED_FIFO).
    """

    path: str
    program: str | None = None
    set: Mapping[str, Any] = field(default_factory=dict)
    pace: float | None = 1.0
    running: bool = True
    save_as: str | None = None
    save_last: float | None = None
    exchange: ExchangePlan | None = None
    realtime: bool = False


class MachineLink:
    """A machine's process, in ``async with``.

    Parameters
    ----------
    start : MachineStart
    told : callable, optional
        Gets what the machine says by itself, with bytes behind it: ``{"told": word, ...}``.

    Attributes
    ----------
    about : dict
        See `machine_about.about`.
    listeners : list of callable
        As `told`.
    ended : asyncio.Event
        The process has ended; `why` says how.
    hand : Hand
        Who works the machine: a page, a program, a Grbl's sender.

    Raises
    ------
    InputError
        What is wrong with the scenario, the program, the values, the pace.
    """

    def __init__(self, start: MachineStart, told: Told = lambda message, data: None) -> None:
        self._start, self.listeners = start, [told]
        self.about: dict[str, Any] = {}
        self._numbers = itertools.count()
        self._waiting: dict[int, asyncio.Future[tuple[Any, bytes]]] = {}
        self.ended = asyncio.Event()
        self.why = ""
        self.hand = Hand(self._let_go)

    async def _let_go(self) -> None:
        with contextlib.suppress(InputError):  # the machine has ended
            await self.ask("release")

    async def __aenter__(self) -> "MachineLink":
        command, options = child(f"from {machine_process.__name__} import main; main()")
        self._process: Process = await asyncio.create_subprocess_exec(
            *command, stdin=PIPE, stdout=PIPE, limit=1 << 20, **options
        )
        self._send(asdict(self._start))
        try:
            while (got := await self._received()) is not None and "told" in got[0]:
                self._tell(*got)
        except asyncio.CancelledError:
            self._process.kill()
            raise
        if got is None or "error" in got[0]:
            number = await self._process.wait()
            raise InputError(got[0]["error"] if got else _ending(number))
        self.about = got[0]["about"]
        self._listening = asyncio.create_task(self._listen())
        return self

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        assert self._process.stdin is not None
        self._process.stdin.close()
        try:
            async with asyncio.timeout(_PATIENCE):
                await self.ended.wait()
        except TimeoutError:
            self._process.kill()
        await self._listening

    def _send(self, message: dict[str, Any]) -> None:
        assert self._process.stdin is not None
        self._process.stdin.write(packed(message))

    async def _received(self) -> tuple[dict[str, Any], bytes] | None:
        assert self._process.stdout is not None
        try:
            size, more = HEAD.unpack(await self._process.stdout.readexactly(HEAD.size))
            text = await self._process.stdout.readexactly(size)
            data = await self._process.stdout.readexactly(more)
        except asyncio.IncompleteReadError:
            return None
        return json.loads(text), data

    def _tell(self, message: dict[str, Any], data: bytes) -> None:
        for listener in self.listeners:
            listener(message, data)

    async def _listen(self) -> None:
        while (got := await self._received()) is not None:
            answer, data = got
            if "told" in answer:
                self._tell(answer, data)
                continue
            waiting = self._waiting.pop(answer["id"], None)
            if waiting is None or waiting.done():
                continue
            if answer["error"] is None:
                waiting.set_result((answer["value"], data))
            else:
                waiting.set_exception(InputError(answer["error"]))
        self.why = _ending(await self._process.wait())
        self.ended.set()
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(InputError(self.why))

    async def ask(self, request: str, /, **arguments: Any) -> Any:
        """The value that the loop's method ``do_NAME`` gives.

        Raises
        ------
        InputError
            The machine refuses, or its process has ended.
        """
        return (await self.ask_with_data(request, **arguments))[0]

    async def ask_with_data(self, request: str, /, **arguments: Any) -> tuple[Any, bytes]:
        """The same, with the bytes that come behind the value."""
        if self.ended.is_set():
            raise InputError(self.why)
        number = next(self._numbers)
        future: asyncio.Future[tuple[Any, bytes]] = asyncio.get_running_loop().create_future()
        self._waiting[number] = future
        self._send({"id": number, "name": request, "arguments": arguments})
        try:
            return await future
        finally:
            self._waiting.pop(number, None)


def _ending(status: int) -> str:
    """How a process has ended, from its status."""
    how = f"was ended by {signal.Signals(-status).name}" if status < 0 else "has ended"
    return f"the machine's process {how}"
