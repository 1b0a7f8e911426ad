"""Frequency responses and stability limits by simulation of the running FMUs."""

# ruff: noqa: E402
from motionfmu.extras import needed

needed("tune")

from motionfmu.freq.bench import Bench, Setup, setup
from motionfmu.freq.excitation import Excitation, multisine, prbs, sine
from motionfmu.freq.response import Response, measure, measured_loop, sweep

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
