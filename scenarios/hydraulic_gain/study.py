"""The textbook's gain of a hydraulic axis, a third of its natural frequency, against its damping.

    .venv/bin/python scenarios/hydraulic_gain/study.py [folder]

An integrator with oil and mass behind it, K/(s (s^2/w^2 + 2 d s/w + 1)), rings at w with K = 2 d w:
so w/3 asks for a damping above 1/6. The largest gains are those of the formula, of the linear model
with all delays, and of the running FMUs; once with a valve and a controller that are fast, once
with those of the article.
"""

import functools
import sys
import tomllib
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from rich.progress import track

import motionfmu
from motionfmu.analysis import linear
from motionfmu.analysis.freq.limit import RingingTest, simulated_gain
from motionfmu.analysis.linear import largest_gain

HERE = Path(__file__).parent
SCALE = "controller.scale_phase"
AT = {
    "axis.table_speed": 0.05,
    "axis.table_position": 0.0,
}  # at the middle, where the oil is softest
# P alone; no dry friction, which is no damping ratio; a short timer routine: no edge is lost
COMMON: dict[str, Any] = {
    "controller.law": 0,
    "controller.p_gain": 5000,
    "controller.timer_cycles": 5,
    "axis.start_position": -0.025,
    "axis.table_coulomb": 0.0,
    "axis.table_static": 0.0,
}
FAST: dict[str, Any] = {
    "controller.p_gain": 1200,
    "controller.timer_period": 2e-4,
    "controller.filter_time": 1e-4,
    "axis.valve_frequency": 5000.0,
    "axis.current_time": 2e-5,
}
FINE = {"controller.amplifier_gain": 3.0}  # smaller steps of the PWM, for the ringing
LOOPS = {"fast valve and controller": FAST, "the article's": {}}
# Leakage past the piston [m3/s/Pa], viscous friction [N s/m]
DAMPED = (
    (0.0, 0.0),
    (0.0, 1000.0),
    (1e-12, 1000.0),
    (3e-12, 1000.0),
    (6e-12, 1000.0),
    (1e-11, 1000.0),
)
DEFAULT = 2  # the axis as it is
KICK = 50.0  # [line periods] many PWM counts, so that their rounding does not show
COLOURS = dict(zip(LOOPS, ("#d55e00", "#0072b2"), strict=True))


@dataclass
class Row:
    """An axis and the largest gains of its loop [1/s]."""

    loop: str
    damping: float
    frequency: float  # [rad/s] oil and mass
    model: float
    ringing: float  # [rad/s] of the model at its limit
    fmus: float

    @property
    def formula(self) -> float:
        """2 d w."""
        return 2.0 * self.damping * self.frequency


def axis_of(loop: str, damped: tuple[float, float], **more: Any) -> linear.AxisModel:
    """The linear model of a loop."""
    leakage, viscous = damped
    plant = {"axis.cylinder_leakage": leakage, "axis.table_viscous": viscous}
    return linear.model(HERE, at=AT, set=COMMON | LOOPS[loop] | plant | more)


def gain_of(axis: linear.AxisModel) -> float:
    """Velocity gain K [1/s]: s L(s) at low frequency."""
    loop, omega = axis.loop(SCALE), 0.05
    return float(abs(loop(np.exp(1j * omega * loop.dt))) * omega)


@functools.cache
def as_it_is(loop: str) -> float:
    """Velocity gain [1/s] of the axis as it is, with the register of `COMMON` or `FAST`."""
    return gain_of(axis_of(loop, DAMPED[DEFAULT]))


def resonance(axis: linear.AxisModel) -> tuple[float, float]:
    """Frequency [rad/s] and damping ratio of oil and mass, from the poles of the open loop."""
    loop = axis.loop(SCALE)
    poles = loop.poles()
    s = np.log(poles[np.abs(poles) > 1e-3]) / loop.dt
    s = s[(s.imag > 0.0) & (np.abs(s) > 200.0) & (np.abs(s) < 475.0)]
    found = s[np.argmin(-s.real / np.abs(s))]
    return float(abs(found)), float(-found.real / abs(found))


def measure(loop: str, damped: tuple[float, float]) -> Row:
    """Largest gain by formula, model and FMUs."""
    axis = axis_of(loop, damped, **FINE)
    kp, (omega, damping) = gain_of(axis), resonance(axis)
    limit = largest_gain(axis, SCALE)
    rung = simulated_gain(axis, (SCALE, ()), RingingTest(KICK, 20))
    return Row(loop, damping, omega, kp * limit.gain, limit.omega, kp * rung.gain)


