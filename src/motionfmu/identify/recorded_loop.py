"""A record on the communication points of a loop, in the units of its signals."""

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base import units
from motionfmu.identify.axis_loop import AxisLoop
from motionfmu.identify.axis_record import AxisRecord, column_of, no_scale, scale_of_units

Array = NDArray[np.float64]
# Share of a communication step by which the interval of a record may be no whole number of them.
_WHOLE = 1e-3


@dataclass(frozen=True)
class ColumnUse:
    """What a column of a record is in the scenario.

    Parameters
    ----------
    signal : str
        ``component.variable``: an input that the column drives, or an output to compare.
    scale : float, optional
        Of the signal's unit per unit of the column; units say it if it is not given.
    offset : float
        Added, in the signal's unit.
    """

    signal: str
    scale: float | None = None
    offset: float = 0.0


@dataclass(frozen=True)
class RecordedLoop:
    """Signals of a record as a loop has them."""

    record: AxisRecord
    every: int  # communication steps between two samples
    interval: float  # [s] between two samples
    samples: int
    driven: Array  # (points, n_driven), held from sample to sample
    compared: tuple[str, ...]
    measured: Array  # (samples, n_compared)
    columns: Mapping[str, str]  # column by signal
    scales: Mapping[str, float]  # of the signal per unit of the column, by signal

    @property
    def time(self) -> Array:
        """Of the samples [s], from the first one on."""
        return np.arange(self.samples, dtype=np.float64) * self.interval


def ratio_of_inputs(loop: AxisLoop) -> Array:
    """How much each driven input is of the first output fed back, where the loop rests.

    Of all values that let the laws stand still and ask nothing of the plant; (n_driven,), 0 for an
    input with which none do.
    """
    laws, n = loop.laws, len(loop.driven)
    found = np.zeros(n)
    if not loop.fed:
        return found
    keep, read = np.eye(len(laws.memory)), np.zeros((len(laws.memory), n + len(loop.fed)))
    for k in range(laws.cycle):
        keep, read = laws.keep[k] @ keep, laws.keep[k] @ read + laws.read[k]
    for k in range(n):
        still = np.column_stack([keep - np.eye(len(keep)), read[:, k]])
        asked = np.column_stack([laws.take[0], laws.through[0][:, k]])
        whole = np.vstack([still, asked])
        right = -np.concatenate([read[:, n], laws.through[0][:, n]])
        scale = np.maximum(np.linalg.norm(whole, axis=0), 1e-300)
        solution, *_ = np.linalg.lstsq(whole / scale, right, rcond=1e-12)
        left = float(np.linalg.norm(whole / scale @ solution - right))
        if left <= 1e-6 * max(float(np.linalg.norm(right)), 1e-300):
            found[k] = solution[-1] / scale[-1]
    return found


def recorded(
    loop: AxisLoop,
    record: AxisRecord,
    uses: Mapping[str, ColumnUse],
    ratios: Mapping[str, float],
) -> RecordedLoop:
    """Put a record onto the communication points.

    `ratios` are values of signals per metre or radian of the axis' position, for columns whose unit
    is no other form of the signal's.
    """
    every = max(1, round(record.interval / loop.step))
    interval = every * loop.step
    even = math.isclose(interval, record.interval, rel_tol=_WHOLE / every)
    samples = int((record.time[-1] - record.time[0]) / interval * (1.0 + 1e-12)) + 1
    if even:
        samples = len(record.time)
    time = record.time[0] + interval * np.arange(samples)
    scales, columns, values = {}, {}, {}
    for name, use in uses.items():
        raw = column_of(record, name, use.signal)
        scale = use.scale
        if scale is None:
            scale = _scale(loop, record, (name, use.signal), ratios)
        here = raw if even else np.interp(time, record.time, raw)
        values[use.signal] = here * scale + use.offset
        scales[use.signal], columns[use.signal] = scale, name
    compared = tuple(u.signal for u in uses.values() if u.signal not in loop.driven)
    driven = np.zeros(((samples - 1) * every + 1, len(loop.driven)))
    for k, name in enumerate(loop.driven):
        grain = loop.grain.get(name, 0.0)
        column = np.round(values[name] / grain) * grain if grain else values[name]
        driven[:, k] = np.repeat(column, every)[: len(driven)]
    measured = (
        np.column_stack([values[n] for n in compared]) if compared else np.zeros((samples, 0))
    )
    return RecordedLoop(
        record, every, interval, samples, driven, compared, measured, columns, scales
    )


def _scale(
    loop: AxisLoop, record: AxisRecord, of: tuple[str, str], ratios: Mapping[str, float]
) -> float:
    """Of a signal's unit per unit of a column."""
    name, signal = of
    component, _, variable = signal.partition(".")
    port = loop.scenario.resolver.ports[component][variable.partition("[")[0]]
    own, scale = scale_of_units(record, name, signal, port.unit)
    if scale:
        return scale
    if signal in ratios and own.exponents in (
        units.parse("m").exponents,
        units.parse("rad").exponents,
    ):
        return own.factor * ratios[signal]
    raise no_scale(record, name, signal, port.unit)
