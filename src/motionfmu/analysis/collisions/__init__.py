"""Where an arm comes near to itself and to the bodies of its cell."""

from motionfmu.analysis.collisions.arm_parts import ArmParts
from motionfmu.analysis.collisions.cell import Cell, CellBody, read_cell
from motionfmu.analysis.collisions.clearance import Approach, approaches

__all__ = ["Approach", "ArmParts", "Cell", "CellBody", "approaches", "read_cell"]
