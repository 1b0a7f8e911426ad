"""Size of an error and where it is largest."""

import math

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.arcs import Array
from motionfmu.analysis.contour.kinds import Statistics
from motionfmu.analysis.contour.order import quantiles
from motionfmu.analysis.contour.path import Path
from motionfmu.analysis.contour.track import Track


def statistics(path: Path, time: Array, track: Track, chosen: NDArray[np.bool_]) -> Statistics:
    """Statistics of the distance over chosen samples, one at least."""
    rows = np.flatnonzero(chosen)
    size = track.distance[rows]
    worst = int(rows[np.argmax(size)])
    x, y, z = track.feet(np.array([worst]))[0].tolist()
    mean, square = float(size.mean()), float(np.einsum("i,i->", size, size))
    top = float(size.max())
    own = int(track.segment[worst])
    p50, p95, p99 = quantiles(size, (0.5, 0.95, 0.99))
    return Statistics(
        max=top,
        rms=math.sqrt(square / len(size)),
        mean=mean,
        p50=p50,
        p95=p95,
        p99=p99,
        time=float(time[worst]),
        line=int(path.lines[own]),
        command=int(path.commands[own]),
        point=(x, y, z),
    )
