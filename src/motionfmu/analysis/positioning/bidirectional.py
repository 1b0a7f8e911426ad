"""Accuracy and repeatability of positioning one axis (ISO 230-2:2014)."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Coverage factor of an uncertainty: two standard deviations to either side.
COVERAGE = 2.0


@dataclass(frozen=True)
class PositioningTest:
    """Deviations of an axis at targets approached from both sides.

    All lengths have one unit, for a linear axis mm, for a rotary one degrees. The definitions are
    those of ISO 230-2:2014, clause 3.

    Attributes
    ----------
    targets : ndarray, shape (m,)
        Target positions, ascending.
    up, down : ndarray, shape (n, m)
        Actual position less target of each approach in positive and in negative direction;
        ISO 230-2 wants five.

    Raises
    ------
    ValueError
        The shapes do not fit each other, or there are fewer than two approaches.
    """

    targets: Array
    up: Array
    down: Array

    def __post_init__(self) -> None:
        shape = self.up.shape
        if self.up.ndim != 2 or shape != self.down.shape or self.targets.shape != shape[1:]:
            told = f"targets {self.targets.shape}, up {shape}, down {self.down.shape}"
            raise ValueError(f"{told}: (m,), (n, m) and (n, m) wanted")
        if shape[0] < 2 or shape[1] < 1:
            raise ValueError(f"{shape[0]} approaches of {shape[1]} targets: two and one at least")

    @cached_property
    def means(self) -> tuple[Array, Array]:
        """Mean unidirectional deviations, up and down (m,)."""
        return self.up.mean(axis=0), self.down.mean(axis=0)

    @cached_property
    def spreads(self) -> tuple[Array, Array]:
        """Estimators of the standard deviation, up and down (m,)."""
        return self.up.std(axis=0, ddof=1), self.down.std(axis=0, ddof=1)

    @property
    def reversals(self) -> Array:
        """Reversal value of each target (m,)."""
        return self.means[0] - self.means[1]

    @property
    def repeatabilities(self) -> Array:
        """Bidirectional repeatability at each target (m,)."""
        up, down = (2.0 * COVERAGE * s for s in self.spreads)
        return np.maximum(0.5 * (up + down) + np.abs(self.reversals), np.maximum(up, down))

    def figures(self) -> dict[str, float]:
        """The figures of the axis, in the unit of the deviations.

        Returns
        -------
        dict
            A: bidirectional accuracy; E: bidirectional systematic deviation; R: bidirectional
            repeatability; B, B_mean: reversal value and its mean; M: range of the mean
            bidirectional deviation; A, E and R with _up and _down are those of one direction.
        """
        (up, down), (s_up, s_down) = self.means, self.spreads
        found = {
            "A": _range(np.concatenate([up, down]), COVERAGE * np.concatenate([s_up, s_down])),
            "E": float(np.ptp([up, down])),
            "R": float(self.repeatabilities.max()),
            "B": float(np.abs(self.reversals).max()),
            "B_mean": float(self.reversals.mean()),
            "M": float(np.ptp(0.5 * (up + down))),
        }
        for name, mean, spread in (("up", up, s_up), ("down", down, s_down)):
            found[f"A_{name}"] = _range(mean, COVERAGE * spread)
            found[f"E_{name}"] = float(np.ptp(mean))
            found[f"R_{name}"] = float(2.0 * COVERAGE * spread.max())
        return found


def _range(mean: Array, half: Array) -> float:
    """From the lowest to the highest end of means with half a width each."""
    return float(np.max(mean + half) - np.min(mean - half))
