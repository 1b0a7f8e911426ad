"""JSON of strangers: what is nested deeply is refused before a parser goes down into it."""

import json
import re
from typing import Any

DEEPEST = 32
_ESCAPED, _STRING = re.compile(r"\\.", re.DOTALL), re.compile(r'"[^"]*"')


def strange_json(text: str | bytes) -> Any:
    """Value of a JSON text; a ValueError if it is none, too deep, or has no finite numbers."""
    # At the interpreter's own limit whatever else runs there, as a finalizer, would fail, too.
    whole = text.decode() if isinstance(text, bytes) else text
    if whole.count("[") + whole.count("{") > DEEPEST:
        depth = 0
        for mark in re.findall(r"[\[\]{}]", _STRING.sub("", _ESCAPED.sub("", whole))):
            depth += 1 if mark in "[{" else -1
            if depth > DEEPEST:
                raise ValueError("nested too deeply")
    return json.loads(whole, parse_constant=_no_number)


def _no_number(word: str) -> None:
    raise ValueError(f"{word} is no JSON")
