"""How far the elementary functions are from the true values, by mpmath.

`python tests/elementary/nearest.py 1000000` prints the table of src/base/elementary/README.md;
its last column counts results that are not the nearest double. Twelve minutes with gmpy2 installed.
"""

import ctypes
import math
import random
import struct
import subprocess
import sys
import tempfile
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import mpmath
from mpmath import mp, mpf

CORE = Path(__file__).resolve().parents[2] / "src/base/elementary"
FLAGS = "-std=c11 -Wall -Wextra -Wpedantic -Werror -ffp-contract=off -fno-math-errno".split()
Arguments = tuple[float, ...]
rnd = random.Random(19)


def built(folder: Path, *options: str, compiler: str = "gcc") -> ctypes.CDLL:
    """The functions as a library of their own."""
    file = folder / "elementary.so"
    sources = sorted(CORE.glob("*.c"))
    subprocess.run(
        [compiler, *FLAGS, "-O2", *options, "-shared", "-fPIC", "-o", file, *sources, "-lm"],
        check=True,
    )
    return ctypes.CDLL(str(file))


def telling(folder: Path, *options: str) -> ctypes.CDLL:
    """The functions and, in `told`, what they round and the bound of what that may be off by."""
    (folder / "told.c").write_text("double told[3];\n")
    before = ["-include", Path(__file__).with_name("told.h"), "-I", CORE]
    return built(folder, *map(str, before), *options, str(folder / "told.c"))


def share_of_bound(library: ctypes.CDLL, name: str, at: Arguments) -> float:
    """Error of what is rounded, of its bound; 0 if the function rounded nothing of the kind."""
    told = (ctypes.c_double * 3).in_dll(library, "told")
    told[0] = told[1] = told[2] = 0.0
    function(library, name)(*at)
    high, low, bound = map(mpf, told)
    value = abs(true_value(name, at))
    if not bound or not value:
        return 0.0
    # Signs and powers of 2 come later.
    scale = mpf(2) ** int(mpmath.nint(mpmath.log(value / abs(high + low), 2)))
    return float(abs(abs(high + low) - value / scale) / bound)


def function(library: ctypes.CDLL, name: str) -> Callable[..., float]:
    """One function, of one argument or two."""
    found = getattr(library, f"el_{name}")
    found.restype = ctypes.c_double
    found.argtypes = [ctypes.c_double] * (2 if name in ("atan2", "pow", "hypot") else 1)
    return found


def any_double() -> float:
    """Any bits."""
    return struct.unpack("d", struct.pack("Q", rnd.getrandbits(64)))[0]


def wide(low: int, high: int) -> float:
    """Any exponent of base 2 within limits, and any sign."""
    return math.ldexp(rnd.uniform(1, 2), rnd.randint(low, high)) * rnd.choice((-1, 1))


def flat(low: float, high: float) -> Callable[[], float]:
    return lambda: rnd.uniform(low, high)


def spread(low: int, high: int) -> Callable[[], float]:
    return lambda: wide(low, high)


def near_steps() -> float:
    """Around multiples of pi / 64: zeros, extremes and limits of the tables' steps."""
    return float(mp.pi / 256 * rnd.randint(-600, 600)) + rnd.choice((0.0, wide(-50, -10)))


def near_zeros() -> float:
    """A double p 2^e next to a multiple q of pi/2: p/q is a convergent of pi/2 / 2^e."""
    e, p, before = rnd.randint(-52, 970), 1, 0
    with mp.workprec(1300):
        rest = mp.pi / 2 / mpf(2) ** e
        while True:
            whole = int(mpmath.floor(rest))
            if whole * p + before >= 2**53:
                return math.ldexp(p, e)
            p, before = whole * p + before, p
            rest = 1 / (rest - whole)


def long_sides() -> Arguments:
    """Legs of triangles whose long side is a whole number."""
    a, b = rnd.getrandbits(25) + 1, rnd.getrandbits(25) + 1
    return float(abs(a * a - b * b)), float(2 * a * b)


def powers() -> Arguments:
    """Powers that are doubles, or in the middle of two."""
    bits, power = rnd.choice(((27, 2), (18, 3), (13, 4), (52, 0.5), (30, 1.5), (20, -1)))
    return float(rnd.getrandbits(bits) | 1), float(power)


def pairs(first: Callable[[], float], other: Callable[[], float]) -> Callable[[], Arguments]:
    return lambda: (first(), other())


def apart() -> Arguments:
    """Two of sizes far from each other."""
    x = wide(-300, 300)
    return x, x * wide(-70, -3)


