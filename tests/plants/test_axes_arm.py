"""The arm by its axes against pinocchio, and against the arm by its lengths where both are one."""

import re
import shutil
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio
import pytest
from few_cases import few
from robot_arm import EXACT, PACKAGE, Arm, ByAxes, OtherAxes, Pinocchio

SEED = 11
RNG = np.random.default_rng(SEED)
U = np.zeros(9)


@pytest.fixture(autouse=True)
def same_draws() -> None:
    """Each test draws the same, whatever ran before it."""
    RNG.bit_generator.state = np.random.default_rng(SEED).bit_generator.state


def random_arm(exact: bool = True, **more: Any) -> ByAxes:
    """Axes anywhere and of any length, whole tensors, a tool and a payload beside the flange."""
    second = RNG.uniform(0.01, 0.2, (6, 3))
    moments = second[:, [1, 2, 0]] + second[:, [2, 0, 1]]
    return ByAxes(
        **((EXACT if exact else {}) | more),
        axis_origin=RNG.uniform(-0.5, 0.5, (6, 3)),
        axis_direction=RNG.normal(size=(6, 3)) * RNG.uniform(0.1, 9.0, (6, 1)),
        mass=RNG.uniform(0.5, 9.0, 6),
        center=RNG.uniform(-0.2, 0.2, (6, 3)),
        inertia=moments,
        product=RNG.uniform(-0.005, 0.005, (6, 3)),
        payload_center=[0.05, -0.03, 0.12],
        tool_place=[0.02, 0.01, -0.03],
        tool_turn=[20.0, -40.0, 70.0],
    )


def ideal(a: ByAxes) -> np.ndarray:
    """Angles at the start behind gears that do not give way."""
    return np.array(a.start[a.places("rotor.angle")] / a.parameter("gear_ratio"))


@pytest.mark.more
def test_dynamics_are_those_of_pinocchio() -> None:
    """Forward and inverse, five random arms at 100 random states each: 1e-11 of the largest."""
    forward, inverse, sizes = 0.0, 0.0, []
    for _ in range(5):
        a = random_arm()
        oracle = Pinocchio(a)
        for _ in range(100):
            q, v = RNG.uniform(-3, 3, (2, 6))
            motor = (q + RNG.uniform(-3e-3, 3e-3, 6)) * a.parameter("gear_ratio")
            x = a.state(link_angle=q, link_speed=v, rotor_angle=motor, rotor_speed=v * 100)
            acceleration = a.rates(x, U)[a.places("link.speed")]
            torque = a.outputs(x, U)["gear_torque"] - a.parameter("link_viscous") * v
            exact = oracle.forward(q, v, torque)
            forward = max(forward, np.abs(acceleration - exact).max() / np.abs(exact).max())
            wanted = oracle.inverse(q, v, acceleration)
            inverse = max(inverse, np.abs(torque - wanted).max() / np.abs(wanted).max())
            sizes.append(np.abs(exact).max())
    print(f"forward {forward:.1e}, inverse {inverse:.1e}")
    assert max(forward, inverse) < 1e-11
    assert np.median(sizes) > 10.0


# Places that slide, and number of joints: a SCARA's, a gantry's with a wrist, some others.
FEWER = [([2], 4), ([0, 1, 2], 6), ([1, 4], 5), ([0], 1)]


