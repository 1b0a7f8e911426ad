"""Who looks at a live machine, and who works it."""

import asyncio
import json
from dataclasses import dataclass, field
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import same
from motionfmu.live.server.machine_link import MachineLink

PERIOD = 1 / 50  # [s] between two frames
PATIENCE = 5.0  # [s] for the token
SAMPLES = 1 << 14  # of a channel, that a page is sent at a time
# What a page may ask for without having the machine in hand.
OPEN = {"journal", "watch", "take", "samples"}
REQUESTS = OPEN | {
    "set",
    "press",
    "hold",
    "release",
    "pace",
    "go",
    "pause",
    "step",
    "back",
    "save",
    "channels",
    "command",
}


@dataclass(eq=False)
class Watcher:
    """A page that is open, and what it looks at."""

    socket: WebSocket
    names: list[str] = field(default_factory=list)
    since: int | None = None  # samples from this step on are to be sent


class Watchers:
    """The pages that are open, of which one has the machine in hand."""

    def __init__(self, link: MachineLink, token: str) -> None:
        self._link, self._token = link, token
        self._open: list[Watcher] = []
        self._hand: Watcher | None = None

    async def serve(self, socket: WebSocket) -> None:
        """Tell a page of the machine; do what it asks; its first message is the token."""
        await socket.accept()
        try:
            given = await asyncio.wait_for(socket.receive_text(), PATIENCE)
        except (TimeoutError, WebSocketDisconnect, KeyError):
            given = ""
        if not same(given, self._token):
            await socket.close(1008, "the token is wrong")
            return
        watcher = Watcher(socket)
        self._open.append(watcher)
        self._hand = self._hand or watcher
        telling = asyncio.create_task(self._tell(watcher))
        try:
            await socket.send_text(json.dumps({"about": self._link.about}))
            while True:
                await self._message(watcher, await socket.receive_text())
        except (WebSocketDisconnect, RuntimeError, KeyError):
            pass
        finally:
            telling.cancel()
            self._open.remove(watcher)
            if self._hand is watcher:
                self._hand = None
                await self._link.ask("release")

    async def _message(self, watcher: Watcher, text: str) -> None:
        try:
            asked = json.loads(text)
            value = await self.do(watcher, asked["do"], asked.get("with", {}))
            answer = {"id": asked.get("id"), "value": value}
        except InputError as error:
            answer = {"id": asked.get("id"), "error": str(error)}
        await watcher.socket.send_text(json.dumps(answer))

    async def do(self, watcher: Watcher | None, name: str, arguments: dict[str, Any]) -> Any:
        """Do what is asked."""
        if name not in REQUESTS:
            raise InputError(f"{name}: no such request")
        if name == "watch":
            assert watcher is not None
            watcher.names = list(arguments["names"])
            return None
        if name == "samples":
            assert watcher is not None
            watcher.since = arguments.get("since")
            return None
        if name == "take":
            self._hand = watcher
            return None
        if watcher is not None and watcher is not self._hand and name not in OPEN:
            raise InputError("somebody else has the machine in hand: take it first")
        return await self._link.ask(name, **arguments)

    async def _tell(self, watcher: Watcher) -> None:
        """Send frames to a page as fast as it takes them, 50 a second at most."""
        loop = asyncio.get_running_loop()
        while True:
            due = loop.time() + PERIOD
            try:
                frame = await self._link.ask("frame", names=watcher.names)
                frame |= {"hand": watcher is self._hand, "watchers": len(self._open)}
                await watcher.socket.send_text(json.dumps({"frame": frame}))
                if watcher.since is not None:
                    about, data = await self._link.ask_with_data(
                        "samples", since=watcher.since, most=SAMPLES
                    )
                    watcher.since = about["begin"] + about["rows"]
                    await watcher.socket.send_text(json.dumps({"samples": about}))
                    await watcher.socket.send_bytes(data)
            except InputError as error:
                await watcher.socket.send_text(json.dumps({"ended": str(error)}))
                return
            await asyncio.sleep(max(0.0, due - loop.time()))
