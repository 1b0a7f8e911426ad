"""The pen line's commands slot by slot, and the lag of its drives, against theory."""

from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from py_opw_kinematics import KinematicModel, Robot
from scipy.spatial.transform import RigidTransform, Rotation

import motionfmu

LINE = ROOT / "scenarios" / "robot_line"
SLOT, CYCLE = 5e-6, 1e-4  # [s]
SPEED, ACC = 10.0, 1000.0  # [mm/s], [mm/s2]
RATIO = np.array([100, 120, 120, 100, 100, 80])
UNITS = RATIO * 2500 / (2 * np.pi)  # [pulses/rad]
SLOTS = """# The line's commands, looked at in each slot.
stop = {stop}
step = 5e-6
leave = ["soft.*", "card.*"]
[component]
soft = "soft_controller"
card = "fpga_card"
[connect]
"card.host_*" = "soft.card_*"
"soft.card_*" = "card.*"
[set]
"soft.program" = "line.job"
"soft.points" = "{line}/line.points"
"soft.tool" = [0, 0, 150, 0, 0, 0]
"soft.start_delay" = 0.01
"soft.start_joint" = {start}
"card.bus_period" = 5e-6
[record]
signals = ["card.pulse_count", "card.underruns", "card.irq_clock"]
[check]
"card.underruns" = {{ max = 0 }}
[[contrary]]
off = "nothing"
set = {{ "soft.ik_time" = 1e-3 }}
fails = ["card.underruns"]
"""


def joints(y: np.ndarray) -> np.ndarray:
    """Joint angles [rad] of the pen's tip at y [mm] of the line, tool down, elbow up."""
    model = KinematicModel(
        a1=0.15,
        a2=-0.115,
        b=0,
        c1=0.445,
        c2=0.7,
        c3=0.795,
        c4=0.085,
        offsets=(0, 0, -np.pi / 2, 0, 0, 0),
    )
    robot = Robot(model, degrees=False)
    turn = Rotation.from_euler("xyz", [180, 0, 180], degrees=True)
    found, near = [], (-0.31, 0.94, -0.45, 0.0, 1.08, -0.31)
    for place in y:
        pose = RigidTransform.from_components((1.4, place * 1e-3, 0.5), turn)
        near = robot.inverse(pose, current_joints=near)[0]
        found.append(near)
    return np.array(found)


def way(t: np.ndarray) -> np.ndarray:
    """Way [mm] of a start from rest at constant acceleration."""
    ramp = SPEED / ACC
    return np.where(t < ramp, ACC * t**2 / 2, SPEED * (t - ramp / 2)) * (t > 0)


def test_pulses_are_the_rounded_theory_in_every_slot(tmp_path: Path) -> None:
    start = np.degrees(joints(np.array([-450.0]))[0])
    file = tmp_path / "scenario.toml"
    (tmp_path / "line.job").write_text("MOVL P002 V=10.0\nEND\n")
    file.write_text(SLOTS.format(stop=0.31, line=LINE, start=[float(x) for x in start]))
    run = motionfmu.load(tmp_path).run()
    # The first interrupt from 10 ms on executes the line, its memory begins to play a cycle later.
    irq = run["card.irq_clock"] * 25e-9
    t = run.time - (irq[irq >= 0.01].min() + CYCLE)
    ends = np.arange(0, t[-1] + CYCLE, CYCLE)
    q = joints(way(ends) - 450.0)
    ideal = np.stack([np.interp(t, ends, q[:, i]) for i in range(6)], axis=1) * UNITS
    origin = np.rint(ideal[0])
    off = np.abs(run["card.pulse_count"] + origin - ideal)
    assert np.all(run["card.underruns"] == 0)
    assert np.abs(run["card.pulse_count"][-1]).max() > 80
    assert 0.49 < off.max() < 0.5 + 1e-4


@pytest.mark.parametrize(
    ("gain", "forward", "override"),
    [(63.0, 0.3, 1.0), (48.0, 0.3, 1.0), (63.0, 0.0, 1.0), (30.0, 0.3, 0.5)],
)
def test_the_lag_is_that_of_the_formula_within_a_unit(
    gain: float, forward: float, override: float
) -> None:
    sets = {
        "drives.position_gain": gain,
        "drives.feed_forward": forward,
        "soft.override": override,
    }
    run = motionfmu.load(LINE).run(set=sets, stop=5.0)
    q = run["soft.joint_command"][:, 0] * UNITS[0]
    rate = (q[2800:4900] - q[2700:4800]) / 0.1  # [pulses/s]
    lag = (1.0 - forward) * rate / gain
    deviation = run["drives.following_error"][2750:4850, 0] * 2500
    assert np.abs(deviation - lag).max() < 1.0
    assert np.abs(np.mean(deviation - lag)) < 0.1
    assert lag.min() > 1.0
