"""The keys with which every fmu.toml begins: name, description, tick and experiment."""

import math
import re
from collections.abc import Callable, Collection, Mapping, Sequence
from typing import Any

from motionfmu.base.errors import suggestion
from motionfmu.base.toml_lines import shown

TICK_MAX = 1_000_000_000  # [ns]
_NAME = r"[A-Z][A-Za-z0-9]{0,63}"  # becomes a part of names of C functions and files


def wrong_keys(
    doc: Mapping[str, Any], keys: Sequence[Collection[str]], text: str, file: str
) -> list[str]:
    """Messages about unknown and missing keys; `keys` has the required ones first."""
    known = set().union(*keys)
    found, meant = [], ""
    for key in sorted(set(doc) - known):
        close = suggestion(key, known)
        meant += close
        found.append(f"{file}:{line_of(text, key)}: unknown key {key!r}{close}")
    lost = (key for key in sorted(set(keys[0]) - set(doc)) if repr(key) not in meant)
    return [*found, *(f"{file}: {key!r} is missing" for key in lost)]


def wrong_head(doc: Mapping[str, Any], text: str, file: str) -> list[str]:
    """What is wrong with an fmu.toml's name, description, tick_ns and experiment, if it has them.

    Each is ``file:line: what``.
    """
    found = []

    def look(key: str, good: Callable[[Any], bool], what: str) -> None:
        if key in doc and not good(doc[key]):
            found.append(f"{file}:{line_of(text, key)}: {key} {shown(doc[key])} {what}")

    look("name", lambda x: matches(_NAME, x), "is not CamelCase")
    look("description", lambda x: isinstance(x, str) and x.isprintable(), "is not a line of text")
    ticks = f"is not a positive integer, {TICK_MAX} at most"
    look("tick_ns", lambda x: type(x) is int and 1 <= x <= TICK_MAX, ticks)
    look("experiment", _experiment, "is not { stop = seconds, step = seconds }")
    return found


def _experiment(x: Any) -> bool:
    return isinstance(x, dict) and set(x) == {"stop", "step"} and all(map(_positive, x.values()))


def _positive(x: Any) -> bool:
    number = isinstance(x, float | int) and not isinstance(x, bool)
    return number and 0.0 < x < math.inf


def matches(pattern: str, x: Any) -> bool:
    """Whether a value is a text all of which matches a pattern."""
    return isinstance(x, str) and re.fullmatch(pattern, x) is not None


def line_of(text: str, key: str) -> int:
    """Line of a key or table in a text; 0 if there is none."""
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(rf"\s*\[?[\"']?{re.escape(key)}[\"']?\s*[=\].]", line):
            return number
    return 0
