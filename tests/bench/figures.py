"""The last table of the benchmark: what is asked, and what was found the time before."""

import json
import math
import platform
from dataclasses import dataclass
from datetime import date
from enum import Enum, auto
from pathlib import Path

LAST = Path(__file__).parent / "last.json"
# Share by which a figure may get worse: counts are the same again, times are not.
COUNTED, TIMED = 0.02, 0.2


@dataclass
class Figure:
    """One line: what it is, and which way is better."""

    name: str
    value: float
    most: float = math.inf
    least: float = 0.0
    counted: bool = False

    @property
    def asked(self) -> str:
        """What is asked of it, MISSED if it is not so."""
        if self.least == 0.0 and self.most == math.inf:
            return ""
        words = f"at most {self.most:g}" if self.least == 0.0 else f"at least {self.least:g}"
        return words if self.least <= self.value <= self.most else f"{words} MISSED"

    def worse(self, last: float) -> bool:
        """Than last time, by more than may be."""
        ratio = last / self.value if self.least else self.value / last
        return ratio > 1.0 + (COUNTED if self.counted else TIMED)


def machine(method: str | None) -> str:
    """What the figures depend on beside the code."""
    return f"{platform.machine()}, {platform.python_version()}, counts: {method or 'none'}"


class Kept(Enum):
    """What becomes of the figures."""

    SHOWN = auto()
    NEW = auto()  # those to compare with from now on
    ONE_ROUND = auto()  # of which times are no figures: one may be twice the next


def show(figures: list[Figure], method: str | None, kept: Kept) -> None:
    """Print all beside what is asked and what was last; times of one round without judging them."""
    last = json.loads(LAST.read_text()) if LAST.exists() else {"machine": "", "figures": {}}
    here = machine(method)
    print(f"\n{'':52}{'now':>10}{'last':>10}   asked")
    for f in figures:
        if math.isnan(f.value):
            continue
        before = last["figures"].get(f.name)
        same = before is not None and (not f.counted or last["machine"] == here)
        if kept is Kept.ONE_ROUND and not f.counted:
            about = f"about {float(f'{f.value:.2g}'):g}"
            print(f"{f.name:52}{about:>10}{'':10}   {f.asked.removesuffix(' MISSED')}")
            continue
        told = f"{before:10.5g}" if same else f"{'-':>10}"
        mark = "   WORSE" if same and f.worse(before) else ""
        print(f"{f.name:52}{f.value:10.5g}{told}   {f.asked}{mark}")
    print(f"here: {here}; last: {last['machine'] or 'none'}")
    if kept is Kept.ONE_ROUND:
        print(
            "one round: its times, and what was printed before, are a rough look; nothing is kept"
        )
    if kept is Kept.NEW:
        found = [f for f in figures if not math.isnan(f.value)]
        values = {f.name: float(f"{f.value:.5g}") for f in found}
        asked = {f.name: f.asked for f in found if f.asked}
        head = {"day": date.today().isoformat(), "machine": here}
        LAST.write_text(json.dumps(head | {"figures": values, "asked": asked}, indent=1) + "\n")
