"""Socket in a server's folder, by which commands on this machine reach the running server.

Request and answer are lines of JSON; behind the request of an upload come the file's bytes. Whoever
may open the folder may command the cards.
"""

import asyncio
import contextlib
import json
import logging
import os
import socket
from dataclasses import asdict
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.locking import lock
from motionfmu.cards import messages as m
from motionfmu.cards.card_settings import asked as wanted
from motionfmu.cards.card_settings import lines
from motionfmu.cards.config import CardConfig
from motionfmu.cards.server import JOB_MAX, Cards
from motionfmu.cards.views import CardView

LOG = logging.getLogger("motionfmu.cards")
SOCKET, LOCK = "control", "lock"
LINE_MAX = 65536  # [byte] of a request


class Control:
    """The server's end; one server for each folder."""

    def __init__(self, cards: Cards, folder: Path) -> None:
        self._cards, self._folder = cards, folder
        self._server: asyncio.Server | None = None
        self._lock = -1

    async def listen(self) -> None:
        """Take requests; InputError if another server uses the folder."""
        _needs_sockets(self._folder)
        try:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._lock = os.open(self._folder / LOCK, os.O_RDWR | os.O_CREAT, 0o600)
        except OSError as error:
            raise InputError(f"folder {self._folder}: {error.strerror}") from None
        try:
            lock(self._lock, self._folder, "another server uses this folder")
        except InputError:
            os.close(self._lock)
            raise
        place = self._folder / SOCKET
        place.unlink(missing_ok=True)
        before = os.umask(0o077)
        try:
            self._server = await asyncio.start_unix_server(self._serve, str(place), limit=LINE_MAX)
        except OSError as error:
            os.close(self._lock)
            raise InputError(f"{place}: {error}") from None
        finally:
            os.umask(before)

    async def close(self) -> None:
        """Take no more."""
        if self._server:
            self._server.close()
            (self._folder / SOCKET).unlink(missing_ok=True)
            os.close(self._lock)

    async def _serve(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        try:
            try:
                answer = await self._answer(json.loads(await reader.readline()), reader)
            except (InputError, ValueError, KeyError, TypeError) as error:
                answer = {"wrong": str(error)}
            except (ConnectionError, asyncio.IncompleteReadError):
                raise
            except Exception as error:  # any error is the answer to the request
                LOG.exception("a request was not done")
                answer = {"wrong": f"the server failed, its log says more: {error!r}"}
            writer.write(json.dumps(answer).encode() + b"\n")
            await writer.drain()
        except (OSError, asyncio.IncompleteReadError):
            pass  # the client has gone
        finally:
            writer.close()

    async def _answer(self, asked: dict[str, Any], reader: asyncio.StreamReader) -> dict[str, Any]:
        if asked["do"] == "list":
            return {"cards": [shown(view) for view in self._cards.list()]}
        if asked["do"] == "command":
            values = asked.get("values", {})
            result = await self._cards.command(asked["card"], asked["name"], **values)
        elif asked["do"] == "settings":
            result, found = await self._cards.settings(asked["card"])
            return asdict(result) | {"settings": [[*key, value] for key, value in found.items()]}
        elif asked["do"] == "configure":
            config = CardConfig.model_validate(asked["config"])
            end = await self._cards.configure(asked["card"], config)
            return asdict(end.result) | {"lines": [*lines(wanted(config), end)]}
        else:
            if not 0 <= asked["bytes"] <= JOB_MAX * m.PAGE:
                raise InputError(f"a file of {asked['bytes']} bytes is too long")
            file = await reader.readexactly(asked["bytes"])
            result = await self._cards.upload(asked["card"], file)
        return asdict(result)


def _needs_sockets(folder: Path) -> None:
    """InputError where Python has no sockets that are files, which is Windows."""
    if not hasattr(socket, "AF_UNIX"):
        raise InputError(
            f"{folder}: a server and its commands meet at a Unix socket here, which Python does "
            "not have on this system; run them on Linux or macOS, or in WSL"
        )


def shown(view: CardView) -> dict[str, Any]:
    """The state of a card as JSON."""
    status = view.status
    return view.outline() | {
        "frame": status.frame if status else 0,
        "position": list(status.position) if status else [],
        "stock": status.stock if status else 0,
        "underflows": status.underflows if status else 0,
    }


def ask(folder: Path, request: dict[str, Any], file: bytes = b"") -> dict[str, Any]:
    """The answer of the server that runs in a folder; InputError if none does."""
    _needs_sockets(folder)
    with contextlib.closing(socket.socket(socket.AF_UNIX)) as link:
        try:
            link.connect(str(folder / SOCKET))
            link.sendall(json.dumps(request).encode() + b"\n" + file)
            with link.makefile("rb") as stream:
                line = stream.readline()
        except OSError as error:
            told = error.strerror or str(error)
            raise InputError(
                f"{folder}: no server runs here ({told}); --folder names another"
            ) from None
    if not line:
        raise InputError(f"{folder}: the server ended without an answer")
    answer: dict[str, Any] = json.loads(line)
    if "wrong" in answer:
        raise InputError(answer["wrong"])
    return answer
