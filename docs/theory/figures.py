"""Figures of the pages beside this file, from the libraries that the tests build.

After `make build`: PYTHONPATH=tests .venv/bin/python docs/theory/figures.py
"""

import itertools
import math
from collections.abc import Callable
from pathlib import Path

import matplotlib as mpl
import numpy as np
from matplotlib import pyplot as plt
from matplotlib.axes import Axes
from scurve_moves import MOVE, scurve_positions, scurve_totals
from shape_paths import Segment, lines, shaped
from speed_rides import Chain, Orders, hermite, limits, place, planned, ride

HERE = Path(__file__).parent
BLUE, RED, GREEN, GREY, ORANGE = "#1f5fa8", "#c0392b", "#2e8b57", "#777777", "#d98200"
Array = np.ndarray
FIGURES: list[Callable[[], plt.Figure]] = []


def figure(made: Callable[[], plt.Figure]) -> Callable[[], plt.Figure]:
    """Note a function that makes the figure of its name."""
    FIGURES.append(made)
    return made


def panels(rows: int, columns: int, size: tuple[float, float], **more: object) -> tuple:
    """A figure and its axes, all with a thin grid."""
    made, axes = plt.subplots(rows, columns, figsize=size, layout="constrained", **more)
    for ax in np.atleast_1d(axes).ravel():
        ax.grid(color="#e4e4e4", linewidth=0.6)
        ax.set_axisbelow(True)
    return made, axes


def along(segments: list[Segment], count: int = 400) -> tuple[Array, Array, Array, Array]:
    """Parameter, places, r' and r'' along segments, from 0."""
    start, rows = 0.0, []
    for p in segments:
        u = np.linspace(0.0, p.length, count)
        rows.append((start + u, *p.at(u)))
        start += p.length
    return tuple(np.concatenate(x) for x in zip(*rows, strict=True))  # type: ignore[return-value]


def curvature(slope: Array, bend: Array) -> Array:
    """Signed curvature in X Y. [1/mm]"""
    cross = slope[:, 0] * bend[:, 1] - slope[:, 1] * bend[:, 0]
    return cross / np.linalg.norm(slope[:, :2], axis=1) ** 3


def tube(ax: Axes, points: Array, radius: float) -> None:
    """What is within a radius of a polyline, as a band of that width in data units."""
    from shapely.geometry import LineString

    band = LineString(points).buffer(radius, quad_segs=24)
    x, y = band.exterior.xy
    ax.fill(x, y, color="#dfe9f5", zorder=0)
    ax.plot(x, y, color="#9db8d9", linewidth=0.7, zorder=1)


@figure
def corner() -> plt.Figure:
    """A corner of 90 degrees: with room two quintics, without room one."""
    tolerance = 0.05
    fig, (left, right) = panels(1, 2, (9.0, 3.7))
    for side, colour, name in ((3.0, BLUE, "lines of 3 mm"), (0.24, RED, "lines of 0.24 mm")):
        points = np.array([[-side, 0.0], [0.0, 0.0], [0.0, side]])
        segments, _ = shaped(lines(points, tolerance, 0.0))
        curves = [p for p in segments if p.kind == "curve"]
        u, at, slope, bend = along(segments)
        middle = u[-1] / 2.0
        left.plot(at[:, 0], at[:, 1], color=colour, label=name, linewidth=1.6, zorder=3)
        joints = [curves[0].at(np.zeros(1))[0], *(c.at(np.array([c.length]))[0] for c in curves)]
        ends = np.vstack(joints)
        left.plot(ends[:, 0], ends[:, 1], "o", color=colour, markersize=4, zorder=4)
        near = abs(u - middle) < 1.6
        right.plot(u[near] - middle, curvature(slope, bend)[near], color=colour, label=name)
    wide = np.array([[-1.3, 0.0], [0.0, 0.0], [0.0, 1.3]])
    tube(left, wide, tolerance)
    left.plot(wide[:, 0], wide[:, 1], "--", color=GREY, linewidth=0.9, label="commands", zorder=2)
    left.set(xlim=(-0.9, 0.15), ylim=(-0.15, 0.9), aspect="equal", xlabel="X [mm]", ylabel="Y [mm]")
    left.set_title("band: tolerance 0.05 mm", fontsize=9)
    left.legend(loc="upper left", fontsize=8)
    right.set(xlabel="parameter from the corner's middle [mm]", ylabel="curvature [1/mm]")
    right.legend(loc="upper left", fontsize=8)
    return fig


