"""Samples of a record at which the drive is at its limit, where its law is no longer linear."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import law
from motionfmu.analysis.linear.law import Law
from motionfmu.base.errors import InputError
from motionfmu.identify.axis_loop import AxisLoop
from motionfmu.identify.recorded_loop import RecordedLoop

Array = NDArray[np.float64]
# Share of the limit from which on a drive counts as at it: what noise takes off, and time [s]
# before and after that counts as well.
_NEAR, _AROUND = 0.97, 3e-3
# Shorter stretches between two limits [s] are left out, too.
_SHORTEST = 0.15
# Share of a record that must be left.
_LEFT = 0.1


@dataclass(frozen=True)
class LimitedSamples:
    """Which samples are left out, and why."""

    out: NDArray[np.bool_]  # (samples,)
    signal: str = ""
    limit: float = np.inf

    @property
    def first(self) -> int:
        """The first sample that is left out; the number of samples if none is."""
        return int(np.argmax(self.out)) if self.out.any() else len(self.out)

    def runs(self, begin: int, end: int) -> list[tuple[int, int]]:
        """Stretches of samples [begin, end) that are not left out."""
        inside = np.concatenate([[False], ~self.out[begin:end], [False]])
        edges = begin + np.flatnonzero(np.diff(inside.astype(np.int8)))
        return [(int(a), int(b)) for a, b in edges.reshape(-1, 2)]

    @property
    def note(self) -> str:
        """What is left out, in words; empty if nothing is."""
        if not self.out.any():
            return ""
        return (
            f"{100.0 * float(np.mean(self.out)):.3g} % of the record are left out: {self.signal} is"
            f" at its limit of {self.limit:.6g} there, or not for long enough away from it."
        )


def limited_samples(loop: AxisLoop, data: RecordedLoop, force: Array) -> LimitedSamples:
    """Find them; `force` is what drives the plant at all samples."""
    source = loop.sources[loop.wired[0]]
    component, _, variable = source.partition(".")
    said = law.carried(loop.scenario.document.body.component[component])
    if not isinstance(said, Law) or variable not in said.limit:
        return LimitedSamples(np.zeros(data.samples, dtype=bool))
    limit = law.number(said, loop.values[component], said.limit[variable])
    near = np.zeros(data.samples, dtype=bool)
    near[: len(force)] = np.abs(force) >= _NEAR * limit
    wide = max(1, round(_AROUND / data.interval))
    out = np.convolve(near, np.ones(2 * wide + 1), "same") > 0.0
    found = LimitedSamples(out, source, limit)
    if near.any():
        for begin, end in found.runs(0, data.samples):
            if (end - begin) * data.interval < _SHORTEST:
                out[begin:end] = True
        if np.mean(~out) < _LEFT:
            raise InputError(
                f"{data.record.name}: {source} is at its limit of {limit:.6g} in"
                f" {100.0 * float(np.mean(out)):.3g} % of the record: too little is left"
            )
    return found
