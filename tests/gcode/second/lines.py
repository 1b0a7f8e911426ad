"""One line of a part program as a tree: words, settings, an O word, whose values are functions."""

import math
from collections.abc import Callable
from dataclasses import dataclass, field

from second.parameters import Parameters, Wrong

Value = Callable[[Parameters], float | None]  # None: vacant, on Fanuc's controls

KEYWORDS = (
    "sub endsub call return do while endwhile if elseif else endif break continue repeat endrepeat"
).split()
# Each row binds tighter than the one before; within a row from left to right.
LEVELS = (("and", "or", "xor"), ("eq", "ne", "gt", "ge", "lt", "le"), ("+", "-"), ("*", "/", "mod"))
LEVELS_FANUC = (
    ("eq", "ne", "gt", "ge", "lt", "le"),
    ("+", "-", "or", "xor"),
    ("*", "/", "mod", "and"),
)
EQUAL = 1e-6  # numbers that differ by less are the same to EQ and NE


@dataclass
class Line:
    """What a line says; `order` is that of an O word, with its label and arguments."""

    slash: bool = False
    percent: bool = False
    words: list[tuple[str, Value]] = field(default_factory=list)
    whole: str = ""  # letters whose value is a number without a point
    settings: list[tuple[Value | str, Value]] = field(default_factory=list)
    label: Value | str | None = None
    order: str = ""
    arguments: list[Value] = field(default_factory=list)
    blank: bool = True  # nothing but comments
    number: float | None = None  # of N


def _power(a: float, b: float) -> float:
    try:
        found = math.pow(a, b)
    except (ValueError, OverflowError):
        raise Wrong("power") from None
    return found


def _modulo(a: float, b: float) -> float:
    if b == 0.0:
        raise Wrong("modulo 0")
    rest = math.fmod(a, b)
    return rest + abs(b) if rest < 0.0 else rest


def _divide(a: float, b: float) -> float:
    if b == 0.0:
        raise Wrong("division by 0")
    return a / b


BINARY: dict[str, Callable[[float, float], float]] = {
    "+": lambda a, b: a + b,
    "-": lambda a, b: a - b,
    "*": lambda a, b: a * b,
    "/": _divide,
    "mod": _modulo,
    "**": _power,
    "and": lambda a, b: float(a != 0.0 and b != 0.0),
    "or": lambda a, b: float(a != 0.0 or b != 0.0),
    "xor": lambda a, b: float((a != 0.0) != (b != 0.0)),
    "eq": lambda a, b: float(abs(a - b) < EQUAL),
    "ne": lambda a, b: float(abs(a - b) >= EQUAL),
    "gt": lambda a, b: float(a > b),
    "ge": lambda a, b: float(a >= b),
    "lt": lambda a, b: float(a < b),
    "le": lambda a, b: float(a <= b),
}


def _checked(f: Callable[[float], float]) -> Callable[[float], float]:
    def safe(x: float) -> float:
        try:
            return f(x)
        except (ValueError, OverflowError):
            raise Wrong("argument of a function") from None

    return safe


def _bits(f: Callable[[int, int], int]) -> Callable[[float, float], float]:
    """An operation on the bits of whole numbers."""

    def whole(x: float) -> int:
        near = int(math.copysign(math.floor(abs(x) + 0.5), x))
        if not -(2**31) < near < 2**31:
            raise Wrong("more than 32 bits")
        return near

    return lambda a, b: float(f(whole(a), whole(b)))


BINARY_FANUC = BINARY | {
    "and": _bits(lambda a, b: a & b),
    "or": _bits(lambda a, b: a | b),
    "xor": _bits(lambda a, b: a ^ b),
}

