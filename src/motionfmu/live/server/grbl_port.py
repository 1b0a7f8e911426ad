"""Where a sender opens a Grbl: a TCP port of this machine, or a pseudo-terminal."""

import asyncio
import contextlib
import errno
import os
import sys
from types import TracebackType

from motionfmu.base.errors import InputError
from motionfmu.live.server.grbl_session import GrblSession
from motionfmu.live.server.machine_link import MachineLink

HOST = "127.0.0.1"
TERMINAL = "pty"
CHUNK = 4096  # [byte]
BACKLOG = 1 << 20  # [byte] that a sender may leave unread before it is dropped


class GrblPort:
    """A machine's Grbl port, in ``async with``; one sender at a time.

    Parameters
    ----------
    link : MachineLink
        It is open.
    where : str
        A TCP port, 0 any; or ``pty``.

    Attributes
    ----------
    address : str
        What a sender is told.

    Raises
    ------
    InputError
        The machine has no controller for it, or the port is none or taken.
    """

    def __init__(self, link: MachineLink, where: str) -> None:
        self._session = GrblSession(link)
        if where != TERMINAL and not (where.isdecimal() and int(where) < 1 << 16):
            raise InputError(f"--grbl {where}: a port from 0 to 65535, or {TERMINAL}")
        if where == TERMINAL and sys.platform == "win32":
            raise InputError(f"--grbl {TERMINAL}: Windows has none; give a port")
        self._where = where
        self._busy = False
        self._tasks: set[asyncio.Task[None]] = set()
        self.address = ""

    async def __aenter__(self) -> "GrblPort":
        if self._where == TERMINAL:
            self._open_terminal()
        else:
            await self._open_socket()
        return self

    async def _open_socket(self) -> None:
        try:
            self._server = await asyncio.start_server(self._serve, HOST, int(self._where))
        except OSError as error:
            told = os.strerror(error.errno or 0)
            raise InputError(f"--grbl {self._where}: {HOST}: {told}") from None
        port = self._server.sockets[0].getsockname()[1]
        self.address = f"tcp://{HOST}:{port}"

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        for task in self._tasks:
            task.cancel()
        await asyncio.gather(*self._tasks, return_exceptions=True)
        if self._where == TERMINAL:
            os.close(self._master)
            os.close(self._slave)
        else:
            self._server.close()
            await self._server.wait_closed()

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        if self._busy:
            writer.close()
            return
        self._busy = True

        def write(data: bytes) -> None:
            if writer.transport.get_write_buffer_size() < BACKLOG:
                writer.write(data)
            else:
                writer.transport.abort()

        task = asyncio.ensure_future(self._session.run(write))
        self._tasks.add(task)
        try:
            while data := await reader.read(CHUNK):
                self._session.receive(data)
        except ConnectionError:
            pass
        finally:
            task.cancel()
            await asyncio.gather(task, return_exceptions=True)
            self._tasks.discard(task)
            await self._session.end()
            self._busy = False
            writer.close()

    def _open_terminal(self) -> None:
        import tty

        self._master, self._slave = os.openpty()
        tty.setraw(self._slave)
        os.set_blocking(self._master, False)
        self.address = os.ttyname(self._slave)
        self._tasks.add(asyncio.ensure_future(self._serve_terminal()))

    async def _serve_terminal(self) -> None:
        """As a serial port is: it is there whether somebody has it open or not."""

        def write(data: bytes) -> None:
            with contextlib.suppress(BlockingIOError):
                os.write(self._master, data)

        loop = asyncio.get_running_loop()

        def read() -> None:
            try:
                self._session.receive(os.read(self._master, CHUNK))
            except OSError as error:
                if error.errno not in (errno.EIO, errno.EAGAIN):
                    raise

        loop.add_reader(self._master, read)
        try:
            await self._session.run(write)
        finally:
            loop.remove_reader(self._master)
