"""The path of a run and its magnified contour error."""

import numpy as np

from motionfmu.analysis.contour import ContourResult
from motionfmu.analysis.contour.arcs import Array
from motionfmu.report.diagram import DOT, Diagram, Heat, path_diagram, path_lines
from motionfmu.report.error_path import ErrorPath
from motionfmu.report.numbers import length
from motionfmu.report.style import HEAT, PATH, RAPID

HAIR = "#f0c9a8"
HEIGHT = 560  # [pixel]


def path_chart(drawn: ErrorPath) -> Diagram:
    """The path with its contour error magnified on it.

    Marks 0 to 3 are the rapids, the hairs, the path and the magnified error; the page's script
    redraws the hairs and the error when the magnification is changed.
    """
    size = np.abs(drawn.error) * 1e3
    heat = Heat(size, "Contour error [µm]", (0.0, float(np.nanmax(size)) or 1.0))
    told = [
        f"{1e3 * error:.2f} µm\nline {line}, {time:.4f} s"
        for error, line, time in zip(drawn.error, drawn.line, drawn.time, strict=True)
    ]
    error = {"name": "actual path, error magnified", "color": HEAT[2], "heat": heat}
    marks = [
        path_lines(drawn.rapids, name="rapid", color=RAPID, width=1.2, dash=DOT, hover=()),
        path_lines(hairs(drawn, drawn.magnify), color=HAIR, width=1.0, hover=()),
        path_lines(drawn.path, name="programmed path", color=PATH, width=1.6, hover=()),
        path_lines(drawn.magnified(drawn.magnify), hover=told, **error),
    ]
    return path_diagram(drawn.names, marks, HEIGHT)


def path_titles(name: str, contour: ContourResult, drawn: ErrorPath) -> tuple[str, str]:
    """Title and note of the picture of a path."""
    error = contour.error
    note = f"largest {length(error.max)} in line {error.line}, RMS {length(error.rms)}"
    return f"{name}: contour error drawn {drawn.magnify:,.0f} times as large", note


def hairs(drawn: ErrorPath, factor: float) -> Array:
    """Hairs (3 n, k) from the path to the magnified error [mm]."""
    # Two ends and a row of NaN for each hair.
    ends = drawn.magnified(factor)[drawn.hairs]
    out = np.full((3 * len(ends), ends.shape[1]), np.nan)
    out[::3], out[1::3] = drawn.foot[drawn.hairs], ends
    return out
