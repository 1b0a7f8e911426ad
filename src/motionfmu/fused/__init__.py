"""A system as one program: the parts of its FMUs, wires and recorder compiled into one FMU."""

from motionfmu.fused.fmu_parts import NoCompiler, NotFused
from motionfmu.fused.fused_program import FusedProgram, exported, program

__all__ = ["FusedProgram", "NoCompiler", "NotFused", "exported", "program"]
