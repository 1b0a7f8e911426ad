"""Work in a process that has its modules: a demo tuned, and short runs of it."""

import time
from pathlib import Path

from medians import Medians

import motionfmu
import motionfmu.study.tune
from motionfmu.run.session import Session

DEMO = Path(__file__).resolve().parents[2] / "scenarios/circle"
STEPS, RUNS = 100, 40


class Tuning:
    """The demo tuned: processor time [s]."""

    def __init__(self) -> None:
        self._rounds = Medians()

    def __call__(self) -> None:
        start = time.process_time()
        motionfmu.study.tune.tune(DEMO)
        self._rounds.add("tune", time.process_time() - start)

    @property
    def seconds(self) -> float:
        return self._rounds["tune"]


class ShortRun:
    """A run of 100 steps of the demo in a session, each with another gain: processor time [s]."""

    def __init__(self) -> None:
        scenario = motionfmu.load(DEMO)
        stop = round(STEPS * scenario.document.body.step, 9)
        self._session = Session(scenario, ["mcc.p_gain"], stop=stop)
        self._rounds = Medians()

    def __call__(self) -> None:
        start = time.process_time()
        for gain in range(100, 100 + RUNS):
            ran = self._session.run({"mcc.p_gain": gain})
            assert len(ran.time) == STEPS
        self._rounds.add("run", (time.process_time() - start) / RUNS)

    @property
    def seconds(self) -> float:
        return self._rounds["run"]
