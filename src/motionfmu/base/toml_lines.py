"""TOML files within limits of size, line numbers of their keys, values on a command line."""

import re
import stat
import tomllib
from collections.abc import Iterable
from pathlib import Path
from typing import TYPE_CHECKING, Any, TypeVar

from motionfmu.base.errors import InputError

if TYPE_CHECKING:
    from pydantic import BaseModel

Model = TypeVar("Model", bound="BaseModel")
# Limits of a file. Files that people write are far below; beyond, reading could take hours or all
# memory.
SIZE_MAX = 1 << 20  # bytes
DEPTH_MAX = 16  # brackets inside each other, parts of a key
KEY_MAX = 200  # characters
INTEGER_MAX = 2**63  # range that TOML asks of a reader
SHOWN_MAX = 200  # characters of a value in a message
_PLACE = re.compile(r"^(.+?):(\d+): ")  # file and line with which a message begins
_UNQUOTED = str.maketrans("", "", "\"'")
# Whole strings and comments, even unfinished ones, then characters of brackets, keys and lines.
_TOKEN = re.compile(
    r'"""(?:\\.|[^\\])*?(?:"""|\\?\Z)'
    r"|'''.*?(?:'''|\Z)"
    r'|"(?:\\.|[^"\\\n])*"?'
    r"|'[^'\n]*'?"
    r"|#[^\n]*|[\[\]{}.=,\n]",
    re.DOTALL,
)


