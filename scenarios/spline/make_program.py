"""Write spline.ngc: a curve by G5 and G5.1, a smaller copy turned round, and as short lines."""

import math
from itertools import pairwise
from pathlib import Path

import numpy as np

FEED = 3000  # [mm/min]
TOLERANCE = 0.02  # [mm]
LINE = 0.25  # [mm] chords at most
# Control points [mm] of two cubics and a parabola; tangents agree where they meet.
CURVE = (
    ((0, 0), (8, 16), (22, 16), (30, 0)),
    ((30, 0), (38, -16), (52, -16), (60, 0)),
    ((60, 0), (70, 20), (80, 0)),
)
TEXT = """%
(A CURVE, ITS COPY OF HALF THE SIZE TURNED BY 90 DEGREES, THE CURVE AS SHORT LINES)
O100 SUB
  G0 X0. Y0.
  G5 X30. Y0. I8. J16. P-8. Q16.
  G5 X60. Y0. P-8. Q-16.
  G5.1 X80. Y0. I10. J20.
O100 ENDSUB
N10 G17 G21 G40 G49 G80 G90 G64 P{tolerance:g} F{feed}
N20 O100 CALL
N30 G52 X95. Y-35.
N40 #<size> = 0.5
N50 #<turn> = 90
/N52 #<size> = 1
/N54 #<turn> = 0
N60 G51 X0. Y0. P#<size>
N70 G68 X0. Y0. R#<turn>
N80 O100 CALL
N90 G69
N100 G50
N110 M66 P0 L0 (INPUT 0: EXACT STOP FOR THE LINES)
N120 O110 IF [#5399 EQ 1]
N130 G61
N140 O110 ENDIF
N150 G52 X0. Y-35.
N160 G0 X0. Y0.
{lines}
M30
%
"""


def points(control: tuple[tuple[float, float], ...], u: np.ndarray) -> np.ndarray:
    """Points of a Bezier curve by de Casteljau's rule [mm], shape (n, 2)."""
    rows = [np.tile(np.array(p, float), (len(u), 1)) for p in control]
    while len(rows) > 1:
        rows = [a + (b - a) * u[:, None] for a, b in pairwise(rows)]
    return rows[0]


def chords(control: tuple[tuple[float, float], ...]) -> np.ndarray:
    """Ends of chords of equal arcs [mm], shape (n, 2), without the first point."""
    fine = points(control, np.linspace(0.0, 1.0, 20001))
    way = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(fine, axis=0).T))])
    count = math.ceil(way[-1] / LINE)
    at = np.interp(np.linspace(0.0, way[-1], count + 1)[1:], way, np.linspace(0.0, 1.0, 20001))
    return points(control, at)


def program() -> str:
    """Text of the part program."""
    ends = np.concatenate([chords(c) for c in CURVE])
    lines = "\n".join(f"{'G1 ' * (i == 0)}X{x:.4f} Y{y:.4f}" for i, (x, y) in enumerate(ends))
    return TEXT.format(tolerance=TOLERANCE, feed=FEED, lines=lines)


if __name__ == "__main__":
    Path(__file__).with_name("spline.ngc").write_text(program())
