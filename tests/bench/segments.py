"""What a short segment costs by look-ahead, against the number of commands in the ring."""

import subprocess
from dataclasses import dataclass, field
from pathlib import Path

import numpy as np

PROGRAM = Path(__file__).resolve().parents[2] / "build/tests/bench/lookahead_cost"
FILLINGS = (16, 64, 256)  # commands


@dataclass
class Segments:
    """Processor time per segment [s] at each filling, best of all rounds."""

    name: str
    ramps: str  # T or S
    dda_time: float  # [ms]
    jerk: float | None = None  # [mm/s^3] of each axis of a curve, 0 no limit; None: no curve
    cost: dict[int, float] = field(default_factory=lambda: dict.fromkeys(FILLINGS, np.inf))
    points: float = 0.0  # made per segment

    def __call__(self) -> None:
        for filling in FILLINGS:
            line = [PROGRAM, str(filling), str(self.dda_time), self.ramps]
            line += [] if self.jerk is None else [str(self.jerk)]
            cost, points = map(float, subprocess.check_output(line, text=True).split())
            self.cost[filling], self.points = min(self.cost[filling], cost), points

    @property
    def growth(self) -> float:
        """Cost with the fullest ring over that with the emptiest."""
        return self.cost[FILLINGS[-1]] / self.cost[FILLINGS[0]]


# One point a segment, and a tenth to a fifth of that.
ALL = (
    Segments("T ramps", "T", 2.5),
    Segments("T ramps, planning alone", "T", 10.0),
    Segments("S ramps", "S", 6.5),
    Segments("S ramps, planning alone", "S", 26.0),
    Segments("curve, T", "T", 1.5, 0.0),
    Segments("curve, T, planning alone", "T", 15.0, 0.0),
    Segments("curve, S", "T", 1.5, 50000.0),
    Segments("curve, S, planning alone", "T", 15.0, 50000.0),
)


def table(ruckig: float) -> None:
    """Cost of a segment beside that of a rest-to-rest move by ruckig [s]."""
    heads = "".join(f"{f:>10}" for f in FILLINGS)
    heads += f"{'points':>9}{'ruckig/it':>11}{'million/s':>11}"
    print(f"\n{'one segment, ns; commands in ring':34}{heads}")
    for s in ALL:
        figures = "".join(f"{s.cost[f] * 1e9:10.0f}" for f in FILLINGS)
        print(
            f"  {s.name:32}{figures}{s.points:9.2f}{ruckig / s.cost[FILLINGS[-1]]:11.2f}"
            f"{1e-6 / s.cost[FILLINGS[-1]]:11.2f}"
        )
