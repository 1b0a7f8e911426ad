"""Who looks at a live machine, and who works it."""

import asyncio
import contextlib
import json
import logging
import secrets
from collections import deque
from dataclasses import dataclass, field
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import same
from motionfmu.live.serving.hand import Holder
from motionfmu.live.serving.machine_link import MachineLink
from motionfmu.live.serving.request_table import CheckedRequest, checked, parsed

PERIOD = 1 / 60  # [s] between two frames
PATIENCE = 5.0  # [s] for the token, and for a page that takes nothing
PAGES = 100  # open at once
STRANGERS = 100  # connections that have not said the token yet
SAMPLES = 1 << 14  # of a channel, that a page is sent at a time
ANSWERS = 64  # that wait for a page to take them; it is not listened to until then
PROGRAMS = 16  # keys that are kept: with one a program keeps the hand from request to request
_LOG = logging.getLogger(__name__)
_Parts = tuple[str | bytes, ...]


@dataclass(eq=False)
class Watcher(Holder):
    """A page that is open, what it looks at, and what it is to be sent."""

    socket: WebSocket | None = None
    names: tuple[str, ...] | None = ()  # of frames; None: no frames
    since: int | None = None  # samples from this step on are to be sent
    scope: bool = False  # triggered recordings are to be sent
    frame: str = ""  # the latest, of which a slow page gets only some
    busy: bool = False  # it has not taken yet what it was sent
    must: deque[_Parts] = field(default_factory=deque)  # messages of which none is left out
    asked: set["asyncio.Task[None]"] = field(default_factory=set)  # requests without an answer yet
    news: asyncio.Event = field(default_factory=asyncio.Event)
    room: asyncio.Event = field(default_factory=asyncio.Event)  # to listen to it

    def put(self, *parts: str | bytes) -> None:
        """Send messages one behind the other, whatever else is sent."""
        self.must.append(parts)
        self.news.set()
        self.count()

    def count(self) -> None:
        """Listen to it, if not too much waits for it."""
        if len(self.must) + len(self.asked) < ANSWERS:
            self.room.set()
        else:
            self.room.clear()


