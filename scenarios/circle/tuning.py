"""Tuned gains against published rules: one table, and a brute-force search beside the tuner.

    .venv/bin/python scenarios/circle/tuning.py            # the table of the README
    .venv/bin/python scenarios/circle/tuning.py --brute    # the tuner against every point of a grid

A tuned line has the same margins asked of it as its rule has: the least of all loops and plants,
the rule's overshoot (0.1 % where it has none) and its slowest time constant.
"""

import itertools
import math
import sys
import time
from pathlib import Path

import numpy as np
from rich.progress import track

import motionfmu
from motionfmu.study.tune import Tuned, problem, tune
from motionfmu.study.tune.curve import margin
from motionfmu.study.tune.tuning_functions import TuningFunctions
from motionfmu.study.tune.tuning_result import settings

HERE = Path(__file__).parent
PROGRAMS = ("circle", "square", "lookahead")
# Load and stiffness of the axes: 60 kg less, 100 kg more on the table; a screw at its far end.
FAMILY = {"machine.table_mass": [40.0, 200.0], "machine.screw_stiffness": [6e7, 1.2e8]}
LEAD, COUNTS = 0.01, 10_000  # [m], [counts] per turn
INERTIA = 2e-3 + 100.0 * (LEAD / (2.0 * math.pi)) ** 2  # [kg·m²] motor, and table at the motor
# Kp of one unit of the card's register [1/s]: 2^-6 * (20 V / 65536) * 300 rpm/V * counts / 60
UNIT = 2.0**-6 * 20.0 / 65536.0 * 300.0 * COUNTS / 60.0
OVERSHOOT = 1e-3  # a rule without overshoot still leaves room for rounding


def rule(kp: float, hertz: float, integral: float) -> dict[str, float]:
    """Gains of a cascade: Kp [1/s], velocity loop [Hz], integral time [s]."""
    return {
        "mcc.p_gain": round(kp / UNIT),
        "drives.velocity_gain": INERTIA * 2.0 * math.pi * hertz,
        "drives.velocity_time": integral,
    }


# Yaskawa Sigma-II user's manual, 6.4.4, machines of high rigidity (ball screw directly coupled):
# 50 to 70 1/s, 50 to 70 Hz, 5 to 20 ms. Kp = wv/4: damping 1 with a first-order velocity loop.
WV = 0.5 / INERTIA  # [rad/s] of the scenario's own velocity gain, 0.5 N·m s/rad
RULES = {
    "Yaskawa, high rigidity": rule(60.0, 60.0, 0.0125),
    "Kp = wv/4": rule(WV / 4.0, WV / (2.0 * math.pi), 0.02),
}


def limits_of(study: TuningFunctions) -> dict[str, object]:
    """Limits that the present gains just keep."""
    worst = {"sensitivity": 1.0, "gain": math.inf, "phase": 180.0}
    over, slow, gains = OVERSHOOT, 0.0, study.gains(study.present)
    for parts in study.parts:
        for k, part in parts.items():
            for name in part.loops:
                has = margin(part.loop(name, gains[k])).values
                worst["sensitivity"] = max(worst["sensitivity"], 1.0 / has[0])
                worst["gain"] = min(worst["gain"], math.exp(min(has[1], has[2])))
                worst["phase"] = min(worst["phase"], math.degrees(has[3]))
            answer = part.step(gains[k], 2, 2000, False).value[0]
            over = max(over, float(answer.max()) - 1.0)
            slow = max(slow, part.slowest(gains[k])[0])
    return {
        "margins": {
            "sensitivity": worst["sensitivity"],
            "gain": worst["gain"],
            "phase": worst["phase"],
        },
        "overshoot": over,
        "recovery": slow,
    }


def compared(program: str, gains: dict[str, float]) -> Tuned:
    """Tune with the margins of a rule, from the rule's gains."""
    scenario = motionfmu.load(HERE.parent / program)
    asked = {"velocity": True, "axes": "equal", "family": FAMILY, "starts": 1, "check": 0}
    study = TuningFunctions(scenario, problem(asked), scenario.run(set=gains), gains)
    limits = limits_of(study)
    return tune(scenario, {**asked, "limits": limits}, gains)


