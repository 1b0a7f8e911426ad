"""The command that makes the card's C headers."""

from pathlib import Path
from typing import Annotated

import typer

from motionfmu.cli.card import card
from motionfmu.cli.common import out


@card.command()
def headers(
    config: Annotated[Path, typer.Argument(help="Configuration of the card, card.toml.")],
    folder: Annotated[Path, typer.Option("--out", "-o", help="Folder of the headers.")] = Path(
        "include"
    ),
    crlf: Annotated[bool, typer.Option("--crlf", help="Lines end in CR LF.")] = False,
) -> None:
    """Make the headers of a firmware project; those that are as they should be stay untouched."""
    from motionfmu.cards import load
    from motionfmu.cards.headers import write

    for file in write(load(config), folder, config.name, crlf):
        out.print(str(file), markup=False, soft_wrap=True)
