"""What one S-curve costs, by scurve and by ruckig, in turns on the same random moves."""

import time
from collections.abc import Callable

import numpy as np
import ruckig
import scurve_moves as moves
from medians import Medians

COUNT = 10_000
BLOCK = 500  # moves that each plans before the next one's turn


class Plans:
    """Processor time of one plan [s], mean of a block of random moves.

    Python's call of ruckig is measured, too, by calling it with its only axis switched off, and
    subtracted, block by block. ruckig's check of its input goes with it, that of scurve counts.
    """

    def __init__(self, name: str, draw: Callable[[int, np.random.Generator], np.ndarray]) -> None:
        self.name, self._blocks = name, Medians()
        drawn = draw(COUNT, np.random.default_rng(1))
        drawn = drawn[np.isfinite(moves.ruckig_totals(drawn))]
        self._moves = [drawn[k : k + BLOCK] for k in range(0, len(drawn) - BLOCK + 1, BLOCK)]
        self._inputs = [_inputs(block) for block in self._moves]
        self._calls = [_inputs(block) for block in self._moves]
        for told in (told for block in self._calls for told in block):
            told.enabled = [False]

    def __call__(self) -> None:
        for drawn, inputs, calls in zip(self._moves, self._inputs, self._calls, strict=True):
            start = time.process_time()
            moves.scurve_totals(drawn)
            scurve = (time.process_time() - start) / BLOCK
            loop, call = _calculate(inputs), _calculate(calls)
            for what, found in (
                ("scurve", scurve),
                ("call", call),
                ("ruckig", loop - call),
                ("ratio", (loop - call) / scurve),
            ):
                self._blocks.add(what, found)

    @property
    def scurve(self) -> float:
        return self._blocks["scurve"]

    @property
    def ruckig(self) -> float:
        """Without its call."""
        return self._blocks["ruckig"]

    @property
    def ratio(self) -> float:
        """ruckig over scurve, of the same moves one behind the other."""
        return self._blocks["ratio"]

    @property
    def call(self) -> float:
        return self._blocks["call"]


def _inputs(drawn: np.ndarray) -> list[ruckig.InputParameter]:
    return [moves.ruckig_input(move) for move in drawn.tolist()]


def _calculate(inputs: list[ruckig.InputParameter]) -> float:
    """Processor time of one calculation by ruckig, called from Python [s]."""
    run, plan = ruckig.Ruckig(1).calculate, ruckig.Trajectory(1)
    start = time.process_time()
    for told in inputs:
        run(told, plan)
    return (time.process_time() - start) / len(inputs)


def table(plans: list[Plans]) -> None:
    """Cost of a plan beside ruckig's."""
    print(f"\n{'one S-curve, ns':28}{'scurve':>10}{'ruckig':>10}{'its call':>10}{'x scurve':>10}")
    for p in plans:
        figures = "".join(f"{t * 1e9:10.0f}" for t in (p.scurve, p.ruckig, p.call))
        print(f"{p.name:28}{figures}{p.ratio:10.2f}")
