"""A published record of a real ball-screw axis, EMPS, and the scenario of its example.

A. Janot, M. Gautier, M. Brunot, "Data Set and Reference Models of EMPS", Workshop on Nonlinear
System Identification Benchmarks, Eindhoven 2019.
"""

from pathlib import Path

import numpy as np

import motionfmu
from motionfmu.identify import ColumnUse, identify_file

AXIS = Path(__file__).resolve().parents[2] / "examples/digital_twin/axis"
RECORD = AXIS / "record.csv"
LEAD, INERTIA, DRIVE = 0.01, 1e-5, 35.15065  # [m], [kg.m2], [N/V] of its scenario.toml
SHARE = LEAD / (2.0 * np.pi)


def emps() -> motionfmu.Scenario:
    """A drive and an axis whose values are far from those that are to be found."""
    return motionfmu.load(AXIS)


def columns() -> dict[str, ColumnUse]:
    """What the columns of the record are."""
    return dict(identify_file.options(identify_file.read(AXIS / "identify.toml"), "").columns)
