"""Frequency responses and stability limits by simulation of the running FMUs."""

# ruff: noqa: E402
from motionfmu.base.extras import needed

needed("tune")

from motionfmu.analysis.freq.bench import Bench, Setup, setup
from motionfmu.analysis.freq.excitation import Excitation, multisine, prbs, sine
from motionfmu.analysis.freq.response import Response, measure, measured_loop, sweep

__all__ = [
    "Bench",
    "Excitation",
    "Response",
    "Setup",
    "measure",
    "measured_loop",
    "multisine",
    "prbs",
    "setup",
    "sine",
    "sweep",
]
