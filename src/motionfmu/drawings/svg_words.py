"""Values of SVG attributes: lengths, transforms, view boxes, styles."""

import math
import re
from dataclasses import dataclass

import numpy as np

from motionfmu.drawings.pen_path import Array

PX = 25.4 / 96.0  # [mm]
_UNITS = {"": 1.0, "px": 1.0, "mm": 1 / PX, "cm": 10 / PX, "in": 96.0, "pt": 96 / 72, "pc": 16.0}
_UNITS |= {"q": 0.25 / PX, "em": 16.0, "ex": 8.0, "rem": 16.0}
NUMBER = r"[-+]?(?:\d+\.?\d*|\.\d+)(?:[eE][-+]?\d+)?"
_LENGTH = re.compile(rf"\s*({NUMBER})\s*([a-zA-Z%]*)\s*")
_NUMBERS = re.compile(rf"\s*,?\s*({NUMBER})")
_CALL = re.compile(r"[\s,]*([a-zA-Z]+)\s*\(([^()]*)\)[\s,]*")
_COMMENT = re.compile(r"/\*.*?\*/", re.DOTALL)
_RULE = re.compile(r"([^{}]+)\{([^{}]*)\}")
_SIMPLE = re.compile(r"(\*|[a-zA-Z][\w-]*)?([.#][\w-]+)*")
_PARTS = re.compile(r"[.#][\w-]+")
IDENTITY = np.eye(3)


class WrongValue(ValueError):
    """A value that SVG does not know; the text says what is wanted."""


def length(text: str, whole: float) -> float:
    """A length in user units; `whole` is 100 %."""
    m = _LENGTH.fullmatch(text)
    unit = m[2].lower() if m else ""
    if m is None or (unit != "%" and unit not in _UNITS):
        raise WrongValue("a length wanted, such as 10, 5mm or 50%")
    value = float(m[1])
    found = value * whole / 100.0 if unit == "%" else value * _UNITS[unit]
    if not math.isfinite(found):
        raise WrongValue("a finite length wanted")
    return found


def numbers(text: str) -> list[float]:
    """All numbers of a list."""
    found, at = [], 0
    while m := _NUMBERS.match(text, at):
        found.append(float(m[1]))
        at = m.end()
    if text[at:].strip(" \t\r\n,") or not all(map(math.isfinite, found)):
        raise WrongValue("numbers wanted")
    return found


def transform(text: str) -> Array:
    """The matrix of a list of transforms."""
    found, at, text = IDENTITY, 0, text.strip()
    while at < len(text):
        m = _CALL.match(text, at)
        if m is None:
            if text[at:] in ("none", ""):
                return found
            raise WrongValue("a list of transforms wanted")
        values = numbers(re.sub(r"(?<=\d)(?:px|[d]eg)\b", "", m[2]))
        found, at = found @ _one(m[1], values), m.end()
    return found


def _one(name: str, v: list[float]) -> Array:
    counts = {"matrix": (6,), "translate": (1, 2), "scale": (1, 2), "rotate": (1, 3)}
    counts |= {"translateX": (1,), "translateY": (1,), "scaleX": (1,), "scaleY": (1,)}
    counts |= {"skewX": (1,), "skewY": (1,)}
    if len(v) not in counts.get(name, ()):
        raise WrongValue(f"{name} with {len(v)} numbers is no transform")
    a = math.radians(v[0])
    c, s = math.cos(a), math.sin(a)
    if name == "matrix":
        rows = [[v[0], v[2], v[4]], [v[1], v[3], v[5]]]
    elif name == "rotate":
        x, y = v[1:] or (0.0, 0.0)
        rows = [[c, -s, x - c * x + s * y], [s, c, y - s * x - c * y]]
    elif name.startswith("skew"):
        rows = (
            [[1, math.tan(a), 0], [0, 1, 0]]
            if name == "skewX"
            else [[1, 0, 0], [math.tan(a), 1, 0]]
        )
    elif name.startswith("translate"):
        x, y = (0.0, v[0]) if name == "translateY" else (v[0], v[1] if len(v) > 1 else 0.0)
        rows = [[1, 0, x], [0, 1, y]]
    else:
        x, y = {"scaleX": (v[0], 1.0), "scaleY": (1.0, v[0])}.get(name, (v[0], v[-1]))
        rows = [[x, 0, 0], [0, y, 0]]
    return np.array([*rows, [0, 0, 1]], float)


def fitted(box: list[float], size: tuple[float, float], aspect: str) -> Array:
    """The matrix from a view box to a viewport of a size, by preserveAspectRatio."""
    x, y = size[0] / box[2], size[1] / box[3]
    words = aspect.replace("defer", "").split() or ["xMidYMid"]
    left = bottom = 0.0
    if words[0] != "none":
        x = y = max(x, y) if "slice" in words[1:] else min(x, y)
        shares = {"Min": 0.0, "Mid": 0.5, "Max": 1.0}
        m = re.fullmatch(r"x(Min|Mid|Max)Y(Min|Mid|Max)", words[0])
        if m is None:
            raise WrongValue("none or xMidYMid and the like wanted")
        left = shares[m[1]] * (size[0] - x * box[2])
        bottom = shares[m[2]] * (size[1] - y * box[3])
    return np.array([[x, 0, left - x * box[0]], [0, y, bottom - y * box[1]], [0, 0, 1]])


@dataclass(frozen=True)
class StyleRule:
    """What a style sheet says of elements of a tag, class or id."""

    tag: str  # "" any
    parts: frozenset[str]  # ".class" and "#id", all of which it must have
    says: dict[str, str]

    def of(self, tag: str, names: frozenset[str]) -> bool:
        """Whether it is about an element."""
        return self.tag in ("", tag) and self.parts <= names

    @property
    def strength(self) -> tuple[int, int, int]:
        """What of two rules counts."""
        ids = sum(p[0] == "#" for p in self.parts)
        return ids, len(self.parts) - ids, bool(self.tag)


def declarations(text: str) -> dict[str, str]:
    """Properties by name."""
    pairs = (p.partition(":") for p in _COMMENT.sub("", text).split(";"))
    kept = (v.replace("!important", "").strip() for _, _, v in pairs)
    names = (p.partition(":")[0].strip().lower() for p in _COMMENT.sub("", text).split(";"))
    return {name: value for name, value in zip(names, kept, strict=True) if name and value}


def style_rules(text: str) -> tuple[list[StyleRule], int]:
    """Rules of a style sheet, the weakest first, and how many selectors are not known."""
    found, unknown = [], 0
    text = re.sub(r"@(?:import|charset|namespace)[^;]*;|<!\[CDATA\[|\]\]>", "", text)
    for m in _RULE.finditer(_COMMENT.sub("", text)):
        says = declarations(m[2])
        for selector in m[1].split(","):
            selector = selector.strip()
            if not _SIMPLE.fullmatch(selector) or not selector:
                unknown += 1
                continue
            tag = re.match(r"[\w-]*", selector)
            name = tag[0] if tag else ""
            found.append(StyleRule(name, frozenset(_PARTS.findall(selector)), says))
    return sorted(found, key=lambda rule: rule.strength), unknown