ANGLES = [flat(-7, 7), flat(-1.3e5, 1.3e5), spread(-30, 1023), near_steps, near_zeros]
RATIOS = [
    flat(-1, 1),
    spread(-30, -1),
    lambda: 1 - abs(wide(-53, -3)),
    lambda: abs(wide(-40, -2)) - 1,
]
HALVES = [flat(-1, 1), flat(-45, 45), spread(-30, 8), flat(700, 709)]
DRAWN: dict[str, list[Callable[[], Any]]] = {
    "sin": ANGLES,
    "cos": ANGLES,
    "tan": ANGLES,
    "asin": RATIOS,
    "acos": RATIOS,
    "atan": [flat(-10, 10), spread(-40, 80), lambda: rnd.randint(-64, 64) / 64 + wide(-40, -8)],
    "atan2": [
        pairs(flat(-10, 10), flat(-10, 10)),
        pairs(spread(-50, 10), spread(-50, 10)),
        pairs(any_double, any_double),
        apart,
    ],
    "exp": [flat(-10, 10), spread(-60, 8), flat(-745, 709), flat(-745.1, -707)],
    "expm1": [flat(-1, 1), flat(-40, 700), spread(-60, 2)],
    "sinh": HALVES,
    "cosh": HALVES,
    "tanh": [flat(-1, 1), flat(-23, 23), spread(-30, 4)],
    "log": [
        flat(0, 10),
        lambda: abs(any_double()),
        lambda: 1 + wide(-52, -3),
        flat(0.68, 1.45),
        lambda: abs(wide(-1074, -1020)),
    ],
    "pow": [
        pairs(flat(0, 10), flat(-10, 10)),
        pairs(lambda: abs(wide(-20, 20)), spread(-5, 5)),
        pairs(lambda: 1 + wide(-30, -3), spread(0, 20)),
        pairs(lambda: 1 + wide(-8, -7), spread(13, 15)),
        powers,
    ],
    "hypot": [
        pairs(flat(-10, 10), flat(-10, 10)),
        pairs(spread(-50, 10), spread(-50, 10)),
        pairs(any_double, any_double),
        long_sides,
        apart,
    ],
    "cbrt": [flat(-10, 10), any_double, lambda: float(rnd.randint(1, 200000) ** 3)],
}


def true_value(name: str, at: Arguments) -> mpf:
    """The value to 200 bits."""
    # Bits of a product with 2/pi before the point, and of a difference of 1 and a tiny number.
    with mp.workprec(1300 if name in ("sin", "cos", "tan") and abs(at[0]) > 1e9 else 320):
        x = mpf(at[0])
        if name == "pow":
            value = mpmath.power(x, mpf(at[1]))
        elif name == "cbrt":
            value = mpmath.sign(x) * mpmath.cbrt(abs(x))
        else:
            value = getattr(mpmath, name)(*map(mpf, at))
    return value


def drawn(name: str, count: int) -> Iterator[Arguments]:
    """Arguments whose value is finite, of each kind as many."""
    kinds = DRAWN[name]
    for i in range(count):
        at = kinds[i % len(kinds)]()
        at = at if isinstance(at, tuple) else (at,)
        if all(map(math.isfinite, at)):
            yield at


def hard(name: str, count: int) -> Iterator[Arguments]:
    """Arguments at which the function passes the middle between two doubles, where it is flat."""
    inverse = {
        "sin": (mpmath.asin, 1 - 1e-9, 1),
        "cos": (mpmath.acos, 1 - 1e-9, 1),
        "log": (mpmath.exp, 100, 700),
        "cbrt": (lambda y: y**3, 1, 2),
        "tanh": (mpmath.atanh, 1 - 1e-9, 1),
        "atan": (mpmath.tan, 1.57, 1.5707),
        "exp": (mpmath.log, 1, 1.001),
        "cosh": (mpmath.acosh, 1, 1.0001),
    }
    if name in inverse:
        of, low, high = inverse[name]
        for _ in range(count):
            y = rnd.uniform(low, high)
            yield (float(of(mpf(y) + mpf(math.ulp(y)) / 2)),)


def ulps(name: str, at: Arguments, y: float) -> tuple[float, bool]:
    """Distance from the true value in units of its last place, and whether it is the nearest."""
    value = true_value(name, at)
    if abs(value) >= mpf(2) ** 1024 - mpf(2) ** 970:
        return (0.0 if math.isinf(y) and (y > 0) == (value > 0) else math.inf), math.isinf(y)
    if not math.isfinite(y):
        return math.inf, False
    exponent = mpmath.frexp(value)[1] if value else -1074
    unit = mpf(2) ** max(exponent - 53, -1074)
    off = abs(mpf(y) - value) / unit
    return float(off), off <= mpf(0.5)


def worst(
    f: Callable[..., float], name: str, all_at: Iterator[Arguments]
) -> tuple[float, Any, int]:
    """Largest distance in units of the last place, where, and how many are not the nearest."""
    most, where, other = 0.0, None, 0
    for at in all_at:
        off, nearest = ulps(name, at, f(*at))
        other += not nearest
        if off > most:
            most, where = off, at
    return most, where, other


def main() -> None:
    """The table."""
    mp.prec = 200
    with tempfile.TemporaryDirectory() as folder:
        library = built(Path(folder))
        for name in sys.argv[2:] or DRAWN:
            found = worst(function(library, name), name, drawn(name, int(sys.argv[1])))
            print(f"| {name} | {found[0]:.9f} | {found[2]} |", found[1], flush=True)


if __name__ == "__main__":
    main()
