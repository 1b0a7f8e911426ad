"""Figures of the page about tasks on one processor, from the cores in C."""

import numpy as np
from clock_runs import (
    BINARY,
    COMPUTE,
    END,
    GIVE,
    MARK,
    MUTEX,
    RUNS,
    TAKE,
    CyclicRun,
    KernelRun,
    waits,
)
from matplotlib import pyplot as plt
from plots import BLUE, GREEN, GREY, ORANGE, RED, figure, panels
from task_theory import handover, longest_response, rate_monotonic_bound, share_late

COLOURS = (RED, ORANGE, GREEN, BLUE)


@figure
def response() -> plt.Figure:
    """Four tasks due together: which runs, and the longest responses of the analysis."""
    cycle, time = [500, 800, 1400, 4000], [110, 170, 260, 600]
    seen = 4000
    run = CyclicRun(cycle, time, 56_000, seen=seen)
    fig, ax = panels(1, 1, (8.6, 2.9))
    for i, (t, c) in enumerate(zip(cycle, time, strict=True)):
        own = np.r_[False, run.running == i, False].astype(int)
        begin, end = np.flatnonzero(np.diff(own) == 1), np.flatnonzero(np.diff(own) == -1)
        spans = list(zip(begin, end - begin, strict=True))
        ax.broken_barh(spans, (-i - 0.35, 0.7), color=COLOURS[i])
        ax.plot(np.arange(0, seen, t), [-i - 0.43] * len(range(0, seen, t)), "^", color=GREY,
                markersize=4)  # fmt: skip
        r = longest_response(cycle, time, i)
        assert run.response[i] == r
        ax.plot([r, r], [-i - 0.45, -i + 0.45], color="black", linewidth=1.4)
        ax.text(r + 20, -i + 0.22, f"R = {r}", fontsize=8)
        ax.text(-60, -i, f"C = {c}, T = {t}", fontsize=8, ha="right", va="center")
    ax.set(xlim=(0, seen), ylim=(-3.6, 0.6), xlabel="t [clocks]", yticks=[])
    return fig


@figure
def schedulable() -> plt.Figure:
    """Share of random sets of five tasks that hold, over their load."""
    dice = np.random.default_rng(3)
    loads = np.arange(0.6, 1.001, 0.025)
    by_run, by_analysis = [], []
    for load in loads:
        held, found = 0, 0
        for _ in range(250):
            cycle = np.sort(dice.integers(1000, 20_000, 5))
            share = dice.dirichlet(np.ones(5)) * load
            time = np.maximum(np.floor(share * cycle), 1).astype(int)
            held += not CyclicRun(list(cycle), list(time), 2 * int(cycle[-1])).missed.any()
            found += all(longest_response(list(cycle), list(time), i) > 0 for i in range(5))
        by_run.append(held / 250)
        by_analysis.append(found / 250)
    fig, ax = panels(1, 1, (6.4, 3.3))
    ax.plot(loads, by_run, "o", color=BLUE, label="run")
    ax.plot(loads, by_analysis, color=GREEN, label="response time analysis")
    bound = rate_monotonic_bound(5)
    ax.axvline(bound, color=RED, label=f"5 (2$^{{1/5}}$ - 1) = {bound:.3f}")
    ax.axvline(np.log(2.0), color=GREY, linestyle="--", label="ln 2")
    ax.set(xlabel="load", ylabel="share of the sets that hold", ylim=(0, 1.05))
    ax.legend(fontsize=8, loc="lower left")
    return fig


def locked(kind: int) -> KernelRun:
    """A low task holds a semaphore that the high one wants, while one in the middle computes."""
    tasks = [
        (1, [(TAKE, 5), (TAKE, 0), (COMPUTE, 300), (GIVE, 0), (COMPUTE, 60), (MARK, 0)]),
        (2, [(TAKE, 6), (COMPUTE, 500), (MARK, 0)]),
        (3, [(TAKE, 7), (COMPUTE, 50), (TAKE, 0), (COMPUTE, 100), (GIVE, 0), (MARK, 0)]),
    ]
    give = [[(GIVE, k), (END, 1)] for k in (5, 6, 7, 0)]
    pends = [(5, 3)] * (kind == BINARY) + [(20, 0), (120, 2), (140, 1)]
    return KernelRun(tasks, 1300, give, pends, [kind])


