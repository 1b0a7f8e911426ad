"""Figures of the page about pulses, counts and clocks of cards, from the cores in C."""

import numpy as np
from clock_runs import CARDS, counted, lateness, played, pulse_ticks, stock
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, figure, panels


@figure
def dda() -> plt.Figure:
    """Seven pulses in 32 ticks beside the line that they follow, and distances of commands."""
    fig, (left, right) = panels(1, 2, (9.0, 3.5))
    ticks, command = 32, 7
    tick = pulse_ticks(command, ticks)
    at = np.r_[0, tick, ticks]
    left.plot([0, ticks], [0, command], color=GREY, linewidth=0.9, label="i k/N")
    left.step(at, np.r_[0 : command + 1, command], where="post", color=BLUE, label="pulses put out")
    ideal = (2 * np.arange(command) + 1) * ticks / (2 * command)
    left.plot(ideal, np.arange(command) + 0.5, "x", color=RED, label="half-way: the ideal tick")
    left.set(xlabel="tick i", ylabel="pulses", xlim=(0, ticks), ylim=(0, command + 0.3))
    left.legend(fontsize=8)
    commands = np.unique(np.geomspace(2, 4095, 240).astype(int))
    ends = [(np.diff(pulse_ticks(int(k), 4096)).min(), np.diff(pulse_ticks(int(k), 4096)).max())
            for k in commands]  # fmt: skip
    least, most = np.array(ends).T
    for edge, colour, name in ((most, RED, "longest"), (least, GREEN, "shortest")):
        off = 100.0 * (4096 / edge / commands - 1.0)
        right.plot(commands, off, ".", color=colour, markersize=3, label=f"{name} distance")
    bounds = (
        (commands / (4096 - commands), "k/(N - k)"),
        (-commands / (4096 + commands), "-k/(N + k)"),
    )
    for (bound, name), line in zip(bounds, "-:", strict=True):
        right.plot(commands, 100.0 * bound, line, color=GREY, linewidth=0.9, label=name)
    right.set(xscale="log", xlabel="command k of N = 4096 [pulses]", ylim=(-52, 102))
    right.set_ylabel("rate between two pulses, off k/T by [%]")
    right.legend(fontsize=8)
    return fig


@figure
def late_pulses() -> plt.Figure:
    """How early or late pulses of a uniform motion are, on three cards."""
    fig, ax = panels(1, 1, (7.6, 3.9))
    for (name, (period, tick, spread)), colour, length in zip(
        CARDS.items(), (BLUE, GREEN, ORANGE), (25e-9, 25e-9, 20e-9), strict=True
    ):
        highest = 0.4 / tick / length if name != "FPGA card" else 9e6
        rates = np.geomspace(20.0, highest, 700)
        bound = [lateness(f * period * length) / f + tick * length for f in rates]
        ax.plot(rates, 1e6 * np.array(bound), color=colour, linewidth=0.9)
        found = []
        points = np.geomspace(30.0, 0.8 * highest, 26)
        for f in points:
            clock = played(
                f * length, period, 2 + int(60.0 / min(1.0, f * period * length)), spread
            )
            found.append(np.abs(clock * length - (np.arange(len(clock)) + 0.5) / f).max())
        ax.plot(points, 1e6 * np.array(found), "o", color=colour, markersize=3.5,
                label=f"{name}: {period * length * 1e6:g} µs")  # fmt: skip
    rates = np.geomspace(20.0, 9e6, 50)
    ax.plot(rates, 0.5e6 / rates, ":", color=GREY, label="half a pulse")
    ax.set(xscale="log", yscale="log", xlabel="rate of pulses [1/s]", ylim=(1e-2, 3e4))
    ax.set_ylabel("most that one is early or late [µs]")
    ax.legend(fontsize=8, loc="lower left")
    return fig


@figure
def filtered() -> plt.Figure:
    """Share of the edges that are counted behind a digital filter, over their rate."""
    fig, ax = panels(1, 1, (6.6, 3.3))
    for clocks, colour in ((160, BLUE), (40, GREEN), (10, ORANGE)):
        rates = np.geomspace(1e5, 2e7, 80)
        share = []
        for rate in rates:
            lines = 300.0
            counts, _ = counted(0.1, 0.1 + lines, round(4.0 * lines / rate * 40e6), clocks)
            share.append(counts / (4.0 * lines))
        ax.plot(rates, share, "o", color=colour, markersize=3, label=f"F = {clocks} clocks")
        border = 2.0 * 40e6 / clocks
        ax.axvline(border, color=colour, linewidth=0.9)
        ax.text(border, 0.5, f" 2 f/F = {border / 1e6:g} · 10⁶/s", fontsize=8, color=colour)
    ax.set(xscale="log", xlabel="counts per second at f = 40 MHz", ylabel="share counted")
    ax.legend(fontsize=8, loc="lower left")
    return fig


@figure
def stock_of_a_card() -> plt.Figure:
    """Stock over time for two latencies, and DDA times without a command over the latency."""
    fig, (left, right) = panels(1, 2, (9.0, 3.3))
    for late, colour in ((0.4, BLUE), (3.7, ORANGE), (4.4, RED)):
        found, _ = stock(3, 4, late, 21)
        left.step(
            np.arange(21), found, where="post", color=colour, label=f"answer after {late:g} T"
        )
    left.axhline(3, color=GREY, linestyle="--", linewidth=0.9)
    left.set(
        xlabel="t/T",
        ylabel="stock behind the boundary",
        ylim=(-0.3, 9.4),
        xlim=(0, 20),
        xticks=range(0, 21, 4),
    )
    left.legend(fontsize=8, ncols=2, loc="upper center")
    latencies = np.arange(0.05, 10.0, 0.1)
    for n, batch, colour in ((0, 1, BLUE), (3, 4, GREEN), (7, 8, ORANGE)):
        share = [stock(n, batch, late, 4000)[1] / 4000 for late in latencies]
        right.plot(
            latencies, share, ".-", color=colour, label=f"m = {n}, M = {batch}", markersize=3
        )
        right.axvline(n + 1, color=colour, linewidth=0.8, linestyle="--")
    right.set(xlabel="latency/T", ylabel="share of DDA times without a command", xlim=(0, 10))
    right.legend(fontsize=8)
    return fig
