"""Figures of the page about identification, from the package's own estimates."""

import math
import tempfile
from pathlib import Path

import numpy as np
from arm_truth import MIDDLE, SPAN, plant_of
from emps import DRIVE, RECORD
from matplotlib import pyplot as plt
from noisy_loop import direct_of, loop_of
from noisy_loop import plant_of as true_loop
from plots import BLUE, GREEN, GREY, ORANGE, RED, Array, figure, panels

import motionfmu
from motionfmu.analysis.measured_response import (
    EstimateOptions,
    LoopSignals,
    MassModel,
    MeasuredResponse,
    estimate,
    fit_masses,
)
from motionfmu.calibrate import CircleChoice, circle_errors, circle_record
from motionfmu.identify import rigid_motion
from motionfmu.identify.arm_dynamics.joint_equation import base_of
from motionfmu.identify.arm_dynamics.link_regressor import regressor
from motionfmu.identify.axis_record import of_record
from motionfmu.identify.friction_curve import friction_curve

PUBLISHED = np.array([95.1089, 203.5034, 20.3935, -3.1648])  # kg, N s/m, N, N


@figure
def friction_axis() -> plt.Figure:
    """The record of EMPS: force by the linear model, and friction over speed."""
    record = of_record(motionfmu.record(RECORD))
    s, force = rigid_motion.smooth(
        [record.columns["position"], DRIVE * record.columns["voltage"]], record.interval, 60.0
    )
    v, a = rigid_motion.derivatives(s, record.interval)
    columns = np.column_stack([a, v, np.sign(v), np.ones_like(v)])
    inner = np.arange(100, len(v) - 100)
    moving = inner[np.abs(v[inner]) > 0.02 * np.abs(v).max()]
    found = np.linalg.lstsq(columns[moving], force[moving], rcond=None)[0]
    fig, (left, right) = panels(1, 2, (8.8, 3.5))
    t = record.interval * np.arange(len(v))
    shown = inner[inner < 3200]
    left.plot(t[shown], force[shown], color=GREY, linewidth=2.2, label="drive")
    law = columns @ found
    left.plot(t[shown], law[shown], color=BLUE, linewidth=1.0, label="least squares")
    left.plot(t[shown], (force - law)[shown], color=RED, linewidth=0.8, label="left")
    left.set(xlabel="t [s]", ylabel="force [N]", xlim=(0, 3.2))
    left.legend(fontsize=8, loc="lower right")
    even = moving[np.abs(a[moving]) < 5.0]
    drive = force[even] - found[0] * a[even]
    own = (columns @ found)[even] - found[0] * a[even]
    curve = friction_curve(v[even], drive, own, ("m/s", "N"))
    right.errorbar(
        *(curve.speed, curve.drive, curve.scatter),
        fmt="o",
        color=RED,
        markersize=3,
        linewidth=0.8,
        label="drive less M a",
    )
    for values, colour, name in ((found, BLUE, "least squares"), (PUBLISHED, ORANGE, "published")):
        for side in (-1.0, 1.0):
            x = side * np.linspace(1e-4, 0.13, 2)
            label = name if side > 0 else None
            right.plot(x, values[1] * x + side * values[2] + values[3], color=colour, label=label)
    right.set(xlabel="speed [m/s]", ylabel="friction and offset [N]")
    right.legend(fontsize=8)
    return fig