@figure
def swing() -> plt.Figure:
    """Distance of the first half of a corner from its line, for parts p of the half length."""
    fig, ax = panels(1, 1, (6.4, 3.4))
    t = np.linspace(0.0, 1.0, 500)
    for p, colour in ((0.375, RED), (0.2, ORANGE), (0.1, GREEN), (0.048, BLUE)):
        bend = 1.5 + 17.0 * (0.375 - p)
        control = [0.0, 0.0, 0.0, p + bend / 20.0 - 0.4, p - 0.2, p]
        off = sum(math.comb(5, k) * t**k * (1 - t) ** (5 - k) * c for k, c in enumerate(control))
        ax.plot(t, off, color=colour, label=f"p = {p:g}")
    ax.axhline(0.0, color=GREY, linewidth=0.8)
    ax.set(xlabel="τ = u / half", ylabel="w(τ) - (1 - τ)", xlim=(0, 1))
    ax.text(0.03, -0.028, "outside", fontsize=8, color=GREY)
    ax.text(0.03, 0.012, "inside", fontsize=8, color=GREY)
    ax.legend(fontsize=8, loc="upper left", bbox_to_anchor=(0.14, 1.0))
    return fig


def raster_points() -> Array:
    """A slope on a raster of 25 um, bent in the middle."""
    x = np.linspace(0.0, 12.0, 6000)
    y = 0.9 * np.sin(x / 2.2) + 0.1 * x
    p = np.round(np.c_[x, y] * 40.0) / 40.0
    return p[np.r_[True, np.any(np.diff(p, axis=0) != 0.0, axis=1)]]


@figure
def raster() -> plt.Figure:
    """A run of short lines on a raster, its tube and its spline."""
    tolerance, points = 0.02, raster_points()
    segments, _ = shaped(lines(points, tolerance))
    u, at, slope, bend = along(segments, 60)
    fig, (left, right) = panels(1, 2, (9.0, 3.6))
    inside = (points[:, 0] > 0.4) & (points[:, 0] < 1.8)
    tube(left, points[inside], tolerance)
    left.plot(points[:, 0], points[:, 1], color=GREY, linewidth=0.9, label="commands")
    left.plot(at[:, 0], at[:, 1], color=BLUE, linewidth=1.6, label="spline")
    knots = np.array([p.at(np.zeros(1))[0][0] for p in segments])
    left.plot(knots[:, 0], knots[:, 1], "o", color=BLUE, markersize=4, label="knots")
    left.set(xlim=(0.6, 1.5), ylim=(0.25, 0.77), aspect="equal", xlabel="X [mm]", ylabel="Y [mm]")
    left.set_title("band: tolerance 0.02 mm", fontsize=9)
    left.legend(fontsize=8, loc="upper left")
    x = at[:, 0]
    dy, ddy = 0.9 / 2.2 * np.cos(x / 2.2) + 0.1, -0.9 / 2.2**2 * np.sin(x / 2.2)
    right.plot(u, ddy / (1.0 + dy**2) ** 1.5, color=ORANGE, label="curve behind the raster")
    right.plot(u, curvature(slope, bend), color=BLUE, label="spline")
    right.set(xlabel="parameter [mm]", ylabel="curvature [1/mm]", xlim=(0, 11.5), ylim=(-0.3, 0.3))
    right.legend(fontsize=8)
    return fig


