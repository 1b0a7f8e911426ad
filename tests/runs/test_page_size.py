"""A page keeps within its size whatever a run has recorded."""

import numpy as np
import pytest
from page_curves import page_data

from motionfmu.report.diagram import SamplesMark, Scale, one
from motionfmu.report.html_page import LARGEST, Page, PageFrame
from motionfmu.report.samples import Samples
from motionfmu.run.decimate import MOST

CURVES, AXES, SAMPLES = 25, 6, 8_000


def noisy(plots: int) -> str:
    """A page of plots of six axes whose samples say nothing of each other, each with own peaks."""
    random, page = np.random.default_rng(1), Page()
    time = np.arange(SAMPLES) * 1e-3
    for k in range(plots):
        values = random.normal(size=(AXES, SAMPLES))
        marks = [SamplesMark(Samples(time, v), f"axis {i + 1}") for i, v in enumerate(values)]
        drawn = one(Scale("Time", "s"), Scale(f"signal {k}"), marks, 200)
        page.section(f"Signal {k}", "", page.place(f"signal{k}", drawn, True))
    return page.text(PageFrame("noise", "Curves of a long run.", "report", (), ""))


@pytest.fixture(scope="module")
def long() -> str:
    return noisy(CURVES)


def test_a_page_of_a_hundred_and_fifty_long_curves_is_within_its_size(long: str) -> None:
    assert SAMPLES < MOST  # nothing is left out but for the size
    assert LARGEST / 2 < len(long.encode()) <= LARGEST


def test_a_page_that_has_room_leaves_more_of_each_curve(long: str) -> None:
    few, many = long, noisy(2)
    assert len(many.encode()) <= LARGEST
    data = [page_data(text)["figures"][0]["data"][0] for text in (few, many)]
    sizes = [len(str(one)) for one in data]
    assert sizes[1] > 5 * sizes[0]
