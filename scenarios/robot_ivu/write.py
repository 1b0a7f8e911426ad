"""Writes ivu.job, large.txt, small.txt and path.txt: the letters IVU in short lines.

The strokes are those of the Hershey Roman simplex font, created by Dr. A. V. Hershey at the U.S.
National Bureau of Standards; the format of the data is by James Hurt, Cognition, Inc.
"""

from pathlib import Path

import numpy as np
from numpy.typing import NDArray

CAP = 60.0  # [mm] height of the letters, 21 units of the font
PIECE = 0.8  # [mm] longest line of the large letters; the small ones have as many
LIFT = 10.0  # [mm] of the pen between strokes
ASIDE = 6.0  # [mm] where the tool comes from, to the right and above, or to the left and below
SMALL = 0.2  # of the large letters
ORIGIN = (1000.0, 0.0, 350.0)  # [mm] of the user frame, which is turned by -90 degrees
CUT = 2.0  # [mm] at either end of a stroke that is not looked at: the arm stands 1 mm off
# Width, and strokes with y down; capitals reach from -12 to 9.
LETTERS = {
    "I": (8, [[(4, -12), (4, 9)]]),
    "V": (18, [[(1, -12), (9, 9)], [(17, -12), (9, 9)]]),
    "U": (
        22,
        [
            [
                (4, -12),
                (4, 3),
                (5, 6),
                (7, 8),
                (10, 9),
                (12, 9),
                (15, 8),
                (17, 6),
                (18, 3),
                (18, -12),
            ]
        ],
    ),
}
Array = NDArray[np.float64]


def rounded(corners: Array) -> Array:
    """A smooth curve through the corners (Catmull-Rom), straight between two of them."""
    if len(corners) < 3:
        return corners
    ends = 2 * corners[[0, -1]] - corners[[1, -2]]
    p = np.vstack([ends[:1], corners, ends[1:]])
    u = np.linspace(0, 1, 50, endpoint=False)[:, None]
    parts = [corners[:1]]
    for a, b, c, d in zip(p, p[1:], p[2:], p[3:], strict=False):
        if np.linalg.norm(c - b) > CAP / 2:  # the straight sides
            parts.append(b + u * (c - b))
            continue
        slope_b = (c - a) / 2 if np.linalg.norm(b - a) < CAP / 2 else (c - b) * [0, 1]
        slope_c = (d - b) / 2 if np.linalg.norm(d - c) < CAP / 2 else (c - b) * [0, 1]
        h = 2 * u**3 - 3 * u**2 + 1, u**3 - 2 * u**2 + u, 3 * u**2 - 2 * u**3, u**3 - u**2
        parts.append(h[0] * b + h[1] * slope_b + h[2] * c + h[3] * slope_c)
    return np.vstack([*parts, corners[-1:]])


def cut(curve: Array) -> Array:
    """Points along a curve, evenly spaced by PIECE at most."""
    length = np.r_[0, np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))]
    at = np.linspace(0, length[-1], int(np.ceil(length[-1] / PIECE)) + 1)
    return np.column_stack([np.interp(at, length, curve[:, i]) for i in (0, 1)])


def strokes() -> list[Array]:
    """Points of the four strokes [mm]."""
    found, left = [], 0.0
    for width, letter in LETTERS.values():
        for corners in letter:
            scaled = np.array([(left + x, 9 - y) for x, y in corners]) * CAP / 21
            found.append(cut(rounded(scaled)))
        left += width
    return found


def jobs(lines: list[Array]) -> list[str]:
    """Main jobs, and one for each stroke; its points are two aside, above, the stroke, above."""
    text = []
    for name, runs, sides in (("TWO", 1, (0, 1)), ("SAME", 1, (0, 0)), ("TEN", 5, (0, 1))):
        text += [f"JOB {name}", "TOOL 1", "USER 1", "SPEED V=8.0", "MOVJ P000 VJ=20"]
        for side in sides:
            text += [f"SET B000 {side}", f"LOOP {runs}"]
            text += [f"CALL JOB:STROKE{n + 1}" for n in range(len(lines))]
            text += ["ENDLOOP"]
        text += ["MOVJ P000 VJ=20", "END"]
    first = 1
    for n, curve in enumerate(lines):
        text += [f"JOB STROKE{n + 1}", "IFTHEN B000=0", f"MOVL P{first:03d} V=50.0", "ELSE"]
        text += [f"MOVL P{first + 1:03d} V=50.0", "ENDIF", f"MOVL P{first + 2:03d} V=50.0"]
        first += 3
        text += [f"MOVL P{first:03d} V=10.0"]
        text += [f"MOVL P{first + i:03d} PL=1" for i in range(1, len(curve) - 1)]
        text += [f"MOVL P{first + len(curve) - 1:03d}"]
        text += [f"MOVL P{first + len(curve):03d} V=50.0", "END"]
        first += len(curve) + 1
    return text


def middle(lines: list[Array]) -> Array:
    """Of the text [mm]."""
    every = np.vstack(lines)
    return (every.min(axis=0) + every.max(axis=0)) / 2


def looked_at(lines: list[Array], stroke: int, scale: float) -> Array:
    """Command path of a stroke in the base frame, without its ends [mm]."""
    curve = (lines[stroke] - middle(lines)) * scale
    at = np.r_[0, np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))]
    inner = at[(at > CUT) & (at < at[-1] - CUT)]
    x, y = (np.interp(np.r_[CUT, inner, at[-1] - CUT], at, curve[:, i]) for i in (0, 1))
    return np.column_stack([ORIGIN[0] + y, ORIGIN[1] - x, np.full(len(x), ORIGIN[2])])


def points(lines: list[Array], scale: float) -> list[str]:
    """The points file of letters of a scale, about the same middle."""
    text = [
        "' IVU in the plane of user frame 1: x along the line of writing, y up, z out of the paper",
        "TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0",
        f"USER 1 X={ORIGIN[0]:g} Y={ORIGIN[1]:g} Z={ORIGIN[2]:g} A=0 B=0 C=-90",
        "P000 X=0 Y=0 Z=60 A=180 B=0 C=-90 FRONT UP NOFLIP TOOL=1 USER=1",
    ]
    number = 1

    def put(at: Array, z: float) -> None:
        nonlocal number
        text.append(f"P{number:03d} X={at[0]:.3f} Y={at[1]:.3f} Z={z:g} A=180 B=0 C=-90")
        number += 1

    for curve in lines:
        drawn = (curve - middle(lines)) * scale
        put(drawn[0] + ASIDE, LIFT)
        put(drawn[0] - ASIDE, LIFT)
        put(drawn[0], LIFT)
        for at in drawn:
            put(at, 0)
        put(drawn[-1], LIFT)
    return text


def main() -> None:
    here, lines = Path(__file__).parent, strokes()
    (here / "ivu.job").write_text("\n".join(jobs(lines)) + "\n")
    for name, scale in (("large", 1.0), ("small", SMALL)):
        (here / f"{name}.txt").write_text("\n".join(points(lines, scale)) + "\n")
    np.savetxt(here / "path.txt", looked_at(lines, 3, SMALL), fmt="%.4f")


if __name__ == "__main__":
    main()
