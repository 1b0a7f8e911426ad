"""Records of the arm's own FMUs: motors that follow Fourier series, what a drive would record."""

from dataclasses import dataclass, field
from typing import Any

import numpy as np

from motionfmu import scenario
from motionfmu.identify.arm_dynamics.arm_plant import ArmPlant, arm_plant
from motionfmu.records import Record

STEP = 5e-5
FINE = 1  # steps between two samples of which a drive's mean is made
# Amplitudes of the joints [°] and how far apart their frequencies are, for a rich motion.
SPAN = np.array([70.0, 40.0, 40.0, 90.0, 60.0, 90.0])
MIDDLE = np.array([0.0, 10.0, 0.0, 0.0, 60.0, 0.0])
DRIVES = {
    "drives.mode": 1,
    "drives.pulses_per_turn": 10000,
    "drives.position_gain": 30.0,
    "drives.feed_forward": 0.0,
    "drives.velocity_gain": [1.4, 1.4, 0.8, 0.06, 0.06, 0.02],
    "drives.velocity_time": 0.016,
    "drives.torque_limit": 30.0,
    "drives.error_limit": 1e4,
}


def plant_of(**values: Any) -> ArmPlant:
    """The arm alone, with some values of its own."""
    own = {
        "stop": 1.0,
        "step": 1e-4,
        "component": {"arm": "robot_arm"},
        "leave": ["arm.torque", "arm.force"],
        "record": {"signals": ["arm.link_angle"]},
        "set": {f"arm.{k}": v for k, v in values.items()},
    }
    return arm_plant(scenario(own, name="arm"), {})


@dataclass(frozen=True)
class ArmTruth:
    """An arm with some values of its own, and how it is recorded."""

    values: dict[str, Any] = field(default_factory=dict)  # of the arm, by variable
    seconds: float = 40.0
    rate: float = 250.0  # [Hz]
    seed: int = 1
    noise: float = 0.002  # of torques, as a share of their RMS
    counts: int = 2**22  # of an encoder behind the gear, a turn


def series(truth: ArmTruth, t: np.ndarray) -> np.ndarray:
    """Joint angles [°]: Fourier series that begin at rest (Swevers et al. 1997)."""
    rng = np.random.default_rng(truth.seed)
    base = 0.05  # [Hz]
    found = np.zeros((len(t), 6))
    for k in range(6):
        a, b = rng.normal(size=(2, 8)) / np.sqrt(np.arange(1, 9))[None]
        f = base * np.arange(1, 9) * (1.0 + 0.03 * k)
        w = 2.0 * np.pi * f
        x = (a * np.sin(w * t[:, None]) + b * np.cos(w * t[:, None])).sum(axis=1)
        found[:, k] = MIDDLE[k] + SPAN[k] * x / np.abs(x).max()
    return found


def simulated(truth: ArmTruth) -> Record:
    """Drives in position mode lead the arm's FMU along; what they record."""
    t = np.arange(0.0, truth.seconds, 1e-3)
    joints = series(truth, t)
    ease = np.clip(t / 1.0, 0.0, 1.0)
    ease = ease**3 * (10.0 - 15.0 * ease + 6.0 * ease**2)
    start = joints[0]
    joints = start + (joints - start) * ease[:, None]
    ratio = np.array(truth.values.get("gear_ratio", [100, 120, 120, 100, 100, 80]))
    pulses = np.round((joints - start) / 360.0 * ratio * 10000.0).astype(int)
    every = round(1.0 / truth.rate / STEP) // FINE
    own = scenario(
        {
            "stop": truth.seconds,
            "step": STEP,
            "leave": ["drives.dac", "drives.enable", "drives.alarm_reset", "arm.force"],
            "component": {"drives": "servo_drives", "arm": "robot_arm"},
            "connect": {"drives.phase": "arm.motor_phase", "arm.torque": "drives.torque"},
            "set": {
                **DRIVES,
                "arm.start_joint": start.tolist(),
                **{f"arm.{k}": v for k, v in truth.values.items()},
            },
            "drive": [
                {
                    "input": "drives.pulse_count",
                    "at": [round(float(x), 9) for x in t],
                    "value": pulses.tolist(),
                }
            ],
            "record": {
                "every": FINE,
                "signals": ["drives.torque", "arm.motor_angle", "arm.link_angle", "drives.alarm"],
            },
        },
        name="arm_truth",
    )
    result = own.run()
    assert not np.asarray(result["drives.alarm"]).any()
    rng = np.random.default_rng(truth.seed + 100)
    # a drive's torque is a mean over the time between two samples, or commands would beat with them
    fine = np.asarray(result["drives.torque"])
    summed = np.cumsum(np.vstack([np.zeros((1, 6)), fine]), axis=0)
    at = np.arange(every, len(fine) - every, every)
    torque = (summed[at + every // 2] - summed[at - every // 2]) / every
    torque = torque + truth.noise * torque.std(axis=0) * rng.normal(size=torque.shape)
    grain = 2.0 * np.pi / truth.counts
    link = grain * np.round(np.asarray(result["arm.link_angle"])[at] / grain)
    count = 2.0 * np.pi / 2**20
    motor = count * np.round(np.asarray(result["arm.motor_angle"])[at] / count)
    return Record(
        "simulated",
        np.round(result.time[at] * 1e9).astype(np.int64),
        {"tau": torque, "motor": motor, "link": link},
        {"tau": "N.m", "motor": "rad", "link": "rad"},
    )
