"""Make src/base/elementary/el_*_tables.h: every constant of the functions, from mpmath alone.

`python tests/elementary/tables.py`; test_elementary.py holds the files against this.
"""

import textwrap
from collections.abc import Callable, Iterable
from pathlib import Path

import mpmath
from mpmath import mp, mpf

mp.prec = 1400
CORE = Path(__file__).resolve().parents[2] / "src/base/elementary"
Number = float | mpf

SINES = 256  # steps of a turn
POWERS = 128  # steps of an octave
LOGARITHMS = 128  # intervals of [LOWEST, 2 LOWEST)
LOWEST = mpf(181) / 256  # the middle interval is around 1, where the logarithm's own is 0
FACTORIALS = 31
INVERSES = 16
GRID = 2.0**-41  # of 11 bits of exponent times ln 2 and the logarithm, exact in a sum
ARC_TERMS = 9
WORDS = 40  # of 32 bits of 2/pi: 1024 + 53 + 9 * 32 is less than 1280 + 32


def short(x: Number, bits: int) -> float:
    """The nearest number of so many bits."""
    x = mpf(x)
    if x == 0:
        return 0.0
    unit = mpf(2) ** (mpmath.frexp(x)[1] - bits)
    return float(mpmath.nint(x / unit) * unit)


def on_grid(x: Number, unit: float) -> float:
    """The nearest multiple of a unit."""
    return float(mpmath.nint(mpf(x) / unit) * unit)


def parts(x: Number, first: float, count: int) -> list[float]:
    """A number as a sum: its first part is given, each other one is the nearest to what is left."""
    found = [first]
    for _ in range(count - 1):
        found.append(float(mpf(x) - mpmath.fsum(map(mpf, found))))
    return found


def pair(x: Number) -> list[float]:
    """The two doubles whose sum is nearest."""
    return parts(x, float(mpf(x)), 2)


def polynomial(f: Callable[[mpf], mpf], low: Number, high: Number, terms: int) -> list[float]:
    """Coefficients from x^0 on that agree with f at Chebyshev's points."""
    low, high = mpf(low), mpf(high)
    at = [
        (low + high) / 2 + (high - low) / 2 * mpmath.cos((2 * i + 1) * mp.pi / (2 * terms))
        for i in range(terms)
    ]
    matrix = mpmath.matrix(terms, terms)
    for i, x in enumerate(at):
        for j in range(terms):
            matrix[i, j] = x**j
    return [float(c) for c in mpmath.lu_solve(matrix, mpmath.matrix([f(x) for x in at]))]


def number(x: float) -> str:
    """A double in C, exact, without the zeros at its end."""
    if x == 0:
        return "0.0"
    digits, exponent = x.hex().split("p")
    return f"{digits.rstrip('0').rstrip('.')}p{exponent}"


def array(what: str, name: str, size: str, items: Iterable[str]) -> str:
    """A table in C, under a line that says what it is."""
    body = textwrap.fill(", ".join(items), 96, initial_indent=" " * 4, subsequent_indent=" " * 4)
    return f"/* {what} */\nstatic const {name}{size} = {{\n{body}\n}};\n"


def reduced(step: mpf, bits: int) -> list[float]:
    """A step as two numbers of so many bits and a double: whole multiples of the two are exact."""
    first = short(step, bits)
    second = short(step - mpf(first), bits)
    return [first, second, float(step - mpf(first) - mpf(second))]