@figure
def proof() -> plt.Figure:
    """One chord: the parts of its curve with control points, and the feet."""
    fig, ax = panels(1, 1, (7.2, 2.9))
    a, b, radius = np.array([0.0, 0.0]), np.array([4.0, 0.0]), 0.5
    tube(ax, np.array([a, b]), radius)
    control = np.array([[0.35, 0.3], [1.4, 0.45], [2.6, -0.42], [3.75, -0.25]])
    t = np.linspace(0.0, 1.0, 200)[:, None]
    curve = sum(math.comb(3, k) * t**k * (1 - t) ** (3 - k) * c for k, c in enumerate(control))
    ax.plot([a[0], b[0]], [a[1], b[1]], "o-", color=GREY, linewidth=1.0)
    ax.plot(control[:, 0], control[:, 1], "s--", color=ORANGE, linewidth=0.8, markersize=4)
    ax.plot(curve[:, 0], curve[:, 1], color=BLUE, linewidth=1.8)
    for end in (control[0], control[3]):
        ax.plot([end[0], end[0]], [end[1], 0.0], ":", color=RED, linewidth=1.2)
        ax.plot(end[0], 0.0, "x", color=RED)
    for corner_at, end in ((a, control[0]), (b, control[3])):
        ax.plot([corner_at[0], end[0]], [corner_at[1], end[1]], "-", color=RED, linewidth=0.8)
    for text, at in (
        ("vertex i", (-0.42, -0.2)),
        ("vertex i+1", (3.9, 0.12)),
        ("$r(u_i)$", (0.05, 0.36)),
        ("$r(u_{i+1})$", (3.55, -0.45)),
        ("control points", (1.5, 0.33)),
        ("feet", (0.45, -0.2)),
        ("band of the tolerance", (1.55, -0.64)),
    ):
        ax.text(*at, text, fontsize=9)
    ax.set(xlim=(-0.7, 4.7), ylim=(-0.75, 0.65), aspect="equal")
    ax.axis("off")
    return fig


def bends() -> Array:
    """60 mm whose curvature swells and fades, in curves of 0.5 mm."""
    s = np.linspace(0.0, 60.0, 24_001)
    bend = 0.35 * np.sin(s / 4.0) * np.sin(s / 19.0) ** 2
    angle = np.concatenate([[0.0], np.cumsum(0.5 * (bend[1:] + bend[:-1]) * s[1])])
    middle = 0.5 * (angle[1:] + angle[:-1])
    x, y = (np.append(0.0, np.cumsum(f(middle) * s[1])) for f in (np.cos, np.sin))
    ends, chain = [], Chain(feed=120.0)
    for i in range(0, len(s), 200):
        ahead = place(np.cos(angle[i]), np.sin(angle[i]))
        across = place(-np.sin(angle[i]), np.cos(angle[i]))
        ends.append(np.array([place(x[i], y[i]), ahead, bend[i] * across]))
    for start, end in itertools.pairwise(ends):
        chain.curve(hermite(start, end, 0.5), 0.5)
    return chain.told()


ACC, JERK = 1000.0, 30_000.0


@figure
def planes() -> plt.Figure:
    """The states of one cell at both of its ends, and what the pass backwards picks."""
    cells = planned(bends(), limits(ACC), "cells")
    i = next(k for k, c in enumerate(cells) if c["planes"] >= 6 and c["most"] < 0.9 * c["feed"])
    cell, behind = cells[i], cells[i + 1]
    fig, ax = panels(1, 1, (5.6, 4.4))
    wide = 1.6 * max(cell["most"], behind["most"])
    x0, x1 = np.meshgrid(np.linspace(0.0, wide, 500), np.linspace(0.0, wide, 500))
    allowed = np.ones_like(x0, bool)
    for g0, g1 in cell["plane"][: int(cell["planes"])]:
        allowed &= g0 * x0 + g1 * x1 <= 1.0
        edge = np.linspace(-wide, 2.0 * wide, 2)
        at = (edge, (1.0 - g0 * edge) / g1) if abs(g1) > abs(g0) else ((1.0 - g1 * edge) / g0, edge)
        ax.plot(*at, color=GREY, linewidth=0.7)
    ax.contourf(x0, x1, allowed, [0.5, 1.5], colors=["#dfe9f5"])
    most = min(behind["most"], cell["feed"])
    ax.axhline(most, color=GREEN, label="most x at the end")
    ax.plot(cell["most"], cell["top"], "o", color=RED, label="most x at the start, and its end")
    ax.plot([0, wide], [0, wide], ":", color=ORANGE, label="a = 0")
    ax.set(xlim=(0, wide), ylim=(0, wide), xlabel="x at the start [mm²/s²]")
    ax.set_ylabel("x at the end [mm²/s²]")
    ax.legend(fontsize=8, loc="upper left")
    return fig


