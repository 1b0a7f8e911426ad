"""The page as an ASGI application: cards, commands, jobs, configuration."""

import asyncio
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any, Protocol

from starlette.applications import Starlette
from starlette.convertors import IntegerConvertor, register_url_convertor
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute

from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import Guard
from motionfmu.base.strange_json import strange_json
from motionfmu.base.toml_lines import shown
from motionfmu.cards.config import CardConfig, load
from motionfmu.cards.server_page.configuration import Configuration
from motionfmu.cards.server_page.job_pictures import Pictures
from motionfmu.cards.server_page.open_pages import OpenPages
from motionfmu.cards.server_page.plan_process import opened_apart
from motionfmu.cards.views import CardView, CommandResult, ConfigurationResult, Event

FILES = Path(__file__).parent
KINDS = {
    ".html": "text/html",
    ".css": "text/css",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
FILE_MAX = 16 << 20  # bytes of a drawing or a job
Answer = Callable[[Request], Awaitable[Response]]


class CardId(IntegerConvertor):
    """The card in a path; its digits are limited, for Python refuses numbers of thousands."""

    regex = "[0-9]{1,20}"


register_url_convertor("card", CardId())


class Fleet(Protocol):
    """What the page needs of `motionfmu.cards.server.Cards`."""

    def list(self) -> list[CardView]:
        """All cards."""

    async def command(self, card: int, name: str, /, **values: int) -> CommandResult:
        """Do a command."""

    async def upload(self, card: int, job: bytes) -> CommandResult:
        """Bring a job."""

    async def configure(self, card: int, config: CardConfig) -> ConfigurationResult:
        """Send settings that differ."""

    def subscribe(self) -> "asyncio.Queue[Event]":
        """Events from now on."""

    def unsubscribe(self, queue: "asyncio.Queue[Event]") -> None:
        """No more of them."""


def application(cards: Fleet, token: str, config: Path | None = None) -> Starlette:
    """The page of the cards of a server.

    Parameters
    ----------
    cards : Cards
        The server's cards; the page runs on their event loop.
    token : str
        Who has it may use the page: at its start it stands in the address, ``/?token=...``.
    config : Path, optional
        The card.toml that plans are made with, that the form shows and saves.

    Returns
    -------
    Starlette

    Raises
    ------
    InputError
        The configuration is wrong.
    """
    page = _CardPage(cards, load(config) if config else None, config)
    live = OpenPages(cards, token)
    routes = [
        Route("/", _file("page.html")),
        *(Route(f"/{f.name}", _file(f.name)) for f in sorted(FILES.iterdir()) if f.suffix in KINDS),
        Route("/cards/{card:card}/command", page.command, methods=["POST"]),
        Route("/cards/{card:card}/job", page.send, methods=["POST"]),
        Route("/open", page.open, methods=["POST"]),
        Route("/picture", page.picture, methods=["POST"]),
        *page.configuration.routes(),
        WebSocketRoute("/live", live.serve),
    ]
    return Starlette(
        routes=routes,
        middleware=[Middleware(Guard, token=token)],
        exception_handlers={InputError: _wrong},
    )


async def _wrong(request: Request, error: Exception) -> Response:
    return JSONResponse({"errors": str(error).splitlines()}, 422)


def _file(name: str) -> Answer:
    text = (FILES / name).read_bytes()
    kind = KINDS[Path(name).suffix]

    async def answer(request: Request) -> Response:
        return Response(text, media_type=kind)

    return answer


async def body(request: Request, most: int) -> bytes:
    """Bytes of a request; InputError if they are more."""
    parts = bytearray()
    async for part in request.stream():
        parts += part
        if len(parts) > most:
            raise InputError(f"more than {most} bytes")
    return bytes(parts)


async def values(request: Request) -> dict[str, Any]:
    """Values of a request, a JSON object; InputError if it is none."""
    try:
        found = strange_json(await body(request, 1 << 20))
    except ValueError:
        found = None
    if not isinstance(found, dict):
        raise InputError("a JSON object is wanted")
    return found


class _CardPage:
    def __init__(self, cards: Fleet, config: CardConfig | None, file: Path | None) -> None:
        self._cards = cards
        self._pictures = Pictures()
        self._planning = asyncio.Lock()
        self.configuration = Configuration(config, file, values, cards.configure)

    async def command(self, request: Request) -> Response:
        """Do a command: its name, and its values."""
        asked = await values(request)
        name = asked.pop("name", "")
        result = await self._cards.command(request.path_params["card"], str(name), **asked)
        return _result(result)

    async def open(self, request: Request) -> Response:
        """Read a job or plan a drawing, and show it."""
        name = Path(request.query_params.get("name", "drawing")).name
        page = request.query_params.get("page", "1")
        if not (page.isascii() and page.isdecimal() and len(page) < 10):
            raise InputError(f"page {shown(page)}: a number from 1 wanted")
        data = await body(request, FILE_MAX)
        async with self._planning:  # one at a time: it takes a processor
            job = await opened_apart(data, name, self.configuration.used, int(page))
        self._pictures.add(job)
        return JSONResponse(job.picture)

    async def picture(self, request: Request) -> Response:
        """The picture of a job that was opened before, or null."""
        job = self._pictures.get(str((await values(request)).get("job")))
        return JSONResponse(job.picture if job else None)

    async def send(self, request: Request) -> Response:
        """Bring an opened job into a card; answers when it is there, or refused."""
        job = self._pictures.get(str((await values(request)).get("job")))
        if job is None:
            raise InputError("this job is not open any more: open its file again")
        return _result(await self._cards.upload(request.path_params["card"], job.job))


def _result(result: CommandResult) -> Response:
    said = {"code": result.code, "ok": result.ok, "text": result.text, "state": result.state}
    return JSONResponse(said | {"advice": result.advice})
