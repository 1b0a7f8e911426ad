"""Units as drives, oscilloscopes and people write them, in FMI's spelling."""

import re

from motionfmu.base import units

# What stands for another spelling, in the order in which it is replaced.
_SPELLINGS = (
    ("µ", "u"),
    ("μ", "u"),
    ("°", "deg"),
    ("Ω", "Ohm"),
    ("²", "2"),
    ("³", "3"),
    ("⁻¹", "-1"),
    ("⁻²", "-2"),
    ("^", ""),
    ("**", ""),
    ("·", "."),
    ("*", "."),
    (" ", "."),
)
# Words and the units that they are, without regard to case.
_WORDS = {
    "second": "s",
    "seconds": "s",
    "sec": "s",
    "sek": "s",
    "msec": "ms",
    "usec": "us",
    "volt": "V",
    "volts": "V",
    "ampere": "A",
    "amp": "A",
    "amps": "A",
    "degree": "deg",
    "degrees": "deg",
    "grad": "deg",
    "1/min": "rpm",
    "u/min": "rpm",
    "r/min": "rpm",
    "rev/min": "rpm",
    "min-1": "rpm",
    "nm": "N.m",
    "ncm": "N.cm",
    "mnm": "mN.m",
    "none": "1",
    "(none)": "1",
    "": "1",
    "-": "1",
}
# A length of 1e-9 m and a torque are written alike; one that is meant as a length is rare.
_TORQUES = ("Nm", "NM", "mNm", "Ncm")
PERCENT = units.Unit("%", 0.01, units.parse("1").exponents)


def quantity(text: str) -> units.Unit:
    """The unit that a text means; a ValueError names a symbol that no unit has.

    ``1/min`` is a speed of rotation here, as drives have it.
    """
    bare = text.strip()
    if bare == "%":
        return PERCENT
    word = bare.replace(" ", "")
    if word.lower() in _WORDS and (word.lower() != "nm" or word in _TORQUES):
        return units.parse(_WORDS[word.lower()])
    if " (" in bare:  # "V (Voltage)"
        return quantity(bare.partition(" (")[0])
    for written, spelled in _SPELLINGS:
        bare = bare.replace(written, spelled)
    return units.parse(bare)


def is_unit(text: str) -> bool:
    """Whether a text is a unit."""
    try:
        quantity(text)
    except ValueError:
        return False
    return True


def fmi_name(text: str | None) -> str | None:
    """A unit in FMI's spelling; what is no unit stays as it is, such as ``inc``."""
    if text is None:
        return None
    try:
        return quantity(text).name
    except ValueError:
        return text.strip()


def si_name(exponents: tuple[int, ...]) -> str:
    """The unit of the SI with these exponents of the base units, in FMI's spelling."""
    if name := _DERIVED.get(exponents):
        return name
    above = [
        f"{b}{e if e > 1 else ''}" for b, e in zip(units.BASE, exponents, strict=True) if e > 0
    ]
    below = [
        f"/{b}{-e if e < -1 else ''}" for b, e in zip(units.BASE, exponents, strict=True) if e < 0
    ]
    return ".".join(above or ["1"]) + "".join(below)


_DERIVED = {units.parse(n).exponents: n for n in ("V", "N", "Pa", "W", "N.m", "Ohm", "H")}

_BRACKETS = re.compile(r"^(.*?)\s*\[([^\[\]]*)\]$", re.DOTALL)
_ROUND = re.compile(r"^(.*?)\s*\(([^()]*)\)$", re.DOTALL)
_IN = re.compile(r"^(.+?)(?:\s+in\s+|\s*/\s*)(\S+)$")


def name_and_unit(text: str) -> tuple[str, str | None]:
    """Part the text of a column's head: ``position [mm]``, ``U (V)``, ``x in mm``, ``x/mm``.

    A number in brackets that follows a name at once is an element, ``X[1]``; what is in round
    brackets, or behind ``in`` or a stroke, is a unit only if there is one of this name.
    """
    bare = text.strip()
    if found := _BRACKETS.match(bare):
        if not (found[2].isdecimal() and bare[len(found[1])] == "["):
            return found[1], found[2]
        return bare, None
    for pattern in (_ROUND, _IN):
        found = pattern.match(bare)
        if found and found[1] and is_unit(found[2]) and found[2].strip():
            return found[1], found[2]
    return bare, None
