"""The benchmark's own loops record what their scenarios do, or its comparison would stop."""

import re

import pytest
from conftest import ROOT

import motionfmu


@pytest.mark.parametrize(
    ("scenario", "header"),
    [
        ("scenarios/circle", "tests/bench/fused_circle.h"),
        ("tests/bench/six_axes", "tests/bench/six_axes/fused_six_axes.h"),
    ],
)
def test_the_fused_loop_records_the_signals_of_its_scenario(scenario: str, header: str) -> None:
    listed = {
        ".".join(pair) for pair in re.findall(r"X\((\w+), (\w+),", (ROOT / header).read_text())
    }
    result = motionfmu.load(ROOT / scenario).run(stop=0.01)
    assert listed == set(result.signals)
