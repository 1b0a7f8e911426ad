"""A system as one program: the parts of its FMUs, wires and recorder compiled into one FMU."""

from motionfmu.fused.parts import NoCompiler, NotFused
from motionfmu.fused.program import Program, exported, program

__all__ = ["NoCompiler", "NotFused", "Program", "exported", "program"]
