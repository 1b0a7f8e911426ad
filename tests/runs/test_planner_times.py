"""Times of shapes beside LinuxCNC's: the table of scenarios/short_lines is what is driven now."""

import sys
import tomllib
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from conftest import ROOT

FOLDER = ROOT / "scenarios/short_lines"
HEAD = "| shape | F [mm/s] | here [s] | LinuxCNC [s] | LinuxCNC over here |"


@pytest.fixture(scope="module")
def study() -> Iterator[Any]:
    """The scenario's study, which is no module of the package."""
    pytest.importorskip("toppra")
    sys.path.insert(0, str(FOLDER))
    import study as module

    assert Path(str(module.__file__)).parent == FOLDER
    yield module
    sys.path.remove(str(FOLDER))


def rows() -> list[list[str]]:
    """Cells of the table."""
    text = (FOLDER / "README.md").read_text(encoding="utf-8").split(HEAD, 1)[1]
    lines = text.split("\n\n", 1)[0].splitlines()[2:]
    return [[cell.strip() for cell in line.strip("|").split("|")] for line in lines]


def test_the_table_has_every_shape_measured_in_linuxcnc(study: Any) -> None:
    told = {(name, float(feed)): (theirs, over) for name, feed, _, theirs, over in rows()}
    assert list(told) == study.RUNS
    for run, seconds in study.recorded().items():
        assert told.pop(run)[0] == f"{seconds:.2f}"
    assert told == {}
    kept = tomllib.loads((FOLDER / "linuxcnc_times.toml").read_text(encoding="utf-8"))
    text = (FOLDER / "README.md").read_text(encoding="utf-8")
    assert kept["version"].partition("-")[0].partition("~")[0] in text


@pytest.mark.parametrize("row", rows(), ids=lambda row: " ".join(row[:2]))
def test_a_shape_takes_the_time_of_the_table(study: Any, row: list[str]) -> None:
    name, feed, here, theirs, over = row
    now = study.driven(name, float(feed))
    assert f"{now:.2f}" == here
    assert f"{study.recorded()[name, float(feed)] / now:.2f}" == over
    assert float(here) < float(theirs)
