"""Part programs: what they say, how long they take, without a machine.

>>> from motionfmu.analysis.gcode import read
>>> program = read("G1 X10 F600\\nG3 Y10 R5\\nM2")
>>> program.commands["end"][:, :2].tolist()
[[10.0, 0.0], [10.0, 10.0]]
"""

from motionfmu.analysis.gcode.program import Fault, Program, defaults, read
from motionfmu.analysis.gcode.summary import Stroke, Summary, Use, strokes, summarise

__all__ = [
    "Fault",
    "Program",
    "Stroke",
    "Summary",
    "Use",
    "defaults",
    "read",
    "strokes",
    "summarise",
]
