"""TOML as people write it: line numbers of keys for messages, words of a command line."""

import re
import tomllib
from typing import Any


class Lines:
    """Finds the line on which a key of a TOML text stands.

    Parameters
    ----------
    text : str
        The whole file.
    """

    def __init__(self, text: str) -> None:
        self._at: dict[tuple[str, str], int] = {}
        table = ""
        counts: dict[str, int] = {}
        for number, line in enumerate(text.splitlines(), 1):
            if header := re.match(r"\s*\[\[(.+?)\]\]", line):
                name = _numbered(header[1], counts)
                counts[name] = counts.get(name, -1) + 1
                table = f"{name}.{counts[name]}"
                self._at[table, ""] = number
            elif header := re.match(r"\s*\[([^\[].*?)\]\s*(#.*)?$", line):
                table = _numbered(header[1], counts)
                self._at[table, ""] = number
            elif key := re.match(r"""\s*("[^"]*"|'[^']*'|[A-Za-z0-9_.-]+)\s*=""", line):
                self._at.setdefault((table, key[1].strip("\"'")), number)

    def of(self, table: str, key: str = "") -> int:
        """Line of a key, else of the nearest table around it, else 1.

        Parameters
        ----------
        table : str
            Table name, empty for the top; ``drive.0`` for the first ``[[drive]]``,
            ``figure.0.plot.1`` for the second ``[[figure.plot]]`` of the first ``[[figure]]``.
        key : str
            Key without quotes, or table at the top; empty for the table itself.

        Returns
        -------
        int
        """
        while table:
            if found := self._at.get((table, key)) or self._at.get((table, "")):
                return found
            table, _, key = table.rpartition(".")
        places = (("", key), (key, ""), (f"{key}.0", ""))
        return next((self._at[p] for p in places if p in self._at), 1)


def _numbered(header: str, counts: dict[str, int]) -> str:
    """Put the number of the latest array table after the name of each one around a table."""
    name = ""
    around, dot, own = header.rpartition(".")
    for part in around.split(".") if dot else ():
        name += part.strip()
        name += f".{counts[name]}." if name in counts else "."
    return name + own.strip()


def word(text: str) -> Any:
    """Read a value from a command line.

    Parameters
    ----------
    text : str

    Returns
    -------
    object
        What TOML says it is; a bare word is text.
    """
    try:
        return tomllib.loads(f"x = {text}")["x"]
    except tomllib.TOMLDecodeError:
        return text
