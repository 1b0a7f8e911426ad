"""Live updates: cards and events are sent to every open page as they change."""

import asyncio
import json
from dataclasses import asdict
from typing import Any

from starlette.websockets import WebSocket, WebSocketDisconnect

from motionfmu.base.page_guard import same
from motionfmu.cards.views import CardView, Event

PAGES = 32  # open at once
PERIOD = 0.1  # [s] between two messages
PATIENCE = 5.0  # [s] for the token, and for a page that takes nothing
EVENTS = 200  # of all cards, at the start
FLEETING = ("status", "progress")  # kinds that are no line of the log


class OpenPages:
    """The pages that are open."""

    def __init__(self, cards: Any, token: str) -> None:
        self._cards, self._token = cards, token
        self._open = 0

    async def serve(self, page: WebSocket) -> None:
        """Tell a page of all cards, then of those that change; its first message is the token."""
        await page.accept()
        try:
            given = await asyncio.wait_for(page.receive_text(), PATIENCE)
        except (TimeoutError, WebSocketDisconnect, KeyError):
            given = ""
        if not same(given, self._token) or self._open >= PAGES:
            await page.close(1008, "the token is wrong, or too many pages are open")
            return
        self._open += 1
        queue = self._cards.subscribe()
        closed = asyncio.create_task(_closed(page))
        try:
            await self._tell(page, queue, closed)
        except (TimeoutError, WebSocketDisconnect, RuntimeError):
            pass  # the page is gone, or takes nothing
        finally:
            self._open -= 1
            self._cards.unsubscribe(queue)
            closed.cancel()

    async def _tell(
        self, page: WebSocket, queue: "asyncio.Queue[Event]", closed: "asyncio.Task[None]"
    ) -> None:
        known: dict[int, dict[str, Any]] = {}
        views = self._cards.list()
        past = [e for v in views for e in v.events if e.kind not in FLEETING]
        events = sorted(past, key=lambda e: e.time)[-EVENTS:]
        happened = True
        while not closed.done():
            if happened:
                now = {v.id: told(v) for v in self._cards.list()}
                fresh = [card for i, card in now.items() if known.get(i) != card]
                gone = sorted(known.keys() - now.keys())
                known = now
                message = {"cards": fresh, "gone": gone, "events": [asdict(e) for e in events]}
                await asyncio.wait_for(page.send_text(json.dumps(message)), PATIENCE)
            await asyncio.wait({closed}, timeout=PERIOD)
            taken = [queue.get_nowait() for _ in range(queue.qsize())]
            happened = bool(taken)
            events = [e for e in taken if e.kind not in FLEETING]


async def _closed(page: WebSocket) -> None:
    """Wait until a page is closed; its messages are ignored."""
    while (await page.receive())["type"] != "websocket.disconnect":
        pass


def told(card: CardView) -> dict[str, Any]:
    """A card as the page knows it."""
    hello = card.hello
    return card.outline() | {
        "status": asdict(card.status) if card.status else None,
        "firmware": hello.firmware if hello else 0,
        "axes": hello.axes if hello else 0,
    }