@figure
def inversion() -> plt.Figure:
    """Who has the processor where a semaphore guards a section, and where a mutex does."""
    fig, axes = panels(2, 1, (8.6, 3.4), sharex=True)
    for ax, kind, name in zip(axes, (BINARY, MUTEX), ("semaphore", "mutex"), strict=True):
        run = locked(kind)
        e = run.event[run.event["what"] == RUNS]
        ends = {i: int(run.marks(i)[0]) for i in range(3)}
        edge = np.append(e["clock"], 1300)
        for begin, end, task in zip(edge[:-1], edge[1:], e["number"], strict=True):
            stop = min(end, ends[int(task)])
            if stop > begin and begin > 0:
                ax.broken_barh([(begin, stop - begin)], (task - 0.35, 0.7),
                               color=COLOURS[2 - task])  # fmt: skip
        ax.plot([120, 120], [1.55, 2.45], color="black")
        ax.plot([ends[2], ends[2]], [1.55, 2.45], color="black")
        ax.text(ends[2] + 8, 2.0, f"response {ends[2] - 120}", fontsize=8, va="center")
        ax.set(yticks=[0, 1, 2], yticklabels=["low", "middle", "high"], ylim=(-0.6, 2.6))
        ax.set_title(name, fontsize=9)
    axes[1].set(xlabel="t [clocks]", xlim=(0, 1150))
    return fig


@figure
def woken_tasks() -> plt.Figure:
    """From an interrupt to the task that it wakes, over the interrupt's place behind a tick."""
    times = {"tick": 1_000_000, "tick_time": 2000, "switch_time": 1500, "entry_time": 100}
    own = 3000
    fig, (left, right) = panels(1, 2, (9.0, 3.2))
    near = np.r_[993_000:1_000_001:61, 1:5000:61]
    wide = np.unique(np.r_[near, 3000:993_000:24_990]).astype(int)
    for ax, phases, yields, back in ((left, near, True, 500_000), (right, wide, False, 10**7)):
        found = []
        for phase in phases:
            tasks = [(2, [(TAKE, 0), (MARK, 0)]), (1, [(COMPUTE, 10**8)])]
            steps = [(COMPUTE, own), (GIVE, 0), (END, int(yields))]
            pends = 3_000_000 + int(phase)
            run = KernelRun(tasks, 6_000_000, [steps], [(pends, 0)], **times)
            found.append((run.marks(0)[0] - pends) / 1000.0)
        formula = [handover(int(p), own, times, yields) / 1000.0 for p in phases]
        at = (phases - times["tick"] * (phases > back)) / 1000.0
        ax.plot(at, formula, color=GREY, linewidth=0.9, label="formula")
        colour = BLUE if yields else RED
        ax.plot(at, found, ".", color=colour, label="kernel", markersize=3.5)
        ax.set(xlabel="behind the tick [µs]", ylabel="to the task [µs]")
        ax.set_title("with a yield" if yields else "yield forgotten", fontsize=9)
        ax.legend(fontsize=8)
    left.set_ylim(4.0, 7.5)
    return fig


@figure
def late_runs() -> plt.Figure:
    """Share of cycles whose interrupt waits longer than the memory of pulses plays."""
    fig, ax = panels(1, 1, (6.8, 3.4))
    budget = np.linspace(0.0, 700.0, 701)
    for name, mean, most, colour in (("good", 1.2, 160.0, GREEN), ("graphics", 2.7, 667.0, RED)):
        rare = 1e-3
        ax.plot(budget, share_late(budget, mean, most, rare), color=colour, linewidth=1.0)
        wait = waits(20.0, 40.0 * mean, 20.0 + 40.0 * most, rare, 2_000_000) / 40.0 - 0.5
        at = np.array([2, 5, 8, 12, 20, 60, 100, 140, 200, 300, 400, 500, 600])
        share = np.array([(wait > b).mean() for b in at])
        ax.plot(at[share > 0], share[share > 0], "o", color=colour, markersize=4, label=name)
    for slots in (20, 64, 128):
        ax.axvline(5.0 * slots - 31.3, color=GREY, linestyle="--", linewidth=0.8)
        ax.text(5.0 * slots - 29.0, 0.012, f"{slots} slots", fontsize=8, color=GREY)
    ax.set(yscale="log", xlabel="wait that is still in time [µs]", ylabel="share of the runs late")
    ax.set(ylim=(1e-6, 1.0), xlim=(0, 700))
    ax.legend(fontsize=8, loc="upper center", title="one wait of 1000 is long", title_fontsize=8)
    return fig
