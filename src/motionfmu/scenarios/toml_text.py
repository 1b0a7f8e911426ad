"""TOML text of tables, as a person writes a scenario or a machine."""

import json
from collections.abc import Iterator, Mapping
from typing import Any

WIDTH = 140  # characters of a line


def key_text(key: str) -> str:
    """A key, in quotes if it needs them."""
    bare = key.isascii() and key.replace("_", "a").replace("-", "a").isalnum()
    return key if bare else json.dumps(key, ensure_ascii=False)


def value_text(value: Any) -> str:
    """A value on one line."""
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{key_text(k)} = {value_text(v)}" for k, v in value.items()) + " }"
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(value_text, value)) + "]"
    if isinstance(value, str | bool):
        return json.dumps(value, ensure_ascii=False)
    return repr(value)


def pair_lines(key: str, value: Any, width: int = 0) -> list[str]:
    """Lines of a key, padded to a width, and its value; a long list has an item in each."""
    head = f"{key_text(key).ljust(width)} = "
    whole = head + value_text(value)
    if len(whole) <= WIDTH or not isinstance(value, list):
        return [whole]
    return [f"{head}[", *(f"    {value_text(x)}," for x in value), "]"]


def table_lines(name: str, table: Any) -> Iterator[str]:
    """Lines of a table, or of an array of tables, behind an empty one each."""
    for row in table if isinstance(table, list) else [table]:
        yield from ("", f"[[{name}]]" if isinstance(table, list) else f"[{name}]")
        inner = {k: v for k, v in row.items() if isinstance(table, list) and _is_array(v)}
        own = {k: v for k, v in row.items() if k not in inner}
        width = max((len(key_text(k)) for k in own), default=0)
        for key, value in own.items():
            yield from pair_lines(key, value, width)
        for key, value in inner.items():
            yield from table_lines(f"{name}.{key}", value)


def document_lines(tables: Mapping[str, Any]) -> Iterator[str]:
    """Lines of a whole file: keys first, then tables and arrays of tables."""
    inner = {k: v for k, v in tables.items() if isinstance(v, Mapping) or _is_array(v)}
    for key, value in tables.items():
        if key not in inner:
            yield from pair_lines(key, value)
    for key, value in inner.items():
        yield from table_lines(key, value)


def _is_array(value: Any) -> bool:
    """Whether a value is an array of tables."""
    return isinstance(value, list) and bool(value) and isinstance(value[0], Mapping)
