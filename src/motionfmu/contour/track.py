"""A position followed along the exact path."""

from dataclasses import dataclass

from motionfmu.contour.assign import Index
from motionfmu.contour.geometry import Array


@dataclass(frozen=True)
class Track:
    """Nearest points of some samples on the path.

    Attributes
    ----------
    segment : ndarray of int, shape (n,)
        Index of the segment; never decreases.
    along : ndarray, shape (n,)
        Way along the whole path [mm].
    foot : ndarray, shape (n, 3)
        Nearest points [mm].
    distance : ndarray, shape (n,)
        Distance to them [mm].
    signed : ndarray, shape (n,), optional
        The same, negative to the right of the direction of travel; None for a path in space.
    """

    segment: Index
    along: Array
    foot: Array
    distance: Array
    signed: Array | None
