"""Input of the analysis: recorded cycles, and options of their evaluation."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.iso9283.command_path import CommandPath
from motionfmu.analysis.iso9283.turn import Array

PLANES = 200
CORNER = 1.0  # [mm] planes turn at a corner: ISO 9283 looks at cornering by itself
RAMP = 0.5  # share of the speed below which either end of a cycle is a ramp, as in ISO 9283


@dataclass(frozen=True)
class Cycle:
    """One run along the command path.

    Attributes
    ----------
    time : ndarray, shape (n,)
        [s], increasing.
    position : ndarray, shape (n, 3)
        Tool [mm].
    quaternion : ndarray, shape (n, 4), optional
        Orientation of the tool, (w, x, y, z).
    """

    time: Array
    position: Array
    quaternion: Array | None = None

    def __post_init__(self) -> None:
        count = len(self.time)
        if count < 2 or not (np.diff(self.time) > 0.0).all():
            raise ValueError("the times of a cycle must be two or more and increase")
        if self.position.shape != (count, 3):
            raise ValueError(f"position is {self.position.shape} instead of {(count, 3)}")
        if not np.isfinite(self.position).all():
            raise ValueError("a position is not finite")
        if self.quaternion is not None and self.quaternion.shape != (count, 4):
            raise ValueError(f"quaternion is {self.quaternion.shape} instead of {(count, 4)}")


@dataclass(frozen=True)
class Cycles:
    """Cycles along one command path, and how they are looked at.

    Attributes
    ----------
    cycles : sequence of Cycle
        One or more; ISO 9283 wants ten.
    path : CommandPath
    speed : float, optional
        Commanded speed [mm/s]; without it AV, RV and FV are not given.
    normal : ndarray, shape (3,), optional
        Normal of the surface that is drawn on; in-plane is across the path in that surface,
        height along the normal.
    pen_width : float
        Width of a painted stroke [mm].
    planes : int
        Number of planes across the path, evenly along what is evaluated.
    ramp : float
        Part of the speed (commanded, else the median) below which the start and the end of a cycle
        are ramps and left out; 0 leaves nothing out.
    corner : float
        Length that is left out to either side of a corner of the path of more than 10 degrees [mm].
    """

    cycles: Sequence[Cycle]
    path: CommandPath
    speed: float | None = None
    normal: Array | None = None
    pen_width: float = 0.0
    planes: int = PLANES
    ramp: float = RAMP
    corner: float = CORNER

    def __post_init__(self) -> None:
        if not self.cycles:
            raise ValueError("there is no cycle")
        if self.planes < 2:
            raise ValueError(f"planes = {self.planes}: two or more wanted")
        if not 0.0 <= self.ramp < 1.0:
            raise ValueError(f"ramp = {self.ramp:g}: 0 or more and less than 1 wanted")
        if self.speed is not None and not self.speed > 0.0:
            raise ValueError(f"speed = {self.speed:g} mm/s: more than 0 wanted")
        if self.normal is not None and not np.linalg.norm(self.normal) > 0.0:
            raise ValueError("the normal has no length")
        if self.pen_width < 0.0 or self.corner < 0.0:
            raise ValueError("a width is negative")

    @classmethod
    def of(cls, positions: Sequence[Array], path: CommandPath, period: float) -> "Cycles":
        """Make cycles of arrays sampled with one period.

        Parameters
        ----------
        positions : sequence of ndarray, or ndarray, shape (runs, n, 3)
            Tool of each run [mm]; runs may differ in length.
        path : CommandPath
        period : float
            Time between two samples [s].
        """
        times = [np.arange(len(p), dtype=np.float64) * period for p in positions]
        return cls(
            [Cycle(t, np.asarray(p, np.float64)) for t, p in zip(times, positions, strict=True)],
            path,
        )
