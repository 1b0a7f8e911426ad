"""The path of a run and its magnified contour error."""

from typing import Any

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.arcs import Array
from motionfmu.report.diagram import DOT, Diagram, Heat, Mark, PointMark, path_diagram, path_lines
from motionfmu.report.error_path import ErrorPath
from motionfmu.report.error_scale import BEYOND
from motionfmu.report.numbers import length
from motionfmu.report.style import HEAT, INK, PATH, RAPID

HAIR = "#f0c9a8"
HEIGHT = 560  # [pixel]
OUTLIERS_TOLD = 3


def path_chart(drawn: ErrorPath) -> Diagram:
    """The path with its contour error magnified on it.

    Marks 0 to 3 are the rapids, the hairs, the path and the magnified error, and 4 its outliers, if
    there are any; the page's script redraws 1, 3 and 4 when the magnification is changed.
    """
    size = np.abs(drawn.error) * 1e3
    heat = Heat(size, "Contour error [µm]", (0.0, 1e3 * drawn.end or 1.0))
    told = [
        f"{1e3 * error:.2f} µm\nline {line}, {time:.4f} s"
        for error, line, time in zip(drawn.error, drawn.line, drawn.time, strict=True)
    ]
    error = {"name": "actual path, error magnified", "color": HEAT[2], "heat": heat}
    marks: list[Mark] = [
        path_lines(drawn.rapids, name="rapid", color=RAPID, width=1.2, dash=DOT, hover=()),
        path_lines(hairs(drawn, drawn.magnify), color=HAIR, width=1.0, hover=()),
        path_lines(drawn.path, name="programmed path", color=PATH, width=1.6, hover=()),
        path_lines(drawn.magnified(drawn.magnify), hover=told, **error),
    ]
    if len(drawn.outliers):
        places = drawn.magnified(drawn.magnify)[drawn.outliers]
        z = places[:, 2] if places.shape[1] == len("XYZ") else None
        look: Any = {"name": f"beyond {length(drawn.end)}", "color": INK, "symbol": "diamond"}
        look |= {"size": 9.0, "hover": [told[k] for k in drawn.outliers]}
        marks.append(PointMark(places[:, 0], places[:, 1], z=z, **look))
    return path_diagram(drawn.names, marks, HEIGHT)


def outlier_words(drawn: ErrorPath) -> str:
    """Where the error goes beyond the colours; empty if it does not."""
    places = sorted(drawn.outliers, key=lambda k: -abs(drawn.error[k]))
    if not places:
        return ""
    first = places[:OUTLIERS_TOLD]
    told = [f"{length(abs(drawn.error[k]))} in line {drawn.line[k]}" for k in first]
    told += [f"{more} more"] if (more := len(places) - len(told)) else []
    return (
        f"Colours end at {length(drawn.end)}, {BEYOND:g} times the 95 % point. Diamonds mark what"
        f" is beyond, which is drawn no longer than that: {', '.join(told)}."
    )


def path_titles(name: str, contour: ContourResult, drawn: ErrorPath) -> tuple[str, str]:
    """Title and note of the picture of a path."""
    error = contour.error
    note = f"largest {length(error.max)} in line {error.line}, RMS {length(error.rms)}"
    note += f"\n{words}" if (words := outlier_words(drawn)) else ""
    return f"{name}: contour error drawn {drawn.magnify:,.0f} times as large", note


def hairs(drawn: ErrorPath, factor: float) -> Array:
    """Hairs (3 n, k) from the path to the magnified error [mm]."""
    # Two ends and a row of NaN for each hair.
    ends = drawn.magnified(factor)[drawn.hairs]
    out = np.full((3 * len(ends), ends.shape[1]), np.nan)
    out[::3], out[1::3] = drawn.foot[drawn.hairs], ends
    return out
