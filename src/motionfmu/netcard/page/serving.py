"""The page on a port of this machine, on the event loop of the cards."""

import asyncio
import os
import socket
from types import TracebackType

import uvicorn
from starlette.applications import Starlette

from motionfmu.errors import InputError

HOST = "127.0.0.1"
CLOSING = 1.0  # [s] for pages that are open when it ends


class Serving:
    """The page on a port of this machine, in ``async with``.

    Parameters
    ----------
    app : Starlette
        See `application`.
    port : int
        0: the system chooses.

    Raises
    ------
    InputError
        The port is taken.
    """

    def __init__(self, app: Starlette, port: int) -> None:
        try:
            self._socket = socket.create_server((HOST, port))
        except OSError as error:
            told = os.strerror(error.errno or 0)
            raise InputError(f"page {HOST}:{port}: {told}") from None
        self._server = uvicorn.Server(
            uvicorn.Config(app, log_level="warning", timeout_graceful_shutdown=int(CLOSING))
        )

    async def __aenter__(self) -> int:
        self._task = asyncio.create_task(self._server.serve([self._socket]))
        return int(self._socket.getsockname()[1])

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._server.should_exit = True
        await self._task
        self._socket.close()
