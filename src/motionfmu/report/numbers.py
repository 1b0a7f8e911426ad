"""Numbers as a reader wants them: units, rounding, round magnifications."""

import math

from motionfmu.base.units import spelled

MINUS = "\N{MINUS SIGN}"
# Lengths from here on read better in mm than in µm [mm].
MILLIMETRES_FROM = 1.0
NOTHING = "—"  # where there is no number


def label(name: str, unit: str | None) -> str:
    """A quantity with its unit as it is spelled on all pages."""
    text = spelled(unit)
    return f"{name} [{text}]" if text else name


def length(value: float, sign: bool = False) -> str:
    """A length [mm] in µm or mm: three or four digits, a true minus."""
    size = abs(value)
    if size >= MILLIMETRES_FROM:
        return f"{figure(value, sign)} mm"
    return f"{figure(value * 1e3, sign)} µm"


def figure(value: float, sign: bool = False) -> str:
    """A number with three to four significant digits."""
    if not math.isfinite(value):
        return str(value)
    size = abs(value)
    if size < 5e-4:
        return "0"
    digits = max(0, 3 - max(0, math.floor(math.log10(size)) + 1)) if size >= 1e-2 else 4
    text = f"{value:+.{digits}f}" if sign else f"{value:.{digits}f}"
    return text.replace("-", MINUS)


def unit(largest: float) -> tuple[float, str]:
    """Factor from mm to the unit for lengths up to this one [mm], and the name of the unit."""
    return (1.0, "mm") if largest >= MILLIMETRES_FROM else (1e3, "µm")


def round_down(value: float) -> float:
    """Largest of 1, 2, 5, 10, 20, ... that is not above a value > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    return max(m * power for m in (0.5, 1.0, 2.0, 5.0) if m * power <= value * (1.0 + 1e-12))


def round_up(value: float) -> float:
    """A round number that is not far above a value > 0."""
    power = 10.0 ** math.floor(math.log10(value))
    steps = (1.0, 1.5, 2.0, 3.0, 4.0, 5.0, 6.0, 8.0, 10.0)
    return min(m * power for m in steps if m * power >= value * (1.0 - 1e-12))


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
