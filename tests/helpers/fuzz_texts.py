"""Texts and tables for the fuzzing of readers: real files with a few things changed."""

import json
import math
from typing import Any

from hypothesis import strategies as st

Path_ = tuple[str | int, ...]

NUMBERS = [-1, 0, 1, 2, 7, 300, 20_000, 2**31, 2**63 - 1, -(2**63)]
NUMBERS += [-0.0, 0.5, -1.0, 25e-9, 1e-300, 1e5, 1e300, math.inf, math.nan]
WORDS = ["", "a", "*", "?", ".", "a.b", "a.b.c", "[1]", "a.b[1]", "a.b[²]", "a.b[99999999999]"]
WORDS += ["..", "/", "/dev/zero", "a\nb", "a\x00b", "\u2028", "\ufeff", "é", "x" * 300, "contour."]
RAW = [
    "[",
    "]",
    "{",
    "}",
    "=",
    ".",
    ",",
    '"',
    "'",
    '"""',
    "'''",
    "\\",
    "#",
    "\n",
    "\r",
    "\0",
    "nan",
]
RAW += ["1979-05-27", "07:32:00", "0x", "1_0", "+", "-", "e9", "[" * 40, "a." * 40, "9" * 5000, "é"]


def leaves(known: list[str]) -> st.SearchStrategy[Any]:
    """Values that a reader may meet; `known` are words that mean something to it."""
    simple = st.sampled_from([*NUMBERS, *WORDS, True, False]) | st.sampled_from(known)
    more = st.integers(-(2**70), 2**70) | st.floats() | st.text(max_size=20)
    return st.recursive(
        simple | simple | more,
        lambda inner: (
            st.lists(inner, max_size=4)
            | st.dictionaries(st.sampled_from([*WORDS, *known]), inner, max_size=3)
        ),
        max_leaves=6,
    )


def toml(value: Any) -> str:
    """A value as TOML, tables inline."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int | float):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value).replace("\x7f", "\\u007f")
    if isinstance(value, list | tuple):
        return "[" + ", ".join(map(toml, value)) + "]"
    return "{" + ", ".join(f"{toml(str(k))} = {toml(v)}" for k, v in value.items()) + "}"


def document(tables: dict[str, Any], first: str = "# About.") -> str:
    """A whole file of tables."""
    return "\n".join([first, *(f"{toml(str(k))} = {toml(v)}" for k, v in tables.items())]) + "\n"


def paths(value: Any, here: Path_ = ()) -> list[Path_]:
    """Places of all values in tables."""
    found = [here] if here else []
    if isinstance(value, dict):
        pairs = list(value.items())
    else:
        pairs = list(enumerate(value)) if isinstance(value, list) else []
    return found + [p for k, v in pairs for p in paths(v, (*here, k))]


def words(value: Any) -> list[str]:
    """Keys and texts in tables."""
    found = {str(k) for p in paths(value) for k in p if isinstance(k, str)}
    if isinstance(value, dict | list):
        inner = value.values() if isinstance(value, dict) else value
        found |= {w for v in inner for w in words(v)}
    return sorted(found | ({value} if isinstance(value, str) else set())) or ["a"]


@st.composite
def changed_tables(draw: st.DrawFn, originals: list[dict[str, Any]]) -> dict[str, Any]:
    """One of some tables with up to three things in it replaced, removed, renamed or added."""
    tables = json.loads(json.dumps(draw(st.sampled_from(originals))))
    values = leaves(words(tables))
    for _ in range(draw(st.integers(1, 3))):
        if not (places := paths(tables)):
            break
        path = draw(st.sampled_from(places))
        around = tables
        for key in path[:-1]:
            around = around[key]
        way = draw(st.sampled_from(["replace", "replace", "remove", "rename", "add"]))
        if way == "remove":
            del around[path[-1]]
        elif way == "replace" or isinstance(around, list):
            around[path[-1]] = draw(values)
        elif way == "rename":
            name = draw(st.sampled_from([*WORDS, *words(tables)]))
            around[name] = around.pop(path[-1])
        else:
            around[draw(st.sampled_from([*WORDS, *words(tables)]))] = draw(values)
    return tables


@st.composite
def changed_text(draw: st.DrawFn, originals: list[str]) -> str:
    """One of some texts with up to four cuts, repeats or insertions; or any text."""
    if draw(st.integers(0, 9)) == 0:
        return draw(st.text())
    text = draw(st.sampled_from(originals))
    for _ in range(draw(st.integers(1, 4))):
        at = draw(st.integers(0, len(text)))
        end = min(len(text), at + draw(st.sampled_from([0, 1, 1, 2, 5, 40])))
        new = draw(st.sampled_from(["", *RAW, *WORDS]) | st.text(max_size=3))
        if draw(st.integers(0, 5)) == 0:
            new = text[at:end] * 2
        text = text[:at] + new + text[end:]
    return text
