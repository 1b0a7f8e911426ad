"""Figures of the page about speed, from the libraries that the tests build."""

import itertools

import numpy as np
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels
from scurve_moves import MOVE, scurve_positions, scurve_totals
from speed_rides import Chain, Orders, hermite, limits, place, planned, ride


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
