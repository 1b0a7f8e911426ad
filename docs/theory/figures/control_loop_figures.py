"""Figures of the page about control loops, from linear models and from runs of their FMUs."""

import math

import numpy as np
from fmu_runs import PER_GAIN, ROOT
from matplotlib import pyplot as plt
from matplotlib.ticker import NullFormatter, ScalarFormatter
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels

import motionfmu
from motionfmu.analysis import freq, linear
from motionfmu.analysis.freq.step_run import step_of
from motionfmu.analysis.linear.stability import grid, margins, response
from motionfmu.study.tune import problem
from motionfmu.study.tune.tuning_functions import TuningFunctions

DEMO, THEORY = (ROOT / "scenarios" / name for name in ("circle", "circle_theory"))
ENC, PHASE = "card.enc_phase", "drives.phase"
T = 1e-4  # [s] period of card and drives
SMOOTH = {f"machine.{s}_{k}": 0.0 for s in ("motor", "table") for k in ("coulomb", "static")}
# Limits far away, and counts so small that rounding does not show.
WIDE = {
    "drives.encoder_counts": 2**30,
    "drives.torque_limit": 1e6,
    "drives.speed_limit": 1e6,
    "drives.error_limit": 1e6,
}


@figure
def two_masses() -> plt.Figure:
    """Motor and table speed over torque: formula, linear model and running FMUs."""
    set_ = SMOOTH | WIDE | {"machine.screw_damping": 3e3}
    axis = linear.model(DEMO, set=set_)
    cut = "machine.torque_command"
    names = ["machine.motor_speed", "machine.table_speed"]
    setup = freq.setup(axis, cut, names, cut)
    lines = np.unique(np.round(np.geomspace(2, 240, 26)).astype(int))
    found = freq.measure(setup, freq.multisine(500, lines, 2.0, settle=30, measure=2))
    omega = np.geomspace(2.0 * math.pi * 20.0, 0.97 * math.pi / T, 800)
    s = 1j * omega
    m, c, k, j, lead = (
        axis.value(f"machine.{n}")
        for n in ("table_mass", "screw_damping", "screw_stiffness", "motor_inertia", "lead")
    )
    r, lag = lead / (2.0 * math.pi), axis.value("machine.current_time")
    below = s * (j * m * s**2 + (j + r * r * m) * (c * s + k)) * (1.0 + lag * s)
    scale = (1.0, 1.0 / r)  # the table's speed as a motor's
    above = (m * s**2 + c * s + k, r * (c * s + k))
    fig, axes = panels(2, 1, (8.2, 5.0), sharex=True)
    hertz = omega / (2.0 * math.pi)
    for name, colour, top, unit, column in zip(
        names, (BLUE, GREEN), above, scale, (0, 1), strict=True
    ):
        model = unit * response(axis.system(cut, name, cut), omega)
        held = unit * top / below * np.exp(-0.5 * s * T) * np.sinc(omega * T / (2.0 * math.pi))
        dots = unit * found.values[:, column]
        at = found.omega / (2.0 * math.pi)
        word = name.split(".")[1].replace("_", " ")
        axes[0].loglog(hertz, np.abs(model), color=colour, label=word)
        axes[0].loglog(hertz, np.abs(held), ":", color=RED, linewidth=1.2)
        axes[0].loglog(at, np.abs(dots), "o", color=colour, markersize=3.5)
        axes[1].semilogx(hertz, np.degrees(np.unwrap(np.angle(model))), color=colour)
        axes[1].semilogx(hertz, np.degrees(np.unwrap(np.angle(held))), ":", color=RED)
        near = np.interp(at, hertz, np.unwrap(np.angle(model)))
        axes[1].semilogx(
            at,
            np.degrees(near + np.angle(dots * np.exp(-1j * near))),
            "o",
            color=colour,
            markersize=3.5,
        )
    axes[0].loglog([], [], ":", color=RED, label="formula, held")
    axes[0].loglog([], [], "o", color=GREY, markersize=3.5, label="running FMUs")
    for f in (math.sqrt(k / m), math.sqrt(k / m * (1.0 + r * r * m / j))):
        axes[0].axvline(f / (2.0 * math.pi), color=GREY, linewidth=0.8, linestyle="--")
    axes[0].set(ylabel="speed/torque [rad/s per N·m]", ylim=(8e-4, 2e1))
    axes[1].set(xlabel="frequency [Hz]", ylabel="phase [°]", xlim=(20, 5000))
    axes[0].legend(fontsize=8, loc="lower left")
    return fig


