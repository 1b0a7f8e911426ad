"""A card's configuration as the text of its file."""

import re
from collections.abc import Iterator
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import Lines
from motionfmu.cards.config import CardConfig, read
from motionfmu.cards.config_tables import Input

Place = tuple[str, str]  # table, key
_ROW = re.compile(r"""([^=]*=\s*)(?:"[^"]*"|'[^']*'|[^#"'\s]+)(\s*(?:#.*)?)""")


def text_of(config: CardConfig) -> str:
    """Text of a card.toml that gives this configuration, without pins that have no function."""
    tree = config.model_dump()
    inputs, outputs = tree.pop("inputs"), tree.pop("outputs")
    axes, pen = tree.pop("axes"), tree["motion"].pop("pen")
    lines = ["# Configuration of a network motion card."]
    lines += _table("[network]", tree.pop("network"))
    for axis in axes:
        lines += _table("[[axes]]", axis)
    lines += _table("[motion]", tree.pop("motion"))
    lines += _table("[motion.pen]", pen)
    for name, table in tree.items():
        lines += _table(f"[{name}]", table)
    for k, table in enumerate(inputs):
        if table != Input().model_dump():
            lines += _table(f"[inputs.{k}]", table)
    lines += _table("[outputs]", {str(k): name for k, name in enumerate(outputs) if name})
    return "\n".join(lines) + "\n"


def _table(head: str, values: dict[str, Any]) -> list[str]:
    wide = max(map(len, values), default=0)
    rows = [f"{key:{wide}} = {_value(value)}" for key, value in values.items()]
    return ["", head, *rows] if rows else []


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, float) and value.is_integer() and abs(value) < 1e15:
        return str(int(value))
    return f'"{value}"' if isinstance(value, str) else repr(value)


def with_values(text: str, config: CardConfig) -> str | None:
    """Text of a file in which only values that differ are replaced; None if that is not enough."""
    try:
        has = dict(_leaves(read(text, "").model_dump()))
    except InputError:
        return None
    wanted = dict(_leaves(config.model_dump()))
    if has.keys() != wanted.keys():  # another number of axes
        return None
    lines, at = text.split("\n"), Lines(text)
    new: dict[str, list[str]] = {}
    for (table, key), value in wanted.items():
        if has[table, key] == value:
            continue
        if not at.has(table, key):
            new.setdefault(table, []).append(f"{key} = {_value(value)}")
            continue
        k = at.of(table, key) - 1
        row = _ROW.fullmatch(lines[k])
        if not row:
            return None
        lines[k] = f"{row[1]}{_value(value)}{row[2]}"
    for table in sorted(new, key=at.of, reverse=True):  # from the last line on: others stay
        if at.has(table):
            lines[at.of(table) : at.of(table)] = new[table]
    for table in (t for t in new if not at.has(t)):
        lines += [f"[{table}]", *new[table], ""]
    try:
        found = "\n".join(lines)
        return found if read(found, "") == config else None
    except InputError:
        return None


def _leaves(tree: Any, table: str = "") -> Iterator[tuple[Place, Any]]:
    """Values by their places."""
    rows = enumerate(tree) if isinstance(tree, list) else tree.items()
    for key, value in rows:
        if isinstance(value, dict | list):
            yield from _leaves(value, f"{table}.{key}".lstrip("."))
        else:
            yield (table, str(key)), value
