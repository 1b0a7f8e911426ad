"""Numbers of both runs in words, with their units."""

from motionfmu.compare.number_pairs import Number
from motionfmu.report.numbers import MINUS, NOTHING, text_of

GONE = f"B {MINUS} A"


def change_text(n: Number) -> str:
    """Change of the size of B against A's in percent; empty where there is none."""
    if n.change is None:
        return ""
    size = abs(n.change)
    if size == 0.0:
        return "0 %"
    text = f"{n.change:+.1f}" if size >= 0.05 else f"{n.change:+.1g}"
    return (f"{n.change:+.0f}" if size >= 100 else text).replace("-", MINUS) + " %"


def signed(n: Number) -> str:
    """Difference of a length."""
    return text_of(n.difference, "mm", sign=True)


def row_of(words: str, n: Number, unit: str) -> tuple[str, ...]:
    """A row of a table: what, A, B, B - A, change in percent."""
    sign = n.difference is not None and n.difference != 0.0
    gone = NOTHING if n.difference is None else text_of(n.difference, unit, sign)
    change = "" if unit == "rad" else change_text(n)
    return (words, text_of(n.a, unit), text_of(n.b, unit), gone, change)
