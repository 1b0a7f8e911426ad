"""Contours as a part program for a mill."""

from collections.abc import Iterator
from dataclasses import dataclass, field

import numpy as np

from motionfmu.drawings.contours import PenContour, corners
from motionfmu.drawings.drawing_options import DrawingOptions
from motionfmu.drawings.pen_path import SAME, Array, PenPath, at_share, bend_of, shares

CORNER = 20.0  # [deg] what turns more is a corner, as on a network card
# [mm] The path between corners is one curve within this of the contour, as on a network card.
ROUND = 0.02
# [mm] A curve of a smaller radius, which a controller may take for a cusp, is drawn in chords.
SHARP = 0.002
_NONE = -1


@dataclass
class GcodeText:
    """Lines of a part program, and the place in the drawing that each is from."""

    lines: list[str] = field(default_factory=list)
    source: list[int] = field(default_factory=list)

    def add(self, line: str, source: int = _NONE) -> None:
        """Write a line, unless it is empty."""
        if line:
            self.lines.append(line)
            self.source.append(source)

    @property
    def text(self) -> str:
        """All of it."""
        return "\n".join(self.lines) + "\n"


def gcode_of(
    contours: list[PenContour], name: str, options: DrawingOptions, has_z: bool
) -> GcodeText:
    """A part program that draws contours, with the pen as Z if there is one.

    Arcs are G2 and G3, curves G5, the rest is G1. Corners are exact stops, if options say no other;
    what lies between them is G64 P.
    """
    found = GcodeText()
    found.add(f"({''.join(c for c in name if c.isalnum() or c in ' ._-')})")
    found.add("G90 G21 G17 G94 G61")
    up, down = (f"G0 Z{options.up:g}", f"G1 Z{options.down:g}") if has_z else ("", "")
    exact = True
    for contour in contours:
        path = contour.path.moved(1.0, options.offset)
        found.add(up, contour.first)
        found.add(f"G0 {_place(path.nodes[0])}", contour.first)
        found.add(down, contour.first)
        if contour.speed:
            found.add(f"F{contour.speed * 60:.6g}", contour.first)
        for stops, lines, source in _pieces(path, options.corners != "round"):
            if stops != exact:
                found.add("G61" if stops else f"G64 P{ROUND:g}", source)
                exact = stops
            for line in lines:
                found.add(line, source)
    found.add(up)
    found.add("M2")
    return found


def _pieces(path: PenPath, stop: bool) -> Iterator[tuple[bool, list[str], int]]:
    """Of each piece whether it ends with an exact stop, its lines, and where it is from."""
    points, places = path.with_chords()
    sharp = corners(points, CORNER)[places] if stop else np.zeros(len(places), bool)
    sharp[-1:] = True
    centres, curved = path.centres(), path.curved
    for k in range(len(path.source)):
        begin, end = path.nodes[k], path.nodes[k + 1]
        if path.bulges[k]:
            i, j = centres[k] - begin
            word = "G3" if path.bulges[k] > 0.0 else "G2"
            lines = [f"{word} {_place(end)} I{i:.6f} J{j:.6f}"]
        elif curved[k]:
            lines = _curve(path.piece(k))
        else:
            lines = [f"G1 {_place(end)}"]
        yield bool(sharp[k + 1]), lines, int(path.source[k])


def _curve(cubic: Array) -> list[str]:
    """A cubic curve as G5, or in chords if it has no direction at an end or nearly a cusp."""
    (i, j), (p, q) = cubic[1] - cubic[0], cubic[2] - cubic[3]
    if min(np.hypot(i, j), np.hypot(p, q)) > 10.0 * SAME and bend_of(cubic) < 1.0 / SHARP:
        return [f"G5 {_place(cubic[3])} I{i:.6f} J{j:.6f} P{p:.6f} Q{q:.6f}"]
    return [f"G1 {_place(point)}" for point in at_share(cubic, shares(cubic, 0.1 * ROUND))]


def _place(point: Array) -> str:
    return f"X{point[0]:.6f} Y{point[1]:.6f}"
