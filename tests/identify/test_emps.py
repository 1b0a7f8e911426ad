"""A published record of a real ball-screw axis, against its published values.

A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS", Workshop on Nonlinear
System Identification Benchmarks, Eindhoven 2019.
"""

import numpy as np
import pytest
from conftest import ROOT

import motionfmu
from motionfmu.identify import ColumnUse, IdentifyOptions, identify, run_of_record
from motionfmu.identify.axis_record import of_record

RECORD = ROOT / "examples/digital_twin/axis/record.csv"
pytestmark = pytest.mark.more
LEAD, INERTIA = 0.01, 1e-5  # [m], [kg.m2]: any, for the record has forces and lengths only
SHARE = LEAD / (2.0 * np.pi)
KP, KV, DRIVE = 160.18, 243.45, 35.15065  # [1/s], [V.s/m], [N/V]
MASS, COULOMB, VISCOUS = 95.1089, 20.3935, 203.5034  # [kg], [N], [N.s/m] published
ONE = [True] + [False] * 5


@pytest.fixture(scope="module")
def scenario():
    return motionfmu.scenario(
        {
            "stop": 1.0,
            "step": 1e-4,
            "component": {"drives": "servo_drives", "machine": "ball_screw_axes"},
            "connect": {
                "drives.phase": "machine.motor_phase",
                "machine.torque_command": "drives.torque",
            },
            "leave": [f"drives.{n}" for n in ("enable", "alarm_reset", "dac", "pulse_count")]
            + ["machine.force"],
            "set": {
                "drives.mode": 1,
                "drives.period": 1e-3,
                "drives.active": ONE,
                "machine.active": ONE,
                "drives.pulses_per_turn": 10_000_000,
                "drives.encoder_counts": 200_000,  # 5e-8 m, the encoder's resolution
                "drives.position_gain": KP,
                "drives.velocity_gain": KV * DRIVE * SHARE**2,
                "drives.velocity_time": 0.0,
                "drives.torque_limit": 10.0 * DRIVE * SHARE,
                "machine.lead": LEAD,
                "machine.current_time": 0.0,
                "machine.motor_inertia": INERTIA,
                "machine.motor_coulomb": 0.0,
                "machine.motor_static": 0.0,
                "machine.motor_viscous": 0.0,
                # far from what is to be found
                "machine.table_mass": 50.0,
                "machine.table_coulomb": 5.0,
                "machine.table_static": 5.0,
                "machine.table_viscous": 50.0,
            },
            "record": {"signals": ["drives.torque"]},
        },
        name="emps",
    )


@pytest.fixture(scope="module")
def columns():
    return {
        "reference": ColumnUse("drives.pulse_count"),
        "position": ColumnUse("machine.motor_phase"),
        "voltage": ColumnUse("drives.torque", DRIVE * SHARE),
    }


def test_published_values_are_found_where_the_published_law_is_asked_for(scenario, columns):
    asked = IdentifyOptions(columns, laws=["offset"])
    found = identify(scenario, of_record(motionfmu.record(RECORD)), asked)
    mass = found.value("table_mass").value + INERTIA / SHARE**2
    assert mass == pytest.approx(MASS, rel=0.01)
    assert found.value("table_coulomb").value == pytest.approx(COULOMB, rel=0.04)
    assert found.value("table_viscous").value == pytest.approx(VISCOUS, rel=0.04)
    assert found.value("force").value == pytest.approx(3.1648, rel=0.04)


def test_fmus_with_the_law_that_validation_chooses_repeat_the_record(scenario, columns):
    found = identify(scenario, of_record(motionfmu.record(RECORD)), IdentifyOptions(columns))
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
