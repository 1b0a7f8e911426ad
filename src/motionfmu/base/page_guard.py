"""Access to a page that a command serves: only from this machine, from the page, with the token."""

import secrets

from starlette.datastructures import Headers
from starlette.responses import PlainTextResponse
from starlette.types import ASGIApp, Message, Receive, Scope, Send

# Names of this machine; a name that an attacker's page has pointed to it is none of them.
HOSTS = {"127.0.0.1", "localhost", "[::1]"}
HEADERS = {
    "content-security-policy": "default-src 'none'; script-src 'self'; style-src 'self'; "
    "connect-src 'self'; img-src 'self' data:; form-action 'none'; frame-ancestors 'none'; "
    "base-uri 'none'",
    "cross-origin-resource-policy": "same-origin",
    "x-content-type-options": "nosniff",
    "referrer-policy": "no-referrer",
    "cache-control": "no-store",
}


def refused(headers: Headers, tls: bool = False) -> str:
    """Why a request or connection is refused by its Host and Origin; empty if it is not."""
    host = headers.get("host", "")
    if host.rsplit(":", 1)[0] not in HOSTS and host not in HOSTS:
        return "this host name is not the page's"
    origin = headers.get("origin")
    # A browser sends Origin with every POST and WebSocket; other programs need not.
    if origin is not None and origin != f"http{'s' * tls}://{host}":
        return "another page may not do this"
    return ""


class Guard:
    """Refuses requests from elsewhere, and sets the headers that restrict a browser."""

    def __init__(self, app: ASGIApp, token: str) -> None:
        self._app, self._token = app, token

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on a request that is allowed."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        why = refused(headers, scope.get("scheme") in ("https", "wss"))
        if scope["type"] == "websocket":
            if why:
                await send({"type": "websocket.close", "code": 1008, "reason": why})
            else:
                await self._app(scope, receive, send)
            return
        given = headers.get("authorization", "")
        if not why and scope.get("method") != "GET" and not same(given, f"Bearer {self._token}"):
            why = "the page's token is missing or wrong: open the address that the server printed"

        async def with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                own = [(k.encode(), v.encode()) for k, v in HEADERS.items()]
                message["headers"] = [*message.get("headers", []), *own]
            await send(message)

        app = PlainTextResponse(why, 403) if why else self._app
        await app(scope, receive, with_headers)


def same(given: str, wanted: str) -> bool:
    """Whether two texts are equal, in a time that does not depend on where they differ."""
    return secrets.compare_digest(given.encode(), wanted.encode())
