"""The path that a part program asks for, as a page draws it."""

from pathlib import Path
from typing import Any

import numpy as np

from motionfmu.analysis.gcode import read, strokes
from motionfmu.analysis.iso9283.simplify import simplified
from motionfmu.base.errors import InputError
from motionfmu.base.program_endings import CARD_JOBS, ROBOT_JOBS

# Points that a page is given at most; off by less than this share of the path's extent.
POINTS, COARSE = 60_000, 3e-4


def planned_path(program: dict[str, Any] | None) -> list[dict[str, Any]]:
    """The strokes of a program up to its first fault: rapid or not, points [mm], lines."""
    if program is None or Path(program["path"]).suffix.lower() in (*ROBOT_JOBS, *CARD_JOBS):
        return []
    tools = Path(program["tools"]).read_text("utf-8") if program.get("tools") else ""
    try:
        found = list(strokes(read(Path(program["path"]), tools)))
    except InputError:
        return []
    if not found:
        return []
    every = np.concatenate([s.points for s in found])
    extent = float(np.linalg.norm(np.ptp(every, axis=0)))
    kept = [simplified(s.points, COARSE * extent) for s in found]
    thin = max(1, -(-sum(map(len, kept)) // POINTS))
    made = []
    for stroke, chosen in zip(found, kept, strict=True):
        few = np.unique(np.append(chosen[::thin], chosen[-1]))
        points = np.round(stroke.points[few], 4)
        made.append(
            {"rapid": stroke.rapid, "points": points.tolist(), "lines": stroke.line[few].tolist()}
        )
    return made
