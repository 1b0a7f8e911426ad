"""Figures of the page about smooth paths, from the library that the tests build."""

import math

import numpy as np
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels, tube
from shape_paths import Segment, lines, shaped


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
