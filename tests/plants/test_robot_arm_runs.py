"""The arm in motion: energy, sag, vibrations, an elastic joint; poses by py-opw-kinematics."""

import numpy as np
import py_opw_kinematics as opw
import pytest
import scipy.linalg
import scipy.optimize
from robot_arm import EXACT, Arm, Pinocchio

FREE = EXACT | {"motor_coulomb": 0, "motor_static": 0, "motor_viscous": 0, "link_viscous": 0,
                "current_time": 0}  # fmt: skip
LOCKED = {"motor_inertia": 1e9}
POSE = np.array([0.2, 0.5, -0.3, 0.4, 0.7, -0.2])
H = 50e-6


def inner(a, joints):
    """Angles of the class from those of the maker."""
    return a.parameter("joint_sign") * joints - np.radians(a.parameter("joint_offset"))


def turns(quaternion):
    """Rotation matrix of w, x, y, z."""
    w, x, y, z = quaternion
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + 2 * w * cross + 2 * cross @ cross


KUKA = {"a1": 0.025, "a2": -0.035, "b": 0.0, "c1": 0.4, "c2": 0.315, "c3": 0.365, "c4": 0.08,
        "joint_sign": [-1, 1, 1, -1, 1, -1],
        "joint_offset": [0, -90, 0, 0, 0, 0]}  # fmt: skip


@pytest.mark.parametrize("changed", [{}, {"b": 0.035}, KUKA], ids=["default", "lateral", "KUKA"])
def test_poses_are_those_of_the_other_library(changed):
    """Tip and orientation at 300 random joints: 1e-12."""
    a = Arm(**EXACT, **changed, tool_length=0.0)
    lengths = {n: float(a.parameter(n)) for n in ("a1", "a2", "b", "c1", "c2", "c3", "c4")}
    flips = tuple(bool(s < 0) for s in a.parameter("joint_sign"))
    model = opw.KinematicModel(**lengths, offsets=tuple(np.radians(a.parameter("joint_offset"))),
                               flip_axes=flips)  # fmt: skip
    robot = opw.Robot(model, degrees=False)
    rng, worst = np.random.default_rng(2), 0.0
    for _ in range(300):
        joints = rng.uniform(-3, 3, 6)
        y = a.outputs(a.state(link_angle=inner(a, joints)), np.zeros(9))
        assert y["link_angle"] == pytest.approx(joints, abs=1e-14)
        pose = robot.forward(joints)
        difference = turns(y["tool_quaternion"]) - pose.rotation.as_matrix()
        place = y["tool_position"] - np.array(pose.translation)
        worst = max(worst, np.abs(difference).max(), np.abs(place).max())
    print(f"worst {worst:.1e}")
    assert worst < 1e-12


def spring_energy(a, windup):
    """What a gear's spring holds."""
    w = np.maximum(np.abs(windup) - a.parameter("lost_motion") / 2, 0.0)
    k1, k2, k3 = (a.parameter(f"stiffness_{n}") for n in (1, 2, 3))
    t1, t2 = (a.parameter(f"knee_{n}") for n in (1, 2))
    bend1, bend2 = t1 / k1, t1 / k1 + (t2 - t1) / k2
    beyond = [np.maximum(w - b, 0.0) ** 2 for b in (bend1, bend2)]
    return 0.5 * (k1 * w**2 + (k2 - k1) * beyond[0] + (k3 - k2) * beyond[1])


def test_energy_balance_along_a_run():
    """Kinetic, potential and spring energy less work and losses: 1e-6 of the work."""
    a = Arm(start_joint=np.degrees(POSE), paper_height=float("-inf"))
    oracle, gears = Pinocchio(a), a.parameter("gear_ratio")
    u = np.array([1.0, -1.5, -0.8, 0.3, 0.2, -0.1, 30.0, -20.0, 40.0])
    steps = 8000
    x = np.array(a.stepped(H, steps)(a.start, np.tile(u, (steps, 1)).T).full()).T
    x = np.vstack([a.start, x])
    q, v = x[:, a.places("link.angle")], x[:, a.places("link.speed")]
    m, w = x[:, a.places("rotor.angle")], x[:, a.places("rotor.speed")]
    current = x[:, [a.states.index(f"current_loop[{k}].state") for k in range(1, 7)]]
    e1, e2, p1, p2 = (a.parameter(f"transmission_{n}")
                      for n in ("error_1", "error_2", "phase_1", "phase_2"))  # fmt: skip
    error = e1 * np.sin(m + p1) + e2 * np.sin(2 * m + p2)
    slope = e1 * np.cos(m + p1) + 2 * e2 * np.cos(2 * m + p2)
    windup = m / gears + a.parameter("zero_error") + error - q
    rate = (1 / gears + slope) * w - v
    coulomb, static, stribeck, viscous, slow = (
        a.parameter(f"motor_{n}")
        for n in ("coulomb", "static", "stribeck_speed", "viscous", "rest_speed")
    )
    rubbing = w / np.hypot(w, slow) * (coulomb + (static - coulomb) / (1 + (w / stribeck) ** 2))
    lost = ((rubbing + viscous * w) * w + a.parameter("gear_damping") * rate**2
            + a.parameter("link_viscous") * v**2).sum(axis=1)  # fmt: skip
    work = (current * w).sum(axis=1)
    tip = [a.outputs(x[k], u)["tool_position"] for k in (0, -1)]
    ends = [
        oracle.energy(q[k], v[k]) + 0.5 * (a.parameter("motor_inertia") * w[k] ** 2).sum()
        + spring_energy(a, windup[k]).sum() for k in (0, -1)
    ]  # fmt: skip
    done = scipy.integrate.simpson(work, dx=H) + u[6:] @ (tip[1] - tip[0])
    size = scipy.integrate.simpson(np.abs(work), dx=H)
    gone = scipy.integrate.simpson(lost, dx=H)
    rest = ends[1] - ends[0] - done + gone
    print(f"work {size:.3g} J, lost {gone:.3g} J, rest {rest:.1e} J")
    assert abs(rest) < 1e-6 * size
    assert size > 50 and gone > 1


