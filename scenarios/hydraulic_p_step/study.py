"""The step response of P beside its formula, and the error that is left over the gain.

    .venv/bin/python scenarios/hydraulic_p_step/study.py [picture.png]

Runs the scenario for the step, and again with three valves and frictions at several gains: TRACK
travels there slowly, and what is left is compared with u_d/Kc.
"""

import sys
from dataclasses import dataclass
from pathlib import Path

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np
from rich.progress import track

import motionfmu

HERE = Path(__file__).parent
STEP = 5000  # [counts]
VOLT = 0.01  # [V] of a PWM count, 20 V/2000
SPEED = 4948.0  # [counts/s] per volt: 0.2474 m/s at 10 V
GAIN = SPEED * VOLT * 166 / 4096  # [1/s] Kp
DELAY = 6e-3  # [s] timer, PWM, filter, valve, pins
# Leakage past piston and over the closed edges by the area squared: crawl under a force [m/s/N].
CRAWL = (1e-12 + 3e-13) / 9.46e-4**2
COUNT = 5e-6  # [m]
KC = (512, 1024, 2048, 4096)  # p_gain, in 1/4096 PWM counts per count


@dataclass(frozen=True)
class Machine:
    """A valve and a friction."""

    name: str
    overlap: float  # [1] share of the stroke
    coulomb: float  # [N]
    static: float  # [N]

    @property
    def deadband(self) -> float:
        """Command that moves nothing [PWM counts]: overlap, friction over leakage, rounding."""
        friction = CRAWL * self.static / COUNT / SPEED / VOLT
        return 10.0 * self.overlap / VOLT + friction + 0.5


MACHINES = (
    Machine("3 %, friction 300 N", 0.03, 200.0, 300.0),
    Machine("6 %, friction 300 N", 0.06, 200.0, 300.0),
    Machine("3 %, friction 2000 N", 0.03, 1500.0, 2000.0),
)
COLOURS = ("#0072b2", "#009e73", "#d55e00")


def formula(time: np.ndarray) -> np.ndarray:
    """100 (1 - exp(-Kp t)) from the time since TRACK jumped [s]."""
    return 100.0 * (1.0 - np.exp(-GAIN * np.clip(time, 0.0, None)))


def step() -> tuple[np.ndarray, np.ndarray]:
    """Time since TRACK jumped [s] and position in percent of the step."""
    r = motionfmu.load(HERE).run()
    jumped = r.time[np.argmax(r["p.track"] > 0)] - 1e-4  # shown a pin period later
    way = (r["axis.table_position"] - r["axis.table_position"][0]) / (STEP * COUNT)
    return r.time - jumped, 100.0 * way


def left(machine: Machine, p_gain: int) -> int:
    """Error at the end of a slow approach [counts]."""
    values = {
        "gap.p_gain": p_gain,
        "gap.step_target": False,
        "gap.speed": 4000.0,
        "gap.acceleration": 40000.0,
        "gap_axis.valve_overlap": machine.overlap,
        "gap_axis.table_coulomb": machine.coulomb,
        "gap_axis.table_static": machine.static,
    }
    r = motionfmu.load(HERE).run(set=values)
    assert not r["gap.code"].any()
    return int(r["gap.error"][-1])


def draw(found: dict[Machine, list[int]], picture: Path) -> None:
    """Step and its difference from the formula on the left, what is left on the right."""
    figure = plt.figure(figsize=(13.0, 6.5), layout="constrained")
    grid = figure.add_gridspec(2, 2, height_ratios=[3, 2])
    time, way = step()
    top = figure.add_subplot(grid[0, 0])
    top.plot(time, way, color=COLOURS[0], label="axis")
    top.plot(time, formula(time), "--", color="#444444", label="100 (1 - exp(-Kp t))")
    top.axvline(1.0 / GAIN, color="#444444", linestyle=":", linewidth=1.0)
    top.annotate("T = 1/Kp", (1.0 / GAIN, 3.0), xytext=(4, 0), textcoords="offset points")
    top.set_ylabel("position [% of the step]")
    top.set_title("Figure 2-2: step response of P", loc="left", fontsize=11)
    low = figure.add_subplot(grid[1, 0], sharex=top)
    low.plot(time, way - formula(time), color=COLOURS[0], label="axis - formula")
    late = way - formula(time - DELAY)
    low.plot(time, late, color=COLOURS[2], label="axis - formula 6 ms later")
    low.set_xlabel("time since the jump [s]")
    low.set_ylabel("difference [%]")
    right = figure.add_subplot(grid[:, 1])
    gains = np.array(KC) / 4096
    for (machine, errors), colour in zip(found.items(), COLOURS, strict=True):
        right.loglog(gains, errors, "o", color=colour, label=f"deadband {machine.name}")
        right.loglog(gains, machine.deadband / gains, color=colour, linewidth=1.0)
    right.set_xticks(gains, [f"{g:g}" for g in gains])
    right.set_yticks([25, 50, 100, 200, 400], ["25", "50", "100", "200", "400"])
    right.minorticks_off()
    right.set_xlabel("Kc [PWM counts per count]")
    right.set_ylabel("error left [counts]")
    right.set_title("Left for good: at most u_d/Kc (lines)", loc="left", fontsize=11)
    for axes in (top, low, right):
        axes.grid(alpha=0.25)
        axes.legend(frameon=False)
        axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(picture, dpi=100)


def main(picture: Path) -> None:
    """Run all cases; print the table, draw the picture."""
    found = {m: [left(m, g) for g in track(KC, m.name, transient=True)] for m in MACHINES}
    print("| deadband | u_d | " + " | ".join(f"Kc = {g / 4096:g}" for g in KC) + " |")
    print("|---" * (len(KC) + 2) + "|")
    for machine, errors in found.items():
        cells = [
            f"{e} of {machine.deadband * 4096 / g:.0f}" for e, g in zip(errors, KC, strict=True)
        ]
        print(f"| {machine.name} | {machine.deadband:.1f} | " + " | ".join(cells) + " |")
    draw(found, picture)
    print(f"picture: {picture}")


if __name__ == "__main__":
    main(Path(sys.argv[1]) if len(sys.argv) > 1 else HERE / "p_step.png")
