"""The command that runs cards as programs."""

from pathlib import Path
from typing import Annotated, cast

import typer

from motionfmu.base.errors import InputError
from motionfmu.cli.card import card, on_end, stopped
from motionfmu.cli.common import out

CARDS_MAX = 1000
SPEED = (0.001, 1000.0)


@card.command()
def sim(  # noqa: PLR0913  (each is an option of the command)
    server: Annotated[
        str, typer.Option(metavar="HOST:PORT", help="Where card serve listens.")
    ] = "127.0.0.1:8765",
    cards: Annotated[int, typer.Option(help="How many; ids count up from --id.")] = 1,
    id: Annotated[int, typer.Option(help="Id of the first.")] = 1,
    speed: Annotated[float, typer.Option(help="So much faster than the clock.")] = 1.0,
    keys: Annotated[Path | None, typer.Option("--key-file", help="As made by card key.")] = None,
    flash: Annotated[Path | None, typer.Option(help="Folder that keeps their flash.")] = None,
    config: Annotated[Path | None, typer.Option("-c", help="card.toml of all of them.")] = None,
    tls: Annotated[
        Path | None, typer.Option(metavar="CERT", help="By TLS; the certificate they trust.")
    ] = None,
) -> None:
    """Run cards: the card's own code as a client of a server; until Ctrl-C."""
    import asyncio
    import contextlib

    from motionfmu.cards.config import load
    from motionfmu.cards.keys import CARD_MAX, alone, read_keys
    from motionfmu.cards.sim import FlashFile, VirtualNetCard, Watch, simulate
    from motionfmu.cards.tls import trusting
    from motionfmu.cards.wire import OPEN_KEY

    trusted = trusting(tls) if tls else None
    host, _, port = server.rpartition(":")
    if not host or not port.isdecimal() or not 0 < int(port) < 65536:
        raise InputError(f"--server {server}: HOST:PORT wanted")
    if not 1 <= cards <= CARDS_MAX:
        raise InputError(f"--cards {cards}: 1 to {CARDS_MAX} wanted")
    if not 0 <= id <= min(2**31, CARD_MAX) - cards:
        raise InputError(f"--id {id}: 0 to {2**31 - cards} wanted")
    if not SPEED[0] <= speed <= SPEED[1]:
        raise InputError(f"--speed {speed}: {SPEED[0]} to {SPEED[1]:g} wanted")
    known = read_keys(keys) if keys else {}
    folders = contextlib.ExitStack()  # to the end: two that write one flash leave neither's
    if flash:
        folders.enter_context(alone(flash, wait=False))
    parameters = load(config).as_parameters() if config else {}
    made: list[tuple[VirtualNetCard, FlashFile | None]] = []
    for i in range(id, id + cards):
        file = FlashFile(flash / f"{i}.flash") if flash else None
        held = file.load() if file else b""
        made.append((VirtualNetCard(i, known.get(i, OPEN_KEY), held, **parameters), file))

    told = -1

    def tell() -> None:
        nonlocal told
        if (now := sum(one.online for one, _ in made)) != told:
            told = now
            what = "" if now else "; they go on to try"
            out.print(f"{now} of {cards} connected{what}", soft_wrap=True)

    reasons: set[str] = set()

    def failed(why: str) -> None:
        if why not in reasons:
            reasons.add(why)
            out.print(f"server {server}: {why}", soft_wrap=True, markup=False)

    def each() -> None:
        tell()
        keep()

    def keep() -> None:
        for one, file in made:
            if file:
                file.save(one)

    out.print(f"{cards} cards from id {id}, server {server}", soft_wrap=True)

    came: list[list[int]] = []

    async def until_ended() -> None:
        came.append(on_end(cast("asyncio.Task[None]", asyncio.current_task()).cancel))
        all_of_them = [one for one, _ in made]
        await simulate(all_of_them, (host, int(port)), speed, Watch(each, failed), trusted)

    with folders:
        try:
            with contextlib.suppress(asyncio.CancelledError):
                asyncio.run(until_ended())
        finally:
            keep()
    stopped(*came)
