"""Warnings about a contour that is recorded at every so many steps only."""

from motionfmu.analysis.contour.contour_result import ContourResult
from motionfmu.analysis.contour.error import LAGS

# A servo lag needs so many rows at least. An error that comes and goes with the lag T falls by
# exp(-t/T), so half a row beside its peak 12 % of it are missed. Commands shorter than a row are no
# loss, for the tool cannot follow what is far shorter than the lag. A cut lasts five lags, 20 rows.
PER_LAG = 4


def sparse(found: ContourResult, step: float) -> list[str]:
    """Warnings about a contour whose rows are farther apart than a step [s]."""
    apart = found.run.instants.middle
    every, lag = round(apart / step), found.window / LAGS
    if every < 2 or apart <= lag / PER_LAG * (1.0 + 1e-9):
        return []
    enough = max(1, int(lag / PER_LAG / step))
    return [
        f"contour: {lag / apart:.2g} rows in the lag of {lag:.3g} s: errors between two rows are"
        f" not seen; every = {enough} shows them, not {every}"
    ]
