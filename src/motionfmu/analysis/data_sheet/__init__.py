"""The data sheet of a machine: figures from runs of its FMUs, none written by hand."""

from motionfmu.analysis.data_sheet.robot_sheet import RobotSheet
from motionfmu.analysis.data_sheet.sheet import AxisSheet, DataSheet, data_sheet

__all__ = ["AxisSheet", "DataSheet", "RobotSheet", "data_sheet"]
