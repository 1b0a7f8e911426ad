"""Time of an identification after its imports, of records of a simulated axis."""

import time

import numpy as np
from axis_truth import COLUMNS, PERIOD, drawn, moves, simulated
from medians import Medians

from motionfmu.identify import IdentifyOptions, identify

SEED, NOISE = 4, 0.01  # of the machine; of the torque, as a share of its RMS
FOUR = ("table_mass", "table_coulomb", "table_viscous", "force")
EIGHT = (
    *FOUR,
    *("table_viscous_asymmetry", "motor_viscous", "screw_damping", "screw_stiffness"),
)


class Identifying:
    """Quantities found from a record of so many samples: processor time [s]."""

    def __init__(self, samples: int, free: tuple[str, ...], most: float) -> None:
        self.samples, self.free, self.most = samples, free, most
        self.truth, _, (speed, acceleration) = drawn(SEED)
        rng = np.random.default_rng(samples)
        command = moves(rng, (samples - 1) * PERIOD, speed, acceleration)
        self.record = simulated(self.truth, command, rng, NOISE)
        self._rounds = Medians()
        self._identified()  # what is compiled is made

    def _identified(self) -> float:
        asked = IdentifyOptions(COLUMNS, free=self.free, laws=[])
        start = time.process_time()
        identify(self.truth.scenario(), self.record, asked)
        return time.process_time() - start

    def __call__(self) -> None:
        self._rounds.add("identify", self._identified())

    @property
    def seconds(self) -> float:
        return self._rounds["identify"]

    @property
    def name(self) -> str:
        """The line of the table."""
        return f"identify, {self.samples:,} samples, {len(self.free)} quantities, s"


def all_records() -> list[Identifying]:
    """Each of the sizes that are asked for."""
    return [Identifying(6_240, FOUR, 3.0), Identifying(25_000, EIGHT, 15.0)]
