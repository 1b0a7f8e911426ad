"""Rows of every so many steps: when they hide a contour's errors, and when not."""

from dataclasses import replace

import pytest
from conftest import ROOT
from contour_runs import Machine, Program, run_along

import motionfmu
from motionfmu.analysis.contour import ContourInput, ContourResult, analyse
from motionfmu.analysis.contour.sparse import sparse

STEP = 1e-3


def corner(every: int, first: int = 0) -> ContourResult:
    """A right angle at 100 mm/s, of which only every so manyth row is kept."""
    path = Program(0, 0).line(20, 0).line(20, 20).path()
    run = run_along(path, 100.0, Machine(step=STEP), ramp=0.1)
    rows = slice(first, None, every)
    names = ("time", "actual", "commanded", "command")
    kept: ContourInput = replace(run, **{n: getattr(run, n)[rows] for n in names})
    return analyse(kept)


def test_a_warning_comes_where_peaks_are_lost() -> None:
    """4 rows in a lag lose less than 1 - exp(-1/8), wherever they fall; a row in a lag more."""
    whole = corner(1).error.max
    assert sparse(corner(1), STEP) == sparse(corner(4), STEP) == []
    (told,) = sparse(corner(5), STEP)
    assert told == (
        "contour: 3.7 rows in the lag of 0.0187 s: errors between two rows are not seen; every = 4"
        " shows them, not 5"
    )
    lost = {n: [1.0 - corner(n, k).error.max / whole for k in range(0, n, 2)] for n in (4, 20)}
    assert 0.0 <= max(lost[4]) < 0.12 < max(lost[20])


@pytest.mark.parametrize(("every", "count"), [(40, 0), (100, 1)])
def test_a_run_warns(every: int, count: int) -> None:
    found = motionfmu.load(ROOT / "scenarios/circle").run(every=every, stop=0.5).warnings
    assert len(found) == count and all("; every = 48 shows them, not 100" in w for w in found)
