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


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """A table; columns without a single entry are left out but the first and the last."""
    kept = [list(row) for row in rows]
    last = len(head) - 1
    used = [k for k in range(len(head)) if k in (0, last) or any(row[k] for row in kept)]
    lines = [[head[k] for k in used], ["---"] * len(used)]
    lines += [[row[k] for k in used] for row in kept]
    return "".join(f"| {' | '.join(line)} |\n" for line in lines)


def anchor(name: str) -> str:
    """A target that links reach as ``#name``, in the line before a heading or a block."""
    return f"({name})=\n"


def toctree(names: Iterable[str], caption: str = "", hidden: bool = True) -> str:
    """A list of pages for the menu."""
    options = (":hidden:\n" if hidden else "") + (f":caption: {caption}\n" if caption else "")
    return (
        "```{toctree}\n" + options + ":maxdepth: 1\n\n" + "".join(f"{n}\n" for n in names) + "```\n"
    )
