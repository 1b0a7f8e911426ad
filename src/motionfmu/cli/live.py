"""The console command for a machine that runs while somebody works at it."""

from pathlib import Path
from typing import Annotated, Any

import typer

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
    paused: Annotated[bool, typer.Option("--paused", help="Stand at first.")] = False,
    open_: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
    set_: Set = [],  # noqa: B006
) -> None:
    """Run a machine in real time with a page to work at it; until Ctrl-C."""
    import asyncio

    needed("live")
    given = {"pace": None if pace == float("inf") else pace, "running": not paused}
    asyncio.run(_serve(str(path), settings(set_), port, given, open_))


async def _serve(
    path: str, set_: dict[str, Any], port: int, given: dict[str, Any], opened: bool
) -> None:
    import asyncio
    import secrets
    import webbrowser

    from motionfmu.base.page_server import PageServer
    from motionfmu.cli.card import on_end, stopped
    from motionfmu.live.server import MachineLink, application

    ended = asyncio.Event()
    came = on_end(ended.set)
    token = secrets.token_urlsafe(16)
    async with MachineLink(path, set_, **given) as link:
        async with PageServer(application(link, token), port) as there:
            address = f"http://127.0.0.1:{there}/?token={token}"
            out.print(f"page: {address}", soft_wrap=True)
            if opened or mode.open:
                webbrowser.open(address)
            waits = [asyncio.create_task(e.wait()) for e in (ended, link.ended)]
            await asyncio.wait(waits, return_when=asyncio.FIRST_COMPLETED)
    stopped(came)
