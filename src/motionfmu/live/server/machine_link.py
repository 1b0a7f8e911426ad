"""The server's side of a machine's process: requests that are awaited."""

import asyncio
import contextlib
import itertools
import json
from asyncio.subprocess import PIPE, Process
from collections.abc import Mapping
from types import TracebackType
from typing import Any

from motionfmu.base.children import child
from motionfmu.base.errors import InputError
from motionfmu.live import machine_process
from motionfmu.live.machine_process import HEAD, packed

# Of a machine that does not end by itself [s].
_PATIENCE = 5.0


class MachineLink:
    """A machine's process, in ``async with``.

    Parameters
    ----------
    scenario : str
        Path or name.
    set : mapping, optional
        Values by ``component.variable``.
    pace : float, optional
        See `Pace`; None: as fast as it goes.
    running : bool
        Whether it goes at once.

    Attributes
    ----------
    about : dict
        See `machine_about.about`.

    Raises
    ------
    InputError
        What is wrong with the scenario, the values, the pace.
    """

    def __init__(
        self,
        scenario: str,
        set: Mapping[str, Any] | None = None,
        pace: float | None = 1.0,
        running: bool = True,
    ) -> None:
        self._start = {
            "scenario": scenario,
            "set": dict(set or {}),
            "pace": pace,
            "running": running,
        }
        self.about: dict[str, Any] = {}
        self._numbers = itertools.count()
        self._waiting: dict[int, asyncio.Future[tuple[Any, bytes]]] = {}
        self.ended = asyncio.Event()

    async def __aenter__(self) -> "MachineLink":
        command, options = child(f"from {machine_process.__name__} import main; main()")
        self._process: Process = await asyncio.create_subprocess_exec(
            *command, stdin=PIPE, stdout=PIPE, limit=1 << 20, **options
        )
        self._send(self._start)
        got = await self._received()
        if got is None or "error" in got[0]:
            await self._process.wait()
            raise InputError(got[0]["error"] if got else "the machine's process has ended")
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
            await asyncio.wait_for(self._process.wait(), _PATIENCE)
        except TimeoutError:
            self._process.kill()
        self._listening.cancel()
        with contextlib.suppress(asyncio.CancelledError):
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

    async def _listen(self) -> None:
        while (got := await self._received()) is not None:
            answer, data = got
            waiting = self._waiting.pop(answer["id"], None)
            if waiting is None or waiting.done():
                continue
            if answer["error"] is None:
                waiting.set_result((answer["value"], data))
            else:
                waiting.set_exception(InputError(answer["error"]))
        self.ended.set()
        for waiting in self._waiting.values():
            if not waiting.done():
                waiting.set_exception(InputError("the machine's process has ended"))

    async def ask(self, name: str, /, **arguments: Any) -> Any:
        """The value that the loop's method ``do_NAME`` gives.

        Raises
        ------
        InputError
            The machine refuses, or its process has ended.
        """
        return (await self.ask_with_data(name, **arguments))[0]

    async def ask_with_data(self, name: str, /, **arguments: Any) -> tuple[Any, bytes]:
        """The same, with the bytes that come behind the value."""
        if self.ended.is_set():
            raise InputError("the machine's process has ended")
        number = next(self._numbers)
        future: asyncio.Future[tuple[Any, bytes]] = asyncio.get_running_loop().create_future()
        self._waiting[number] = future
        self._send({"id": number, "name": name, "arguments": arguments})
        try:
            return await future
        finally:
            self._waiting.pop(number, None)