@figure
def speed() -> plt.Figure:
    """x over u: feed, steady limit, pass backwards, and two rides."""
    told, bounds = bends(), limits(ACC)
    cells = planned(told, bounds, "cells")
    u = np.append(0.0, np.cumsum(cells["length"]))
    full = ride(told, bounds).steps
    held = ride(told, bounds, Orders(1e-3, np.repeat([1.0, 0.0, 1.0], [300, 150, 1]))).steps
    fig, ax = panels(1, 1, (8.6, 3.8))
    ax.step(u, np.append(cells["feed"], cells["feed"][-1]), where="post", color=GREY, label="feed")
    flat = np.minimum(cells["flat"], 4e4)
    ax.step(
        u,
        np.append(flat, flat[-1]),
        where="post",
        color=ORANGE,
        linewidth=0.8,
        label="most with a = 0",
    )
    ax.plot(u, np.append(cells["most"], 0.0), color=GREEN, linewidth=2.2, label="pass backwards")
    ax.plot(full["way"], full["rate"] ** 2, color=BLUE, linewidth=1.2, label="ride")
    ax.plot(held["way"], held["rate"] ** 2, "--", color=RED, linewidth=1.2, label="with a hold")
    ax.set(xlabel="u [mm]", ylabel="x = (du/dt)² [mm²/s²]", ylim=(0, 16_500), xlim=(0, 60))
    ax.legend(fontsize=8, ncols=5, loc="upper center")
    return fig


def over_time(steps: Array, dt: float, rows: list[tuple[str, str, float, float]]) -> plt.Figure:
    """Quantities of the axes X and Y over time with their limits: name, label, limit, scale."""
    fig, axes = panels(len(rows), 1, (8.6, 1.9 * len(rows) + 0.5), sharex=True)
    t = dt * np.arange(1, len(steps) + 1)
    for ax, (name, label, most, scale) in zip(np.atleast_1d(axes), rows, strict=True):
        for k, colour in ((0, BLUE), (1, RED)):
            ax.plot(t, steps[name][:, k] / scale, color=colour, linewidth=1.0, label="XY"[k])
        for sign in (-1, 1):
            ax.axhline(sign * most / scale, color=GREY, linestyle="--", linewidth=0.9)
        ax.set(ylabel=label, ylim=(-1.25 * most / scale, 1.25 * most / scale), xlim=(0, t[-1]))
    np.atleast_1d(axes)[0].legend(fontsize=8, ncols=2, loc="upper right")
    np.atleast_1d(axes)[-1].set_xlabel("t [s]")
    return fig


@figure
def axes_of_speed() -> plt.Figure:
    """Acceleration of each axis of the ride, within its limit."""
    steps = ride(bends(), limits(ACC), Orders(2e-4)).steps
    return over_time(steps, 2e-4, [("acc", "acceleration [mm/s²]", ACC, 1.0)])


@figure
def jerk() -> plt.Figure:
    """x over u with limited jerk: feed, boxes, nodes of the plan, and rides."""
    told, bounds = bends(), limits(ACC, jerk=JERK)
    nodes, boxes = planned(told, bounds, "nodes"), planned(told, bounds, "boxes")
    quick, smooth = ride(told, limits(ACC)).steps, ride(told, bounds).steps
    fig, ax = panels(1, 1, (8.6, 3.8))
    edge = np.append(boxes["start"], boxes["start"][-1] + boxes["length"][-1])
    for column, colour, name in (("feed", GREY, "feed"), ("most", ORANGE, "limits of the boxes")):
        x = np.minimum(boxes[column], 4e4)
        ax.step(edge, np.append(x, x[-1]), where="post", color=colour, linewidth=0.9, label=name)
    ax.plot(nodes["at"], nodes["x"], "o", color=GREEN, markersize=2.4, label="nodes")
    ax.plot(quick["way"], quick["rate"] ** 2, ":", color=RED, linewidth=1.2, label="jerk unlimited")
    ax.plot(smooth["way"], smooth["rate"] ** 2, color=BLUE, linewidth=1.4, label="ride")
    ax.set(xlabel="u [mm]", ylabel="x = (du/dt)² [mm²/s²]", ylim=(0, 16_500), xlim=(0, 60))
    ax.legend(fontsize=8, ncols=5, loc="upper center")
    return fig


