"""TLS: cards and page are reached with the right certificate and in no other way."""

import asyncio
import contextlib
import json
import os
import ssl
import subprocess
import sys
from pathlib import Path

import httpx2
import pytest
from card_links import HOST, until
from fleet import Fleet
from soft_card import CardEnd, SoftCard
from websockets.asyncio.client import connect

from motionfmu.base.errors import InputError
from motionfmu.cards import tls
from motionfmu.cards.server import Cards
from motionfmu.cards.server_page import PageServer, application
from motionfmu.cards.sim import VirtualNetCard, Watch, simulate
from motionfmu.cards.wire import MAGIC, OPEN_KEY

FILES = Path(__file__).parent / "tls"
CERT, KEY, OTHER = FILES / "cert.pem", FILES / "key.pem", FILES / "other.pem"


def test_cards_come_in_by_tls_and_trust_one_certificate(tmp_path: Path) -> None:
    async def main() -> None:
        cards = Cards(tmp_path)
        place = (HOST, await cards.listen(HOST, 0, tls.serving(CERT, KEY)))
        soft = VirtualNetCard(1)
        run = asyncio.create_task(simulate([soft], place, tls=tls.trusting(CERT)))
        await until(lambda: soft.online)
        assert (await cards.command(1, "start")).state == "EMPTY"
        with pytest.raises(ssl.SSLCertVerificationError):
            await asyncio.open_connection(*place, ssl=tls.trusting(OTHER))
        # A card may call the server by any name or address.
        elsewhere = {"ssl": tls.trusting(CERT), "server_hostname": "elsewhere"}
        _, writer = await asyncio.open_connection(*place, **elsewhere)
        writer.close()
        reader, writer = await asyncio.open_connection(*place)
        writer.write(CardEnd(OPEN_KEY, SoftCard(2).hello()).take())
        with contextlib.suppress(ConnectionError):
            assert (
                MAGIC.to_bytes(2, "little") not in await reader.read()
            )  # no frame of the protocol, it is closed
        writer.close()
        assert [view.id for view in cards.list()] == [1]
        run.cancel()
        await asyncio.gather(run, return_exceptions=True)
        await cards.close()

    asyncio.run(main())


@pytest.mark.parametrize(
    ("served", "trusted", "told"),
    [
        (None, CERT, "it does not speak TLS ("),
        ((CERT, KEY), OTHER, "by TLS its certificate is not trusted ("),
        ((), None, "Connect call failed ("),
    ],
)
def test_why_a_card_does_not_come_in(tmp_path: Path, served, trusted, told: str) -> None:
    async def main() -> list[str]:
        cards = Cards(tmp_path)
        port = await cards.listen(HOST, 0, tls.serving(*served) if served else None)
        if served == ():
            await cards.close()
        context = tls.trusting(trusted) if trusted else None
        reasons: list[str] = []
        card = VirtualNetCard(1)
        run = asyncio.create_task(
            simulate([card], (HOST, port), tls=context, watch=Watch(failed=reasons.append))
        )
        await until(lambda: bool(reasons))
        assert not card.online
        run.cancel()
        await asyncio.gather(run, return_exceptions=True)
        if served != ():
            await cards.close()
        return reasons

    (why, *_) = asyncio.run(main())
    assert why.startswith(told)


def test_the_page_is_there_by_tls_alone() -> None:
    fleet = Fleet()
    fleet.add(1, "READY")
    app = application(fleet, "t", None)
    trusts = ssl.create_default_context(cafile=CERT)

    async def main() -> None:
        async with PageServer(app, 0, (CERT, KEY)) as port:
            own = f"https://127.0.0.1:{port}"
            headers = {"authorization": "Bearer t", "origin": own}
            async with httpx2.AsyncClient(verify=trusts, headers=headers) as c:
                order = {"name": "start"}
                assert (await c.post(f"{own}/cards/1/command", json=order)).json()["ok"]
                c.headers["origin"] = own.replace("https", "http")
                assert (await c.post(f"{own}/cards/1/command", json=order)).status_code == 403
            with pytest.raises(httpx2.ConnectError):
                async with httpx2.AsyncClient() as c:
                    await c.get(own)
            live = f"wss://127.0.0.1:{port}/live"
            async with connect(live, ssl=trusts, origin=own) as line:  # type: ignore[arg-type]
                await line.send("t")
                assert json.loads(await line.recv())["cards"][0]["id"] == 1
            reader, writer = await asyncio.open_connection(HOST, port)
            writer.write(b"GET / HTTP/1.1\r\nhost: 127.0.0.1\r\n\r\n")
            with contextlib.suppress(ConnectionError):
                assert b"HTTP/1.1 200" not in await reader.read()
            writer.close()

    asyncio.run(main())


@pytest.mark.parametrize(
    ("files", "why"),
    [
        ((CERT, OTHER), "--tls .*cert.pem .*other.pem: "),
        ((FILES / "none.pem", KEY), "none.pem .*key.pem: No such file"),
        ((FILES / "README.md", KEY), "README.md .*key.pem: "),
    ],
)
def test_wrong_files_are_told(files: tuple[Path, Path], why: str) -> None:
    with pytest.raises(InputError, match=why):
        tls.serving(*files)
    with pytest.raises(InputError, match=r"README\.md: "):
        tls.trusting(FILES / "README.md")
    with pytest.raises(InputError, match=r"none\.pem: No such file"):
        tls.trusting(FILES / "none.pem")


@pytest.mark.skipif(sys.platform == "win32", reason="there is no terminal of this kind")
def test_a_key_behind_a_password_is_refused_without_a_question() -> None:
    """On a terminal OpenSSL would ask, and a server without anybody at it would wait for ever."""
    import fcntl
    import pty
    import termios

    host, terminal = pty.openpty()
    files = f"Path({str(CERT)!r}), Path({str(FILES / 'locked.pem')!r})"
    text = f"from pathlib import Path; from motionfmu.cards import tls; tls.serving({files})"
    asked = subprocess.Popen(
        [sys.executable, "-c", text],
        stdin=terminal,
        stdout=terminal,
        stderr=terminal,
        start_new_session=True,
        preexec_fn=lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0),
    )
    os.close(terminal)
    told = b""
    with contextlib.suppress(OSError):  # its end, on Linux
        while b"pass phrase" not in told and (more := os.read(host, 4096)):
            told += more
    asked.kill()
    asked.wait()
    os.close(host)
    assert b"InputError: --tls" in told and b"pass phrase" not in told
