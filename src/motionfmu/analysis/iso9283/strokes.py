"""How far pen lines of several runs coincide, as lines and as painted strokes."""

from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.iso9283.turn import Array


@dataclass(frozen=True)
class Strokes:
    """Coincidence of pen lines, each figure that of the worst plane.

    Attributes
    ----------
    lines : float
        Largest distance between two centre lines [mm].
    band : float
        Width of what all runs paint together [mm]: lines plus the width of the pen.
    gap : float
        Largest white gap between two neighbouring strokes [mm]; 0 where all overlap.
    common : float
        Least width that every run paints, as a part of the pen's; 1: the strokes coincide, 0: some
        place is not painted by all.
    place : int
        Plane at which the lines are farthest apart.
    """

    lines: float
    band: float
    gap: float
    common: float
    place: int


def coincidence(offsets: Array, width: float = 0.0) -> Strokes:
    """How far the pen lines of several runs coincide.

    Parameters
    ----------
    offsets : ndarray, shape (runs, planes)
        Place of each centre line across the path, in the surface drawn on [mm].
    width : float
        Of a painted stroke [mm]; 0: lines without width, which have nothing in common.
    """
    ordered = np.sort(np.asarray(offsets, dtype=np.float64), axis=0)
    apart = ordered[-1] - ordered[0]
    place = int(np.argmax(apart))
    steps = np.diff(ordered, axis=0)
    gap = float((steps - width).max()) if len(steps) else 0.0
    largest = float(apart[place])
    common = max(0.0, 1.0 - largest / width) if width > 0.0 else 0.0
    return Strokes(largest, largest + width, max(0.0, gap), common, place)