@pytest.mark.parametrize(("slides", "count"), few(FEWER, 1))
def test_joints_that_slide_and_that_are_none(slides: list[int], count: int) -> None:
    """Dynamics, tip, and the start under gravity of random arms against pinocchio."""
    for _ in range(3):
        starts = [*RNG.uniform(-60, 60, count), *[0.0] * (6 - count)]
        kinds = [int(k in slides) for k in range(6)]
        a = random_arm(joints=count, joint_slides=kinds, start_joint=starts)
        oracle, here = Pinocchio(a), np.arange(count)
        for _ in range(30):
            q, v = np.zeros((2, 6))
            q[:count], v[:count] = RNG.uniform(-3, 3, (2, count))
            motor = (q + RNG.uniform(-3e-3, 3e-3, 6)) * a.parameter("gear_ratio")
            x = a.state(link_angle=q, link_speed=v, rotor_angle=motor, rotor_speed=v * 100)
            acceleration = a.rates(x, U)[a.places("link.speed")]
            torque = a.outputs(x, U)["gear_torque"] - a.parameter("link_viscous") * v
            exact = oracle.forward(q[here], v[here], torque[here])
            # Where weight and torque cancel, what is left is no measure of what was subtracted.
            size = max(np.abs(exact).max(), 9.81)
            assert acceleration[here] == pytest.approx(exact, abs=1e-10 * size)
            assert np.abs(acceleration[count:]).max(initial=0.0) < 1e-7
            pinocchio.forwardKinematics(oracle.model, oracle.data, q[here])
            frame = oracle.model.getFrameId("l6", pinocchio.BODY)
            pinocchio.updateFramePlacements(oracle.model, oracle.data)
            A, B, C = np.radians(a.parameter("tool_turn"))
            tool = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(A, B, C), a.parameter("tool_place"))
            along = np.array([0, 0, float(a.parameter("tool_length"))])
            there = oracle.data.oMf[frame] * tool * pinocchio.SE3(np.eye(3), along)
            y = a.outputs(x, U)
            assert y["tool_position"] == pytest.approx(there.translation, abs=1e-12)
            w, i, j, k = y["tool_quaternion"]
            turn = pinocchio.Quaternion(w, i, j, k).toRotationMatrix()
            assert turn == pytest.approx(there.rotation, abs=1e-12)
        angles = a.start[a.places("link.angle")]
        held = a.outputs(a.start, U)["gear_torque"][here]
        wanted = oracle.gravity(ideal(a)[here])
        assert held == pytest.approx(wanted, abs=1e-3 * max(1.0, np.abs(wanted).max()))
        assert (angles[count:] == 0.0).all()


def test_slides_start_at_millimetres() -> None:
    """The start of a joint that slides is told in mm, its motor by rad/m."""
    a = random_arm(joints=4, joint_slides=[0, 0, 1, 0, 0, 0], gravity=0.0, lost_motion=0.0,
                   start_joint=[10, 20, -30, 40, 0, 0])  # fmt: skip
    angles = a.start[a.places("link.angle")]
    exact = [*np.radians([10, 20]), -0.03, np.radians(40), 0, 0]
    assert angles == pytest.approx(exact, abs=1e-12)
    motors = a.start[a.places("rotor.angle")]
    assert motors == pytest.approx(exact * a.parameter("gear_ratio"), abs=1e-9)


@pytest.mark.more
def test_the_tool_is_where_pinocchio_has_it() -> None:
    """Tip and attitude, a tool that is turned on the flange: 1e-12."""
    for _ in range(5):
        a = random_arm()
        oracle = Pinocchio(a)
        A, B, C = np.radians(a.parameter("tool_turn"))
        tool = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(A, B, C), a.parameter("tool_place"))
        tip = tool * pinocchio.SE3(np.eye(3), np.array([0, 0, float(a.parameter("tool_length"))]))
        for q in RNG.uniform(-3, 3, (40, 6)):
            y = a.outputs(a.state(link_angle=q), U)
            pinocchio.forwardKinematics(oracle.model, oracle.data, q)
            there = oracle.data.oMi[6] * tip
            assert y["tool_position"] == pytest.approx(there.translation, abs=1e-12)
            w, x, y_, z = y["tool_quaternion"]
            turn = pinocchio.Quaternion(w, x, y_, z).toRotationMatrix()
            assert turn == pytest.approx(there.rotation, abs=1e-12)


