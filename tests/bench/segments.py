"""What a short segment costs by look-ahead, against the number of commands in the ring."""

import subprocess
from dataclasses import dataclass, field
from pathlib import Path

from medians import Medians

PROGRAM = Path(__file__).resolve().parents[2] / "build/tests/bench/lookahead_cost"
FILLINGS = (16, 64, 256)  # commands
LENGTHS = (1_000, 10_000, 100_000)  # segments of a walk


@dataclass
class Segments:
    """Processor time per segment [s] at each filling."""

    name: str
    ramps: str  # T or S
    dda_time: float  # [ms]
    jerk: float | None = None  # [mm/s^3] of each axis of a curve, 0 no limit; None: no curve
    cost: Medians = field(default_factory=Medians)
    points: float = 0.0  # made per segment

    def __call__(self) -> None:
        for filling in FILLINGS:
            cost, self.points = self.run(filling)
            self.cost.add(filling, cost)

    def run(self, filling: int, *more: int) -> tuple[float, float]:
        """Time per segment [s], points per segment; `more`: how many segments."""
        line = [str(PROGRAM), str(filling), str(self.dda_time), self.ramps]
        line += [] if self.jerk is None else [str(self.jerk)]
        words = subprocess.check_output([*line, *map(str, more)], text=True).split()
        return float(words[0]), float(words[1])

    @property
    def rate(self) -> float:
        """Million segments/s at the slowest filling."""
        return 1e-6 / max(self.cost[f] for f in FILLINGS)

    @property
    def growth(self) -> float:
        """Cost with the fullest ring over that with the emptiest."""
        return self.cost[FILLINGS[-1]] / self.cost[FILLINGS[0]]


@dataclass
class Lengths:
    """Processor time per segment [s] of walks of a curve."""

    walk: Segments
    cost: Medians = field(default_factory=Medians)

    def __call__(self) -> None:
        for length in LENGTHS:
            self.cost.add(length, self.walk.run(FILLINGS[-1], length)[0])

    @property
    def growth(self) -> float:
        """Cost of a segment of the longest walk over that of the shortest."""
        return self.cost[LENGTHS[-1]] / self.cost[LENGTHS[0]]


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
LONG = Lengths(ALL[5])


def table() -> None:
    """Cost of a segment."""
    heads = "".join(f"{f:>10}" for f in FILLINGS)
    heads += f"{'points':>9}{'million/s':>11}"
    print(f"\n{'one segment, ns; commands in ring':34}{heads}")
    for s in ALL:
        figures = "".join(f"{s.cost[f] * 1e9:10.0f}" for f in FILLINGS)
        print(f"  {s.name:32}{figures}{s.points:9.2f}{1e-6 / s.cost[FILLINGS[-1]]:11.2f}")
    heads = "".join(f"{n:>10}" for n in LENGTHS)
    print(f"\n{'one segment, ns; segments in all':34}{heads}")
    print(f"  {LONG.walk.name:32}{''.join(f'{LONG.cost[n] * 1e9:10.0f}' for n in LENGTHS)}")
