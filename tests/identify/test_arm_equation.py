"""The equation of an arm's joints: pinocchio's regressor, the FMU's equation, base parameters."""

import numpy as np
import pinocchio
import pytest
from arm_truth import plant_of
from robot_arm import EXACT, Arm, Pinocchio
from scipy.linalg import qr

from motionfmu.identify.arm_dynamics.joint_equation import base_of
from motionfmu.identify.arm_dynamics.link_regressor import regressor
from motionfmu.identify.arm_dynamics.possible_links import believed
from motionfmu.identify.arm_dynamics.zero_phase import fastest, low_pass

SEED = 3
RNG = np.random.default_rng(SEED)
KUKA = {"a1": 0.025, "a2": -0.035, "c1": 0.4, "c2": 0.315, "c3": 0.365, "c4": 0.08,
        "joint_sign": [-1, 1, 1, -1, 1, -1], "joint_offset": [0, -90, 0, 0, 0, 0]}  # fmt: skip
TILTED = {"payload_center": [0.05, -0.03, 0.12], "b": 0.035, "gravity": 9.7}


@pytest.fixture(autouse=True)
def same_draws() -> None:
    """Each test draws the same, whatever ran before it."""
    RNG.bit_generator.state = np.random.default_rng(SEED).bit_generator.state


def states(n):
    return tuple(RNG.uniform(-3.0, 3.0, (3, n, 6)))


@pytest.mark.parametrize("values", [{}, KUKA, TILTED], ids=["default", "KUKA", "tilted"])
def test_regressor_is_that_of_pinocchio(values):
    plant, motion = plant_of(**values), states(200)
    own = regressor(plant.axes, plant.origins, plant.gravity, motion)
    oracle = Pinocchio(Arm(**values))
    worst = 0.0
    for k, (q, v, a) in enumerate(zip(*motion, strict=True)):
        other = pinocchio.computeJointTorqueRegressor(oracle.model, oracle.data, q, v, a)
        worst = max(worst, np.abs(other - own[k]).max() / np.abs(other).max())
    print(f"worst {worst:.1e}")
    assert worst < 1e-13


ASKEW = {"product": [0.03, -0.05, 0.02] * 3 + [0.002, 0.001, -0.003] * 3}


@pytest.mark.parametrize(
    "values", [{}, TILTED, TILTED | ASKEW], ids=["default", "tilted", "whole tensors"]
)
def test_torques_are_those_of_the_arm(values):
    """Standard parameters of the plant, load included, make the torques of the FMU's equation."""
    plant, a = plant_of(**values), Arm(**values)
    q, v, _ = states(200)
    torque, acceleration = np.zeros_like(q), np.zeros_like(q)
    for k in range(len(q)):
        motor = (q[k] + RNG.uniform(-3e-3, 3e-3, 6)) * a.parameter("gear_ratio")
        x = a.state(link_angle=q[k], link_speed=v[k], rotor_angle=motor, rotor_speed=v[k] * 100)
        acceleration[k] = a.rates(x, np.zeros(9))[a.places("link.speed")]
        torque[k] = a.outputs(x, np.zeros(9))["gear_torque"]
    torque -= a.parameter("link_viscous") * v
    columns = regressor(plant.axes, plant.origins, plant.gravity, (q, v, acceleration))
    own = columns @ believed(plant).standard(plant)[:60]
    assert np.abs(own - torque).max() < 1e-10 * np.abs(torque).max()


@pytest.mark.parametrize("values", [{}, EXACT, KUKA | EXACT], ids=["default", "exact", "KUKA"])
def test_base_parameters_are_all_that_torques_tell(values):
    """40 of an arm with a spherical wrist (Khalil and Dombre): 36 of links, four motors alone."""
    plant, motion = plant_of(**_flat(values)), states(300)
    base = base_of(plant)
    links = regressor(plant.axes, plant.origins, plant.gravity, motion)
    motors = np.eye(6)[None] * motion[2][:, None, :]
    whole = np.concatenate([links, motors], axis=2).reshape(-1, 66)
    diagonal = np.abs(np.diag(qr(whole, mode="r", pivoting=True)[0]))
    assert len(base.kept) == int((diagonal > 1e-9 * diagonal[0]).sum()) == 40
    assert sum(k < 60 for k in base.kept) == 36
    values = RNG.uniform(-1.0, 1.0, 66)
    assert np.abs(whole @ values - whole[:, base.kept] @ (base.combine @ values)).max() < 1e-10
    assert set(base.none) >= {"m1", "mx1", "my1", "mz1", "Ixx1", "Iyy1"}


def _flat(values):
    sizes = {"origin_error": 18}
    return {k: [v] * sizes.get(k, 6) if v == 0.0 else v for k, v in values.items()}


def test_a_base_parameter_says_what_it_is():
    base = base_of(plant_of(**_flat(EXACT)))
    names = {base.names[k]: base.text(n) for n, k in enumerate(base.kept)}
    assert names["mz2"] == "mz2 + 0.7 m3 + 0.7 m4 + 0.7 m5 + 0.7 m6"
    assert names["Iyy5"].startswith("Iyy5 + 0.007225 m6 + 0.17 mz6 + Iyy6")
    assert names["J6"] == "J6"


@pytest.mark.parametrize("rate", [100.0, 1000.0])
def test_low_pass_and_derivatives_have_no_delay(rate):
    t = np.arange(0.0, 20.0, 1.0 / rate)
    w, corner = 2.0 * np.pi * 1.7, 10.0
    x = np.sin(w * t + 0.3)[:, None]
    middle = slice(len(t) // 10, -len(t) // 10)
    exact = (x, w * np.cos(w * t + 0.3)[:, None], -(w**2) * x)
    for k, wanted in enumerate(exact):
        found = low_pass(x, rate, corner, k)
        assert np.abs(found - wanted)[middle].max() < 1e-4 * w**k
    gain = low_pass(np.sin(2.0 * np.pi * corner * t)[:, None], rate, corner)[middle]
    assert np.sqrt(2.0) * gain.std() == pytest.approx(0.5, rel=0.01)
    assert fastest(x, rate) == pytest.approx(1.7, abs=0.2)
