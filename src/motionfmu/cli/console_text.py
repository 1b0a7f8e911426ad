"""Text for the console without rich, which takes longer to load than a short run."""

import os
import shutil
import sys
import textwrap
from collections.abc import Sequence

GREEN, YELLOW, RED, DIM = "32", "33", "1;31", "2"
BESIDE = 36  # columns that a text needs to stand beside a row; else below it
LEAST = 20  # least columns of the last cell of a row


def styled(text: str, style: str) -> str:
    """The text in a style on a terminal that shows it."""
    shown = sys.stdout.isatty() and "NO_COLOR" not in os.environ
    return f"\x1b[{style}m{text}\x1b[0m" if shown and text else text


def width() -> int:
    """Columns of the terminal, or of COLUMNS; a pipe has 80."""
    return max(shutil.get_terminal_size().columns, 40)


def table(head: Sequence[str], rows: Sequence[tuple[Sequence[str], str]]) -> str:
    """Rows of cells below a head, each with the style of its first cell; the last ones break."""
    every = [head, *(cells for cells, _ in rows)]
    sizes = [max(map(len, column)) for column in zip(*every, strict=True)]
    left = 1 + sum(size + 2 for size in sizes[:-1])
    lines = []
    for cells, style in [(head, DIM), *rows]:
        start = f"{cells[0]:<{sizes[0]}}"
        rest = "  ".join(f"{c:<{n}}" for c, n in zip(cells[1:-1], sizes[1:-1], strict=True))
        last = textwrap.wrap(cells[-1], max(width() - left, LEAST)) or [""]
        first = f" {styled(start, style)}  {rest}  " if cells is not head else f" {start}  {rest}  "
        lines += [f"{first}{last[0]}".rstrip(), *(" " * left + more for more in last[1:])]
    lines[0] = styled(lines[0], DIM)
    return "\n".join(lines)


def print_rows(rows: Sequence[tuple[Sequence[str], str]], indent: str = "  ") -> None:
    """Print cells in columns and a text beside them, or below them where there is no room."""
    widths = [max(map(len, column)) for column in zip(*(cells for cells, _ in rows), strict=True)]
    left = len(indent) + sum(w + 2 for w in widths)
    beside = width() - left >= BESIDE
    hang = " " * left if beside else indent + "    "
    for cells, text in rows:
        row = "  ".join(c.ljust(w) for c, w in zip(cells, widths, strict=True))
        row = f"{indent}{row}"
        if beside:
            print(wrapped(text, f"{row}  " if cells else indent, hang))
        else:
            print(row.rstrip())
            if text:
                print(wrapped(text, hang, hang))


def wrapped(text: str, first: str, hang: str) -> str:
    """A text in lines of the console's width; the first and the others begin with these."""
    if not text:
        return first.rstrip()
    return textwrap.fill(
        text,
        width(),
        initial_indent=first,
        subsequent_indent=hang,
        break_long_words=False,
        break_on_hyphens=False,
    )
