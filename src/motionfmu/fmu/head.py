"""What every fmu.toml begins with: name, description, tick and experiment."""

import math
import re
from typing import Any

from motionfmu.errors import InputError
from motionfmu.toml_lines import shown

TICK_MAX = 1_000_000_000  # [ns]
_NAME = r"[A-Z][A-Za-z0-9]{0,63}"  # it is part of the name of C functions and of files


def check_head(doc: dict[str, Any], text: str, file: str) -> None:
    """Check an fmu.toml's name, description, tick_ns and experiment; else ``file:line: what``."""

    def refuse(key: str, what: str) -> InputError:
        return InputError(f"{file}:{line_of(text, key)}: {key} {shown(doc[key])} {what}")

    if not matches(_NAME, doc["name"]):
        raise refuse("name", "is not CamelCase")
    if not isinstance(doc["description"], str) or not doc["description"].isprintable():
        raise refuse("description", "is not a line of text")
    tick = doc["tick_ns"]
    if not isinstance(tick, int) or isinstance(tick, bool) or not 1 <= tick <= TICK_MAX:
        raise refuse("tick_ns", f"is not a positive integer, {TICK_MAX} at most")
    experiment = doc["experiment"]
    good = isinstance(experiment, dict) and set(experiment) == {"stop", "step"}
    if not good or not all(_positive(x) for x in experiment.values()):
        raise refuse("experiment", "is not { stop = seconds, step = seconds }")


def _positive(x: Any) -> bool:
    number = isinstance(x, float | int) and not isinstance(x, bool)
    return number and 0.0 < x < math.inf


def matches(pattern: str, x: Any) -> bool:
    """Whether a value is text of a pattern as a whole."""
    return isinstance(x, str) and re.fullmatch(pattern, x) is not None


def line_of(text: str, key: str) -> int:
    """Line of a key or table in a text; 0 if there is none."""
    for number, line in enumerate(text.split("\n"), 1):
        if re.match(rf"\s*\[?[\"']?{re.escape(key)}[\"']?\s*[=\].]", line):
            return number
    return 0