UNARY: dict[str, Callable[[float], float]] = {
    "abs": abs,
    "acos": _checked(lambda x: math.degrees(math.acos(x))),
    "asin": _checked(lambda x: math.degrees(math.asin(x))),
    "cos": lambda x: math.cos(math.radians(x)),
    "exp": _checked(math.exp),
    "fix": lambda x: float(math.floor(x)),
    "fup": lambda x: float(math.ceil(x)),
    "ln": _checked(math.log),
    "round": lambda x: math.copysign(math.floor(abs(x) + 0.5), x) + 0.0,
    "sin": lambda x: math.sin(math.radians(x)),
    "sqrt": _checked(math.sqrt),
    "tan": lambda x: math.tan(math.radians(x)),
}


UNARY_FANUC = UNARY | {
    "fix": lambda x: float(math.trunc(x)),
    "fup": lambda x: math.copysign(math.ceil(abs(x)), x) + 0.0,
}


def plain(value: float | None) -> float:
    """A value to reckon with."""
    return 0.0 if value is None else value


def without_comments(text: str) -> str:
    """The line in small letters without comments and blanks; names keep theirs joined."""
    out, depth = [], False
    for c in text:
        if depth:
            depth = c != ")"
        elif c == "(":
            depth = True
        elif c == ";":
            break
        elif c not in " \t\r":
            out.append(c.lower())
    if depth:
        raise Wrong("comment without end")
    return "".join(out)


