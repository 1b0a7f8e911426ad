"""The explanation as a picture: bars of the causes, and the ballbar."""

import math
from pathlib import Path
from typing import TYPE_CHECKING, Any

import matplotlib
import numpy as np
from matplotlib.figure import Figure

from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.pictures import PLAIN, STABLE
from motionfmu.report.polar_plot import polar_names, polar_trace
from motionfmu.report.style import CCW, CW, GRID, INK, MUTED

if TYPE_CHECKING:
    from motionfmu.analysis.explain.decompose import Effect, Explanation

PICTURES = ("causes.svg", "causes.png")
CAUSE, FORMULA = "#0072b2", "#9ec8e3"


def write_picture(found: "Explanation", folder: Path) -> None:
    """Draw the causes, and the first circle run both ways round."""
    polar = bool(found.signatures)
    with matplotlib.rc_context(PLAIN | STABLE):
        drawn = Figure(figsize=(11.0, 4.6) if polar else (8.0, 4.0), layout="constrained")
        left: Any = drawn.add_subplot(1, 2 if polar else 1, 1)
        _bars(left, [e for e in found.effects if e.judged and (e.size > 0.0 or e.theory.value)])
        left.set_title(f"{found.result.name}: causes of the contour error", loc="left")
        if polar:
            _polar(drawn.add_subplot(1, 2, 2, projection="polar"), found)
        for file in PICTURES:
            plain = {"Date": None} if file.endswith("svg") else None
            drawn.savefig(folder / file, dpi=100, metadata=plain)


def _bars(axes: Any, effects: "list[Effect]") -> None:
    effects = effects[::-1]
    largest = max((max(e.size, e.theory.value or 0.0) for e in effects), default=0.0)
    factor, name = unit(largest)
    place = np.arange(len(effects))
    for shift, color, what, values in (
        (0.2, CAUSE, "simulated", [e.size for e in effects]),
        (-0.2, FORMULA, "theory", [e.theory.value for e in effects]),
    ):
        sizes = [0.0 if v is None else v * factor for v in values]
        axes.barh(place + shift, sizes, 0.38, color=color, label=what)
        for y, value, size in zip(place, values, sizes, strict=True):
            if value is not None:
                axes.annotate(
                    figure(size),
                    (size, y + shift),
                    (3, 0),
                    textcoords="offset points",
                    va="center",
                    fontsize=9,
                    color=MUTED,
                )
    axes.set_yticks(place, [e.title.replace(" (", "\n(") for e in effects], color=INK)
    axes.set_xlabel(f"Largest change of the contour error [{name}]")
    axes.margins(x=0.12)
    axes.grid(axis="x", color=GRID)
    axes.set_axisbelow(True)
    axes.tick_params(length=0)
    for side in axes.spines.values():
        side.set_visible(False)
    axes.legend(frameon=False, loc="lower right", reverse=False)


def _polar(axes: Any, found: "Explanation") -> None:
    mark = found.signatures[0]
    test = mark.test
    top = 0.0
    for way, color, name in ((test.ccw, CCW, "ccw"), (test.cw, CW, "cw")):
        if way is None:
            continue
        angle, deviation = polar_trace(way, test.radius)
        top = max(top, float(np.abs(deviation).max()))
        axes.plot(np.radians(angle), deviation, color=color, lw=1.3, label=name)
    turn = np.linspace(0.0, 2.0 * math.pi, 181)
    axes.plot(turn, np.zeros_like(turn), color=INK, lw=1.0, ls="--", label="nominal")
    top = top or 1.0
    axes.set_rlim(-2.2 * top, 1.05 * top)
    axes.set_rticks([-top, 0.0], [length(-1e-3 * top), "0"], fontsize=8, color=MUTED)
    axes.set_rlabel_position(67.5)
    axes.set_xticks(np.radians(np.arange(0, 360, 45)), polar_names(test.axes), fontsize=9)
    axes.grid(color=GRID)
    axes.spines["polar"].set_color(GRID)
    named = [f"{f.name} {length(f.size)}" for f in mark.findings if f.named]
    pairs = [", ".join(named[i : i + 3]) for i in range(0, len(named), 3)]
    words = "\n".join([f"mean radius {length(mark.mean, sign=True)}", *pairs])
    axes.set_title(f"Ballbar R {test.radius:g} mm, {words}", fontsize=10)
    axes.legend(frameon=False, loc="lower left", bbox_to_anchor=(-0.16, -0.08), fontsize=9)
