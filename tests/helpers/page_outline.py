"""What a page shows, a line each, with # for every number: headings, words, tables, curves.

Outlines are kept in tests/pages/outlines. With `OUTLINES=renew` a test writes its own there in
place of comparing: look at what has changed.
"""

import os
import re
from collections.abc import Iterator
from html.parser import HTMLParser
from typing import Any

from conftest import ROOT
from page_curves import page_data

KEPT = ROOT / "tests/pages/outlines"
_NUMBER = re.compile(r"[-+\N{MINUS SIGN}]?\d(?:[\d,. ]*\d)?(?:e[-+]?\d+)?")
_FOLDER = re.compile(r"(?<!\S)/\S*/(?=\S)")  # of a file that a page names by its path
_HIDDEN = {"script", "style", "svg", "title", "option", "template"}
_CELLS = {"td", "th"}
_BLOCKS = {"h1", "h2", "h3", "p", "tr", "li", "dt", "dd", "div", "section", "summary", "button"}
_ROWS = 6  # of a table that are told; more are as the last of them


def masked(text: str) -> str:
    """A text with # in place of each number, single spaces, and names of files without folders."""
    return _NUMBER.sub("#", _FOLDER.sub("", " ".join(text.split())))


class _Shown(HTMLParser):
    """The blocks of text of a page."""

    def __init__(self) -> None:
        super().__init__()
        self.found: list[str] = []
        self._words: list[str] = []
        self._inside: list[str] = []
        self._rows = 0

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self._rows = 0 if tag == "table" else self._rows + (tag == "tr")
        if tag in _HIDDEN:
            self._inside.append(tag)
        if tag in _CELLS:
            self._words.append("|")
        elif tag in _BLOCKS:
            self._end()
            self._words += ["#" * int(tag[1])] if tag in ("h1", "h2", "h3") else []

    def handle_endtag(self, tag: str) -> None:
        if tag in _HIDDEN and tag in self._inside:
            self._inside.remove(tag)
        if tag in _BLOCKS:
            self._end()

    def handle_data(self, data: str) -> None:
        if not self._inside:
            self._words.append(data)

    def _end(self) -> None:
        told = " ".join(" ".join(self._words).split())
        self._words = []
        if told.strip("# |") and not (told.startswith("|") and self._rows > _ROWS):
            marks, _, words = told.partition(" ") if told.startswith("#") else ("", "", told)
            self.found.append(f"{marks} {masked(words)}".strip())


def _titles(layout: dict[str, Any]) -> Iterator[str]:
    for name, value in sorted(layout.items()):
        if isinstance(value, dict):
            title = value.get("title")
            words = title.get("text") if isinstance(title, dict) else title
            if words:
                yield f"{re.sub(r'[0-9]', '', name)} {masked(words)}"
            if name == "scene":
                yield from _titles(value)


def _curve(trace: dict[str, Any]) -> str:
    """Name, kind and axes of a curve, and whether it has any value."""
    kind = f"{trace.get('type', 'scatter')} {trace.get('mode', '')}".strip()
    values = trace.get("samples") or next((trace[k] for k in ("y", "r", "z", "x") if k in trace), 0)
    dash = (trace.get("line") or {}).get("dash", "")
    told = f"{masked(str(trace.get('name', '')))} ({kind} {dash}".rstrip() + ")"
    return told if values else f"{told}, empty"


def outline(page: str) -> str:
    """What a page shows; curves of one plot with the same words are one line."""
    shown = _Shown()
    shown.feed(page)
    lines = list(dict.fromkeys(shown.found))
    data = page_data(page)
    for view in data.get("views", ()):
        lines.append("view of " + ", ".join(k for k, v in sorted(view.items()) if v))
    for k, figure in enumerate(data["figures"]):
        lines.append(f"plot {k + 1}: " + "; ".join(_titles(figure["layout"])))
        lines += dict.fromkeys(f"  {_curve(trace)}" for trace in figure["data"])
    return "\n".join(lines) + "\n"


def shows_what_is_kept(kind: str, page: str) -> None:
    """The outline of a page is the one that is kept of this kind."""
    found, file = outline(page), KEPT / f"{kind}.txt"
    if os.environ.get("OUTLINES") == "renew":
        file.parent.mkdir(exist_ok=True)
        file.write_text(found, encoding="utf-8")
    assert found == file.read_text(encoding="utf-8"), f"{file.name}: OUTLINES=renew writes it anew"
