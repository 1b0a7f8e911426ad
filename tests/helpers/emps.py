"""The scenario of a published record of a real ball-screw axis, EMPS.

A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS", Workshop on Nonlinear
System Identification Benchmarks, Eindhoven 2019. The record itself is not part of the project.
"""

import os
from pathlib import Path

import numpy as np

import motionfmu
from motionfmu.identify import ColumnUse

ROOT = Path(__file__).resolve().parents[2]
RECORD = Path(os.environ.get("MOTIONFMU_EMPS", ROOT.parent / "shared/data/axis-record.csv"))
LEAD, INERTIA = 0.01, 1e-5  # [m], [kg.m2]: any, for the record has forces and lengths only
SHARE = LEAD / (2.0 * np.pi)
KP, KV, DRIVE = 160.18, 243.45, 35.15065  # [1/s], [V.s/m], [N/V]
ONE = [True] + [False] * 5


def emps() -> motionfmu.Scenario:
    """A drive and an axis whose values are far from those that are to be found."""
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


def columns() -> dict[str, ColumnUse]:
    """What the columns of the record are."""
    return {
        "reference": ColumnUse("drives.pulse_count"),
        "position": ColumnUse("machine.motor_phase"),
        "voltage": ColumnUse("drives.torque", DRIVE * SHARE),
    }
