"""Gains of an arm's drives: inertia, margins, worst poses by others and by brute force."""

import json
import tomllib
from pathlib import Path
from typing import Any

import control
import numpy as np
import pytest
from few_cases import few
from robot_arm import EXACT, Arm, Pinocchio

import motionfmu
from motionfmu.analysis.linear.stability import margins
from motionfmu.analysis.linear.tuning_parts import linearised
from motionfmu.base.errors import InputError
from motionfmu.run import machine
from motionfmu.study.arm_gains import ArmTuned, arm_search, tune_arm, verdict
from motionfmu.study.arm_gains.arm_poses import climbed, ranges, spread
from motionfmu.study.arm_gains.arm_search import ArmSearch, PeakLimits
from motionfmu.study.arm_gains.joint_loops import JointLoops

EXACT_ARM = {f"arm.{n}": v for n, v in EXACT.items()}
LOW, HIGH = [-180, -155, -155, -400, -120, -400], [180, 95, 75, 400, 120, 400]
LIMITS = PeakLimits(1.5, 1.3)
# Gains found for robot6, three digits of them.
SOUND = np.array([6 * [17.4], [0.526, 0.526, 0.196, 0.0368, 0.0368, 0.0188],
                  [0.0632, 0.0289, 0.00373, 0.00417, 0.00322, 0.00436]])  # fmt: skip


@pytest.fixture(scope="module")
def loops() -> JointLoops:
    """The loops of the machine's arm."""
    return JointLoops(machine("robot6").plan(), {})


def ends() -> np.ndarray:
    """Between which poses lie."""
    return ranges(np.array(LOW, dtype=float), np.array(HIGH, dtype=float))


def test_inertia_is_pinocchios() -> None:
    """Diagonal of the mass matrix over the gear's square, with the motor, in twenty poses."""
    own = JointLoops(machine("robot6").plan(), EXACT_ARM)
    arm = Arm(**EXACT)
    sign, offset = arm.parameter("joint_sign"), np.radians(arm.parameter("joint_offset"))
    ratio, motors = arm.parameter("gear_ratio"), arm.parameter("motor_inertia")
    poses = spread(ends(), 20)[:20]
    links = Pinocchio(arm)
    wanted = []
    for pose in poses:
        values = own.at(pose, 1).points["arm"].values
        hung = [values["link_angle" if k == 1 else f"link_angle[{k}]"] for k in range(1, 7)]
        mass = links.inertia(sign * np.array(hung) - offset)
        wanted.append(motors + np.diag(mass) / ratio**2)
    assert own.responses(poses).inertia == pytest.approx(np.array(wanted), rel=1e-6)


def by_hand(loops: JointLoops, pose: np.ndarray, gains: np.ndarray, joint: int) -> Any:
    """The loop of a joint with the others closed, of python-control's own blocks.

    The plant is scipy's zero-order hold of the arm's equation, the drives are the formulas of
    their manual; each drive shows its torque a period later.
    """
    axis = loops.at(pose, 1)
    parts, p = linearised(axis, "arm")
    point = axis.points["arm"]
    a, b, c, d = parts.matrices(point.x, point.u, p)
    shown = [y.name for y in parts.ode.outputs]
    phases = [shown.index(f"motor_phase[{k}]") for k in range(1, 7)]
    t = loops.period
    plant = control.sample_system(control.ss(a, b[:, :6], c[phases], d[phases, :6]), t)
    line = 2.0 * np.pi / float(axis.values("drives")["encoder_lines"])
    z = control.tf([1.0, 0.0], [1.0], t)
    drives = []
    for k in range(6):
        kp, kv, ti = gains[:, k]
        law = kv * line * (1.0 + t / ti * z / (z - 1.0)) * (kp + (1.0 - 1.0 / z) / t) / z
        drives.append(control.ss(control.minreal(law, verbose=False)))
    back = control.append(*drives)
    others = [k for k in range(6) if k != joint - 1]
    gate = np.eye(6)[:, others] @ np.eye(6)[others]
    closed = control.feedback(plant, control.ss([], [], [], gate, t) * back)
    own = control.ss(closed.A, closed.B[:, [joint - 1]], closed.C[[joint - 1]], [[0.0]], t)
    return drives[joint - 1] * own


@pytest.mark.parametrize("joint", few([1, 3, 5], [3]))
def test_margins_are_those_of_blocks_by_hand(loops: JointLoops, joint: int) -> None:
    """Gain and phase margin by python-control, peak of S by its frequency response."""
    pose = np.array([0.0, 40.0, -60.0, 25.0, 50.0, -10.0])
    loop = by_hand(loops, pose, SOUND, joint)
    omega = np.geomspace(2.0, 0.99 * np.pi / loops.period, 8000)
    values = loop(np.exp(1j * omega * loops.period))
    every = control.stability_margins(control.frd(values, omega), returnall=True)
    gain, phase = min(g for g in every[0] if g > 1.0), min(abs(p) for p in every[1])
    found = margins(loops.at(pose, joint, SOUND).loop("drives.phase"))
    assert found.stable and found.gain == pytest.approx(gain, rel=2e-3)
    assert found.phase == pytest.approx(phase, abs=0.1)
    size = np.abs(1.0 / (1.0 + values)).max()
    arm = loops.responses(pose[None])
    peak = loops.peaks(loops.alone(arm, SOUND, joint), joint, SOUND[:, joint - 1])[0][0]
    assert found.sensitivity == pytest.approx(size, rel=1e-3)
    assert peak == pytest.approx(size, rel=2e-3)


