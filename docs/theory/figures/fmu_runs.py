"""Runs of FMUs from which figures are made: part programs on machines of two axes."""

import math
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import motionfmu

ROOT = Path(__file__).parents[3]
# Position gain [1/s] of the machine first_order per unit of mcc.p_gain: 20 V in 65536 codes, a
# scale of 2^6, 300 rpm/V, 10000 counts a turn.
PER_GAIN = 20.0 / 65536.0 / 2**6 * 300.0 / 60.0 * 10_000


def ran(scenario: str, program: str, stop: float, **set_: Any) -> motionfmu.Result:
    """A scenario with a part program, to a time [s]; values by component__variable."""
    with TemporaryDirectory() as folder:
        file = Path(folder) / "program.ngc"
        file.write_text(program)
        given = {name.replace("__", "."): value for name, value in set_.items()}
        return motionfmu.load(ROOT / "scenarios" / scenario).run(
            set={"mcc.program": str(file), **given}, stop=round(stop, 2)
        )


def circles(radius: float, feed: float, turns: int = 4, ways: str = "3") -> tuple[str, float]:
    """A program with circles [mm, mm/s] by G2, G3 or both, and the time it takes at most [s]."""
    text = f"G21 G17 G90 G61\nG0 X{radius}\nG4 P0.3\n"
    for way in ways:
        text += f"G{way} X{radius} Y0 I-{radius} J0 P{turns} F{60 * feed:g}\nG4 P0.3\n"
    return text + "M30\n", 1.2 + len(ways) * (0.5 + 2.0 * math.pi * turns * radius / feed)
