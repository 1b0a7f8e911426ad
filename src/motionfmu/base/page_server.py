"""A page that a command serves, on a port of this machine."""

import asyncio
import os
import socket
from pathlib import Path
from types import TracebackType

import uvicorn
from starlette.applications import Starlette

from motionfmu.base.errors import InputError

HOST = "127.0.0.1"
MESSAGE_MAX = 4096  # [byte] of a page to the server: it says its token
CLOSING = 1.0  # [s] for pages that are open when it ends


class PageServer:
    """A page on a port of this machine, in ``async with``.

    Parameters
    ----------
    app : Starlette
    port : int
        0: the system chooses.
    tls : tuple of Path, optional
        Files of a certificate and its key: the page is ``https://``.
    message_max : int
        Bytes of a WebSocket's message to the server.

    Raises
    ------
    InputError
        The port is taken.
    """

    def __init__(
        self,
        app: Starlette,
        port: int,
        tls: tuple[Path, Path] | None = None,
        message_max: int = MESSAGE_MAX,
    ) -> None:
        try:
            self._socket = socket.create_server((HOST, port))
        except OSError as error:
            told = os.strerror(error.errno or 0)
            raise InputError(f"page {HOST}:{port}: {told}") from None
        # Else head and body of an answer are 40 ms apart: the body waits for an acknowledgement.
        self._socket.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
        self._server = uvicorn.Server(
            uvicorn.Config(
                app,
                log_level="warning",
                timeout_graceful_shutdown=int(CLOSING),
                ws_max_size=message_max,
                ssl_certfile=tls and tls[0],
                ssl_keyfile=tls and tls[1],
            )
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