@figure
def nyquist() -> plt.Figure:
    """The position loop with three gains: its curve, and the sensitivity, whose area is 0."""
    fig, (left, right) = panels(1, 2, (9.4, 4.2))
    first = linear.model(THEORY)
    turn = np.exp(1j * np.linspace(0.0, 2.0 * math.pi, 300))
    peak = 1.5
    left.fill((-1.0 + turn / peak).real, (-1.0 + turn / peak).imag, color="#f7e4e1")
    left.plot(turn.real, turn.imag, ":", color=GREY, linewidth=0.9)
    left.plot(-1.0, 0.0, "+", color=RED, markersize=9)
    for phase, colour in ((60.0, BLUE), (45.0, GREEN), (30.0, ORANGE)):
        half = 0.5 * math.radians(90.0 - phase) / 1.5
        wanted = 2.0 * math.sin(half) / T
        loop = first.changed({"mcc.p_gain": round(wanted / PER_GAIN)}).loop(ENC)
        omega = grid(loop)
        omega = omega[omega * T > 0.03]
        value = response(loop, omega)
        told = margins(loop)
        name = f"phase margin {told.phase:.0f}°, gain {told.gain:.1f}, Ms {told.sensitivity:.2f}"
        left.plot(value.real, value.imag, color=colour)
        at = response(loop, np.array([told.omega_phase, told.omega_gain]))
        left.plot(at.real, at.imag, "o", color=colour, markersize=4)
        even = np.linspace(1e-3, math.pi, 2000) / T
        size = np.log(np.abs(1.0 / (1.0 + response(loop, even))))
        right.plot(even * T / math.pi, size, color=colour, label=name)
        right.fill_between(even * T / math.pi, size, color=colour, alpha=0.10)
    right.axhline(math.log(peak), color=RED, linestyle="--", linewidth=0.9)
    right.text(0.7, math.log(peak) + 0.05, "Ms = 1.5", color=RED, fontsize=8)
    left.set(xlim=(-2.1, 1.1), ylim=(-2.2, 1.1), aspect="equal", xlabel="Re L", ylabel="Im L")
    right.legend(fontsize=8, loc="lower right")
    left.set_title("disk: |1 + L| < 1/1.5", fontsize=9)
    right.set(xlabel="share of half the sampling rate", ylabel="ln |S|", xlim=(0, 1))
    right.set(ylim=(-2.5, 1.4))
    return fig


@figure
def gain_by_damping() -> plt.Figure:
    """Steps of the position with three gains behind a lag, and the gain that a phase asks for."""
    fig, (left, right) = panels(1, 2, (9.4, 3.8))
    kp = 200 * PER_GAIN
    for damping, colour in ((1.0, BLUE), (math.sqrt(0.5), GREEN), (0.5, RED)):
        lag = 0.25 / damping**2 / kp
        axis = linear.model(THEORY, set={"machine.tau": lag})
        time, answer = step_of(axis, ENC, (), False).by_fmus(0.16, kp)
        some = slice(None, None, 45)
        left.plot(1e3 * time[some], answer[some], "o", color=colour, markersize=3.5)
        t = np.linspace(0.0, 0.16, 600)
        name = f"damping {damping:.2f}, Kp τ = {kp * lag:.2f}"
        left.plot(1e3 * t, step_behind_lag(t, kp, lag), color=colour, label=name)
    left.plot([], [], "o", color=GREY, markersize=3.5, label="running FMUs")
    left.set(xlabel="t [ms]", ylabel="position / step", ylim=(0.0, 1.25), xlim=(0, 160))
    left.legend(fontsize=8, loc="lower right")
    first = linear.model(THEORY, set={"machine.encoder_lines": 50_000})
    for d, colour in ((1, BLUE), (3, GREEN), (8, RED)):
        phase = np.linspace(0.5, 89.0, 200)
        asked = 2.0 * np.sin(0.5 * np.radians(90.0 - phase) / (d + 0.5))
        right.plot(phase, asked, color=colour, label=f"{d} sample{'s' * (d > 1)} of delay")
        for gain in (80, 200, 450, 900, 1500):
            loop = first.changed({"mcc.p_gain": gain}).loop(ENC, delays={ENC: d - 1})
            told = margins(loop)
            if told.stable:
                right.plot(told.phase, 20 * gain * PER_GAIN * T, "o", color=colour, markersize=4)
        right.plot(0.0, 2.0 * math.sin(math.pi / (2.0 * (2 * d + 1))), "x", color=colour)
    right.set(xlabel="phase margin [°]", ylabel="Kp T", xlim=(-2, 90), ylim=(0.0, 1.05))
    right.legend(fontsize=8)
    return fig


