"""Machines whose parameters are known, and records of them as a drive's trace would be."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

import motionfmu
from motionfmu.identify import AxisRecord, ColumnUse

Array = NDArray[np.float64]
STEP, PERIOD = 1e-4, 1e-3  # [s] communication step; period of the drive and of the record
OFF = [False] * 5
JITTER = 2.0  # noise of a position [counts]
_ALONE = 400.0  # [rad/s] of the velocity loop with a motor that is alone


@dataclass(frozen=True)
class AxisTruth:
    """A drive in position mode and one ball-screw axis; values by ``component.variable``."""

    values: dict[str, Any]  # as the machine is
    guess: dict[str, Any] = field(default_factory=dict)  # as the scenario believes it to be

    def scenario(self, values: dict[str, Any] | None = None) -> "motionfmu.Scenario":
        """The scenario, as believed."""
        return motionfmu.scenario(
            {
                "stop": 1.0,
                "step": STEP,
                "component": {"drives": "servo_drives", "machine": "ball_screw_axes"},
                "connect": {
                    "drives.phase": "machine.motor_phase",
                    "machine.torque_command": "drives.torque",
                },
                "leave": ["drives.enable", "drives.alarm_reset", "drives.dac", "machine.force"],
                "drive": [{"input": "drives.pulse_count", "at": [0.0], "value": [0]}],
                "set": {
                    "drives.mode": 1,
                    "drives.period": PERIOD,
                    "drives.active": [True, *OFF],
                    "machine.active": [True, *OFF],
                    **self.values,
                    **(self.guess if values is None else values),
                },
                "record": {"every": 1, "signals": ["drives.torque", "machine.motor_phase"]},
            },
            name="axis",
        )


def moves(rng: np.random.Generator, stop: float, speed: float, acceleration: float) -> Array:
    """A command of constant accelerations, each `PERIOD`: strokes of many speeds, both ways."""
    rate: list[Array] = []
    total, sign = 0, 1.0
    while total < stop / PERIOD:
        top = speed * rng.choice([0.05, 0.15, 0.4, 0.7, 1.0])
        up = acceleration * rng.uniform(0.4, 1.0)
        ramp = np.arange(0.0, top, up * PERIOD)
        hold = np.full(int(rng.uniform(0.05, 0.15) / PERIOD), top)
        rest = np.zeros(int(rng.uniform(0.0, 0.06) / PERIOD))
        rate += [sign * np.concatenate([ramp, hold, ramp[::-1], rest])]
        total += len(rate[-1])
        sign = -sign
    whole = np.concatenate(rate)[: int(stop / PERIOD)]
    return np.concatenate([[0.0], np.cumsum(whole) * PERIOD])


def simulated(
    truth: AxisTruth, command: Array, rng: np.random.Generator, noise: float
) -> AxisRecord:
    """The record of a run of the FMUs: noise in counts, of the torque as a share of its RMS."""
    v = truth.values
    lead, turn = v["machine.lead"], v["drives.pulses_per_turn"]
    pulses = np.round(command / lead * turn).astype(int)
    rise = np.flatnonzero(np.append(True, np.diff(pulses) != 0))
    ran = (
        truth.scenario({})
        .changed(
            drive=[
                {
                    "input": "drives.pulse_count",
                    "at": [round(PERIOD * k, 9) for k in rise.tolist()],
                    "value": [[int(pulses[k]), 0, 0, 0, 0, 0] for k in rise],
                }
            ],
            stop=round(PERIOD * (len(command) - 1), 9),
        )
        .run()
    )
    rows = np.arange(len(command)) * round(PERIOD / STEP)
    phase = np.asarray(ran["machine.motor_phase"])[:, 0][np.minimum(rows, len(ran.time) - 1)]
    torque = np.asarray(ran["drives.torque"])[:, 0][np.minimum(rows, len(ran.time) - 1)]
    counts = v["drives.encoder_counts"]
    phase = phase / 2500.0 * counts + JITTER * rng.standard_normal(len(phase))  # counts
    position = np.floor(phase) / counts * lead
    torque = torque + noise * float(np.sqrt(np.mean(torque**2))) * rng.standard_normal(len(torque))
    return AxisRecord(
        PERIOD * np.arange(len(command)),
        {"command": pulses / turn * lead, "position": position, "torque": torque},
        {"command": "m", "position": "m", "torque": "N.m"},
        "simulated",
    )


COLUMNS = {
    "command": ColumnUse("drives.pulse_count"),
    "position": ColumnUse("machine.motor_phase"),
    "torque": ColumnUse("drives.torque"),
}


def drawn(
    seed: int, gap: bool = False
) -> tuple[AxisTruth, np.random.Generator, tuple[float, float]]:
    """A machine at random, maybe with backlash, and its speed [m/s] and acceleration [m/s2]."""
    rng = np.random.default_rng([34, seed])
    mass, lead = 5.0 * 100.0 ** rng.random(), float(rng.choice([0.002, 0.005, 0.01, 0.02]))
    share = lead / (2.0 * np.pi)
    inertia = float(rng.uniform(0.2, 2.0)) * mass * share**2
    whole = inertia + mass * share**2
    band = float(rng.uniform(120.0, 300.0))  # [rad/s] of the velocity loop
    if gap:  # in its gap the motor is alone: a loop that is too fast for that hunts for ever
        band = min(band, _ALONE * inertia / whole)
    speed = 25.0 * lead
    acceleration = float(rng.uniform(1.0, 4.0)) * speed / 0.1
    weight = (mass + inertia / share**2) * acceleration
    coulomb = float(rng.uniform(0.05, 0.3)) * weight
    viscous = float(rng.uniform(0.05, 0.3)) * weight / speed
    stiffness = mass * (2.0 * np.pi * float(rng.uniform(150.0, 400.0))) ** 2
    values = {
        "machine.lead": lead,
        "machine.table_mass": mass,
        "machine.motor_inertia": inertia,
        "machine.motor_coulomb": 0.0,
        "machine.motor_static": 0.0,
        "machine.motor_viscous": 0.0,
        "machine.current_time": float(rng.choice([0.0, 2e-4, 5e-4])),
        "machine.screw_stiffness": stiffness,
        "machine.screw_damping": 0.1 * np.sqrt(stiffness * mass),
        "machine.table_coulomb": coulomb,
        "machine.table_static": coulomb,
        "machine.table_viscous": viscous,
        "machine.table_viscous_asymmetry": float(rng.choice([0.0, rng.uniform(-0.4, 0.4)])),
        "machine.table_rest_speed": 1e-3 * speed,
        "machine.backlash": gap * float(rng.choice([0.0, 1e-5 * rng.random()])),
        "machine.force": float(rng.choice([0.0, rng.uniform(-0.2, 0.2)])) * weight,
        "drives.encoder_counts": int(rng.choice([100_000, 1_000_000])),
        "drives.pulses_per_turn": 1_000_000,
        "drives.velocity_gain": band * whole,
        "drives.velocity_time": float(rng.choice([0.0, 0.05])),
        "drives.position_gain": band / 5.0,
        "drives.torque_limit": 10.0 * weight * share,
        "drives.error_limit": 50.0,
        "drives.prompt": bool(rng.random() < 0.3),
    }
    guess = {
        "machine.table_mass": mass * float(rng.uniform(0.4, 2.0)),
        "machine.table_coulomb": coulomb * float(rng.uniform(0.3, 2.0)),
        "machine.table_viscous": viscous * float(rng.uniform(0.3, 2.0)),
        "machine.table_viscous_asymmetry": 0.0,
        "machine.force": 0.0,
    }
    guess["machine.table_static"] = guess["machine.table_coulomb"]
    return AxisTruth(values, guess), rng, (speed, acceleration)