def move(loop: str, gain: float) -> tuple[np.ndarray, np.ndarray, int]:
    """Time [s] and speed [mm/s] on the scenario's move, by the FMUs with friction; lost counts."""
    kp = as_it_is(loop)
    register = round(gain / kp * (COMMON | LOOPS[loop])["controller.p_gain"])
    own = COMMON | LOOPS[loop] | {"controller.p_gain": register}
    own |= {"axis.start_position": -0.02, "axis.table_coulomb": 200.0, "axis.table_static": 300.0}
    result = motionfmu.load(HERE).run(set=own, stop=1.3)
    lost = int(np.max(result["controller.lost"]))
    return result.time, result["axis.table_speed"].ravel() * 1e3, lost


def draw(rows: list[Row], tuned: float, picture: Path) -> list[str]:
    """Largest gain against damping; the scenario's move. Lines of what the moves do."""
    figure = plt.figure(figsize=(11.5, 5.2), layout="constrained")
    grid = figure.add_gridspec(4, 2)
    left = figure.add_subplot(grid[:, 0])
    right = [figure.add_subplot(grid[k, 1]) for k in range(4)]
    omega = rows[DEFAULT].frequency
    d = np.linspace(0.0, 0.3, 50)
    left.plot(d, 2.0 * d * omega, color="black", linewidth=1.0, label="2 d w")
    left.axhline(omega / 3.0, color="black", linestyle="--", linewidth=1.0, label="rule w/3")
    for loop, colour in COLOURS.items():
        own = [r for r in rows if r.loop == loop]
        x = [r.damping for r in own]
        left.plot(x, [r.model for r in own], color=colour, label=f"{loop}: linear model")
        left.plot(x, [r.fmus for r in own], "o", color=colour, label="running FMUs")
        left.plot(x[DEFAULT], own[DEFAULT].fmus, "o", color=colour, markersize=12, fillstyle="none")
    left.axvline(1.0 / 6.0, color="grey", linewidth=0.8, linestyle=":")
    left.annotate("1/6", (1.0 / 6.0, 230.0), (3, 0), textcoords="offset points", color="grey")
    left.set(xlim=(0.0, 0.3), ylim=(0.0, 240.0), xlabel="damping ratio d of oil and mass")
    left.set(ylabel="largest stable gain [1/s]")
    left.set_title("Largest gain; rings: the axis as it is", loc="left", fontsize=10)
    left.legend(frameon=False, fontsize=8, loc="lower right")
    said = []
    fast, article = LOOPS
    rule, third = omega / 3.0, rows[DEFAULT].fmus / 3.0
    shown = (
        (fast, rule, "the rule"),
        (fast, third, "a third of its limit"),
        (article, rule, "the rule"),
        (article, tuned, "as tuned"),
    )
    for axes, (loop, gain, what) in zip(right, shown, strict=True):
        time, speed, lost = move(loop, gain)
        axes.plot(time, speed, color=COLOURS[loop], linewidth=0.9)
        text = f"{loop}: {what}, {gain:.0f} 1/s"
        axes.set_title(text, loc="left", fontsize=9)
        axes.tick_params(labelbottom=axes is right[-1])
        steady = speed[(time > 0.5) & (time < 0.8)]
        said.append(f"{text}: {np.ptp(steady):.1f} mm/s of ringing under way, {lost} counts lost")
    right[-1].set(xlabel="time [s]; the axis as it is, with friction: 40 mm at 50 mm/s")
    figure.supylabel("speed [mm/s]", x=0.52, fontsize=10)
    for axes in (left, *right):
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=120)
    return said


def main(folder: Path) -> None:
    """Print the table, draw the picture."""
    jobs = [(loop, damped) for loop in LOOPS for damped in DAMPED]
    quiet = not sys.stdout.isatty()
    rows = [measure(*job) for job in track(jobs, "loops", transient=True, disable=quiet)]
    print("| loop | d | w | 2 d w | model | rings at | FMUs | w/3 |")
    for r in rows:
        cells = (r.frequency, r.formula, r.model, r.ringing, r.fmus, r.frequency / 3.0)
        print(f"| {r.loop} | {r.damping:.3f} | {' | '.join(f'{x:.0f}' for x in cells)} |")
    picture = folder / "gain.png"
    gains = tomllib.loads((HERE / "gains.toml").read_text(encoding="utf-8"))
    tuned = as_it_is(list(LOOPS)[1]) * gains["controller.p_gain"] / COMMON["controller.p_gain"]
    for line in draw(rows, tuned, picture):
        print(line)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE)
