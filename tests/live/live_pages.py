"""A live machine with its page on a thread of its own, for tests with a browser."""

import asyncio
import threading
from collections.abc import Iterator
from concurrent.futures import Future
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from motionfmu.base.page_server import PageServer
from motionfmu.live.serving import MachineLink, application
from motionfmu.live.serving.machine_app import MESSAGE_MAX
from motionfmu.live.serving.machine_link import MachineStart

TOKEN = "a-token"


@contextmanager
def serving(scenario: str | Path, **more: Any) -> Iterator[str]:
    """The address of a machine's page."""
    ended, found = asyncio.Event(), Future[tuple[asyncio.AbstractEventLoop, int]]()

    async def main() -> None:
        try:
            async with (
                MachineLink(MachineStart(str(scenario), **more)) as link,
                PageServer(application(link, TOKEN), 0, message_max=MESSAGE_MAX) as port,
            ):
                found.set_result((asyncio.get_running_loop(), port))
                await ended.wait()
        except BaseException as error:
            if not found.done():
                found.set_exception(error)
            raise

    thread = threading.Thread(target=asyncio.run, args=(main(),), daemon=True)
    thread.start()
    loop, port = found.result(60)
    try:
        yield f"http://127.0.0.1:{port}/?token={TOKEN}"
    finally:
        loop.call_soon_threadsafe(ended.set)
        thread.join(20)
    assert not thread.is_alive()
