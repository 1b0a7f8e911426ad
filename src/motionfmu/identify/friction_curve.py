"""Friction as a curve over speed, before any law of it."""

import itertools
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
# Bins of each direction, and the fewest points of one that is shown.
_BINS, _FEWEST = 24, 4


@dataclass(frozen=True)
class FrictionCurve:
    """Drive less what accelerates the axis, over speed; bins of each direction."""

    speed: Array  # (n,) mean of a bin
    drive: Array  # (n,) mean
    scatter: Array  # (n,) standard deviation of the drive
    law: Array  # (n,) what the law found gives there
    units: tuple[str, str]  # of speed and drive


def friction_curve(speed: Array, drive: Array, law: Array, units: tuple[str, str]) -> FrictionCurve:
    """Bin the drive that is left at uniform motion, and the law's beside it, over speed."""
    rows = []
    most = float(np.abs(speed).max(initial=0.0))
    edges = np.linspace(0.0, most * (1.0 + 1e-12), _BINS + 1)
    for sign in (-1.0, 1.0):
        for low, high in itertools.pairwise(edges):
            there = (sign * speed > low) & (sign * speed <= high)
            if there.sum() >= _FEWEST:
                values = (a[there] for a in (speed, drive, law))
                v, d, own = (a.mean() for a in values)
                rows.append((v, d, drive[there].std(), own))
    rows.sort()
    columns = np.array(rows, dtype=np.float64).reshape(-1, 4).T
    return FrictionCurve(columns[0], columns[1], columns[2], columns[3], units)
