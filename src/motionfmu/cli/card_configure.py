"""The commands that show and change the settings of a card."""

import json
from pathlib import Path
from typing import Annotated, Any

import typer

from motionfmu.cli.card import card
from motionfmu.cli.card_server import HERE, Folder, Id
from motionfmu.cli.common import FAILED, bare_table, out

AXES = "XYZU"


@card.command()
def configure(
    id: Id,
    config: Annotated[Path, typer.Option("-c", "--config", help="Configuration, card.toml.")],
    folder: Folder = HERE,
) -> None:
    """Send what differs of a configuration to a card that rests; its id and addresses stay."""
    from motionfmu.cards.config import load
    from motionfmu.cards.control import ask

    asked = {"do": "configure", "card": id, "config": load(config).model_dump()}
    answer = ask(folder, asked)
    for line in answer["lines"]:
        out.print(line, markup=False, soft_wrap=True)
    same = "" if answer["lines"] or answer["code"] else ": it has these settings"
    out.print(f"card {id}: {answer['text']}{same}", markup=False, soft_wrap=True)
    if answer["code"]:
        raise typer.Exit(FAILED)


@card.command()
def settings(
    id: Id,
    folder: Folder = HERE,
    as_json: Annotated[bool, typer.Option("--json", help="Print JSON, all of them.")] = False,
) -> None:
    """Show what is set in a card; of its inputs those that do something."""
    from motionfmu.cards.control import ask

    answer = ask(folder, {"do": "settings", "card": id})
    found: dict[str, list[int]] = {}
    for name, _, value in answer["settings"]:
        found.setdefault(name, []).append(value)
    if answer["code"]:
        out.print(f"card {id}: {answer['text']}", soft_wrap=True)
        raise typer.Exit(FAILED)
    if as_json:
        print(json.dumps({n: v if len(v) > 1 else v[0] for n, v in found.items()}, indent=1))
    else:
        _tell(found)


def _tell(found: dict[str, list[int]]) -> None:
    from motionfmu.base.units import spelled
    from motionfmu.cards.card_settings import fields, shown, words
    from motionfmu.cards.config_tables import CardAxis, Input

    used = [i for i, action in enumerate(found["in_action"]) if action]
    tables: dict[Any, Any] = {
        None: bare_table("card", "", ""),
        CardAxis: bare_table("axis", *AXES, ""),
        Input: bare_table("input", *map(str, used), ""),
    }
    for name, (of, _, what) in fields().items():
        if name not in found or name == "card_id":
            continue
        one = of not in (CardAxis, Input)
        columns = range(1) if one else used if of is Input else range(len(AXES))
        values = [
            shown(name, found[name][i], found["pulses_per_m"][0 if one else i % len(AXES)])
            for i in columns
        ]
        tables[None if one else of].add_row(
            words(name, 0) if one else what.words, *values, spelled(what.unit)
        )
    for of, table in tables.items():
        if of is not Input or used:
            out.print(table)
