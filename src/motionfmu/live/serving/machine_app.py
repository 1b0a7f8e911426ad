"""The server of a live machine as an ASGI application: page, WebSocket, requests by HTTP."""

import asyncio
from collections.abc import AsyncIterator, Awaitable, Callable
from pathlib import Path

import numpy as np
from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response, StreamingResponse
from starlette.routing import Route, WebSocketRoute

import motionfmu.base
from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import Guard, same
from motionfmu.base.project_version import version
from motionfmu.live.file_record import RecordHead, csv_head, csv_rows
from motionfmu.live.serving.machine_link import MachineLink
from motionfmu.live.serving.planned_path import planned_path
from motionfmu.live.serving.request_table import checked, openapi, parsed
from motionfmu.live.serving.watchers import Watchers, text_of

FILES = Path(__file__).parent / "page"
SHARED = Path(motionfmu.base.__file__).parent / "machine_picture"
KINDS = {
    ".html": "text/html",
    ".css": "text/css",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
MESSAGE_MAX = 1 << 16  # [byte] of a WebSocket's message, and of the body of a request
PART = 1 << 13  # rows of a record that are made text at a time
Answer = Callable[[Request], Awaitable[Response]]


def application(link: MachineLink, token: str) -> Starlette:
    """The page of a live machine.

    Parameters
    ----------
    link : MachineLink
        It is open.
    token : str
        Who has it may use the page: at its start it stands in the address, ``/?token=...``.

    Returns
    -------
    Starlette
    """
    watchers = Watchers(link, token)

    async def do(request: Request) -> Response:
        body = b""
        async for part in request.stream():
            body += part
            if len(body) > MESSAGE_MAX:
                return JSONResponse({"error": f"more than {MESSAGE_MAX} bytes"}, 413)
        asked = checked(request.path_params["name"], parsed(body or b"{}"))
        value = await watchers.do_by_http(request.headers.get("motionfmu-hand", ""), asked)
        return Response(text_of({"value": value}), media_type="application/json")

    async def samples(request: Request) -> Response:
        if not same(request.headers.get("authorization", ""), f"Bearer {token}"):
            return Response("the token is missing or wrong", 403)
        begin, end = (_step(request.query_params.get(k)) for k in ("begin", "end"))
        return StreamingResponse(_csv(link, begin, end), media_type="text/csv")

    async def documented(request: Request) -> Response:
        return JSONResponse(openapi(version()))

    async def planned(request: Request) -> Response:
        if not same(request.headers.get("authorization", ""), f"Bearer {token}"):
            return JSONResponse({"error": "the token is missing or wrong"}, 403)
        path = await asyncio.to_thread(planned_path, link.about["program"])
        return JSONResponse({"strokes": path})

    files = sorted(f for place in (FILES, SHARED) for f in place.iterdir() if f.suffix in KINDS)
    routes = [
        Route("/", _file(FILES / "page.html")),
        *(Route(f"/{f.name}", _file(f)) for f in files),
        Route("/planned", planned),
        Route("/do/{name:str}", do, methods=["POST"]),
        Route("/samples.csv", samples),
        Route("/openapi.json", documented),
        WebSocketRoute("/live", watchers.serve),
    ]
    return Starlette(
        routes=routes,
        middleware=[Middleware(Guard, token=token)],
        exception_handlers={InputError: _wrong},
    )


def _step(text: str | None) -> int | None:
    """A step of a query."""
    if text is None:
        return None
    if not (text.isascii() and text.isdigit() and len(text) < 19):
        raise InputError(f"step {text[:40]}: a whole number from 0 wanted")
    return int(text)


async def _csv(link: MachineLink, begin: int | None, end: int | None) -> AsyncIterator[str]:
    """A record of the scope's samples, in parts."""
    step, channels = begin or 0, None
    while end is None or step < end:
        most = None if end is None else end
        about, data = await link.ask_with_data("part", begin=step, end=most, most=PART)
        if channels is None:
            channels = about["channels"]
            head = RecordHead(channels, about["units"], about["step_ns"])
            yield csv_head(head)
        if not about["rows"] or about["channels"] != channels:
            return
        rows = np.frombuffer(data).reshape(about["rows"], -1)
        steps = np.arange(about["begin"], about["begin"] + len(rows))
        yield await asyncio.to_thread(csv_rows, steps, rows, about["step_ns"])
        step = about["begin"] + len(rows)
        if end is None:
            end = about["end"]


async def _wrong(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error)}, 422)


def _file(file: Path) -> Answer:
    kind = KINDS[file.suffix]

    async def answer(request: Request) -> Response:
        return Response(file.read_bytes(), media_type=kind)

    return answer
