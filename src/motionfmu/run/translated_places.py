"""Where in a user's own file a fault of a program is that was made of it."""

import json
import re
from collections.abc import Sequence
from pathlib import Path

ENDING = ".places"  # of the file beside a made program
_MADE = re.compile(r"((?:/|[A-Za-z]:\\)[^:]*?\.(?:ngc|job)): line (\d+)")
_COLUMN = re.compile(r", column \d+$")


def write_places(program: Path, source: Path, places: Sequence[str]) -> None:
    """Write beside a made program its source, and what place of it each line is from."""
    told = json.dumps({"source": str(source), "places": list(places)})
    program.with_name(program.name + ENDING).write_text(told, encoding="utf-8")


def places_beside(program: Path) -> list[Path]:
    """The file of places beside a program, if it was made of another one."""
    beside = program.with_name(program.name + ENDING)
    return [beside] if beside.is_file() else []


def in_source(text: str) -> str:
    """A message with the place in the user's file instead of that in a program made of it."""
    m = _MADE.search(text)
    if m is None:
        return text
    beside = Path(m[1] + ENDING)
    try:
        told = json.loads(beside.read_text(encoding="utf-8"))
    except OSError:
        return text
    line = int(m[2])
    place = told["places"][line - 1] if line <= len(told["places"]) else ""
    place = f": {place}" if place else ""
    return text[: m.start()] + told["source"] + place + _COLUMN.sub("", text[m.end() :])
