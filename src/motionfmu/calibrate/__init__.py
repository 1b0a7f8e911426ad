"""Geometry of machines from measured records: ISO 230-2, ISO 230-4, poses of a robot."""

from motionfmu.base.extras import needed

needed("tune")

# ruff: noqa: E402
from motionfmu.calibrate.arm_calibration import (
    ArmCalibration,
    ArmCalibrationOptions,
    PoseFit,
    arm_calibration,
)
from motionfmu.calibrate.circle_errors import CircleErrors, circle_errors
from motionfmu.calibrate.circle_record import CircleChoice, CircleRecord, circle_record
from motionfmu.calibrate.compensation import (
    CompensationTable,
    compensation_table,
    compensation_tables,
    compensation_text,
)
from motionfmu.calibrate.estimate import Estimate
from motionfmu.calibrate.lead_error import LeadError, lead_error
from motionfmu.calibrate.machine_calibration import (
    AxisCalibration,
    CircleCalibration,
    GeometryParameter,
    MachineCalibration,
    MachineRecords,
    machine_calibration,
)
from motionfmu.calibrate.pose_record import PoseRecord, pose_record
from motionfmu.calibrate.position_record import PositionRecord, position_record

__all__ = [
    "ArmCalibration",
    "ArmCalibrationOptions",
    "AxisCalibration",
    "CircleCalibration",
    "CircleChoice",
    "CircleErrors",
    "CircleRecord",
    "CompensationTable",
    "Estimate",
    "GeometryParameter",
    "LeadError",
    "MachineCalibration",
    "MachineRecords",
    "PoseFit",
    "PoseRecord",
    "PositionRecord",
    "arm_calibration",
    "circle_errors",
    "circle_record",
    "compensation_table",
    "compensation_tables",
    "compensation_text",
    "lead_error",
    "machine_calibration",
    "pose_record",
    "position_record",
]
