"""Numbers of both runs in words, with their units."""

import math

from motionfmu.compare.differences import NOTHING
from motionfmu.compare.number_pairs import Number
from motionfmu.report.numbers import MINUS, figure, length

GONE = f"B {MINUS} A"


def text_of(value: float | None, unit: str, sign: bool = False) -> str:
    """A number with its unit: lengths in µm or mm, angles in °, short times in ms."""
    if value is None:
        return NOTHING
    if unit == "m":
        return length(value * 1e3, sign)
    if unit == "mm":
        return length(value, sign)
    if unit == "rad":
        return f"{figure(math.degrees(value), sign)}°"
    if unit == "s" and abs(value) < 1.0:
        return f"{figure(value * 1e3, sign)} ms"
    if unit == "mm/s":
        return f"{figure(value, sign)} {unit}"
    text = f"{value:{'+' if sign else ''}.5g}".replace("-", MINUS)
    return f"{text} {unit}" if unit else text


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