def rows(name: str, program: str, tuned: Tuned) -> list[str]:
    """Two lines of the table: the rule, and what the tuner made of its margins."""
    found = []
    for label, z, runs in (
        (name, tuned.study.present, tuned.before),
        ("tuned", tuned.z, tuned.after),
    ):
        set_ = settings(tuned.study, z)
        least = tuned.margins(z)
        kv, ti = set_["drives.velocity_gain"][0], set_["drives.velocity_time"][0]
        errors = [
            f"{x * 1e3:.1f}"
            for run in runs
            for x in (run.result.contour().error.rms, run.result.contour().error.max)
        ]
        cells = [
            program if label == name else "",
            label,
            f"{set_['mcc.p_gain'][0] * UNIT:.0f}",
            f"{kv / INERTIA / (2.0 * math.pi):.0f}",
            f"{ti * 1e3:.1f}",
            *errors,
            f"{min(m.gain for m in least):.1f}",
            f"{min(m.phase for m in least):.0f}",
            f"{max(m.sensitivity for m in least):.2f}",
        ]
        found.append("| " + " | ".join(cells) + " |")
    return found


def table() -> None:
    """Print the table of the README."""
    heads = "program|gains|Kp|Kv|Ti|rms|max|rms|max|gain|phase|peak S"
    units = "||1/s|Hz|ms|nominal µm|nominal µm|worst µm|worst µm|margin|°|"
    lines = [f"| {' | '.join(heads.split('|'))} |", "|" + "---|" * 12]
    lines.append(f"| {' | '.join(units.split('|'))} |")
    jobs = list(itertools.product(PROGRAMS, RULES.items()))
    for program, (name, gains) in track(jobs, "tuning", disable=not sys.stdout.isatty()):
        tuned = compared(program, gains)
        lines += rows(name, program, tuned)
        print(f"{program}, {name}: {tuned.seconds:.0f} s, {tuned.stopped_by}", file=sys.stderr)
    print("\n".join(lines))


def brute() -> None:
    """Print cost and time of the tuner and of a grid that is refined about its best point."""
    scenario = motionfmu.load(HERE)
    for title, asked, points, rounds in (
        ("position gain, axis by axis", {}, 7, 12),
        ("position and velocity loop, equal axes", {"velocity": True, "axes": "equal"}, 7, 10),
    ):
        tuned = tune(scenario, asked)
        print(f"{title}: tuner {tuned.found.values.worst * 1e3:.4f} µm, all {tuned.seconds:.1f} s")
        cost, seconds, count = _grid(tuned.study, points, rounds)
        off = tuned.found.values.worst / cost - 1.0
        print(f"  brute force {cost * 1e3:.4f} µm, {seconds:.1f} s, {count} points: {off:+.3%}")


def _grid(study: TuningFunctions, points: int, rounds: int) -> tuple[float, float, int]:
    begun, n = time.perf_counter(), len(study.variables)
    low, high = np.zeros(n), np.ones(n)
    cost, done = math.inf, 0
    for _ in track(range(rounds), "brute force", disable=not sys.stdout.isatty()):
        sides = [np.linspace(a, b, points) for a, b in zip(low, high, strict=True)]
        tried = [(study.values(np.array(z), False), np.array(z)) for z in itertools.product(*sides)]
        done += len(tried)
        kept = [t for t in tried if t[0].feasible()]
        if kept:
            values, best = min(kept, key=lambda t: t[0].worst)
            cost = min(cost, values.worst)
        else:  # nearest to the limits where the loops are stable at all
            _, best = max(tried, key=lambda t: np.nan_to_num(t[0].slack.min(), nan=-math.inf))
        width = 1.5 * (high - low) / (points - 1)
        low, high = np.maximum(best - width, 0.0), np.minimum(best + width, 1.0)
    return cost, time.perf_counter() - begun, done


if __name__ == "__main__":
    brute() if "--brute" in sys.argv else table()