def test_at_the_start_gears_hold_what_gravity_asks() -> None:
    """Links hang in their gears as behind ideal ones, whichever way their axes point: to 0.1 %."""
    for _ in range(10):
        a = random_arm(exact=False)
        torque = a.outputs(a.start, U)["gear_torque"]
        wanted = Pinocchio(a).gravity(ideal(a))
        assert torque == pytest.approx(wanted, abs=1e-3 * np.abs(wanted).max())
        assert np.abs(wanted).max() > 10.0


def test_as_declared_it_is_the_arm_by_its_lengths() -> None:
    """The same rates and outputs, errors and all, at 50 random states and at the start: 1e-10."""
    by_axes, by_lengths = ByAxes(), Arm()
    ahead = np.radians(by_lengths.parameter("joint_offset"))
    gears = by_lengths.parameter("gear_ratio")
    assert sorted(by_axes.states) == sorted(by_lengths.states)
    order = [by_lengths.states.index(name) for name in by_axes.states]
    states = []
    for _ in range(50):
        q, v = RNG.uniform(-3, 3, (2, 6))
        motor = (q + RNG.uniform(-3e-3, 3e-3, 6)) * gears
        x = by_axes.state(link_angle=q, link_speed=v, rotor_angle=motor, rotor_speed=v * 100)
        states.append(x)
    for x in [*states, by_axes.start]:
        inner = np.empty(len(x))
        inner[order] = x
        inner[by_lengths.places("link.angle")] -= ahead
        inner[by_lengths.places("rotor.angle")] -= ahead * gears
        rates = by_lengths.rates(inner, U)[order]
        assert by_axes.rates(x, U) == pytest.approx(rates, abs=1e-10 * np.abs(rates).max())
        found, wanted = by_axes.outputs(x, U), by_lengths.outputs(inner, U)
        assert found.keys() == wanted.keys()
        for name, value in wanted.items():
            if name == "tool_quaternion":  # of either sign
                value = value * np.sign(value @ found[name])
            size = max(1.0, float(np.abs(value).max()))
            assert found[name] == pytest.approx(value, abs=1e-10 * size), name


@pytest.mark.more
@pytest.mark.parametrize("axes", ["xyzzxy", "yxxzyx"])
def test_links_that_turn_about_any_axis_of_the_frame(axes: str, tmp_path: Path) -> None:
    """The class of the arm by its lengths, about other axes: as the arm by its axes."""
    package = shutil.copytree(PACKAGE, tmp_path / PACKAGE.name)
    file, rows = package / "SixAxisArm.mo", np.eye(3)[["xyz".index(n) for n in axes]]
    told = ", ".join("{" + ", ".join(f"{v:g}" for v in row) + "}" for row in rows)
    text, count = re.subn(r"final axis = {.*},\n", f"final axis = {{{told}}},\n", file.read_text())
    assert count == 1
    file.write_text(text)
    fields = "mass center inertia product payload_center tool_place tool_turn".split()
    drawn = random_arm()
    given = {n: drawn.parameter(n) for n in fields} | EXACT
    given |= {"origin_error": drawn.parameter("axis_origin")}
    lengths = dict.fromkeys("a1 a2 b c1 c2 c3 c4 joint_offset".split(), 0.0)
    by_axes = ByAxes(**given, axis_origin=0.0, axis_direction=rows, payload_inertia=0.02)
    other = OtherAxes(package, **given, **lengths, payload_inertia=0.02)
    for _ in range(50):
        q, v = RNG.uniform(-3, 3, (2, 6))
        u = np.append(RNG.uniform(-9, 9, 6), RNG.uniform(-50, 50, 3))
        joints = {"link_angle": q, "link_speed": v, "rotor_angle": 100 * q, "rotor_speed": 100 * v}
        for name in ("accelerations", "tool_position", "gear_torque"):
            found, wanted = (
                a.rates(a.state(**joints), u)[a.places("link.speed")]
                if name == "accelerations"
                else a.outputs(a.state(**joints), u)[name]
                for a in (other, by_axes)
            )
            assert np.abs(found - wanted).max() <= 1e-11 * np.abs(wanted).max(), name
