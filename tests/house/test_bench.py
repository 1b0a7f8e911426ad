"""The benchmark's own loop records what the demo does, or its comparison would stop."""

import re

from conftest import ROOT

import motionfmu


def test_the_fused_loop_records_the_signals_of_the_demo() -> None:
    text = (ROOT / "tests/bench/fused.c").read_text()
    listed = {".".join(pair) for pair in re.findall(r"X\((\w+), (\w+),", text)}
    result = motionfmu.load(ROOT / "scenarios/circle").run(stop=0.01)
    assert listed == set(result.signals)
