"""Line numbers of keys in a TOML file, for messages."""

import re


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
                counts[header[1]] = counts.get(header[1], -1) + 1
                table = f"{header[1]}.{counts[header[1]]}"
                self._at[table, ""] = number
            elif header := re.match(r"\s*\[([^\[].*?)\]\s*(#.*)?$", line):
                table = header[1]
                self._at[table, ""] = number
            elif key := re.match(r"""\s*("[^"]*"|'[^']*'|[A-Za-z0-9_.-]+)\s*=""", line):
                self._at.setdefault((table, key[1].strip("\"'")), number)

    def of(self, table: str, key: str = "") -> int:
        """Line of a key, of its table if the key is not found, else 1.

        Parameters
        ----------
        table : str
            Table name, empty for the top; ``drive.0`` for the first ``[[drive]]``.
        key : str
            Key without quotes, empty for the table itself.

        Returns
        -------
        int
        """
        return self._at.get((table, key)) or self._at.get((table, "")) or 1
