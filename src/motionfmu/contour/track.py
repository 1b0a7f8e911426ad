"""A position followed along the exact path."""

from dataclasses import dataclass

from motionfmu.contour.assign import Index
from motionfmu.contour.geometry import Array


@dataclass(frozen=True)
class Track:
    """Nearest points of some samples on the path."""

    segment: Index  # (n,) index; never decreases
    along: Array  # (n,) way along the whole path [mm]
    foot: Array  # (n, 3) nearest points [mm]
    distance: Array  # (n,) to them [mm]
    # (n,) the same, negative to the right of the direction of travel; None for a path in space
    signed: Array | None
