"""The answer of a closed loop to a step."""

import math

import control
import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear.stability import Margins, closed_poles, moving

Array = NDArray[np.float64]
# A chart looks at so many inverses of the bandwidth; without one at so many samples.
_SPAN, _NO_BANDWIDTH = 30.0, 500
# A slow end counts until it has died away by this power of e, and as so many times a chart.
_DIED, _LONGEST = 7.0, 20.0
_FEWEST, _MOST = 20, 200_000  # samples


def chart_length(loop: control.StateSpace, found: Margins) -> float:
    """How long a chart of the step looks [s]."""
    return float(_SPAN / found.bandwidth if found.bandwidth > 0.0 else _NO_BANDWIDTH * loop.dt)


def settling_length(loop: control.StateSpace, found: Margins) -> float:
    """How long the answer of a stable loop is to be looked at for its figures [s]."""
    usual = chart_length(loop, found)
    slow = float(np.abs(moving(closed_poles(loop))).max(initial=1e-3))
    end = _DIED / -math.log(slow) * loop.dt if slow < 1.0 else math.inf
    return float(min(max(usual, end), _LONGEST * usual))


def closed_step(loop: control.StateSpace, length: float) -> tuple[Array, Array]:
    """Times since a step [s] and the answer L/(1 + L) there, of an open loop L."""
    k = 1.0 / (1.0 + loop.D[0, 0])
    a = loop.A - loop.B @ loop.C * k
    b, c, d = loop.B[:, 0] * k, loop.C[0] * k, float(loop.D[0, 0]) * k
    count = max(_FEWEST, min(math.ceil(length / loop.dt), _MOST))
    x, values = np.zeros(loop.nstates), np.empty(count)
    for n in range(count):
        values[n] = c @ x + d
        x = a @ x + b
    return np.arange(count) * loop.dt, values