class Lines:
    """Finds the line on which a key of a TOML text stands."""

    def __init__(self, text: str) -> None:
        self._at: dict[tuple[str, str], int] = {}
        table = ""
        counts: dict[str, int] = {}
        rows: dict[str, int] = {}
        for number, line in enumerate(text.split("\n"), 1):
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
                if table and "." not in table and line[:1].strip():  # a row, if it is a keyed array
                    rows[table] = rows.get(table, -1) + 1
                    self._at.setdefault((f"{table}.{rows[table]}", ""), number)

    def has(self, table: str, key: str = "") -> bool:
        """Whether this key or table itself, not one around it, has a line."""
        return (table, key) in self._at

    def of(self, table: str, key: str = "") -> int:
        """Line of a key, else of the nearest table around it, else 1.

        A table is empty for the top, ``drive.0`` for the first ``[[drive]]``, ``figure.0.plot.1``
        for the second ``[[figure.plot]]`` of the first ``[[figure]]``; a key without quotes, or a
        table at the top, or empty for the table itself.
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
    return (name + own.strip()).translate(_UNQUOTED)


def is_file(path: Path) -> bool:
    """Whether there is a regular file of this name; false also for a name that no file can have."""
    try:
        return path.is_file()
    except (OSError, ValueError):  # too long, or a NUL
        return False


def text_of(file: str | Path) -> str:
    """Read a text file; one that is missing, irregular, too large or not UTF-8 is refused."""
    try:
        # To read a pipe would wait for it, and a device may have no end.
        if not stat.S_ISREG(Path(file).stat().st_mode):
            raise InputError(f"{file}: not a regular file")
        with open(file, "rb") as stream:
            data = stream.read(SIZE_MAX + 1)
    except OSError as error:
        raise InputError(f"{file}: {error.strerror}") from None
    except ValueError as error:  # a NUL in the name
        raise error if isinstance(error, InputError) else InputError(f"{file}: {error}") from None
    if len(data) > SIZE_MAX:
        raise InputError(f"{file}: more than {SIZE_MAX} bytes")
    try:
        return data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: not UTF-8 text ({error})") from None


def tables_of(text: str, file: str | Path) -> dict[str, Any]:
    """Parse a TOML text within the limits of this module; else ``file:line: what``."""
    if len(text) > SIZE_MAX:
        raise InputError(f"{file}: more than {SIZE_MAX} characters")
    if told := _too_deep(text):
        raise InputError(f"{file}:{told}")
    try:
        tables = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        where = re.search(r"line (\d+)", str(error))
        line = where[1] if where else text.count("\n") + 1
        raise InputError(f"{file}:{line}: {error}") from None
    except ValueError:  # Python reads no whole number of more than 4300 digits
        raise InputError(f"{file}: a whole number has too many digits") from None
    if told := _beyond(tables, text):
        raise InputError(f"{file}:{told}")
    return tables


def _too_deep(text: str) -> str:
    """A fault, line and words, if brackets or a key are too deep for the recursive parser."""
    line, depth, dots = 1, 0, 0
    for token in _TOKEN.finditer(text):
        word = token[0]
        if word == ".":
            dots += 1
        elif word[0] not in "\"'#":
            dots = 0
            depth = max(0, depth + (word in "[{") - (word in "]}"))
        if depth > DEPTH_MAX:
            return f"{line}: brackets more than {DEPTH_MAX} deep"
        if dots >= DEPTH_MAX:
            return f"{line}: a key of more than {DEPTH_MAX} parts"
        line += word.count("\n")
    return ""


def _beyond(tables: dict[str, Any], text: str) -> str:
    """A fault, line and words, if a key or a value is beyond a limit."""
    waiting: list[tuple[tuple[str, ...], Any]] = [((), tables)]
    while waiting:
        path, value = waiting.pop()
        told = ""
        if isinstance(value, dict):
            waiting += [((*path, key), inner) for key, inner in value.items()]
        elif isinstance(value, list):
            waiting += [((*path, str(i)), inner) for i, inner in enumerate(value)]
        elif isinstance(value, int) and not -INTEGER_MAX <= value < INTEGER_MAX:
            told = f"{shown(value)}: a whole number has 64 bits"
        elif isinstance(value, str) and "\0" in value:
            told = f"{shown(value)}: a text has no NUL"
        key = path[-1] if path else ""
        if len(key) > KEY_MAX:
            told = f"{shown(key)}: a key has no more than {KEY_MAX} characters"
        elif not key.isprintable():
            told = f"{shown(key)}: a key has only characters that can be printed"
        if told:
            return f"{Lines(text).of('.'.join(path[:-1]), key)}: {told}"
    return ""


def ordered(lines: Iterable[str], files: Iterable[str]) -> list[str]:
    """Messages in the order of files and lines; those without a line come first."""
    names = list(files)

    def order(line: str) -> tuple[int, int]:
        place = _PLACE.match(line)
        if place is None or place[1] not in names:
            return -1, 0
        return names.index(place[1]), int(place[2])

    return sorted(lines, key=order)


def model_of(file: str | Path, model: type[Model]) -> Model:
    """A file's tables as a model of pydantic; else each fault ``file:line: key = value: what``."""
    from pydantic import ValidationError

    text = text_of(file)
    try:
        return model.model_validate(tables_of(text, file))
    except ValidationError as error:
        faults = error.errors()
    lines, found = Lines(text), []
    for one in faults:
        place = [str(p) for p in one["loc"] if p != "[key]"]
        rows = 2 if len(place) > 1 and place[1].isdigit() else 1  # a table of an array
        key = place[rows] if len(place) > rows else (place[-1] if place else "")
        line = lines.of("", key) if len(place) == 1 else lines.of(".".join(place[:rows]), key)
        told = one["msg"].removeprefix("Value error, ")
        value = "" if isinstance(one["input"], dict) else f" = {shown(one['input'])}"
        found.append(": ".join(x for x in (f"{file}:{line}", ".".join(place) + value, told) if x))
    raise InputError(*found)


def shown(value: Any) -> str:
    """The text of a value in a message, cut to a length that a person reads."""
    text = repr(value)
    return text if len(text) <= SHOWN_MAX else f"{text[:SHOWN_MAX]}..."


def word(text: str) -> Any:
    """Read a value from a command line as TOML; a bare word is text."""
    try:
        found = tables_of(f"x = {text}", "")
    except InputError:
        return text
    return found["x"] if len(found) == 1 else text