class Reader:
    """Reads one line from left to right."""

    def __init__(self, text: str, fanuc: bool) -> None:
        self.text, self.at, self.fanuc = without_comments(text), 0, fanuc

    def next(self) -> str:
        return self.text[self.at : self.at + 1]

    def take(self, *choices: str) -> str:
        """The first of the choices that stands here, taken; else nothing."""
        for choice in choices:
            if self.text.startswith(choice, self.at):
                self.at += len(choice)
                return choice
        return ""

    def number(self) -> float | None:
        """An unsigned number, if one begins here."""
        begin, digits = self.at, 0
        while self.next().isdigit() or (
            self.next() == "." and "." not in self.text[begin : self.at]
        ):
            digits += self.next() != "."
            self.at += 1
        if not digits:
            if self.at > begin:
                raise Wrong("number")
            return None
        return float(self.text[begin : self.at])

    def value(self) -> Value:
        """A number, a bracket, a parameter or a function, with any sign."""
        if sign := self.take("+", "-"):
            if self.text.startswith(("+", "-"), self.at):
                raise Wrong("two signs")
            inner = self.value()
            return lambda p: plain(inner(p)) * (1.0 if sign == "+" else -1.0)
        number = self.number()
        if number is not None:
            return lambda p: number
        if self.take("["):
            return self.bracket()
        if self.take("#"):
            name = self.parameter()
            return lambda p: p.get(name if isinstance(name, str) else name(p))
        return self.function()

    def parameter(self) -> Value | str:
        """Behind a #: a name, or the value that is its number."""
        if self.take("<"):
            end = self.text.find(">", self.at)
            if end <= self.at:
                raise Wrong("name")
            name, self.at = self.text[self.at : end], end + 1
            return name
        return self.value()

    def function(self) -> Value:
        if self.take("exists["):
            if not self.take("#"):
                raise Wrong("EXISTS")
            name = self.parameter()
            if not isinstance(name, str) or not self.take("]"):
                raise Wrong("EXISTS")
            return lambda p: float(p.exists(name))
        if self.take("atan["):
            y = self.bracket()
            if not self.take("/["):
                raise Wrong("ATAN")
            x = self.bracket()
            return lambda p: math.degrees(math.atan2(plain(y(p)), plain(x(p))))
        name = self.take(*(f"{n}[" for n in UNARY))[:-1]
        if not name:
            raise Wrong("value")
        inner, f = self.bracket(), (UNARY_FANUC if self.fanuc else UNARY)[name]
        return lambda p: f(plain(inner(p)))

    def bracket(self) -> Value:
        """What stands behind a [, to its ]."""
        inner = self.level(0)
        if not self.take("]"):
            raise Wrong("bracket")
        return inner

    def level(self, depth: int) -> Value:
        """Operators of one row and of those that bind tighter."""
        levels = LEVELS_FANUC if self.fanuc else LEVELS
        if depth == len(levels):
            return self.powers()
        found = self.level(depth + 1)
        while not self.text.startswith("**", self.at) and (sign := self.take(*levels[depth])):
            f = (BINARY_FANUC if self.fanuc else BINARY)[sign]
            found = self.joined(found, f, self.level(depth + 1), sign)
        return found

    def powers(self) -> Value:
        found = self.value()
        while self.take("**"):
            found = self.joined(found, _power, self.value(), "**")
        return found

    @staticmethod
    def joined(a: Value, f: Callable[[float, float], float], b: Value, sign: str) -> Value:
        def both(p: Parameters) -> float:
            x, y = a(p), b(p)
            if sign in ("eq", "ne") and None in (x, y):
                return float((x is y) == (sign == "eq"))
            return f(plain(x), plain(y))

        return both

    def line(self) -> Line:
        found = Line()
        if self.text == "%":
            return Line(percent=True)
        found.slash = bool(self.take("/"))
        if found.slash:
            self.take(*"123456789")  # of its switch
        found.blank = self.at == len(self.text)
        if self.take("n"):
            found.number = self.number()
            if found.number is None:
                raise Wrong("line number")
        if self.take("o"):
            return self.flow(found)
        if self.fanuc and (order := self.take("goto", "if", "while", "do", "end")):
            return self.macro(found, order)
        while self.at < len(self.text):
            if self.take("#"):
                target = self.parameter()
                if not self.take("="):
                    raise Wrong("=")
                found.settings.append((target, self.level(0) if self.fanuc else self.value()))
                continue
            letter = self.next()
            if not (letter.isalpha() and letter.isascii()) and letter not in "@^$":
                raise Wrong("character")
            self.at += 1
            if letter == "n":
                if self.number() is None:
                    raise Wrong("line number")
            else:
                begin = self.at
                found.words.append((letter, self.value()))
                if self.text[begin : self.at].lstrip("+-").isdigit():
                    found.whole += letter
        return found

    def macro(self, found: Line, order: str) -> Line:
        """IF, GOTO, WHILE, DO, END of Fanuc's controls; arguments: the condition, a number."""
        found.label, found.order = "fanuc", f"fanuc_{order}"
        if order in ("if", "while"):
            if not self.take("["):
                raise Wrong("condition")
            found.arguments.append(self.bracket())
            behind = self.take("goto", "then") if order == "if" else self.take("do")
            if not behind:
                raise Wrong("behind a condition")
            found.order += f"_{behind}"
            if behind == "then":
                inner = Reader(self.text[self.at :], True).line()
                if not inner.settings or inner.words or inner.label or inner.number:
                    raise Wrong("behind THEN")
                found.settings = inner.settings
                return found
        found.arguments.append(self.value())
        if self.at < len(self.text):
            raise Wrong("text behind a number")
        return found

    def flow(self, found: Line) -> Line:
        """An O word with its label, order and arguments."""
        if self.take("<"):
            self.at -= 1
            found.label = self.parameter_name()
        else:
            found.label = self.value()
        # "elseif" before "else" and "endwhile" before "while" have no common beginning but these.
        found.order = self.take(*sorted(KEYWORDS, key=len, reverse=True))
        while self.next() == "[" and found.order:
            self.at += 1
            found.arguments.append(self.bracket())
        if self.at < len(self.text):
            raise Wrong("text behind an O word")
        return found

    def parameter_name(self) -> str:
        name = self.parameter()
        if not isinstance(name, str):
            raise Wrong("name")
        return name


def read(text: str, fanuc: bool = False) -> Line:
    """The tree of one line; `Wrong` says that it is none."""
    return Reader(text, fanuc).line()
