"""A published record of a real ball-screw axis, against its published values.

A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS", Workshop on Nonlinear
System Identification Benchmarks, Eindhoven 2019.
"""

from dataclasses import replace

import numpy as np
import pytest
from emps import DRIVE, INERTIA, RECORD, SHARE, columns, emps

import motionfmu
from motionfmu.identify import IdentifyOptions, identify, run_of_record
from motionfmu.identify.axis_record import of_record

pytestmark = pytest.mark.more
MASS, COULOMB, VISCOUS = 95.1089, 20.3935, 203.5034  # [kg], [N], [N.s/m] published
REPETITIONS, BLOCK = 10, 0.5  # of the bootstrap; [s]


def test_published_values_are_found_where_the_published_law_is_asked_for():
    asked = IdentifyOptions(columns(), laws=["offset"])
    found = identify(emps(), of_record(motionfmu.record(RECORD)), asked)
    mass = found.value("table_mass").value + INERTIA / SHARE**2
    assert mass == pytest.approx(MASS, rel=0.01)
    assert found.value("table_coulomb").value == pytest.approx(COULOMB, rel=0.04)
    assert found.value("table_viscous").value == pytest.approx(VISCOUS, rel=0.04)
    assert found.value("force").value == pytest.approx(3.1648, rel=0.04)


def test_fmus_with_the_law_that_validation_chooses_repeat_the_record():
    found = identify(emps(), of_record(motionfmu.record(RECORD)), IdentifyOptions(columns()))
    # slopes of 169 and 239 N s/m forwards and backwards, by least squares on the record
    assert "direction" in found.laws
    assert found.value("table_viscous_asymmetry").value == pytest.approx(-0.17, abs=0.03)
    # its drive acts within the sample, and its gain is 254.6, not 243.45: the record says so
    assert found.settings["drives.prompt[1]"] is True
    gain = found.settings["drives.velocity_gain[1]"] / (DRIVE * SHARE**2)
    assert gain == pytest.approx(254.6, rel=0.01)
    run = run_of_record(found)
    assert run.settled == 0.2
    assert run.differences["following error"] < 0.0025
    assert run.differences["drives.torque"] < 0.038


@pytest.mark.long
def test_deviations_cover_what_block_bootstrap_repetitions_scatter():
    """Ten records of the fit and blocks of its residuals, fitted anew (Politis and Romano 1992)."""
    record = of_record(motionfmu.record(RECORD))
    asked = IdentifyOptions(columns(), laws=["direction", "offset"])
    found = identify(emps(), record, asked)
    rest = found.measured - found.simulated
    rows = np.rint(found.time / record.interval).astype(int)
    rng = np.random.default_rng(6240)
    length = round(BLOCK / record.interval)
    gains = {n: v for n, v in found.settings.items() if n.startswith("drives.")}
    every = []
    for _ in range(REPETITIONS):
        starts = rng.integers(0, len(rest) - length, len(rest) // length + 1)
        drawn = np.concatenate([rest[k : k + length] for k in starts])[: len(rest)]
        made = dict(record.columns)
        for k, name in enumerate(found.signals):
            column = found.recorded.columns[name]
            late = found.ground.first if name in found.ground.loop.shown else 0
            values = made[column].copy()
            new = found.simulated[:, k] + drawn[:, k]
            values[rows - late] = new / found.recorded.scales[name]
            made[column] = values
        again = identify(
            emps(),
            replace(record, columns=made),
            replace(asked, controller=False),
            gains,
        )
        every.append([again.value(n).value for n in found.free])
    scatter = np.std(every, axis=0, ddof=1)
    deviations = np.array([found.value(n).deviation for n in found.free])
    assert (scatter > 0.0).all()
    assert (scatter <= deviations).all(), (found.free, scatter, deviations)
