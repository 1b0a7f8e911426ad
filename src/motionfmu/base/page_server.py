"""A page that a command serves, on a port of this machine."""

import asyncio
import gc
import os
import socket
from pathlib import Path
from types import TracebackType
from typing import Any

import uvicorn
from starlette.applications import Starlette
from uvicorn.protocols.http.auto import AutoHTTPProtocol
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from motionfmu.base.errors import InputError

HOST = "127.0.0.1"
PORT_MAX = 65535
MESSAGE_MAX = 4096  # [byte] of a page to the server: it says its token
CLOSING = 1.0  # [s] for pages that are open when it ends
CONNECTIONS = 256  # at once; with one more, the oldest that asks for nothing is cut off
ASKING = 10.0  # [s] for a connection's first request
OFTEN = 500, 5, 2  # objects, collections of those, of these: the last is of all, a few thousand
SENDING = 1 << 18  # [byte] that the system keeps for a page that does not read them


class _PageConnection(AutoHTTPProtocol):  # type: ignore[misc,valid-type]  # chosen as it is loaded
    """A connection; one that has not asked for anything yet gives way when they are too many."""

    def connection_made(self, transport: asyncio.Transport) -> None:
        super().connection_made(transport)
        loop = asyncio.get_running_loop()
        self.begun = loop.time()
        if len(self.connections) > CONNECTIONS:
            silent = [c for c in self.connections if isinstance(c, _PageConnection) and c.silent]
            min(silent, key=lambda c: c.begun).transport.abort()  # this one, if all others asked
        loop.call_later(ASKING, self._asked, transport)

    @property
    def silent(self) -> bool:
        """Whether this connection has not sent a whole request yet."""
        return self.cycle is None

    def _asked(self, transport: asyncio.Transport) -> None:
        if self.silent and transport.get_protocol() is self:
            transport.abort()


class _PageSocket(WebSocketsSansIOProtocol):
    """A WebSocket that is cut off when it is to be closed, but its page reads nothing."""

    def handle_connect(self, event: Any) -> None:
        super().handle_connect(event)
        self.close_timeout = CLOSING

    async def send(self, message: Any) -> None:
        if message["type"] == "websocket.close" and not self.writable.is_set():
            self.transport.abort()
        await super().send(message)

    def keepalive_timeout(self) -> None:
        super().keepalive_timeout()
        self.transport.abort()


def listener(port: int, name: str) -> socket.socket:
    """A socket that listens on this machine alone; an InputError with the name if it cannot."""
    try:
        made = socket.create_server((HOST, port))
    except OSError as error:
        raise InputError(f"{name}: {os.strerror(error.errno or 0)}") from None
    # Else what follows a short part of an answer waits 40 ms for that part's acknowledgement.
    made.setsockopt(socket.IPPROTO_TCP, socket.TCP_NODELAY, 1)
    return made


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
        self._socket = listener(port, f"page {HOST}:{port}")
        self._socket.setsockopt(socket.SOL_SOCKET, socket.SO_SNDBUF, SENDING)
        self._server = uvicorn.Server(
            uvicorn.Config(
                app,
                http=_PageConnection,
                ws=_PageSocket,
                # On a loopback it costs more than it saves.
                ws_per_message_deflate=False,
                log_level="error",  # what strangers send is no news
                timeout_graceful_shutdown=int(CLOSING),
                ws_max_size=message_max,
                ssl_certfile=tls and tls[0],
                ssl_keyfile=tls and tls[1],
            )
        )

    async def __aenter__(self) -> int:
        # Of what refused connections leave, the collector then looks at that alone, and so often.
        gc.collect()
        gc.freeze()
        gc.set_threshold(*OFTEN)
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
