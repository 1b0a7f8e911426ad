"""Simulated time against the clock on the wall."""

import math
import time
from collections.abc import Callable
from dataclasses import dataclass, field

# A machine that is later than this gives up what it has missed, so that it does not race [s].
_GIVEN_UP = 0.2
SLOWEST, QUICKEST = 0.01, 100.0


@dataclass
class Lateness:
    """How late the machine was woken: times are in [s].

    `counts` are wake-ups later than 2^(k-1) and not later than 2^k ms/64, for k = 0, 1, ...
    """

    woken: int = 0
    worst: float = 0.0
    given_up: float = 0.0  # was not made up for
    counts: list[int] = field(default_factory=lambda: [0] * 16)

    def add(self, late: float) -> None:
        """Count a wake-up."""
        self.woken += 1
        self.worst = max(self.worst, late)
        units = max(late, 0.0) * 64e3
        k = 0 if units <= 1.0 else math.ceil(math.log2(units))
        self.counts[min(k, len(self.counts) - 1)] += 1

    def below(self, share: float) -> float:
        """The end [s] of the class below which so large a share of the wake-ups lies."""
        total = 0
        for k, count in enumerate(self.counts):
            total += count
            if total >= share * self.woken:
                return min(2.0**k / 64e3, self.worst) if self.woken else 0.0
        return self.worst


@dataclass
class Pace:
    """Simulated seconds for each second on the wall.

    Attributes
    ----------
    factor : float
        0.01 to 100, or infinite: as fast as it goes.
    clock, sleep : callable
        The wall's, to be replaced in tests.
    lateness : Lateness
    """

    factor: float = 1.0
    clock: Callable[[], float] = time.perf_counter
    sleep: Callable[[float], None] = time.sleep
    lateness: Lateness = field(default_factory=Lateness)
    _begun: tuple[float, float] | None = None  # wall and simulated time at which they were equal

    def set(self, factor: float) -> None:
        """Go on at another pace.

        Parameters
        ----------
        factor : float

        Raises
        ------
        ValueError
            It is not 0.01 to 100, nor infinite.
        """
        if factor != math.inf and not SLOWEST <= factor <= QUICKEST:
            raise ValueError(f"pace {factor:g}: {SLOWEST:g} to {QUICKEST:g}, or inf")
        self.factor = factor
        self.halt()

    def halt(self) -> None:
        """Forget when it began: a pause, another pace, another state."""
        self._begun = None

    def wait(self, simulated: float) -> None:
        """Wait until it is time to go on from a simulated time.

        Parameters
        ----------
        simulated : float
            [s].
        """
        if self.factor == math.inf:
            return
        now = self.clock()
        if self._begun is None:
            self._begun = now, simulated
            return
        wall, begun = self._begun
        due = wall + (simulated - begun) / self.factor
        if due > now:
            self.sleep(due - now)
            now = self.clock()
        late = now - due
        self.lateness.add(late)
        if late > _GIVEN_UP:
            self.lateness.given_up += late
            self._begun = now, simulated
