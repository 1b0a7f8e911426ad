"""The configuration on the page: form, checks, file, headers."""

import io
import zipfile
from collections.abc import Awaitable, Callable
from pathlib import Path
from typing import Any

from starlette.requests import Request
from starlette.responses import JSONResponse, Response
from starlette.routing import Route

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.cards.card_settings import asked, lines
from motionfmu.cards.config import CardConfig, faults, read
from motionfmu.cards.config_text import text_of, with_values
from motionfmu.cards.headers import texts
from motionfmu.cards.server_page.form import form
from motionfmu.cards.views import ConfigurationResult

NAME = "card.toml"
LONG_AGO = (1980, 1, 1, 0, 0, 0)  # the date of all headers: equal ones are equal bytes
Values = Callable[[Request], Awaitable[dict[str, Any]]]
Configure = Callable[[int, CardConfig], Awaitable[ConfigurationResult]]


class Configuration:
    """The configuration in use, and the file it is kept in."""

    def __init__(
        self, used: CardConfig | None, file: Path | None, values: Values, configure: Configure
    ) -> None:
        self.used, self._file, self._values, self._configure = used, file, values, configure

    def routes(self) -> list[Route]:
        """The addresses that the page requests."""
        named = {
            "form": self._form,
            "read": self._read,
            "check": self._check,
            "text": self._text,
            "save": self._save,
            "headers": self._headers,
        }
        named["send/{card:card}"] = self._send
        return [Route(f"/config/{n}", answer, methods=["POST"]) for n, answer in named.items()]

    async def _form(self, request: Request) -> Response:
        values = self.used.model_dump() if self.used else None
        file = str(self._file) if self._file else ""
        return JSONResponse({"form": form(), "values": values, "file": file})

    async def _read(self, request: Request) -> Response:
        """Values of a file's text."""
        asked = await self._values(request)
        config = read(str(asked.get("text")), str(asked.get("name") or NAME))
        return JSONResponse({"values": config.model_dump()})

    async def _check(self, request: Request) -> Response:
        """What is wrong with values, by their places."""
        wrong = faults(await self._values(request))
        return JSONResponse({"faults": [{"place": p, "why": w} for p, _, w in wrong]})

    async def _good(self, request: Request) -> CardConfig:
        values = await self._values(request)
        if wrong := faults(values):
            raise InputError(*(f"{place}: {why}" for place, _, why in wrong))
        return CardConfig.model_validate(values)

    async def _text(self, request: Request) -> Response:
        return JSONResponse({"text": text_of(await self._good(request))})

    async def _save(self, request: Request) -> Response:
        """Use a configuration from now on, and keep it if there is a file.

        If comments of the file would be lost, that is told first, and only ``?lose`` saves it.
        """
        config = await self._good(request)
        text = text_of(config)
        if self._file:
            before = self._file.read_text("utf-8", "replace") if is_file(self._file) else ""
            kept = with_values(before, config)
            if kept is None and "#" in before and "lose" not in request.query_params:
                return JSONResponse({"file": str(self._file), "loses": True})
            text = kept or text
            part = self._file.with_name(f".{self._file.name}.part")
            try:
                part.write_text(text, encoding="utf-8")
                part.replace(self._file)
            except OSError as error:
                raise InputError(f"cannot write {self._file}: {error.strerror}") from None
        self.used = config
        return JSONResponse({"file": str(self._file) if self._file else ""})

    async def _send(self, request: Request) -> Response:
        """Send what differs to a card."""
        config = await self._good(request)
        end = await self._configure(request.path_params["card"], config)
        said = {"ok": end.result.ok, "text": end.result.text}
        return JSONResponse(said | {"lines": [*lines(asked(config), end)]})

    async def _headers(self, request: Request) -> Response:
        """The C headers, in an archive."""
        config = await self._good(request)
        packed = io.BytesIO()
        with zipfile.ZipFile(packed, "w") as archive:
            for name, text in texts(config, self._file.name if self._file else NAME).items():
                archive.writestr(zipfile.ZipInfo(name, LONG_AGO), text)
        return Response(packed.getvalue(), media_type="application/zip")
