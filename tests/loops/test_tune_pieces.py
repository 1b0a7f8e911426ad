"""Pieces of a long path by which gains are judged."""

import numpy as np
import pytest

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.study.tune import problem
from motionfmu.study.tune.path_error import PIECE, RUN_UP, PathCost, pieces
from motionfmu.study.tune.tuning_functions import TuningFunctions
from motionfmu.study.tune.tuning_words import assumptions

STEP, STRIDE = 1e-3, 2


def test_a_path_that_is_short_enough_is_judged_whole() -> None:
    rows, judged = pieces(np.zeros(999), STRIDE, STEP, 1.0)
    assert rows.tolist() == list(range(0, 999, 2)) and judged.all()


@pytest.mark.parametrize("most", [4.0, 7.5])
def test_pieces_are_the_worst_and_some_of_all_and_motion_begins_before(most: float) -> None:
    error = np.random.default_rng(5).random(40_500)
    error[[3000, 31_500, 31_501, 40_400]] = 5.0, 4.0, 9.0, 3.0
    rows, judged = pieces(error, STRIDE, STEP, most)
    length = round(PIECE / STEP)
    chosen = np.unique(rows[judged] // length)
    assert len(chosen) == int(most / PIECE)
    assert {3, 31} <= set(chosen.tolist()) and chosen[0] <= 3 and chosen[-1] >= 35
    # brute force: a row is looked at if a judged one is at most the run-up ahead
    is_judged = np.isin(np.arange(0, len(error), STRIDE) // length, chosen)
    seen = [
        is_judged[k : k + round(RUN_UP / STEP / STRIDE) + 1].any() for k in range(len(is_judged))
    ]
    assert rows.tolist() == np.arange(0, len(error), STRIDE)[seen].tolist()
    assert judged.tolist() == is_judged[seen].tolist()


@pytest.mark.more
def test_a_motion_in_pieces_is_that_of_the_whole_where_it_is_judged() -> None:
    base = motionfmu.load("pocket").run(every=1)
    whole, part = (
        TuningFunctions(base.scenario, problem({"judged": j}), base) for j in (60.0, 6.0)
    )
    assert isinstance(whole.path, PathCost) and isinstance(part.path, PathCost)
    assert whole.path.judged == pytest.approx(base.time[-1], abs=2e-3)
    assert part.path.judged == pytest.approx(6.0, abs=1.0)
    found = []
    for study in (whole, part):
        error = study.path.error(study.motions(study.present))
        cutting = study.path.time[study.path._cutting]
        found.append(dict(zip(cutting.round(6).tolist(), error.distance, strict=True)))
    assert set(found[1]) < set(found[0]) and len(found[1]) < 0.5 * len(found[0])
    off = [abs(found[0][t] - e) for t, e in found[1].items()]
    assert max(off) < 1e-4 * max(found[0].values()) + 1e-4  # [mm] what the run-up leaves
    assert max(found[1].values()) == pytest.approx(max(found[0].values()), rel=1e-3)
    told = [t for t in assumptions(part) if t.startswith("Path: ")]
    assert told and "of 16 s are judged" in told[0] and "Path: " not in str(assumptions(whole))


def test_at_least_a_second_is_judged() -> None:
    with pytest.raises(InputError, match=r"judged = 0.5: .*greater than or equal to 1"):
        problem({"judged": 0.5})