class Watchers:
    """The pages that are open, of which one has the machine in hand.

    A frame is asked of the machine once for all of them.
    """

    def __init__(self, link: MachineLink, token: str) -> None:
        self._link, self._token = link, token
        self._open: list[Watcher] = []
        self._strangers = 0
        self._programs: dict[str, Holder] = {}
        self._telling: asyncio.Task[None] | None = None
        self.hand = link.hand
        link.listeners.append(self._told)

    async def serve(self, socket: WebSocket) -> None:
        """Tell a page of the machine; do what it asks; its first message is the token."""
        if self._strangers >= STRANGERS or len(self._open) >= PAGES:
            await socket.close(1013, "too many pages are open")
            return
        self._strangers += 1
        try:
            known = await self._knows(socket)
        finally:
            self._strangers -= 1
        if not known:
            return
        watcher = Watcher(socket=socket)
        watcher.put(text_of({"about": self._link.about}))
        self._open.append(watcher)
        if self.hand.holder is None:
            await self.hand.take(watcher)
        if self._telling is None or self._telling.done():
            self._telling = asyncio.create_task(self._tell())
        sending = asyncio.create_task(_send(watcher))
        listening = asyncio.create_task(self._listen(watcher))
        try:
            await asyncio.wait({sending, listening}, return_when=asyncio.FIRST_COMPLETED)
        finally:
            self._open.remove(watcher)
            tasks = (sending, listening, *watcher.asked)
            for task in tasks:
                task.cancel()
            await asyncio.gather(*tasks, return_exceptions=True)
            await self.hand.drop(watcher)
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await socket.close(1011, "the page takes nothing")

    async def _knows(self, socket: WebSocket) -> bool:
        """Whether a page knows the token."""
        await socket.accept()
        try:
            given = await asyncio.wait_for(socket.receive_text(), PATIENCE)
        except (TimeoutError, WebSocketDisconnect, KeyError):
            given = ""
        if same(given, self._token):
            return True
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            await socket.close(1008, "the token is wrong")
        return False

    async def _listen(self, watcher: Watcher) -> None:
        assert watcher.socket is not None
        with contextlib.suppress(WebSocketDisconnect, RuntimeError):
            while True:
                await watcher.room.wait()
                message = await watcher.socket.receive()
                if message["type"] == "websocket.disconnect":
                    return
                task = asyncio.create_task(self._message(watcher, message.get("text")))
                watcher.asked.add(task)
                task.add_done_callback(watcher.asked.discard)
                watcher.count()

    async def _message(self, watcher: Watcher, text: str | None) -> None:
        number = None
        try:
            if text is None:
                raise InputError("a message is text")
            asked = parsed(text)
            if not isinstance(asked, dict):
                raise InputError("a message is a JSON object")
            number = asked.get("id")
            wanted = checked(asked.get("do"), asked.get("with", {}))
            answer = {"id": number, "value": await self.do(watcher, wanted)}
        except InputError as error:
            answer = {"id": number, "error": str(error)}
        except Exception as error:  # a mistake here: whoever asked must not wait for ever
            _LOG.exception("request %s", number)
            answer = {"id": number, "error": f"{type(error).__name__}: {error}"}
        watcher.asked.discard(asyncio.current_task())
        watcher.put(text_of(answer))

    async def do(self, who: Holder, asked: CheckedRequest) -> Any:
        """Do what somebody asks."""
        if asked.kind.hand:
            self.hand.needed(who)
        if asked.kind.server:
            return await getattr(self, f"_do_{asked.name}")(who, **asked.arguments)
        if asked.name in ("trigger", "channels") and isinstance(who, Watcher):
            who.scope = True
        return await self._link.ask(asked.name, **asked.arguments)

    async def _do_watch(self, who: Watcher, names: list[str] | None) -> None:
        await self._link.ask("values", names=names or [])  # tells which is none
        who.names = None if names is None else tuple(names)

    async def _do_samples(self, who: Watcher, since: int | None = None) -> None:
        who.since, who.scope = since, who.scope or since is not None

    async def _do_name(self, who: Watcher, name: str) -> None:
        who.name = name

    async def _do_take(self, who: Holder) -> None:
        await self.hand.take(who)

    async def _do_drop(self, who: Holder) -> None:
        await self.hand.drop(who)

    async def _do_recording(self, who: Watcher, number: int = -1) -> None:
        about, data = await self._link.ask_with_data("recording", number=number)
        who.put(text_of({"triggered": about}), data)

    async def do_by_http(self, key: str, asked: CheckedRequest) -> Any:
        """Do what a program asks, which has the hand by a key."""
        if asked.kind.socket:
            raise InputError(f"{asked.name}: by WebSocket only")
        if key and key not in self._programs:
            raise InputError("Motionfmu-Hand: no such key; take gives one")
        who = self._programs.get(key) or Holder("a program")
        if asked.name == "take":
            key = key or secrets.token_urlsafe(16)
            self._programs[key] = who
            while len(self._programs) > PROGRAMS:
                del self._programs[next(iter(self._programs))]
            await self.hand.take(who)
            return {"hand": key}
        if asked.name == "drop":
            self._programs.pop(key, None)
        free = self.hand.holder is None
        try:
            return await self.do(who, asked)
        finally:
            if free and not key and self.hand.holder is who:
                self.hand.holder = None  # one request, without a key, of a program

    def _told(self, message: dict[str, Any], data: bytes) -> None:
        """The machine says something by itself."""
        if message["told"] == "triggered":
            text = text_of({"triggered": message["value"]})
            for watcher in self._open:
                if watcher.scope:
                    watcher.put(text, data)

    async def _tell(self) -> None:
        """Send frames to all pages 60 times a second, for as long as any is open."""
        loop = asyncio.get_running_loop()
        due = loop.time()
        while self._open:
            due = max(due, loop.time() - PERIOD) + PERIOD  # what sleep adds does not add up
            try:
                await self._frames()
                await self._samples()
            except InputError as error:
                if not self._link.ended.is_set():
                    raise
                for watcher in self._open:
                    watcher.put(text_of({"ended": str(error)}))
                return
            await asyncio.sleep(max(0.0, due - loop.time()))

    async def _frames(self) -> None:
        """Ask for a frame with what any page looks at; give each its own part."""
        ready = [w for w in self._open if w.names is not None and not w.frame]
        if not ready:
            if self._link.ended.is_set():
                raise InputError(self._link.why)
            return
        names = list(dict.fromkeys(n for w in ready for n in w.names or ()))
        frame = await self._link.ask("frame", names=names)
        values = frame.pop("values")
        holder = self.hand.holder
        frame |= {"watchers": len(self._open), "holder": holder.name if holder else None}
        texts: dict[tuple[bool, tuple[str, ...]], str] = {}
        for watcher in ready:
            key = watcher is holder, watcher.names or ()
            if key not in texts:
                own = {"hand": key[0], "values": {n: values[n] for n in key[1] if n in values}}
                texts[key] = text_of({"frame": frame | own})
            watcher.frame = texts[key]
            watcher.news.set()

    async def _samples(self) -> None:
        """Ask for samples once for all pages that follow; those that lag get the latest."""
        ready = [w for w in self._open if w.since is not None and not w.busy]
        if not ready:
            return
        least = min(w.since for w in ready if w.since is not None)
        about, data = await self._link.ask_with_data("samples", since=least, most=SAMPLES)
        begin, end = about["begin"], about["begin"] + about["rows"]
        row = 8 * len(about["channels"])
        for watcher in ready:
            since = watcher.since
            if since is None:  # it has been switched off
                continue
            # A page that was told of later steps follows the machine back.
            first = min(max(since, begin), end) if since <= end else begin
            own = {**about, "begin": first, "rows": end - first}
            if end > first:
                watcher.put(text_of({"samples": own}), data[(first - begin) * row :])
            watcher.since = end


def text_of(message: dict[str, Any]) -> str:
    """A message as JSON, in which a number that is none is null."""
    try:
        return json.dumps(message, allow_nan=False)
    except ValueError:
        return json.dumps(json.loads(json.dumps(message), parse_constant=lambda word: None))


async def _send(watcher: Watcher) -> None:
    """Send a page what there is as fast as it takes it; end when it takes nothing."""
    assert watcher.socket is not None
    with contextlib.suppress(TimeoutError, WebSocketDisconnect, RuntimeError):
        while True:
            await watcher.news.wait()
            watcher.news.clear()
            watcher.busy = True
            while watcher.must:
                for part in watcher.must.popleft():
                    await _put(watcher.socket, part)
                watcher.count()
            if watcher.frame:
                await _put(watcher.socket, watcher.frame)
                watcher.frame = ""
            watcher.busy = False


async def _put(socket: WebSocket, part: str | bytes) -> None:
    async with asyncio.timeout(PATIENCE):
        if isinstance(part, str):
            await socket.send_text(part)
        else:
            await socket.send_bytes(part)
