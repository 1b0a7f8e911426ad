"""Units as FMI carries them: exponents of the SI base units and a factor."""

import math
import re
from dataclasses import dataclass

BASE = ("kg", "m", "s", "A", "K", "mol", "cd", "rad")

# Symbol: (factor to SI, exponents of the base units). FMI counts rad among the base units.
SYMBOLS: dict[str, tuple[float, dict[str, int]]] = {
    "1": (1.0, {}),
    "kg": (1.0, {"kg": 1}),
    "m": (1.0, {"m": 1}),
    "mm": (1e-3, {"m": 1}),
    "L": (1e-3, {"m": 3}),
    "nm": (1e-9, {"m": 1}),
    "um": (1e-6, {"m": 1}),
    "cm": (1e-2, {"m": 1}),
    "km": (1e3, {"m": 1}),
    "s": (1.0, {"s": 1}),
    "ns": (1e-9, {"s": 1}),
    "us": (1e-6, {"s": 1}),
    "ms": (1e-3, {"s": 1}),
    "min": (60.0, {"s": 1}),
    "h": (3600.0, {"s": 1}),
    "A": (1.0, {"A": 1}),
    "mA": (1e-3, {"A": 1}),
    "K": (1.0, {"K": 1}),
    "rad": (1.0, {"rad": 1}),
    "deg": (math.pi / 180.0, {"rad": 1}),
    "mrad": (1e-3, {"rad": 1}),
    "urad": (1e-6, {"rad": 1}),
    "rev": (2.0 * math.pi, {"rad": 1}),
    "rpm": (2.0 * math.pi / 60.0, {"rad": 1, "s": -1}),
    "Hz": (1.0, {"s": -1}),
    "kHz": (1e3, {"s": -1}),
    "N": (1.0, {"kg": 1, "m": 1, "s": -2}),
    "mN": (1e-3, {"kg": 1, "m": 1, "s": -2}),
    "kN": (1e3, {"kg": 1, "m": 1, "s": -2}),
    "Pa": (1.0, {"kg": 1, "m": -1, "s": -2}),
    "bar": (1e5, {"kg": 1, "m": -1, "s": -2}),
    "kPa": (1e3, {"kg": 1, "m": -1, "s": -2}),
    "MPa": (1e6, {"kg": 1, "m": -1, "s": -2}),
    "W": (1.0, {"kg": 1, "m": 2, "s": -3}),
    "kW": (1e3, {"kg": 1, "m": 2, "s": -3}),
    "J": (1.0, {"kg": 1, "m": 2, "s": -2}),
    "V": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "mV": (1e-3, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "kV": (1e3, {"kg": 1, "m": 2, "s": -3, "A": -1}),
    "Ohm": (1.0, {"kg": 1, "m": 2, "s": -3, "A": -2}),
    "H": (1.0, {"kg": 1, "m": 2, "s": -2, "A": -2}),
}


# The unit in which a tool shows values of a unit, and their usual size.
SHOWN: dict[str, tuple[str | None, float | None]] = {
    "m": ("mm", 0.1),
    "m/s": ("mm/s", 0.1),
    "mm": (None, 100.0),
    "mm/s": (None, 100.0),
    "mm/s2": (None, 1e3),
    "mm/min": (None, 1e3),
    "m3/s": ("L/min", 1e-4),
    "rad": ("deg", None),
    "rad/s": ("rpm", 100.0),
    "deg": (None, 100.0),
    "deg/s": (None, 100.0),
    "rpm": (None, 1e3),
    "s": ("ms", 1e-3),
    "N": (None, 1e3),
    "N/m": (None, 1e8),
    "N.s/m": (None, 1e3),
    "N.m/rad": (None, 1e5),
    "kg.m2": (None, 1e-3),
    "Pa": ("bar", 1e6),
}


# Spelling of units on pages, in pictures and on the console; data keep FMI's names.
SPELLED = {"um": "µm", "us": "µs", "urad": "µrad", "deg": "°", "Ohm": "Ω"}
POWERS = str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


@dataclass(frozen=True)
class Unit:
    """A unit by its factor to SI and its base-unit exponents."""

    name: str  # as written, for example N.m.s/rad
    factor: float  # value in SI = factor * value in this unit
    exponents: tuple[int, ...]  # in the order of `BASE`

    def attributes(self) -> dict[str, str]:
        """Attributes of the FMI element BaseUnit."""
        out = {b: str(e) for b, e in zip(BASE, self.exponents, strict=True) if e}
        if self.factor != 1.0:
            out["factor"] = repr(self.factor)
        return out


def parse(name: str) -> Unit:
    """Read a unit such as ``mm/min``, ``N.m`` or ``kg.m2``.

    Symbols are joined by ``.`` (product) and ``/`` (each divides once), with integer exponents; a
    ValueError names a symbol that is not in `SYMBOLS`.
    """
    factor, total = 1.0, dict.fromkeys(BASE, 0)
    for i, part in enumerate(name.split("/")):
        sign = -1 if i else 1
        for token in part.split("."):
            match = re.fullmatch(r"([A-Za-z]+|1)(-?[0-9]{1,2})?", token)
            if match is None or match[1] not in SYMBOLS:
                raise ValueError(f'unit "{name}": unknown symbol "{token}"')
            power = sign * int(match[2] or 1)
            scale, exponents = SYMBOLS[match[1]]
            try:
                factor *= scale**power
            except OverflowError:
                factor = math.inf
            for base, e in exponents.items():
                total[base] += power * e
    if not 0.0 < factor < math.inf:
        raise ValueError(f'unit "{name}": beyond all numbers')
    return Unit(name, factor, tuple(total[b] for b in BASE))


def shown_as(name: str | None) -> str | None:
    """The unit in which a tool shows a value of this unit; None for this unit itself."""
    return SHOWN.get(name or "", (None, None))[0]


def usual(name: str | None) -> float | None:
    """The usual size of a value in this unit; None if that is near 1."""
    return SHOWN.get(name or "", (None, None))[1]


def spelled(name: str | None) -> str:
    """Spelling of a unit for readers: ``mm/s²``, ``N·m``, ``°/s``, ``µm``; empty for a number."""

    def symbol(match: re.Match[str]) -> str:
        return SPELLED.get(match[1], match[1]) + match[2].translate(POWERS)

    plain = "" if name in (None, "1") else str(name)
    return re.sub(r"([A-Za-z]+)(-?[0-9]*)", symbol, plain).replace(".", "·")


def convertible(a: str | None, b: str | None) -> bool:
    """Whether a wire may carry a value unchanged: dimension and factor are equal; None is ``1``."""
    ua, ub = parse(a or "1"), parse(b or "1")
    return ua.exponents == ub.exponents and math.isclose(ua.factor, ub.factor, rel_tol=1e-12)
