"""Against inverse dynamics by least squares in numpy, which shares no code with what is tested.

Gautier 1997: a low pass without phase, central differences, one row for each sample in motion.
"""

import numpy as np
import pytest
from axis_truth import COLUMNS, drawn, moves, simulated
from emps import DRIVE, INERTIA, RECORD, SHARE, columns, emps

import motionfmu
from motionfmu.identify import IdentifyOptions, identify
from motionfmu.identify.axis_record import of_record

CUTOFF = 30.0  # [Hz]


def smooth(values: np.ndarray, interval: float) -> np.ndarray:
    """A Gaussian low pass: its kernel is even, so it has no phase."""
    half = int(0.6 / CUTOFF / interval)
    at = interval * np.arange(-half, half + 1)
    kernel = np.exp(-0.5 * (2.0 * np.pi * CUTOFF / 1.18 * at) ** 2)
    return np.convolve(values, kernel / kernel.sum(), "same")


def idim(position: np.ndarray, force: np.ndarray, interval: float) -> np.ndarray:
    """Mass, Coulomb, viscous friction forwards and backwards, and a constant force."""
    s, f = smooth(position, interval), smooth(force, interval)
    v = (s[2:] - s[:-2]) / (2.0 * interval)
    a = (s[2:] - 2.0 * s[1:-1] + s[:-2]) / interval**2
    edge = int(3.0 / CUTOFF / interval)
    # a sign that goes through the same low pass is the mean of friction there
    sign = smooth(np.sign(np.gradient(s)), interval)[1:-1]
    rows = np.column_stack([a, sign, np.maximum(v, 0.0), np.minimum(v, 0.0), -np.ones_like(v)])
    inner = slice(edge, len(v) - edge)
    moving = np.abs(v[inner]) > 0.05 * np.abs(v[inner]).max()
    found, *_ = np.linalg.lstsq(rows[inner][moving], f[1:-1][inner][moving], rcond=None)
    return found


@pytest.mark.more
def test_the_record_of_emps():
    record = of_record(motionfmu.record(RECORD))
    other = idim(record.columns["position"], DRIVE * record.columns["voltage"], record.interval)
    found = identify(emps(), record, IdentifyOptions(columns(), laws=["direction", "offset"]))
    mass = found.value("table_mass").value + INERTIA / SHARE**2
    assert mass == pytest.approx(other[0], rel=0.015)
    assert found.value("table_coulomb").value == pytest.approx(other[1], rel=0.1)
    viscous, more = (found.value(f"table_viscous{n}").value for n in ("", "_asymmetry"))
    assert viscous * (1.0 + more) == pytest.approx(other[2], rel=0.05)
    assert viscous * (1.0 - more) == pytest.approx(other[3], rel=0.05)


@pytest.mark.parametrize(
    "seed", [pytest.param(k, marks=[] if k == 1 else pytest.mark.more) for k in (1, 3, 4, 9)]
)
def test_machines_without_backlash(seed):
    truth, rng, (speed, acceleration) = drawn(seed)
    record = simulated(truth, moves(rng, 4.0, speed, acceleration), rng, 0.01)
    share = truth.values["machine.lead"] / (2.0 * np.pi)
    other = idim(record.columns["position"], record.columns["torque"] / share, record.interval)
    asked = IdentifyOptions(COLUMNS, laws=["direction", "offset"])
    found = identify(truth.scenario(), record, asked)
    value = {p.name.partition(".")[2]: p.value for p in found.parameters}
    mass = value["table_mass"] + truth.values["machine.motor_inertia"] / share**2
    weight = float(np.sqrt(np.mean((record.columns["torque"] / share) ** 2)))
    assert mass == pytest.approx(other[0], rel=0.03)
    assert value["table_coulomb"] == pytest.approx(other[1], abs=0.05 * weight)
    viscous, more = value["table_viscous"], value["table_viscous_asymmetry"]
    top = float(np.abs(np.gradient(record.columns["position"], record.interval)).max())
    assert viscous * (1.0 + more) * top == pytest.approx(other[2] * top, abs=0.08 * weight)
    assert viscous * (1.0 - more) * top == pytest.approx(other[3] * top, abs=0.08 * weight)
