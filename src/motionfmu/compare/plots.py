"""What the page of a comparison draws: A blue, B orange, their difference below."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.contour.circles import plane_axes
from motionfmu.compare.overlay import Pair
from motionfmu.compare.pairing import Pairing
from motionfmu.compare.side import Side
from motionfmu.compare.words import GONE
from motionfmu.report.diagram import (
    DASH,
    DOT,
    SOLID,
    Diagram,
    Mark,
    SamplesMark,
    Scale,
    Subplot,
    ends_of,
    path_diagram,
    path_lines,
)
from motionfmu.report.error_scale import magnification, scale_end, within
from motionfmu.report.numbers import label, unit
from motionfmu.report.polar_chart import deviation_line, polar_rings
from motionfmu.report.samples import Samples
from motionfmu.report.signal_chart import recolored, signal_chart
from motionfmu.report.style import AXES, PATH
from motionfmu.run.decimate import keep_peaks
from motionfmu.run.figures import Chart, Curve, Panel
from motionfmu.scenarios.rates import change, wrong

Array = NDArray[np.float64]

RUN_A, RUN_B = "run A", "run B"
A, B = AXES[0], AXES[1]
DIFFERENCE = ("#5a0f45", *AXES[2:], AXES[0], AXES[1])  # of one element, of several
POINTS, BUCKETS = 2400, 400
HEIGHT = 520  # [pixel] of the path
FLAT = 1e-6  # part of its size by which a path in a plane leaves it
SAME_PATH = 1e-2  # [mm] two paths whose points lie nearer are one: lengths are kept in 32 bits


def signal_figure(found: Pairing, name: str) -> Diagram:
    """A signal of both runs, a panel for each element that differs, and the difference."""
    both = found[name]
    panels, looks = [], []
    gone: list[Curve] = []
    for i in both.differing:
        curves = [
            Curve(run, x.time, _column(x, name, i), both.steps)
            for run, x in ((RUN_A, found.a), (RUN_B, found.b))
        ]
        element = both.names[i].removeprefix(name)  # "[1]": the heading has the name
        title = label(element or name.rpartition(".")[2], both.unit)
        panels.append(Panel(title, tuple(curves), {}, True))
        looks += [(A, SOLID), (B, SOLID)]
        gone.append(Curve(element, both.time, both.difference[:, i], both.steps))
    several = len(gone) > 1
    panels.append(Panel(label(GONE, both.unit), tuple(gone), {}, several))
    looks += [(DIFFERENCE[(i + several) % len(DIFFERENCE)], SOLID) for i in range(len(gone))]
    return recolored(signal_chart(Chart(name, "", _whole(found), True, tuple(panels))), looks)


def _column(x: Side, name: str, i: int) -> Array:
    data = x.signals[name]
    return data.reshape(len(data), -1)[:, i].astype(np.float64)


def _whole(found: Pairing) -> tuple[float, float]:
    """From the earliest sample of both runs to the latest."""
    ends = [t for x in (found.a, found.b) for t in (float(x.time[0]), float(x.time[-1]))]
    return min(ends), max(ends)


def figure_of(found: Pairing, asked: Mapping[str, Any]) -> Diagram | None:
    """A figure of the scenario with the curves of both runs; None if they do not have them."""
    panels: list[Panel] = []
    looks: list[tuple[str, str]] = []
    window = asked["window"]
    for plot in asked["plot"]:
        named = _named(found, plot)
        if not named:
            return None
        alone = len(named) == 1
        curves, gone = [], []
        for k, (words, both, i) in enumerate(named):
            for run, x in ((RUN_A, found.a), (RUN_B, found.b)):
                own = Curve("", x.time, _column(x, both.name, i), both.steps)
                curves.append(_drawn(own, plot, run if alone else f"{words}, {run}", window))
            apart = Curve("", both.time, both.difference[:, i], both.steps)
            gone.append(_drawn(apart, plot, words, window))
            color = AXES[k % len(AXES)]
            looks += [(A, SOLID), (B, SOLID)] if alone else [(color, SOLID), (color, DASH)]
        if len(_known(curves)) < len(curves):
            return None
        panels.append(Panel(plot["label"], _known(curves), dict(plot["levels"]), True))
        unit_of = plot["label"][plot["label"].rindex("[") :] if "[" in plot["label"] else ""
        if len(_known(gone)) == len(gone):  # else the common times do not bear the rate
            panels.append(Panel(f"{GONE} {unit_of}".strip(), _known(gone), {}, not alone))
            colors = DIFFERENCE[:1] if alone else [AXES[k % len(AXES)] for k in range(len(gone))]
            looks += [(color, SOLID) for color in colors]
    span = (window[0], window[1]) if window else _whole(found)
    chart = Chart(asked["title"], "", span, window is None, tuple(panels))
    return recolored(signal_chart(chart), looks)


def _named(found: Pairing, plot: Mapping[str, Any]) -> list[tuple[str, Pair, int]]:
    """Name, signal and element of each curve of a panel; none if a run lacks one."""
    named: list[tuple[str, Pair, int]] = []
    for signal in plot["signals"]:
        whole, bracket, index = signal.partition("[")
        if whole not in found.names:
            return []
        both = found[whole]
        wanted = [int(index.removesuffix("]")) - 1] if bracket else range(both.a.shape[1])
        named += [(both.names[i], both, i) for i in wanted]
    names = plot["names"] or [name for name, *_ in named]
    return [(words, both, i) for words, (_, both, i) in zip(names, named, strict=True)]


def _drawn(
    own: Curve, plot: Mapping[str, Any], name: str, window: Sequence[float] | None
) -> Curve | None:
    """A curve as the figure asks for it; None if a rate does not fit its times."""
    time, values = own.time, own.values
    if plot["rate"] is not None:
        step = round(1e9 * (time[1] - time[0])) if len(time) > 1 else 0
        if not step or wrong(plot["rate"], step, float(time[-1])):
            return None
        time, values = change(time, values, plot["rate"])
    low, high = window or (-math.inf, math.inf)
    first = max(0, int(np.searchsorted(time, low, side="right")) - 1)
    part = slice(first, int(np.searchsorted(time, high)) + 1)
    return Curve(name, time[part], plot["scale"] * values[part], plot["steps"] or own.steps)


def _known(curves: Sequence[Curve | None]) -> tuple[Curve, ...]:
    return tuple(c for c in curves if c is not None)


def same_path(a: Side, b: Side) -> bool:
    """Whether both runs follow the same path, as far as both go."""
    one, other = (_cut(x) for x in (a, b))
    inside = (one[0] >= other[0][0]) & (one[0] <= other[0][-1])
    if not inside.any():
        return False
    feet = [np.interp(one[0][inside], other[0], c) for c in other[2].T]
    near = np.linalg.norm(np.column_stack(feet) - one[2][inside], axis=1)
    return float(np.quantile(near, 0.99)) < SAME_PATH


def _cut(x: Side) -> tuple[Array, Array, Array]:
    """Way along the path, error and point of the path, where the tool cuts; the way increases."""
    error = x.track["error"]
    known = np.flatnonzero(np.isfinite(error))
    along, first = np.unique(x.track["along"][known], return_index=True)
    return along, error[known[first]], x.track["foot"][known[first]].astype(np.float64)


def error_figure(a: Side, b: Side) -> tuple[Diagram, float]:
    """Contour error of both runs along the path, the difference below, and how large it is [mm]."""
    one, other = _cut(a), _cut(b)
    inside = (one[0] >= other[0][0]) & (one[0] <= other[0][-1])
    way = one[0][inside]
    gone = np.interp(way, other[0], other[1]) - one[1][inside]
    factor, name = unit(max(np.abs(one[1]).max(), np.abs(other[1]).max()))
    finer, fine = unit(float(np.abs(gone).max()))
    curves = [
        SamplesMark(Samples(x[0], factor * x[1]), run, color)
        for x, run, color in ((one, RUN_A, A), (other, RUN_B, B))
    ]
    change = SamplesMark(Samples(way, finer * gone), GONE, DIFFERENCE[0])
    ends = float(min(one[0][0], other[0][0])), float(max(one[0][-1], other[0][-1]))
    rows = (
        _subplot("Contour error", name, curves, 202.0),
        _subplot(GONE, fine, [change], 118.0),
    )
    drawn = Diagram((Scale("Along the path", "mm", ends),), rows)
    return drawn, float(np.abs(gone).max())


def _subplot(title: str, unit: str, curves: Sequence[SamplesMark], height: float) -> Subplot:
    ends = ends_of([c.samples.values for c in curves], zero=True)
    return Subplot(Scale(title, unit, ends), curves, height)


def path_figure(a: Side, b: Side) -> tuple[Diagram, float]:
    """Both paths with their errors so many times as large, and how many."""
    feet = [x.track["foot"][np.isfinite(x.track["error"])] for x in (a, b)]
    every = np.concatenate(feet).astype(np.float64)
    size = np.ptp(every, axis=0)
    chosen = np.sort(np.argsort(size)[1:])  # the plane of the two longest sides
    flat = float(size.min()) <= FLAT * float(size.max())
    drawn = chosen if flat else np.arange(3)
    errors = np.concatenate([np.abs(x.track["error"]) for x in (a, b)])
    known = errors[np.isfinite(errors)]
    corners = max(len(x.numbers["contour"]["corners"]) for x in (a, b))
    reach = max(float(x.track["along"].max()) for x in (a, b)) / (corners + 1)
    worst = float(np.percentile(known, 95)), float(known.max())
    factor = magnification(worst, float(size.max()), reach)
    lines: list[Mark] = []
    for x, run, color in ((a, RUN_A, A), (b, RUN_B, B)):
        kept = _kept(x.track["error"])
        foot, gap = (x.track[k][kept][:, drawn].astype(np.float64) for k in ("foot", "gap"))
        if not lines:
            nominal = np.where(np.isfinite(gap), foot, np.nan)
            look: Any = {"color": PATH, "width": 1.4, "hover": ()}
            lines.append(path_lines(nominal, name="programmed path", **look))
        told = [f"{run}: {1e3 * error:.2f} µm" for error in x.track["error"][kept]]
        look = {"name": run, "color": color, "width": 1.8, "hover": told}
        lines.append(path_lines(foot + factor * within(gap, scale_end(worst)), **look))
    return path_diagram(["XYZ"[i] for i in drawn], lines, HEIGHT), factor


def _kept(error: Array) -> NDArray[np.int64]:
    """Samples that draw the error well: even ones, peaks, and both sides of a gap."""
    cut = np.isfinite(error)
    edges = np.flatnonzero(np.diff(cut)) if len(cut) > 1 else np.empty(0, dtype=np.int64)
    even = np.flatnonzero(cut)[np.linspace(0, cut.sum() - 1, POINTS).astype(np.int64)]
    peaks = keep_peaks(np.nan_to_num(error), BUCKETS)
    return np.unique(np.concatenate([even, peaks, edges, edges + 1]))


def circle_figure(found: Pairing, place: int) -> Diagram | None:
    """Radial deviation of both runs round a circle; None if a run did not go round it."""
    lines, done = [], set()
    for x, run, color in ((found.a, RUN_A, A), (found.b, RUN_B, B)):
        for way, words, dash in (("ccw", "counter-clockwise", SOLID), ("cw", "clockwise", DOT)):
            angle = x.track.get(f"circles.{place}.{way}.angle")
            if angle is None:
                continue
            done.add(run)
            deviation = 1e3 * x.track[f"circles.{place}.{way}.deviation"]
            lines.append(deviation_line(angle, deviation, f"{run}, {words}", color, dash))
    if len(done) < 2:
        return None
    normal = np.array(found.a.numbers["contour"]["circles"][place]["normal"])
    return polar_rings(lines, plane_axes(normal))
