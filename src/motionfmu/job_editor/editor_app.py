"""The server of the page on which a robot's program is edited."""

import asyncio
import json
from pathlib import Path
from typing import Any

from starlette.applications import Starlette
from starlette.middleware import Middleware
from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

import motionfmu.base
import motionfmu.report
from motionfmu.base.errors import InputError
from motionfmu.base.page_guard import Guard
from motionfmu.job_editor.edited_job import EditedJob, JobTexts

FILES = Path(__file__).parent / "page"
SHARED = Path(motionfmu.base.__file__).parent / "machine_picture"
REPORT = Path(motionfmu.report.__file__).parent
OF_REPORT = {"/report.css": "page.css", "/theme.js": "theme.js", "/view.js": "view.js"}
KINDS = {".html": "text/html", ".css": "text/css", ".js": "text/javascript"}
BODY_MAX = 1 << 24  # [byte] of a request


def application(job: EditedJob, token: str) -> Starlette:
    """The page of a program.

    Parameters
    ----------
    job : EditedJob
    token : str
        Who has it may use the page: it stands in the address, ``/?token=...``.

    Returns
    -------
    Starlette
    """
    turn, asked = asyncio.Lock(), [0]

    async def opened(request: Request) -> Response:
        file, points = job.files
        texts = job.texts
        names = {"file": file.name, "points_file": points and points.name}
        return JSONResponse(names | {"job": texts.job, "points": texts.points})

    async def judged(request: Request) -> Response:
        texts, _ = await _texts(request)
        asked[0] += 1
        mine = asked[0]
        async with turn:  # what has been overtaken meanwhile is not begun
            if mine != asked[0]:
                return JSONResponse({"error": "something newer is to be judged"}, 409)
            found = await asyncio.to_thread(job.judge, texts, lambda: mine == asked[0])
        status = 200 if mine == asked[0] else 409
        return JSONResponse(found if status == 200 else {"error": "overtaken"}, status)

    async def saved(request: Request) -> Response:
        texts, over = await _texts(request)
        async with turn:
            await asyncio.to_thread(job.save, texts, over)
        return JSONResponse({})

    places = [
        f for folder in (FILES, SHARED) for f in sorted(folder.iterdir()) if f.suffix in KINDS
    ]
    routes = [
        Route("/", _file(FILES / "page.html")),
        *(Route(f"/{f.name}", _file(f)) for f in places),
        *(Route(path, _file(REPORT / name)) for path, name in OF_REPORT.items()),
        Route("/open", opened, methods=["POST"]),
        Route("/judge", judged, methods=["POST"]),
        Route("/save", saved, methods=["POST"]),
    ]
    return Starlette(
        routes=routes,
        middleware=[Middleware(Guard, token=token)],
        exception_handlers={InputError: _wrong},
    )


async def _texts(request: Request) -> tuple[JobTexts, bool]:
    """Texts of a request, and whether they are saved over another's change."""
    body = b""
    async for part in request.stream():
        body += part
        if len(body) > BODY_MAX:
            raise InputError(f"more than {BODY_MAX} bytes")
    try:
        given: Any = json.loads(body)
    except ValueError:
        raise InputError("no JSON") from None
    kinds = {"job": str, "points": str, "over": bool}
    if not isinstance(given, dict) or not given.keys() <= kinds.keys() or "job" not in given:
        raise InputError("job, points and over are wanted")
    for name, value in given.items():
        if not isinstance(value, kinds[name]):
            raise InputError(f"{name}: {kinds[name].__name__} wanted")
    return JobTexts(given["job"], given.get("points", "")), given.get("over", False)


async def _wrong(request: Request, error: Exception) -> Response:
    return JSONResponse({"error": str(error)}, 422)


def _file(file: Path) -> Any:
    kind = KINDS[file.suffix]

    async def answer(request: Request) -> Response:
        return Response(file.read_bytes(), media_type=kind)

    return answer
