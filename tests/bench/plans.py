"""What one S-curve costs, by scurve and by ruckig, in turns on the same random moves."""

import time
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import ruckig
import scurve_moves as moves

COUNT = 10_000


@dataclass
class Plans:
    """Seconds of one plan, mean of many random moves, best of all rounds.

    Python's call of ruckig is measured, too, by calling it with its only axis switched off, and
    subtracted. ruckig's check of its input goes with it, that of scurve counts.
    """

    name: str
    draw: Callable[[int, np.random.Generator], np.ndarray]
    scurve: float = np.inf
    loop: float = np.inf  # ruckig with its call
    call: float = np.inf

    def __post_init__(self) -> None:
        drawn = self.draw(COUNT, np.random.default_rng(1))
        self.moves = drawn[np.isfinite(moves.ruckig_totals(drawn))]
        self.inputs = [moves.ruckig_input(move) for move in self.moves.tolist()]
        self.calls = [moves.ruckig_input(move) for move in self.moves.tolist()]
        for told in self.calls:
            told.enabled = [False]

    def __call__(self) -> None:
        start = time.perf_counter()
        moves.scurve_totals(self.moves)
        self.scurve = min(self.scurve, (time.perf_counter() - start) / len(self.moves))
        self.loop = min(self.loop, calculate(self.inputs))
        self.call = min(self.call, calculate(self.calls))

    @property
    def ruckig(self) -> float:
        """ruckig without its call."""
        return self.loop - self.call


def calculate(inputs: list[ruckig.InputParameter]) -> float:
    """Seconds of one calculation by ruckig, called from Python."""
    run, plan = ruckig.Ruckig(1).calculate, ruckig.Trajectory(1)
    start = time.perf_counter()
    for told in inputs:
        run(told, plan)
    return (time.perf_counter() - start) / len(inputs)


def table(plans: list[Plans]) -> None:
    """Cost of a plan beside ruckig's."""
    print(f"\n{'one S-curve, ns':28}{'scurve':>10}{'ruckig':>10}{'its call':>10}{'x scurve':>10}")
    for p in plans:
        figures = "".join(f"{t * 1e9:10.0f}" for t in (p.scurve, p.ruckig, p.call))
        print(f"{p.name:28}{figures}{p.ruckig / p.scurve:10.2f}")
