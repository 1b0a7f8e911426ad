"""Size of an error and where it is largest."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.contour.geometry import Array
from motionfmu.contour.path import Path
from motionfmu.contour.track import Track


@dataclass(frozen=True)
class Statistics:
    """Size of an error over many samples: its magnitude [mm], and where it is largest."""

    max: float
    rms: float
    mean: float
    p50: float
    p95: float
    p99: float
    time: float  # when it is largest [s]
    line: int  # of the program, and command, where it is largest
    command: int
    point: tuple[float, float, float]  # of the path where it is largest [mm]


def statistics(path: Path, time: Array, track: Track, chosen: NDArray[np.bool_]) -> Statistics:
    """Statistics of the distance over chosen samples, one at least."""
    size = track.distance[chosen]
    worst = int(np.flatnonzero(chosen)[np.argmax(size)])
    label = path.segments[int(track.segment[worst])].label
    p50, p95, p99 = (float(p) for p in np.percentile(size, [50.0, 95.0, 99.0]))
    x, y, z = (float(c) for c in track.foot[worst])
    return Statistics(
        max=float(size.max()),
        rms=float(np.sqrt(np.mean(size**2))),
        mean=float(size.mean()),
        p50=p50,
        p95=p95,
        p99=p99,
        time=float(time[worst]),
        line=label.line,
        command=label.command,
        point=(x, y, z),
    )
