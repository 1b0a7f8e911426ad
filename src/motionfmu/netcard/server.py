"""The server of network cards: many cards on one event loop."""

import asyncio
from pathlib import Path

from motionfmu.netcard.views import CardView, Event, Result


class Cards:
    """All cards of one server; everything runs on the event loop that called `listen`."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder

    async def listen(self, host: str = "127.0.0.1", port: int = 0) -> int:
        """Take connections of cards; returns the port."""
        raise NotImplementedError

    async def close(self) -> None:
        """Close all connections; what waits in the folder stays there."""
        raise NotImplementedError

    def list(self) -> list[CardView]:
        """All cards that were ever heard or have a job waiting, by id."""
        raise NotImplementedError

    async def command(self, card: int, name: str, **values: int) -> Result:
        """Do start, pause, stop, home (axes), reset or output (pins, mode, level, width).

        Never raises for what the card or the link does: a Result says it. InputError for a name
        or a value that no card knows.
        """
        raise NotImplementedError

    async def upload(self, card: int, job: bytes) -> Result:
        """Bring a job file into a card's flash; returns when it is there, or refused.

        Who does not wait any more (cancels) leaves the job in the folder: it is brought when the
        card comes. A newer job for the card takes its place. InputError if it is no job file.
        """
        raise NotImplementedError

    def subscribe(self) -> "asyncio.Queue[Event]":
        """Events from now on; the oldest are dropped if nobody takes them."""
        raise NotImplementedError

    def unsubscribe(self, queue: "asyncio.Queue[Event]") -> None:
        """No more events into this queue."""
        raise NotImplementedError
