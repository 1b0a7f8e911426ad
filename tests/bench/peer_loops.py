"""Frequency responses and margins of the demo's loops by python-control, beside ours."""

import time
from collections.abc import Callable
from pathlib import Path

import control
import numpy as np
from medians import Medians
from peers import ROUNDS, Row, agree

from motionfmu.analysis import linear
from motionfmu.analysis.linear.loops import feedbacks
from motionfmu.analysis.linear.stability import grid, margins, response

DEMO = Path(__file__).resolve().parents[2] / "scenarios/circle"
AT = {"machine.motor_speed": 30.0}  # [rad/s] beyond friction that sticks
EQUAL, FOUND = 1e-9, 1e-5  # of a response, of margins, which both search between frequencies
TURNS = 10


def _taken(act: Callable[..., object], *arguments: object) -> float:
    """Processor time of a call, mean of some turns [s]."""
    start = time.process_time()
    for _ in range(TURNS):
        act(*arguments)
    return (time.process_time() - start) / TURNS


def _their_margins(loop: control.StateSpace, omega: np.ndarray) -> object:
    """Margins by python-control from a response at some frequencies."""
    return control.stability_margins(control.frequency_response(loop, omega))


class Rows:
    """Processor time of the responses and margins of each loop [ms].

    python-control finds margins from a response: from a system of nine states its polynomials are
    too coarse, which it tells itself.
    """

    def __init__(self) -> None:
        self.missing: list[str] = []
        self._rounds = Medians()
        model = linear.model(DEMO, 1, AT)
        self._loops = {at: model.loop(at, cut) for at, cut in feedbacks(model).items()}
        for at, loop in self._loops.items():
            omega = grid(loop)
            theirs = control.frequency_response(loop, omega)
            gap = np.abs(np.ravel(theirs.complex) / response(loop, omega) - 1.0).max()
            agree(f"response at {at}", gap < EQUAL, f"by {gap:.1e}")
            found, (gain, phase, distance, *_) = margins(loop), control.stability_margins(theirs)
            pairs = ((found.gain, gain), (found.phase, phase), (found.sensitivity, 1.0 / distance))
            gap = max(abs(a / b - 1.0) for a, b in pairs)
            agree(f"margins at {at}", gap < FOUND, f"by {gap:.1e}")

    def __call__(self) -> None:
        for at, loop in self._loops.items():
            omega = grid(loop)
            for what, act, arguments in (
                ("response", response, (loop, omega)),
                ("their response", control.frequency_response, (loop, omega)),
                ("margins", margins, (loop,)),
                ("their margins", _their_margins, (loop, omega)),
            ):
                self._rounds.add((what, at), _taken(act, *arguments))

    def rows(self) -> list[Row]:
        """Two rows for each loop."""
        tool = f"python-control {control.__version__}"
        told = {
            "response": "response of the loop at {} at {} frequencies",
            "margins": "margins of the loop at {} from {} frequencies",
        }
        return [
            Row(
                text.format(at, f"{len(grid(loop)):,}"),
                "ms",
                tool,
                1e3 * self._rounds[what, at],
                1e3 * self._rounds[f"their {what}", at],
                ROUNDS,
            )
            for at, loop in self._loops.items()
            for what, text in told.items()
        ]
