"""Markdown as MyST reads it: escaped text, code, tables."""

import re
from collections.abc import Iterable, Sequence

_MARKS = re.compile(r"([\\`*_{}\[\]<>$|#~^@])")


def plain(text: str) -> str:
    """A text in one line of which nothing is markup."""
    return _MARKS.sub(r"\\\1", " ".join(text.split()))


def code(text: str) -> str:
    """A text in one line as code; empty if it is empty."""
    text = " ".join(text.split())
    ticks = "``" if "`" in text else "`"
    pad = " " if "`" in text else ""
    return f"{ticks}{pad}{text}{pad}{ticks}".replace("|", "\\|") if text else ""


def told(text: str) -> str:
    """A text in one line in which names between single marks are code."""
    parts = " ".join(text.split()).split("`")
    if len(parts) % 2 == 0:
        return plain(text)
    return "".join(code(part) if k % 2 else plain(part) for k, part in enumerate(parts))


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; columns without a single entry are left out but the first and the last."""
    kept = [list(row) for row in rows]
    last = len(head) - 1
    used = [k for k in range(len(head)) if k in (0, last) or any(row[k] for row in kept)]
    lines = [[head[k] for k in used], ["---"] * len(used)]
    lines += [[row[k] for k in used] for row in kept]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def toctree(names: Iterable[str]) -> str:
    """A list of pages for the menu, each ``page`` or ``words <page>``."""
    lines = ["```{toctree}", ":hidden:", ":maxdepth: 1", "", *names, "```"]
    return "\n".join(lines) + "\n"
