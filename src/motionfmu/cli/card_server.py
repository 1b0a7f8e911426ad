"""The commands of the server of cards, and of those who talk to it."""

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import install
from motionfmu.cli.card import card, on_end, stopped
from motionfmu.cli.common import FAILED, App, Group, bare_table, out

if TYPE_CHECKING:
    from motionfmu.cards.server import Cards
    from motionfmu.cards.server_page import PageServer

AXES = "XYZU"
Folder = Annotated[Path, typer.Option("--folder", help="The server's folder.")]
Id = Annotated[int, typer.Argument(metavar="ID", help="The card's id.")]
HERE = Path("cards")

key = App(cls=Group, rich_markup_mode=None, help="Keys of cards.", no_args_is_help=True)
card.add_typer(key, name="key")


@card.command()
def serve(  # noqa: PLR0913  (each is an option of the command)
    bind: Annotated[str, typer.Option(help="Address for cards; from outside: keys.")] = "127.0.0.1",
    port: Annotated[int, typer.Option(help="Port for cards.")] = 8765,
    page: Annotated[int, typer.Option(help="Port of the page on 127.0.0.1; 0 none.")] = 8766,
    folder: Folder = HERE,
    keys: Annotated[Path | None, typer.Option(help="Keys; else keys.toml in the folder.")] = None,
    config: Annotated[Path | None, typer.Option("-c", help="card.toml of the page's form.")] = None,
    tls: Annotated[
        tuple[Path, Path] | None,
        typer.Option(metavar="CERT KEY", help="Cards and page by TLS: two PEM files."),
    ] = None,
) -> None:
    """Serve cards: jobs, commands, their states on a page; until Ctrl-C."""
    import asyncio
    import logging

    from motionfmu.cards.server import Cards, check_port
    from motionfmu.cards.tls import serving

    if tls:
        serving(*tls)
    check_port(port)
    check_port(page)
    if config and not page:
        raise InputError(f"-c {config}: is the page's, and --page 0 wants none")
    logging.basicConfig(level=logging.INFO, format="%(asctime)s %(message)s")
    asyncio.run(_serve(Cards(folder, keys=keys), folder, (bind, port, page), config, tls))


async def _serve(
    cards: "Cards",
    folder: Path,
    places: tuple[str, int, int],
    config: Path | None,
    files: tuple[Path, Path] | None,
) -> None:
    import asyncio
    import contextlib

    from motionfmu.cards import tls
    from motionfmu.cards.control import Control

    bind, port, page = places
    serving, address = _page(cards, page, config, files) if page else (contextlib.nullcontext(), "")
    control = Control(cards, folder)
    await control.listen()
    ended = asyncio.Event()
    came = on_end(ended.set)
    try:
        port = await cards.listen(bind, port, tls.serving(*files) if files else None)
        by = " by TLS" if files else ""
        out.print(f"cards: {bind}:{port}{by}, folder {folder}", soft_wrap=True)
        async with serving:
            if page:
                out.print(f"page: {address}", soft_wrap=True)
            await ended.wait()
    finally:
        await cards.close()
        await control.close()
    stopped(came)


def _page(
    cards: "Cards", port: int, config: Path | None, tls: tuple[Path, Path] | None
) -> "tuple[PageServer, str]":
    """The page, and the address that lets a browser in."""
    import secrets

    try:
        from motionfmu.cards.server_page import PageServer, application
    except ImportError as error:
        text = f"{error.name} is missing; {install('card')}, or --page 0"
        raise InputError(f"--page: {text}") from None
    token = secrets.token_urlsafe(16)
    serving = PageServer(application(cards, token, config), port, tls)
    return serving, f"http{'s' * bool(tls)}://127.0.0.1:{port}/?token={token}"


def _ask(folder: Path, request: dict[str, Any], file: bytes = b"") -> None:
    """Ask the server, print how it ended; status 1 if it was refused or failed."""
    from motionfmu.cards.control import ask
    from motionfmu.cards.views import advice_on

    answer = ask(folder, request, file)
    state = f" ({answer['state']})" if answer["state"] else ""
    out.print(f"card {request['card']}: {answer['text']}{state}", soft_wrap=True)
    if answer["code"]:
        if told := advice_on(answer["code"]):
            out.print(told, soft_wrap=True)
        raise typer.Exit(FAILED)


def _order(folder: Path, card: int, name: str, **values: int) -> None:
    _ask(folder, {"do": "command", "card": card, "name": name, "values": values})


@card.command()
def send(
    id: Id, file: Annotated[Path, typer.Argument(help="job.mcj")], folder: Folder = HERE
) -> None:
    """Bring a job file into a card; ends when it is there, or refused."""
    from motionfmu.cards.server import check_job

    try:
        job = file.read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None
    try:
        check_job(job)
    except InputError as error:
        raise InputError(f"{file}: {error}; card plan makes one of a drawing") from None
    _ask(folder, {"do": "upload", "card": id, "bytes": len(job)}, job)


@card.command()
def start(id: Id, folder: Folder = HERE) -> None:
    """Start the job of a card, or go on behind a pause."""
    _order(folder, id, "start")


@card.command()
def pause(id: Id, folder: Folder = HERE) -> None:
    """Bring a card to rest on its path."""
    _order(folder, id, "pause")


@card.command()
def stop(id: Id, folder: Folder = HERE) -> None:
    """Bring a card to rest and end its run."""
    _order(folder, id, "stop")


@card.command()
def reset(id: Id, folder: Folder = HERE) -> None:
    """Take a card out of the state FAULT."""
    _order(folder, id, "reset")


@card.command()
def home(
    id: Id,
    axes: Annotated[str, typer.Option(help="Those to be homed.")] = AXES,
    folder: Folder = HERE,
) -> None:
    """Home axes of a card."""
    if not axes or set(axes.upper()) - set(AXES):
        raise InputError(f"--axes {axes}: letters of {AXES} wanted")
    _order(folder, id, "home", axes=sum(1 << AXES.index(a) for a in set(axes.upper())))


@card.command()
def status(
    id: Annotated[int | None, typer.Argument(metavar="[ID]", help="One card only.")] = None,
    folder: Folder = HERE,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON.")] = False,
) -> None:
    """Show the cards of a server; status 1 if the card asked for is not connected."""
    from motionfmu.cards.control import ask

    cards = [c for c in ask(folder, {"do": "list"})["cards"] if id in (None, c["id"])]
    if as_json:
        print(json.dumps(cards, indent=1))
    elif not cards:
        out.print("no card has called" if id is None else f"card {id} has never called")
    else:
        table = bare_table("card", "address", "state", "job", "frame", "position", "upload")
        for c in cards:
            sent = c["upload"]
            table.add_row(
                str(c["id"]),
                c["address"] or "not connected",
                c["state"],
                c["job"][:8],
                str(c["frame"]),
                " ".join(map(str, c["position"])),
                f"{sent['taken']} of {sent['pages']} pages {sent['waits']}" if sent else "",
            )
        out.print(table)
    if id is not None and not any(c["connected"] for c in cards):
        raise typer.Exit(FAILED)


@key.command("new")
def key_new(
    id: Id,
    folder: Folder = HERE,
    keys: Annotated[Path | None, typer.Option(help="Keys; else keys.toml in the folder.")] = None,
) -> None:
    """Make a key for a card, in a file that only you read."""
    from motionfmu.cards.keys import new_key

    file = keys or folder / "keys.toml"
    new_key(file, id)
    out.print(f"card {id}: new key in {file}", soft_wrap=True)
