"""The server of a live machine as an ASGI application: page, WebSocket, requests by HTTP."""

import json
from collections.abc import Awaitable, Callable
from pathlib import Path

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route, WebSocketRoute

from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import Guard
from motionfmu.live.server.machine_link import MachineLink
from motionfmu.live.server.watchers import Watchers

FILES = Path(__file__).parent / "page"
KINDS = {
    ".html": "text/html",
    ".css": "text/css",
    ".js": "text/javascript",
    ".svg": "image/svg+xml",
}
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
        name = request.path_params["name"]
        arguments = json.loads(await request.body() or b"{}")
        if not isinstance(arguments, dict):
            raise InputError("a JSON object is wanted")
        return JSONResponse({"value": await watchers.do(None, name, arguments)})

    routes = [
        Route("/", _file("page.html")),
        *(Route(f"/{f.name}", _file(f.name)) for f in sorted(FILES.iterdir()) if f.suffix in KINDS),
        Route("/do/{name:str}", do, methods=["POST"]),
        WebSocketRoute("/live", watchers.serve),
    ]
    return Starlette(
        routes=routes,
        middleware=[Middleware(Guard, token=token)],
        exception_handlers={InputError: _wrong},
    )


async def _wrong(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error)}, 422)


def _file(name: str) -> Answer:
    file, kind = FILES / name, KINDS[Path(name).suffix]

    async def answer(request: Request) -> Response:
        return Response(file.read_bytes(), media_type=kind)

    return answer
