"""What is measured once a round, and the median of its rounds, which is the figure of a line."""

import statistics
from collections.abc import Hashable


class Medians:
    """Values by what they are of; read, each is the median of those that were added.

    The best round of a busy machine is a matter of luck, and a mean has the worst round in it.
    """

    def __init__(self) -> None:
        self._rounds: dict[Hashable, list[float]] = {}

    def add(self, what: Hashable, value: float) -> None:
        """Keep the value of a round."""
        self._rounds.setdefault(what, []).append(value)

    def __getitem__(self, what: Hashable) -> float:
        return statistics.median(self._rounds[what])