@figure
def differences() -> plt.Figure:
    """What differences and the low pass let through, and the noise of an acceleration."""
    step = 1e-3
    fig, (left, right) = panels(1, 2, (8.8, 3.4))
    hertz = np.linspace(1.0, 400.0, 400)
    turn = 2.0 * np.pi * hertz * step
    warped = np.tan(np.pi * np.minimum(hertz, 499.0) * step) / np.tan(np.pi * 60.0 * step)
    curves = (
        (np.sin(turn) / turn, GREEN, "speed, central"),
        ((np.sin(turn / 2) / (turn / 2)) ** 2, ORANGE, "acceleration, central"),
        (1.0 / (1.0 + warped**8), BLUE, "low pass of 60 Hz, there and back"),
    )
    for values, colour, name in curves:
        left.plot(hertz, values, color=colour, label=name)
    t = step * np.arange(6000)
    for f in (10.0, 40.0, 60.0, 80.0, 150.0, 300.0):
        w = 2.0 * np.pi * f
        wave, inner = np.sin(w * t), slice(1000, -1000)
        v, a = rigid_motion.derivatives(wave, step)
        through = rigid_motion.smooth([wave], step, 60.0)[0]
        gains = [
            np.linalg.norm(x[inner]) / np.linalg.norm(wave[inner]) / size
            for x, size in ((v, w), (a, w * w), (through, 1.0))
        ]
        for gain, colour in zip(gains, (GREEN, ORANGE, BLUE), strict=True):
            left.plot(f, gain, "o", color=colour, markersize=4)
    left.set(xlabel="frequency [Hz]", ylabel="gain", xlim=(0, 400), ylim=(-0.05, 1.05))
    left.set_title("lines: formulas, dots: what the package does, 1 kHz", fontsize=9)
    left.legend(fontsize=8)
    noise = np.random.default_rng(1).normal(size=200_000)
    corner = np.geomspace(8.0, 150.0, 60)
    share = 3.0 * np.pi / 64.0 / np.sin(3.0 * np.pi / 8.0)
    wanted = (2.0 * np.pi * corner) ** 2 * np.sqrt(2.0 * corner * step * share)
    right.loglog(corner, wanted, color=BLUE, label="formula")
    some = np.array([8.0, 15, 30, 60, 100, 150])
    rest = [
        rigid_motion.second(rigid_motion.smooth([noise], step, float(f))[0], step).std()
        for f in some
    ]
    right.loglog(some, rest, "o", color=RED, markersize=4, label="low pass and differences")
    right.axhline(math.sqrt(6.0) / step**2, color=GREY, linestyle="--", label="without a low pass")
    right.set(xlabel="corner of the low pass [Hz]", ylabel="noise of a / noise of s [1/s²]")
    right.legend(fontsize=8)
    return fig


@figure
def excitation() -> plt.Figure:
    """Friction found from two motions, and the condition of an arm's equation."""
    fig, (left, right) = panels(1, 2, (8.8, 3.6))
    phase = np.linspace(0.0, 4.0, 800, endpoint=False)
    saw = 4.0 * np.abs(phase % 1.0 - 0.5) - 1.0
    motions = (
        (np.clip(6.0 * saw, -1.0, 1.0), RED, "nearly one speed"),
        (saw, BLUE, "even accelerations"),
    )
    rng = np.random.default_rng(3)
    for v, colour, name in motions:
        columns = np.column_stack([0.4 * v, np.sign(v)])
        solve = np.linalg.pinv(columns)
        draws = solve @ (8.0 * rng.normal(size=(len(v), 300)))
        left.plot(100.0 + draws[0], 20.0 + draws[1], ".", color=colour, markersize=2)
        size, ways = np.linalg.eigh(64.0 * np.linalg.inv(columns.T @ columns))
        a = np.linspace(0.0, 2.0 * np.pi, 200)
        ring = (ways * np.sqrt(5.991 * size)) @ np.array([np.cos(a), np.sin(a)])
        left.plot(100.0 + ring[0], 20.0 + ring[1], color=colour, label=name)
    left.set(xlabel="viscous friction [N·s/m]", ylabel="Coulomb friction [N]")
    left.set_title("300 draws of noise, and the region of 95 %", fontsize=9)
    left.legend(fontsize=8)
    plant = plant_of(lost_motion=[0.0] * 6)
    base = base_of(plant)
    for count in range(1, 11):
        found = [conditioned(plant, base.kept, seed, count) for seed in range(6)]
        right.semilogy([count] * len(found), found, "o", color=BLUE, markersize=3)
    lone = [conditioned(plant, base.kept, seed, 8, alone=True) for seed in range(6)]
    label = "joints one after the other"
    right.semilogy([8.3] * 6, lone, "x", color=RED, markersize=5, label=label)
    right.set(xlabel="harmonics of the series", ylabel="condition of the scaled columns")
    right.set_title("40 base parameters, 20 s, six draws each", fontsize=9)
    right.legend(fontsize=8)
    return fig