def test_sag_under_gravity():
    """Motors locked, the links settle where pinocchio's torque winds the springs up."""
    damping = 4 * Arm().parameter("gear_damping")
    a = Arm(**EXACT, **LOCKED, start_joint=np.degrees(POSE), gear_damping=damping)
    oracle, q0 = Pinocchio(a), inner(a, POSE)
    x = a.state(link_angle=q0, rotor_angle=q0 * a.parameter("gear_ratio"))
    last = a.stepped(H, 30000)(x, np.zeros((9, 30000)))[:, -1]
    sag = q0 - np.array(last.full()).ravel()[a.places("link.angle")]
    torque = oracle.gravity(q0 - sag)
    k1, k2, t1, t2 = (a.parameter(n) for n in ("stiffness_1", "stiffness_2", "knee_1", "knee_2"))
    assert (np.abs(torque) < t2).all() and (np.abs(torque[[1, 2]]) > t1[[1, 2]]).any()
    size = np.abs(torque)
    wanted = np.sign(torque) * (np.minimum(size, t1) / k1 + np.maximum(size - t1, 0) / k2)
    print("sag", sag, "T/K", wanted)
    moved = np.abs(torque) > 0.1
    assert sag[moved] == pytest.approx(wanted[moved], rel=1e-4)
    assert moved.sum() >= 4
    # the start of the FMU is there already
    hung = q0 - a.start[a.places("link.angle")]
    assert hung[moved] == pytest.approx(wanted[moved], rel=1e-2)


def test_free_vibrations_have_the_frequencies_of_the_eigenvalues():
    """Each mode alone, motors locked and no gravity, against K and pinocchio's mass matrix."""
    a = Arm(**FREE, **LOCKED, gravity=0, gear_damping=0, start_joint=np.degrees(POSE))
    q0 = inner(a, POSE)
    squares, modes = scipy.linalg.eigh(
        np.diag(a.parameter("stiffness_1")), Pinocchio(a).inertia(q0)
    )
    run = a.stepped(H, 8000)
    for square, mode in zip(squares, modes.T, strict=True):
        x = a.state(link_angle=q0 + 1e-5 * mode / np.abs(mode).max(),
                    rotor_angle=q0 * a.parameter("gear_ratio"))  # fmt: skip
        path = np.array(run(x, np.zeros((9, 8000))).full())[a.places("link.angle")].T - q0
        along = path @ np.linalg.solve(modes, np.eye(6))[np.argmin(np.abs(squares - square))]
        rising = np.flatnonzero((along[:-1] < 0) & (along[1:] >= 0))
        found = (len(rising) - 1) / (rising[-1] - rising[0]) / H
        print(f"{np.sqrt(square) / 2 / np.pi:.3f} Hz, found {found:.3f}")
        assert found == pytest.approx(np.sqrt(square) / (2 * np.pi), rel=1e-2)


def test_one_elastic_joint_against_the_closed_form():
    """Step of torque on joint 1, the others in line: two masses, a spring and a damper."""
    joints = np.array([0.3, 0, 0, 0, 0, 0])
    a = Arm(**FREE, gravity=0, start_joint=np.degrees(joints))
    torque, n = 0.5, a.parameter("gear_ratio")[0]
    k, d = a.parameter("stiffness_1")[0], a.parameter("gear_damping")[0]
    motor, load = (
        n**2 * a.parameter("motor_inertia")[0],
        Pinocchio(a).inertia(inner(a, joints))[0, 0],
    )
    u = np.zeros((9, 4000))
    u[0] = torque
    x = np.array(a.stepped(H, 4000)(a.start, u).full())
    windup = x[a.places("rotor.angle")[0]] / n - x[a.places("link.angle")[0]]
    t = H * np.arange(1, 4001)
    both = 1 / motor + 1 / load
    omega, decay = np.sqrt(k * both), d * both / 2
    fast = np.sqrt(omega**2 - decay**2)
    shape = 1 - np.exp(-decay * t) * (np.cos(fast * t) + decay / fast * np.sin(fast * t))
    exact = torque * n / motor / omega**2 * shape
    print(f"{omega / 2 / np.pi:.2f} Hz, off by {np.abs(windup - exact).max() / exact.max():.1e}")
    assert np.abs(windup - exact).max() < 1e-2 * exact.max()
    assert exact.max() < a.parameter("knee_1")[0] / k
    angle = x[a.places("link.angle")[0], -1] - 0.3
    assert angle == pytest.approx(torque * n / (motor + load) * t[-1] ** 2 / 2, rel=1e-2)
