"""The interactive plot of the path and its magnified error."""

from typing import Any

import numpy as np

from motionfmu.analysis.contour.arcs import Array
from motionfmu.report.drawing import Drawing
from motionfmu.report.packed import packed
from motionfmu.report.style import COLORSCALE, HEAT, MUTED, PATH, RAPID, axis, layout

Figure = dict[str, Any]

CAMERA = {"eye": {"x": 1.5, "y": 1.5, "z": 1.0}, "center": {"x": 0, "y": 0, "z": -0.12}}


def path_figure(drawing: Drawing) -> Figure:
    """The path with its contour error magnified on it.

    Traces 0 to 3 are the rapids, the hairs, the path and the magnified error; the page's script
    redraws the hairs and the error when the magnification is changed.
    """
    space = len(drawing.names) == 3
    kind = "scatter3d" if space else "scatter"
    top = float(np.nanmax(np.abs(drawing.error))) * 1e3
    shown = drawing.magnified(drawing.magnify)
    marker = {
        "size": 2.5 if space else 4,
        "color": packed(np.abs(drawing.error) * 1e3),
        "colorscale": COLORSCALE,
        "cmin": 0,
        "cmax": top or 1.0,
        "colorbar": {
            "title": {"text": "Contour<br>error [µm]", "font": {"size": 12}},
            "thickness": 14,
            "len": 0.7,
            "outlinewidth": 0,
            "tickfont": {"size": 12, "color": MUTED},
        },
    }
    label = np.column_stack([drawing.time, drawing.line, drawing.error * 1e3])
    hover = (
        "%{customdata[2]:.2f} µm<br>line %{customdata[1]}, %{customdata[0]:.4f} s<extra></extra>"
    )
    traces = [
        _curve(kind, drawing.rapids, "rapid", RAPID, {"dash": "dot", "width": 1.2}),
        _curve(kind, hairs(drawing, drawing.magnify), "", "#f0c9a8", {"width": 1}),
        _curve(kind, drawing.path, "programmed path", PATH, {"width": 3 if space else 1.6}),
        _curve(kind, shown, "actual path, error magnified", HEAT[2], {"width": 1})
        | {
            "mode": "markers+lines",
            "marker": marker,
            "line": {"color": "rgba(217,83,59,0.35)", "width": 1},
            "customdata": packed(label) | {"shape": f"{len(label)},3"},
            "hovertemplate": hover,
            "hoverinfo": None,
        },
    ]
    traces[1]["showlegend"] = False
    if not len(drawing.rapids):
        traces[0]["showlegend"] = False
    titles = [f"{name} [mm]" for name in drawing.names]
    if space:
        more: Figure = scene(titles, CAMERA)
    else:
        more = {
            "xaxis": axis(titles[0], constrain="domain"),
            "yaxis": axis(titles[1], scaleanchor="x", scaleratio=1, constrain="domain"),
        }
    more |= {"hovermode": "closest"}
    return {"data": traces, "layout": layout(640, **more)}


def scene(titles: list[str], camera: Figure) -> Figure:
    """Layout of a path in space, with the axes alike."""
    axes = {f"{a}axis": axis(t) for a, t in zip("xyz", titles, strict=True)}
    for one in axes.values():
        for key in ("automargin", "ticks", "tickcolor"):
            one.pop(key)
        one["title"].pop("standoff")
    return {"scene": axes | {"aspectmode": "data", "camera": camera}}


def hairs(drawing: Drawing, factor: float) -> Array:
    """Hairs (3 n, k) from the path to the magnified error [mm]."""
    # Two ends and a row of NaN for each hair.
    ends = drawing.magnified(factor)[drawing.hairs]
    out = np.full((3 * len(ends), ends.shape[1]), np.nan)
    out[::3], out[1::3] = drawing.foot[drawing.hairs], ends
    return out


def _curve(kind: str, points: Array, name: str, color: str, line: Figure) -> Figure:
    out: Figure = {"type": kind, "mode": "lines", "name": name, "hoverinfo": "skip"}
    out["line"] = {"color": color} | line
    return out | {a: packed(points[:, i]) for i, a in enumerate("xyz"[: points.shape[1]])}