def conditioned(plant: object, kept: Array, seed: int, count: int, alone: bool = False) -> float:
    """Condition of an arm's equation on a random Fourier series of all joints, or one by one."""
    rng, t = np.random.default_rng(seed), np.linspace(0.0, 20.0, 400, endpoint=False)
    w = 2.0 * np.pi / 20.0 * np.arange(1, count + 1)
    a, b = rng.normal(size=(2, 6, count)) / np.sqrt(np.arange(1, count + 1))
    s, c = np.sin(w * t[:, None]), np.cos(w * t[:, None])
    q = s @ a.T + c @ b.T
    size = np.radians(SPAN) / np.abs(q).max(axis=0)
    v = ((c * w) @ a.T - (s * w) @ b.T) * size
    acc = -((s * w * w) @ a.T + (c * w * w) @ b.T) * size
    q = np.radians(MIDDLE) + q * size
    if alone:
        turn = np.arange(len(t)) // (len(t) // 6 + 1)
        still = turn[:, None] != np.arange(6)
        q, v, acc = (np.where(still, x, y) for x, y in ((q[0], q), (0.0, v), (0.0, acc)))
    links = regressor(plant.axes, plant.origins, plant.gravity, (q, v, acc))
    whole = np.concatenate([links, np.eye(6)[None] * acc[:, None, :]], axis=2)
    rows = whole.reshape(-1, whole.shape[2])[:, kept]
    return float(np.linalg.cond(rows / np.linalg.norm(rows, axis=0)))


@figure
def responses() -> plt.Figure:
    """A loop with noise in it by instrument and blindly, and two masses fitted."""
    fig, (left, right) = panels(1, 2, (8.8, 3.7))
    reference = np.random.default_rng(4).normal(size=120_000)
    signals = loop_of(reference, 0.2, 5)
    blind = LoopSignals(None, signals.input, signals.output, signals.interval)
    asked = EstimateOptions(period=0.0, low=2.0, high=200.0)
    for told, colour, name in ((signals, BLUE, "with the reference"), (blind, RED, "without it")):
        found = estimate(told, asked)
        hertz = found.omega / 2.0 / np.pi
        left.loglog(hertz, np.abs(found.values), ".", color=colour, markersize=2, label=name)
    w = 2.0 * np.pi * np.geomspace(2.0, 200.0, 200)
    left.loglog(w / 2 / np.pi, np.abs(true_loop(w)), color="#14406f", label="G")
    mean = np.abs(direct_of(w, 0.2))
    left.loglog(w / 2 / np.pi, mean, color="#7c1f14", label="mean of G and -1/C")
    left.set(xlabel="frequency [Hz]", ylabel="gain", ylim=(0.08, 8.0))
    left.legend(fontsize=8)
    truth = MassModel(5e-4, 3e-4, 200.0, 0.01, 2e-3, 5e-4, 2e-4)
    omega = 2.0 * np.pi * np.arange(20.0, 400.0, 4.0)
    rng = np.random.default_rng(2)
    exact = truth.response(omega)
    error = 0.05 * np.abs(exact)
    drawn = error * (rng.normal(size=len(omega)) + 1j * rng.normal(size=len(omega))) / np.sqrt(2)
    measured = MeasuredResponse(omega, exact + drawn, error, 0 * omega, "made", "made")
    fit = fit_masses(measured, truth.motor_viscous)
    push = omega**2
    hertz = omega / 2.0 / np.pi
    right.semilogy(
        hertz, np.abs(measured.values) * push, ".", color=GREY, label="measured, 5 % noise"
    )
    right.semilogy(hertz, np.abs(fit.model.response(omega)) * push, color=BLUE, label="two masses")
    for place, colour, name in (
        (fit.model.antiresonance, GREEN, "√(k/J₂)"),
        (fit.model.resonance, ORANGE, "√(k(1/J₁+1/J₂))"),
    ):
        right.axvline(place / 2 / np.pi, color=colour, linestyle="--", linewidth=0.9, label=name)
    right.set(xlabel="frequency [Hz]", ylabel="acceleration per torque [1/(kg·m²)]")
    right.legend(fontsize=8)
    return fig


