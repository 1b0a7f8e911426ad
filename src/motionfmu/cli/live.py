"""The console command for a machine that runs while somebody works at it."""

import contextlib
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import Set, app, mode, out, settings


@app.command()
def live(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[
        Path, typer.Argument(help="A scenario, or a machine: its folder, or a name of either.")
    ],
    program: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Program that the machine has.")
    ] = None,
    port: Annotated[int, typer.Option(help="Port of the page on 127.0.0.1; 0: any.")] = 8770,
    pace: Annotated[
        float, typer.Option(help="Simulated seconds for each on the wall: 0.01 to 100, or inf.")
    ] = 1.0,
    opcua: Annotated[
        int | None,
        typer.Option(metavar="PORT", help="OPC UA for Machine Tools on this port; 0: any."),
    ] = None,
    opcua_nodesets: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Its published nodesets, instead of own types."),
    ] = None,
    paused: Annotated[bool, typer.Option("--paused", help="Stand at first.")] = False,
    open_: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
    set_: Set = [],  # noqa: B006
) -> None:
    """Run a machine in real time with a page to work at it; until Ctrl-C."""
    import asyncio

    needed("live")
    if opcua is not None:
        needed("opcua")
    elif opcua_nodesets is not None:
        raise InputError("--opcua-nodesets goes with --opcua")
    begin = _Begin(str(path), settings(set_), None if pace == float("inf") else pace, paused)
    ports = _Ports(port, opcua, opcua_nodesets)
    asyncio.run(_serve(begin, ports, open_))


@dataclass(frozen=True)
class _Begin:
    """What is begun, and how."""

    path: str
    set: dict[str, Any]
    pace: float | None
    paused: bool


@dataclass(frozen=True)
class _Ports:
    """Where the machine can be reached, on this computer."""

    page: int
    opcua: int | None
    nodesets: Path | None


async def _serve(begin: _Begin, ports: _Ports, opened: bool) -> None:
    import asyncio
    import secrets
    import webbrowser

    from motionfmu.base.page_server import PageServer
    from motionfmu.cli.card import on_end, stopped
    from motionfmu.live.server import MachineLink, application

    ended = asyncio.Event()
    came = on_end(ended.set)
    token = secrets.token_urlsafe(16)
    async with (
        MachineLink(begin.path, begin.set, begin.pace, running=False) as link,
        contextlib.AsyncExitStack() as servers,
    ):
        if ports.opcua is not None:
            from motionfmu.live.opcua import OpcUaServer

            server = OpcUaServer(link, ports.opcua, ports.nodesets)
            there = await servers.enter_async_context(server)
            out.print(f"OPC UA: opc.tcp://127.0.0.1:{there}/motionfmu", soft_wrap=True)
        async with PageServer(application(link, token), ports.page) as there:
            address = f"http://127.0.0.1:{there}/?token={token}"
            out.print(f"page: {address}", soft_wrap=True)
            if not begin.paused:  # who looks at it is there now
                await link.ask("go")
            if opened or mode.open:
                webbrowser.open(address)
            waits = [asyncio.create_task(e.wait()) for e in (ended, link.ended)]
            await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    stopped(came)
