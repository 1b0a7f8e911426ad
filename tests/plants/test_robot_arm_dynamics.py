"""The arm's equations against pinocchio, closed forms, and the published terms of the Puma 560."""

import numpy as np
import pytest
from robot_arm import EXACT, Arm, Pinocchio

SEED = 7
RNG = np.random.default_rng(SEED)
TILTED = {"payload_center": [0.05, -0.03, 0.12], "b": 0.035, "gravity": 9.7}


# Links that lie askew: products of up to 0.3 of the least moment of inertia.
SHARES = np.random.default_rng(8).uniform(-0.3, 0.3, (6, 3))
ASKEW = {"product": SHARES * Arm().parameter("inertia").min(axis=1)[:, None]}


@pytest.fixture(autouse=True)
def same_draws() -> None:
    """Each test draws the same, whatever ran before it."""
    RNG.bit_generator.state = np.random.default_rng(SEED).bit_generator.state


@pytest.mark.parametrize(
    "changed",
    [{}, TILTED, TILTED | ASKEW],
    ids=["as declared", "payload beside the flange", "whole tensors"],
)
def test_dynamics_are_those_of_pinocchio(changed):
    """Forward and inverse, 500 random states each: 1e-12 of the largest."""
    a = Arm(**changed)
    oracle = Pinocchio(a)
    sizes, forward, inverse = [], 0.0, 0.0
    for _ in range(500):
        q, v = RNG.uniform(-3, 3, 6), RNG.uniform(-3, 3, 6)
        motor = (q + RNG.uniform(-3e-3, 3e-3, 6)) * a.parameter("gear_ratio")
        x = a.state(link_angle=q, link_speed=v, rotor_angle=motor, rotor_speed=v * 100)
        acceleration = a.rates(x, np.zeros(9))[a.places("link.speed")]
        torque = a.outputs(x, np.zeros(9))["gear_torque"] - a.parameter("link_viscous") * v
        exact = oracle.forward(q, v, torque)
        forward = max(forward, np.abs(acceleration - exact).max() / np.abs(exact).max())
        wanted = oracle.inverse(q, v, acceleration)
        inverse = max(inverse, np.abs(torque - wanted).max() / np.abs(wanted).max())
        sizes.append(np.abs(exact).max())
    print(f"forward {forward:.1e}, inverse {inverse:.1e}")
    assert max(forward, inverse) < 1e-12
    assert np.median(sizes) > 10.0


PUMA_MOTORS = np.array([200e-6, 200e-6, 200e-6, 33e-6, 33e-6, 33e-6])
PUMA_GEARS = np.array([62.6111, 107.815, 53.7063, 76.0364, 71.923, 76.686])
# d, a, twist, mass, centre, moments of inertia: Corke and Armstrong-Helouvry, ICRA 1994
PUMA = [
    (0.672, 0, 90, 0, [0, 0, 0], [0, 0.35, 0]),
    (0, 0.4318, 0, 17.4, [-0.3638, 0.006, 0.2275], [0.13, 0.524, 0.539]),
    (0.15005, 0.0203, -90, 4.8, [-0.0203, -0.0141, 0.070], [0.066, 0.086, 0.0125]),
    (0.4318, 0, 90, 0.82, [0, 0.019, 0], [1.8e-3, 1.3e-3, 1.8e-3]),
    (0, 0, -90, 0.34, [0, 0, 0], [0.3e-3, 0.4e-3, 0.3e-3]),
    (0, 0, 0, 0.09, [0, 0, 0.032], [0.15e-3, 0.15e-3, 0.04e-3]),
]


def chain(joints):
    """Frames of the Puma by Denavit and Hartenberg."""
    frame, found = np.eye(4), []
    for (d, along, twist, *_), t in zip(PUMA, joints, strict=True):
        c, s, ca, sa = np.cos(t), np.sin(t), np.cos(np.radians(twist)), np.sin(np.radians(twist))
        step = [[c, -s * ca, s * sa, along * c], [s, c * ca, -c * sa, along * s],
                [0, sa, ca, d], [0, 0, 0, 1]]  # fmt: skip
        frame = frame @ np.array(step)
        found.append(frame)
    return found


def puma():
    """The class as a Puma 560; its links' frames are parallel to the base with the arm up."""
    up, signs = np.array([0, np.pi / 2, -np.pi / 2, 0, 0, 0]), np.array([1, -1, -1, 1, -1, 1])
    joints = np.cumsum([[0, 0, 0.672], [0, -0.15005, 0], [0, 0, 0.4318], [0.0203, 0, 0],
                        [0, 0, 0.4318], [0, 0, 0]], axis=0)  # fmt: skip
    centers, moments = [], []
    for frame, joint, (*_, r, i) in zip(chain(up), joints, PUMA, strict=True):
        centers.append(frame[:3, :3] @ r + frame[:3, 3] - joint)
        tensor = frame[:3, :3] @ np.diag(i) @ frame[:3, :3].T
        assert tensor == pytest.approx(np.diag(np.diag(tensor)), abs=1e-15), "turned by quarters"
        moments.append(np.diag(tensor))
    return Arm(
        **EXACT, a1=0, a2=0.0203, b=-0.15005, c1=0.672, c2=0.4318, c3=0.4318, c4=0,
        joint_sign=signs, joint_offset=np.degrees(signs * up), mass=[m for *_, m, _, _ in PUMA],
        center=centers, inertia=moments, payload_mass=0, payload_center=0, payload_inertia=0,
        link_viscous=0, gear_ratio=PUMA_GEARS, motor_inertia=PUMA_MOTORS,
    )  # fmt: skip


def test_puma_560():
    """Gravity and inertia terms at (0, 45, 180, 0, 45, 0) deg, as Corke and Armstrong publish them.

    The inertia of the motors, which is part of the published terms, is taken from how they
    accelerate under their own torque with the gears slack.
    """
    a = puma()
    signs, gears = a.parameter("joint_sign"), a.parameter("gear_ratio")
    q = np.array([0, np.pi / 4, np.pi, 0, np.pi / 4, 0])
    inner = signs * q - np.radians(a.parameter("joint_offset"))
    x = a.state(link_angle=inner, rotor_angle=inner * gears)
    still = a.rates(x, np.zeros(9))
    links, motors = [], []
    for k in range(6):  # a little wind-up of one gear: its torque alone; one motor's current alone
        moved, driven = x.copy(), x.copy()
        moved[a.places("rotor.angle")[k]] += 1e-3 * gears[k]
        torque = a.outputs(moved, np.zeros(9))["gear_torque"][k] * signs[k]
        links.append((a.rates(moved, np.zeros(9)) - still)[a.places("link.speed")] / torque)
        driven[a.states.index(f"current_loop[{k + 1}].state")] = 1.0
        motors.append((a.rates(driven, np.zeros(9)) - still)[a.places("rotor.speed")[k]])
    inertia = np.linalg.inv(np.array(links).T)
    gravity = -signs * (inertia @ still[a.places("link.speed")])
    inertia = inertia * np.outer(signs, signs) + np.diag(gears**2 / np.array(motors))
    print(np.round(gravity, 4), np.round(inertia, 4), sep="\n")
    assert gravity == pytest.approx([0, 31.6399, 6.0351, 0, 0.0283, 0], abs=6e-5)
    found = inertia[[0, 0, 0, 1, 1, 2, 3, 4, 5], [0, 1, 2, 1, 2, 2, 3, 4, 5]]
    wanted = [3.6594, -0.4044, 0.1006, 4.4137, 0.3509, 0.9378, 0.1925, 0.1713, 0.1941]
    assert found == pytest.approx(wanted, abs=6e-5)