RADIUS = 100.0


def ballbar_places(a: Array, way: int, which: str) -> tuple[Array, Array]:
    """Where a machine with one error stands on a circle [mm]."""
    x, y = RADIUS * np.cos(a), RADIUS * np.sin(a)
    if which in ("squareness", "all"):
        x = x - 80e-6 * y
    if which in ("scale", "all"):
        x, y = x * (1.0 + 25e-6), y * (1.0 - 25e-6)
    if which in ("lag", "all"):
        x = x + way * 4e-3 * np.sin(a)
    if which in ("backlash", "all"):
        x = x + 0.5 * 6e-3 * way * np.sign(np.sin(a))
    return x, y


@figure
def ballbar() -> plt.Figure:
    """Errors of two axes on a circle: each alone, formula beside places, and all together."""
    fig, axes = panels(2, 2, (8.8, 5.0), sharex=True)
    a = np.linspace(0.0, 2.0 * np.pi, 721)
    sin2, cos2 = np.sin(2.0 * a), np.cos(2.0 * a)
    formulas = {
        "squareness": lambda way: -0.5 * 80e-6 * RADIUS * sin2,
        "scale": lambda way: 0.5 * 50e-6 * RADIUS * cos2,
        "lag": lambda way: 0.5 * way * 4e-3 * sin2,
        "backlash": lambda way: 0.5 * way * 6e-3 * np.sign(np.sin(a)) * np.cos(a),
    }
    for ax, (name, law) in zip(axes.ravel(), formulas.items(), strict=True):
        for way, colour, said in ((1, BLUE, "counter-clockwise"), (-1, RED, "clockwise")):
            x, y = ballbar_places(a, way, name)
            away = 1e3 * (np.hypot(x, y) - RADIUS)
            ax.plot(np.degrees(a), 1e3 * law(way), color=colour, label=said)
            ax.plot(np.degrees(a)[::24], away[::24], "o", color=colour, markersize=3)
        ax.set_title(name, fontsize=9)
        ax.set(xlim=(0, 360), ylabel="deviation [µm]")
    axes[0, 0].set_ylim(-4.6, 7.2)
    axes[0, 0].legend(fontsize=8, loc="upper center", ncols=2)
    for ax in axes[1]:
        ax.set_xlabel("angle [deg]")
    found = read_back()
    told = (
        f"all together, 0.5 µm of noise, read back: squareness {1e6 * found.squareness.value:.1f}"
        f" µrad of 80, scale {1e6 * found.scale.value:.1f} µm/m of 50,"
        f" backlash {1e3 * found.backlash[0].value:.2f} µm of 6"
    )
    fig.suptitle(told, fontsize=9)
    return fig


def read_back() -> object:
    """Errors found in a record with all of them and noise."""
    rng, rows = np.random.default_rng(6), ["X [mm],Y [mm]"]
    for way in (1, -1):
        a = way * np.linspace(0.0, 4.0 * np.pi, 7201)
        x, y = ballbar_places(a, way, "all")
        noise = 5e-4 * rng.normal(size=(2, len(a)))
        rows += [f"{p:.7f},{q:.7f}" for p, q in zip(x + noise[0], y + noise[1], strict=True)]
    with tempfile.TemporaryDirectory() as folder:
        file = Path(folder) / "circle.csv"
        file.write_text("\n".join(rows) + "\n")
        record = circle_record([file], "XY", CircleChoice(radius=RADIUS))
        return circle_errors(record.test, "XY")