@figure
def axes_of_jerk() -> plt.Figure:
    """Acceleration and jerk of each axis of the ride with limited jerk."""
    steps = ride(bends(), limits(ACC, jerk=JERK), Orders(2e-4)).steps
    rows = [
        ("acc", "acc. [mm/s²]", ACC, 1.0),
        ("jerk", "jerk [10³ mm/s³]", JERK, 1000.0),
    ]
    return over_time(steps, 2e-4, rows)


def farthest(start: float, base: float, v1: float, last: float) -> tuple[Array, Array]:
    """Time and farthest place of two triangular pulses over the first one's peak, from `start`."""
    x = np.linspace(start, last, 400)
    w = base + x * abs(x) if start >= 0.0 else base + x**2
    y = np.sqrt(w - v1)
    return 2.0 * (x + y) - start, (base + w) * x + (w + v1) * y


@figure
def scurve() -> plt.Figure:
    """An S-curve from a start in motion, and the farthest place after a time."""
    move = np.array([(0.0, -20.0, 300.0, 60.0, 20.0, 130.0, 900.0, 600.0, 15_000.0)], MOVE)
    total, count = scurve_totals(move)[0], 4001
    t = np.linspace(0.0, total, count)
    s = scurve_positions(move, count)[0]
    v = np.gradient(s, t)
    a = np.gradient(v, t)[2:-2]
    fig, axes = panels(2, 2, (9.2, 4.4))
    for ax, at, values, most in (
        (axes[0, 0], t, v, (130.0,)),
        (axes[1, 0], t[2:-2], a, (900.0, -600.0)),
    ):
        ax.plot(at, values, color=BLUE)
        for y in most:
            ax.axhline(y, color=GREY, linestyle="--", linewidth=0.9)
    axes[0, 0].set_ylabel("speed [mm/s]")
    axes[1, 0].set(ylabel="acceleration [mm/s²]", xlabel="t [s]")
    for ax, start, base, v1 in ((axes[0, 1], 0.0, 0.2, 0.1), (axes[1, 1], -1.8, -0.5, -3.0)):
        time, way = farthest(start, base, v1, 1.3)
        ax.plot(time, way, color=BLUE)
        ax.set_ylabel("farthest place [s³]")
        falls = np.flatnonzero(np.diff(way) < 0.0)
        if len(falls):
            ax.plot(time[falls[0]], way[falls[0]], "o", color=RED, label="end of the first rise")
            ax.legend(fontsize=8, loc="upper center")
    axes[0, 1].set_title("start with a = 0", fontsize=9)
    axes[1, 1].set_title("start with a < 0, target speed below: a sag", fontsize=9)
    axes[1, 1].set_xlabel("T, with a jerk of 1 [s]")
    return fig


@figure
def mean() -> plt.Figure:
    """A plan of constant accelerations, and its mean over 0.1 s."""
    dt, over, acc = 1e-4, 0.1, 500.0
    t = np.arange(0.0, 1.3, dt)
    knots = [0.1, 0.3, 0.5, 0.62, 0.8, 0.88, 1.04]
    v = np.interp(t, knots, [0.0, 100.0, 100.0, 40.0, 40.0, 80.0, 0.0])
    n = round(over / dt)
    smooth = np.convolve(v, np.full(n, 1.0 / n))[: len(t)]
    fig, (top, bottom) = panels(2, 1, (8.2, 4.0), sharex=True)
    for values, colour, name in ((v, GREY, "planned"), (smooth, BLUE, "mean over 0.1 s")):
        top.plot(t, values, color=colour, label=name)
        bottom.plot(t, np.gradient(values, dt), color=colour)
    for sign in (-1, 1):
        bottom.axhline(sign * acc, color=RED, linestyle="--", linewidth=0.9)
    top.set_ylabel("speed [mm/s]")
    top.legend(fontsize=8)
    bottom.set(xlabel="t [s]", ylabel="acceleration [mm/s²]", ylim=(-650, 650), xlim=(0, 1.3))
    return fig


def main() -> None:
    """Write every figure, the same bytes each time."""
    mpl.use("svg")
    mpl.rcParams.update({"svg.hashsalt": "motionfmu", "font.size": 9})
    for made in FIGURES:
        fig = made()
        fig.savefig(HERE / f"{made.__name__}.svg", metadata={"Date": None})
        plt.close(fig)
        print(made.__name__)


if __name__ == "__main__":
    main()
