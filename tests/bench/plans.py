"""What one S-curve costs, by scurve and by ruckig, on the same random moves: counted and timed.

`plans.py KIND PLANNER COUNT` plans so many moves; that process is what is counted.
"""

import sys
import time
from collections.abc import Callable

import counting
import marks
import numpy as np
import ruckig
import scurve_moves as moves
from medians import Medians

DRAWN = 2_000  # moves, which a process plans again and again
COUNTS = (DRAWN, 31 * DRAWN)
KINDS = {"rest to rest": moves.rest_to_rest, "in motion to rest": moves.to_rest}


Planner = Callable[[], object]  # plans all moves that were drawn


def _scurve(drawn: np.ndarray) -> Planner:
    return lambda: moves.scurve_totals(drawn)


def _ruckig(drawn: np.ndarray, enabled: bool = True) -> Planner:
    """Moves calculated by ruckig, called from Python; its only axis can be switched off."""
    inputs = [moves.ruckig_input(move) for move in drawn.tolist()]
    for told in inputs:
        told.enabled = [enabled]
    run, plan = ruckig.Ruckig(1).calculate, ruckig.Trajectory(1)

    def all_of_them() -> None:
        for told in inputs:
            run(told, plan)

    return all_of_them


PLANNERS: dict[str, Callable[[np.ndarray], Planner]] = {
    "scurve": _scurve,
    "ruckig": _ruckig,
    "call": lambda drawn: _ruckig(drawn, enabled=False),  # what Python's call of ruckig costs
}


def _drawn(kind: str) -> np.ndarray:
    drawn = KINDS[kind](2 * DRAWN, np.random.default_rng(1))
    return drawn[np.isfinite(moves.ruckig_totals(drawn))][:DRAWN]


class Plans:
    """Cost of one plan by each of `PLANNERS`: processor time [s], and instructions.

    "call" is subtracted from "ruckig". ruckig's check of its input goes with it, that of scurve
    counts.
    """

    def __init__(self, name: str) -> None:
        self.name, self._times = name, Medians()
        drawn = _drawn(name)
        self._planned = {planner: of(drawn) for planner, of in PLANNERS.items()}

    def __call__(self) -> None:
        for planner, plan in self._planned.items():
            start = time.process_time()
            plan()
            self._times.add(planner, (time.process_time() - start) / DRAWN)

    def loops(self) -> list[counting.Loop]:
        """What is to be counted."""
        line = [sys.executable, counting.PLANS, self.name]
        return [counting.Loop(f"{self.name}, {p}", [*line, p, "{}"], COUNTS) for p in PLANNERS]

    def counted(self, counts: dict[str, counting.Loop]) -> tuple[float, float, float]:
        """Instructions of a plan by scurve, by ruckig without its call, and of that call."""
        scurve, found, call = (counts[f"{self.name}, {p}"].count for p in PLANNERS)
        return scurve, found - call, call

    def ratio(self, counts: dict[str, counting.Loop]) -> float:
        """Instructions of ruckig over those of scurve."""
        scurve, found, _ = self.counted(counts)
        return found / scurve

    def row(self, counts: dict[str, counting.Loop]) -> str:
        """Instructions and times."""
        counted = "".join(f"{n:10.0f}" for n in self.counted(counts))
        scurve, found, call = (self._times[p] * 1e9 for p in PLANNERS)
        return (
            f"{self.name:28}{counted}{self.ratio(counts):10.2f}{scurve:12.0f}{found - call:10.0f}"
        )


def table(plans: list[Plans], counts: dict[str, counting.Loop]) -> None:
    """Cost of a plan beside ruckig's."""
    counted = f"{'scurve':>10}{'ruckig':>10}{'its call':>10}{'x scurve':>10}"
    print(f"\n{'one S-curve, instructions':28}{counted}{'scurve, ns':>12}{'ruckig':>10}")
    for p in plans:
        print(p.row(counts))


def _main(kind: str, planner: str, count: int) -> None:
    plan = PLANNERS[planner](_drawn(kind))
    marks.begin()
    for _ in range(count // DRAWN):
        plan()
    marks.end()


if __name__ == "__main__":
    _main(sys.argv[1], sys.argv[2], int(sys.argv[3]))
