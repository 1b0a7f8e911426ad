"""Linear models of a robot's joints, which one plant couples: modes, statics, loops, the FMUs."""

import importlib.util
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest
import scipy.linalg
from few_cases import few
from robot_arm import EXACT, Arm, Pinocchio

from motionfmu.analysis import freq, linear
from motionfmu.analysis.freq.shape import small
from motionfmu.analysis.linear.loops import feedbacks
from motionfmu.analysis.linear.stability import margins, response
from motionfmu.analysis.linear.tuning_parts import linearised
from motionfmu.base.errors import InputError

LINE = Path(__file__).resolve().parents[2] / "scenarios" / "robot_line"
POSE = [0.2, 0.5, -0.3, 0.4, 0.7, -0.2]
PLAIN = {f"arm.{n}": v for n, v in EXACT.items()} | {"arm.start_joint": np.degrees(POSE).tolist()}
AXES = range(1, 7)


def script() -> ModuleType:
    """The script beside the scenario."""
    spec = importlib.util.spec_from_file_location("gains", LINE / "gains.py")
    assert spec and spec.loader
    found = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(found)
    return found


GAINS = script()
EASY = GAINS.rule(*GAINS.RULES["Yaskawa, upper"], GAINS.inertia("line"))


def joints(values: dict[str, Any], name: str, own: int) -> np.ndarray:
    """Values of all joints; the own one has the name of the array."""
    return np.array([values[name if k == own else f"{name}[{k}]"] for k in AXES])


def test_modes_with_the_motors_locked() -> None:
    """Eigenvalues of the links against the gears' stiffness and pinocchio's mass matrix."""
    free = {"arm.gravity": 0.0, "arm.gear_damping": 0.0, "arm.link_viscous": 0.0}
    axis = linear.model(LINE, 2, set=PLAIN | free)
    parts, p = linearised(axis, "arm")
    a = parts.matrices(axis.points["arm"].x, axis.points["arm"].u, p)[0]
    links = [k for k, s in enumerate(parts.ode.states) if s.name.startswith("link")]
    roots = np.linalg.eigvals(a[np.ix_(links, links)])
    arm = Arm(**EXACT)
    inner = arm.parameter("joint_sign") * POSE - np.radians(arm.parameter("joint_offset"))
    stiffness = np.diag(arm.parameter("stiffness_1"))
    squares = scipy.linalg.eigh(stiffness, Pinocchio(arm).inertia(inner), eigvals_only=True)
    found = np.sort(roots.imag[roots.imag > 0.0])
    print("modes [Hz]", (found / 2.0 / np.pi).round(3))
    assert found == pytest.approx(np.sqrt(squares), rel=1e-5)


def test_the_drives_hold_the_arm_where_it_starts() -> None:
    """Torques at the point are gravity's, and those of a force by virtual work; motors stand."""
    arm = Arm(**EXACT)
    ratio = arm.parameter("gear_ratio")
    still = linear.model(LINE, 3, set=PLAIN | {"arm.paper_height": -10.0})
    pushed = still.points["arm"].values
    q = joints(pushed, "link_angle", 3) * arm.parameter("joint_sign") - np.radians(
        arm.parameter("joint_offset")
    )
    assert joints(pushed, "torque", 3) * ratio == pytest.approx(
        Pinocchio(arm).gravity(q), rel=1e-6, abs=1e-6
    )
    assert joints(pushed, "motor_angle", 3) == pytest.approx(np.multiply(POSE, ratio), abs=1e-9)
    down = linear.model(
        LINE, 3, {"arm.force[3]": -1.0}, PLAIN | {"arm.paper_height": -10.0}
    ).points["arm"]
    moved = joints(down.values, "torque", 3) - joints(pushed, "torque", 3)
    parts, p = linearised(still, "arm")
    point = still.points["arm"]
    c = parts.matrices(point.x, point.u, p)[2]
    names = [s.name for s in parts.ode.states]
    height = [y.name for y in parts.ode.outputs].index("tool_position[3]")
    lever = np.array([c[height, names.index(f"link[{k}].angle")] for k in AXES])
    assert np.abs(lever).max() > 0.5
    assert moved * ratio == pytest.approx(lever, abs=5e-3)


@pytest.mark.parametrize("pose", few(["line", "folded"], 1))
def test_each_loop_has_the_others_closed(pose: str) -> None:
    """Peaks of S against the inverse of 1 + C P of all six, with the drives' formulas by hand."""
    wanted = GAINS.Pose(pose).peaks(EASY)[0]
    for k in (1, 2, 5):
        axis = GAINS.at(pose, EASY, k)
        assert feedbacks(axis) == {"drives.phase": ()}
        assert margins(axis.loop("drives.phase")).sensitivity == pytest.approx(
            wanted[k - 1], rel=2e-3
        )


@pytest.mark.parametrize(("pose", "axis"), [("line", 1), ("folded", 2), ("line", 5)])
def test_the_running_fmus_have_the_response(pose: str, axis: int) -> None:
    """Measured with all six loops closed; where |L| is large only 1/(1 + L) is seen."""
    model = GAINS.at(pose, EASY, axis)
    n, lines = 1000, np.array([1, 2, 3, 4, 6, 9, 14, 20, 30, 45, 70])  # 10 to 700 Hz
    signal = small(model, ("drives.phase", ()), (n, lines), 4.0)
    signal = replace(signal, settle=8, measure=2)
    setup = freq.Setup(model, ("drives.phase",), ("drives.torque",))
    found = freq.measured_loop(setup, signal)
    loop = response(model.loop("drives.phase"), found.omega)
    ratio = (found.values[:, 0] / loop)[(np.abs(loop) > 0.1) & (np.abs(loop) < 10.0)]
    size, angle = np.abs(np.abs(ratio) - 1.0).max(), np.degrees(np.abs(np.angle(ratio))).max()
    print(f"{pose}, joint {axis}: {len(ratio)} lines, {size:.2%}, {angle:.2f} deg")
    assert len(ratio) >= 5
    assert size < 0.003 and angle < 0.3


def test_a_run_begins_in_balance() -> None:
    """What holds the arm is on the wires: the drives have nothing to do, whatever their gains."""
    model = GAINS.at("line", EASY, 2)
    held = model.points["arm"].values["torque"]
    bench = freq.Bench(freq.setup(model, "drives.phase", ["drives.torque", "drives.torque[3]"]))
    shown, _ = bench.run(np.zeros((200, 1)))
    print(f"the arm takes {held:.3f} N.m, the drives have {np.abs(shown).max():.4f}")
    assert abs(held) > 3.0
    assert np.abs(shown).max() < 0.02 * abs(held)


def test_published_gains_ring_and_lower_ones_do_not() -> None:
    """What the README's table says of the pose of the line: the links' peak over their command."""
    line = GAINS.Pose("line")
    fast = GAINS.rule(*GAINS.RULES["MINAS A4"], GAINS.inertia("line"))
    assert 5.0 < line.peaks(fast)[1].max() < 10.0
    assert 1.2 < line.peaks(EASY)[1].max() < 1.7


@pytest.mark.parametrize(
    ("at", "axis", "told"),
    [
        ({"arm.link_angle[2]": 0.5}, 1, "hold it where it starts"),
        ({"arm.torque[2]": 0.5}, 1, "hold it where it starts"),
        ({"arm.force": 0.5}, 1, "has no such input or output"),
        ({}, 7, "axis = 7: "),
    ],
)
def test_what_is_refused(at: dict[str, float], axis: int, told: str) -> None:
    """One message that names what is wrong."""
    with pytest.raises(InputError, match=told):
        linear.model(LINE, axis, at)