def sines() -> list[list[float]]:
    """Of each step of a turn its sine: 26 bits, what is left of it, and the nearest double."""
    found = []
    for k in range(SINES):
        x = mpf(0) if k in (0, SINES // 2) else mpmath.sin(2 * mp.pi * k / SINES)
        found.append([*parts(x, short(x, 26), 2), float(x)])
    return found


def logarithms() -> list[list[float]]:
    """Of each interval a c near 1/m, of 10 bits, and -log c as three numbers."""
    found = []
    for i in range(LOGARITHMS):
        # The double's exponent changes at 1, so the intervals above 1 are twice as wide.
        low = LOWEST + mpf(i) / (2 * LOGARITHMS)
        high = low + mpf(1) / (2 * LOGARITHMS)
        if low >= 1:
            low = 1 + 2 * (low - 1)
            high = low + mpf(1) / LOGARITHMS
        elif high > 1:
            high = 1 + 2 * (high - 1)
        middle = (low + high) / 2
        inverse = mpf(1) if low <= 1 <= high else mpmath.nint(512 / middle) / 512
        x = -mpmath.log(inverse)
        found.append([float(inverse), *parts(x, on_grid(x, GRID), 3)])
    return found


def inverse_quarter() -> list[str]:
    """2/pi in words of 32 bits."""
    bits = int(mpmath.floor(2 / mp.pi * mpf(2) ** (32 * WORDS)))
    return [f"0x{bits >> 32 * (WORDS - 1 - i) & 0xFFFFFFFF:08x}" for i in range(WORDS)]


def sine_rest(u: mpf) -> mpf:
    """(sin r - r) / r^3 of r^2."""
    r = mpmath.sqrt(u)
    return (mpmath.sin(r) - r) / r**3


def cosine_rest(u: mpf) -> mpf:
    """(cos r - 1) / r^2 of r^2."""
    return (mpmath.cos(mpmath.sqrt(u)) - 1) / u


def atan_rest(u: mpf) -> mpf:
    """(atan z - z) / z^3 of z^2."""
    z = mpmath.sqrt(u)
    return (mpmath.atan(z) - z) / z**3


def numbers(what: str, name: str, values: list[float]) -> str:
    """A list of constants in C."""
    return array(what, f"double {name}", f"[{len(values)}]", map(number, values))


def table(what: str, name: str, rows: list[list[float]]) -> str:
    """A table of constants in C."""
    items = ("{ " + ", ".join(map(number, r)) + " }" for r in rows)
    return array(what, f"double {name}", f"[{len(rows)}][{len(rows[0])}]", items)


def sine_tables() -> Iterable[str]:
    """Those of sine, cosine and tangent."""
    widest = (mp.pi / SINES) ** 2
    words = inverse_quarter()
    yield numbers("steps in a radian: 256 / (2 pi)", "TURN_STEPS", [float(SINES / (2 * mp.pi))])
    yield numbers(
        "the step 2 pi / 256 as a sum: 30 bits, 30 bits, the rest",
        "TURN_STEP",
        reduced(2 * mp.pi / SINES, 30),
    )
    yield numbers(
        "coefficients of (sin r - r) / r^3, ascending powers of r^2",
        "SINE_REST",
        polynomial(sine_rest, 0, widest, 3),
    )
    yield numbers(
        "coefficients of (cos r - 1) / r^2, ascending powers of r^2",
        "COSINE_REST",
        polynomial(cosine_rest, 0, widest, 3),
    )
    yield table(
        "row k: sin(2 pi k / 256) as 26 bits and the rest; the nearest double", "SINES", sines()
    )
    yield numbers("pi / 2 as a sum of two doubles", "QUARTER", pair(mp.pi / 2))
    yield array(
        "fractional bits of 2 / pi, in words of 32 bits, the first one first",
        "uint32_t WORDS",
        f"[{len(words)}]",
        words,
    )


def exp_tables() -> Iterable[str]:
    """Those of the exponential function."""
    ln2 = mpmath.log(2)
    half = ln2 / POWERS / 2
    rest = polynomial(lambda r: (mpmath.expm1(r) - r) / r**2, -half, half, 4)
    less = polynomial(lambda r: (mpmath.expm1(r) - r - r * r / 2) / r**3, -half, half, 4)
    powers = [pair(mpf(2) ** (mpf(k) / POWERS)) for k in range(POWERS)]
    yield numbers("steps in a unit of x: 128 / ln 2", "OCTAVE_STEPS", [float(POWERS / ln2)])
    yield numbers(
        "the step ln 2 / 128 as a sum: 35 bits, 35 bits, the rest",
        "OCTAVE_STEP",
        reduced(ln2 / POWERS, 35),
    )
    yield numbers("coefficients of (e^r - 1 - r) / r^2, ascending powers of r", "EXP_REST", rest)
    yield numbers(
        "coefficients of (e^r - 1 - r - r^2 / 2) / r^3, ascending powers of r", "LESS_REST", less
    )
    yield table("row k: 2^(k / 128) as a sum of two doubles", "POWERS", powers)


def log_tables() -> Iterable[str]:
    """Those of the logarithm."""
    ln2, far = mpmath.log(2), mpf(1) / 128
    rest = polynomial(lambda r: (mpmath.log1p(r) - r + r * r / 2) / r**3, -far, far, 6)
    inverses = [[0.0, 0.0]] + [pair(mpf(1) / n) for n in range(1, INVERSES)]
    yield numbers(
        "ln 2 as a sum: a multiple of 2^-41, two rests", "LN2", parts(ln2, on_grid(ln2, GRID), 3)
    )
    yield numbers(
        "coefficients of (log(1 + r) - r + r^2 / 2) / r^3, ascending powers of r", "LOG_REST", rest
    )
    yield table(
        "for each interval of m: c near 1/m; -log c as a multiple of 2^-41 and two rests",
        "LOGARITHMS",
        logarithms(),
    )
    yield table("row n: 1 / n as a sum of two doubles", "INVERSES", inverses)


def arc_tables() -> Iterable[str]:
    """Those of the arc functions."""
    rest = polynomial(atan_rest, 0, mpf(1) / 125**2, 4)
    inverses = [pair(mpf(1) / n) for n in range(1, 2 * ARC_TERMS, 2)]
    yield numbers("coefficients of (atan z - z) / z^3, ascending powers of z^2", "ATAN_REST", rest)
    yield table(
        "row i: atan(i / 64) as a sum of two doubles",
        "ANGLES",
        [pair(mpmath.atan(mpf(i) / 64)) for i in range(65)],
    )
    yield table("row n: 1 / (2 n + 1) as a sum of two doubles", "ODD_INVERSES", inverses)
    turns = ((0, 1), (1, -1), (2, -1), (1, 1))
    starts = [[*pair(mp.pi / 2 * quarters), float(sign)] for quarters, sign in turns]
    yield table(
        "for each octant: angle as a sum of two doubles, sign of what is added to it",
        "ARC_STARTS",
        starts,
    )


def series_tables() -> Iterable[str]:
    """Those of the slow ways' power series."""
    factorials = [pair(1 / mpmath.factorial(n)) for n in range(FACTORIALS)]
    yield table("row n: 1 / n! as a sum of two doubles", "FACTORIALS", factorials)


def cbrt_tables() -> Iterable[str]:
    """Those of the cube root."""
    start = polynomial(mpmath.cbrt, 1, 2, 5)
    yield numbers(
        "coefficients of the cube root in 1 .. 2, to 12 bits, ascending powers", "CBRT_START", start
    )
    yield numbers("cube roots of 1, 2, 4", "CBRTS", [float(mpmath.cbrt(2**k)) for k in range(3)])


def texts() -> dict[str, str]:
    """The headers by their names."""
    found = {}
    for make in (sine_tables, exp_tables, log_tables, arc_tables, series_tables, cbrt_tables):
        name = f"el_{make.__name__}.h"
        guard = name.upper().replace(".", "_")
        what = str(make.__doc__).removeprefix("Those of ").removesuffix(".")
        head = (
            f"/* {name[:-2]} - constants of {what}, for the files of this core.\n"
            " * Made by tests/elementary/tables.py, which computes every number. */"
        )
        include = "#include <stdint.h>\n\n" if make is sine_tables else ""
        body = "\n".join(make())
        found[name] = f"{head}\n#ifndef {guard}\n#define {guard}\n\n{include}{body}\n#endif\n"
    return found


if __name__ == "__main__":
    for name, text in texts().items():
        (CORE / name).write_text(text)