@pytest.mark.more
def test_no_pose_of_many_is_worse_than_the_worst(loops: JointLoops) -> None:
    """800 random poses: none is above what the search says, and few are near."""
    arm = loops.responses(spread(ends(), 170))
    told, _, _ = ArmSearch(loops, LIMITS, True).worst(arm, SOUND, ends())
    own = ArmSearch(loops, LIMITS, True).limits.over(loops.all_peaks(told, SOUND)).max(axis=0)
    drawn = np.random.default_rng(7).uniform(*ends(), size=(800, 6))
    dense = LIMITS.over(loops.all_peaks(loops.responses(drawn), SOUND))
    print("worst told", own.round(4), "of 800", dense.max(axis=0).round(4))
    assert (dense.max(axis=0) <= 1.003 * own).all()
    assert (dense[:, 0] > 0.98 * own[0]).mean() < 0.2


def test_a_climb_ends_at_a_top() -> None:
    """A height of one top within the ends, and one beyond them."""
    inside, beyond = np.array([0, 30, -20, 50, 10, -70.0]), np.array([0, 200, 0, 0, 0, 0.0])
    for top in (inside, beyond):
        pose, best = climbed(np.zeros(6), lambda q, t=top: -((q - t) ** 2).sum(axis=1), ends())
        assert np.abs(pose - np.clip(top, *ends())).max() < 6.0
        assert best == pytest.approx(-((pose - top) ** 2).sum())


@pytest.mark.long
def test_spoilt_gains_are_not_kept(loops: JointLoops) -> None:
    """Sound ones keep the limits in all poses; the machine's own, and too quick ones, do not."""
    search = ArmSearch(loops, LIMITS, True)
    arm = loops.responses(spread(ends(), 20))
    assert verdict(search, arm, SOUND, ends())[0].kept
    ringing = verdict(search, arm, loops.present, ends())[0]
    assert not ringing.kept and ringing.unstable == 0
    assert ringing.joints[0].swing > 8.0
    wild = SOUND.copy()
    wild[1, 1] *= 8.0
    broken = verdict(search, arm, wild, ends())[0]
    assert not broken.kept and broken.unstable >= len(arm.poses)


@pytest.fixture(scope="module")
def tuned(tmp_path_factory: pytest.TempPathFactory) -> ArmTuned:
    """The machine tuned on a quick path: 600 mm/s about corners."""
    folder = tmp_path_factory.mktemp("quick")
    example = machine("robot6").file.parent / "example.job"
    text = example.read_text(encoding="utf-8").replace("V=100.0", "V=600.0")
    text = text.replace("VJ=20.00 V=200.0", "VJ=80.00 V=1000.0").replace("V=50.0", "V=300.0")
    (folder / "quick.job").write_text(text, encoding="utf-8")
    points = example.with_suffix(".points").read_text(encoding="utf-8")
    (folder / "quick.points").write_text(points, encoding="utf-8")
    return tune_arm(machine("robot6").scenario(folder / "quick.job"), {"poses": 40})


@pytest.mark.long
def test_gains_found(tuned: ArmTuned, tmp_path: Path) -> None:
    """Limits kept where they were not, joints less behind with less torque, a file."""
    assert tuned.after.kept and not tuned.before.kept
    assert np.ptp(tuned.found.gains[0]) == 0.0
    assert tuned.slowest == 1 and 10.0 < tuned.found.gains[0, 0] < 30.0
    before, after = tuned.runs
    print(f"RMS {before.rms:.3f} -> {after.rms:.3f} mm, torque {before.torque} -> {after.torque}")
    assert after.lag.max() < 0.7 * before.lag.max() and after.rms < 0.25
    assert after.torque.max() < 0.5 and before.torque.max() == 1.0 and not after.alarm
    assert tomllib.loads(tuned.toml()) == tuned.settings
    json.dumps(tuned.numbers(), allow_nan=False)
    file = tmp_path / "gains.toml"
    file.write_text(tuned.toml(), encoding="utf-8")
    again = motionfmu.load("robot_line").run(set=tomllib.loads(file.read_text()), stop=1.0)
    assert again.parameter("drives.position_gain")[0] == tuned.found.gains[0, 0]


def test_what_is_refused() -> None:
    """One message names what has no meaning for an arm, or that there is none."""
    arm = machine("robot6").plan()
    with pytest.raises(InputError, match=r"cost, limits\.margins\.phase: not for the drives"):
        tune_arm(arm, {"cost": "itae", "limits": {"margins": {"phase": 30.0}}})
    with pytest.raises(InputError, match="no arm: robot_arm"):
        tune_arm(motionfmu.load("circle"))


def test_the_stiffest_loop_is_found_between_the_first_samples() -> None:
    """The integral time that a velocity loop bears as a parabola whose lowest point is known."""
    best = 1.2345

    class Known(arm_search._OneJoint):
        def __init__(self) -> None:
            self.k, self.gains = 0, np.ones((3, 1))
            self.low, self.high = np.zeros(3), np.full(3, 5.0)

        def _time(self, position: float, velocity: float) -> float:
            return velocity + (velocity - best) ** 2

    joint = Known()
    joint.stiffest()
    found = np.log(joint.gains[:, 0])
    step = 5.0 / (arm_search.FINE - 1)
    assert abs(found[1] - best) <= step / (arm_search.FINE - 1) and found[0] == 0.0
    assert found[2] == pytest.approx(found[1] + (found[1] - best) ** 2)