def step_behind_lag(t: Array, kp: float, lag: float) -> Array:
    """Answer of Kp/(tau s^2 + s + Kp) to a step of 1."""
    own = np.emath.sqrt(1.0 - 4.0 * kp * lag + 1e-9j)
    fast, slow = (-1.0 - own) / (2.0 * lag), (-1.0 + own) / (2.0 * lag)
    parts = (fast * np.exp(slow * t) - slow * np.exp(fast * t)) / (fast - slow)
    return np.asarray((1.0 - parts).real)


@figure
def operating_point() -> plt.Figure:
    """Friction of the motor over its speed, and what its slope makes of both loops."""
    axis = linear.model(DEMO, at={"machine.motor_speed": 10.0})
    coulomb, static, knee, viscous, rest = (
        axis.value(f"machine.motor_{n}")
        for n in ("coulomb", "static", "stribeck_speed", "viscous", "rest_speed")
    )
    speed = np.geomspace(1e-3, 100.0, 600)
    smooth = speed / np.hypot(speed, rest)
    drop = (static - coulomb) / (1.0 + (speed / knee) ** 2)
    fig, axes = panels(3, 1, (7.8, 5.6), sharex=True)
    axes[0].semilogx(speed, smooth * (coulomb + drop) + viscous * speed, color=BLUE)
    axes[0].set(ylabel="friction [N·m]", ylim=(0.0, 0.42))
    points = np.geomspace(2e-3, 100.0, 29)
    told = []
    for v in points:
        here = axis.moved({"machine.motor_speed": float(v)})
        told.append((margins(here.loop(ENC)), margins(here.loop(PHASE, (ENC,)))))
    for k, colour, name in ((0, GREEN, "position loop"), (1, RED, "velocity loop")):
        axes[1].semilogx(points, [row[k].phase for row in told], "o-", color=colour, markersize=3)
        wide = [row[k].bandwidth / (2.0 * math.pi) for row in told]
        axes[2].loglog(points, wide, "o-", color=colour, markersize=3, label=name)
    axes[1].set(ylabel="phase margin [°]", ylim=(0, 185))
    axes[2].set(ylabel="bandwidth [Hz]", xlabel="motor speed [rad/s]")
    axes[2].legend(fontsize=8, loc="lower right")
    for ax in axes:
        ax.axvline(knee, color=GREY, linestyle=":", linewidth=0.9)
        ax.axvline(rest, color=GREY, linestyle="--", linewidth=0.9)
    return fig


@figure
def cost_and_limits() -> plt.Figure:
    """The demo's contour error over the position gain, and the room to the limits."""
    base = motionfmu.load(DEMO).run()
    study = TuningFunctions(motionfmu.load(DEMO), problem({"axes": "equal"}), base)
    registers = np.arange(150, 700, 10)
    values = [study.values(np.array([v.share(g) for v in study.variables])) for g in registers]
    cost = 1e3 * np.array([v.worst for v in values])
    room = np.array([v.slack for v in values])
    fig, (top, bottom) = panels(2, 1, (7.8, 5.2), sharex=True)
    kp = registers * PER_GAIN
    top.semilogy(kp, cost, color=BLUE, label="linear model")
    for gain in (200, 300, 400, 500, 600):
        run = motionfmu.load(DEMO).run(set={"mcc.p_gain": gain})
        top.plot(gain * PER_GAIN, 1e3 * run.contour().error.rms, "o", color=BLUE, markersize=5)
    top.plot([], [], "o", color=BLUE, label="runs of the FMUs")
    top.set(ylabel="contour error, RMS [µm]", yticks=(3, 5, 10, 20, 50))
    top.yaxis.set_major_formatter(ScalarFormatter())
    top.yaxis.set_minor_formatter(NullFormatter())
    shown: dict[str, Array] = {}
    for k, limit in enumerate(study.limits):
        what = limit.what.replace(" of the loop at card.enc_phase", ", position loop")
        what = what.replace(" of the loop at drives.phase", ", velocity loop")
        if limit.axis == 1 and room[:, k].min() < 0.6 and np.ptp(room[:, k]) > 0.02:
            shown[what] = room[:, k]
    for (what, slack), colour in zip(shown.items(), (RED, GREEN, ORANGE, GREY, BLUE), strict=False):
        bottom.plot(kp, slack, color=colour, label=what)
    bottom.axhline(0.0, color=GREY, linewidth=0.8)
    good = np.flatnonzero((room >= 0.0).all(axis=1))
    best = good[np.argmin(cost[good])]
    for ax in (top, bottom):
        ax.axvline(kp[best], color=GREY, linestyle="--", linewidth=0.9)
    bottom.set(xlabel="position gain Kp [1/s]", ylabel="room to the limit", ylim=(-1.2, 1.2))
    bottom.legend(fontsize=8, loc="lower left")
    top.legend(fontsize=8)
    return fig
