"""Tutorials: Markdown whose Python blocks are the cells of a notebook, with what each prints."""

import json
import re
from collections.abc import Iterator
from dataclasses import dataclass

BLOCK = re.compile(r"^```(python|text)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)


@dataclass(frozen=True)
class Cell:
    """Words, or code with what it prints."""

    kind: str  # markdown or code
    text: str
    prints: str = ""


def cells(page: str) -> list[Cell]:
    """The cells of a tutorial; a text block right behind code is what the code prints."""
    found: list[Cell] = []
    for kind, text in _parts(page):
        if kind == "text" and found and found[-1].kind == "code" and not found[-1].prints:
            found[-1] = Cell("code", found[-1].text, text)
        elif kind == "python":
            found.append(Cell("code", text))
        elif kind == "text":
            found.append(Cell("markdown", f"```text\n{text}```\n"))
        elif text.strip():
            found.append(Cell("markdown", text.strip() + "\n"))
    return found


def _parts(page: str) -> Iterator[tuple[str, str]]:
    end = 0
    for match in BLOCK.finditer(page):
        if between := page[end : match.start()].strip():
            yield "words", between
        yield match[1], match[2]
        end = match.end()
    yield "words", page[end:]


def notebook(page: str) -> str:
    """A tutorial as a Jupyter notebook, with what its cells print."""
    made = []
    for number, cell in enumerate(cells(page)):
        row = {"cell_type": cell.kind, "id": f"cell-{number}", "metadata": {}, "source": cell.text}
        if cell.kind == "code":
            out = {"output_type": "stream", "name": "stdout", "text": cell.prints}
            row |= {"execution_count": None, "outputs": [out] if cell.prints else []}
        made.append(row)
    kernel = {"name": "python3", "display_name": "Python 3", "language": "python"}
    whole = {"cells": made, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}
    return json.dumps(whole, ensure_ascii=False, indent=1) + "\n"
