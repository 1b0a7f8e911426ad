"""Links that a linkage keeps level, against pinocchio's tree with pivots.

The tree has a pivot before such a link, that of joint 4 with the hand on it; a matrix says how all
its joints follow those of the arm, and the torques of the tree are brought to these by its
transpose.
"""

from typing import Any

import numpy as np
import pinocchio
import pytest
from robot_arm import EXACT, LevelLinks, axes_of, bodies_of, body, joint_line

pytestmark = pytest.mark.more  # to make the equations of an arm takes a while

SEED = 36
U = np.zeros(9)
STATES = 250  # of each of four
# Levels of joints 3 and 4, number of joints, axis 2 along axis 3 or against it: a palletizer,
# one whose forearm is driven from the base, others.
LEVELS = [((0, 2), 4, 1), ((1, 2), 4, -1), ((0, 1), 5, -1), ((1, 0), 6, 1)]


def level_arm(
    rng: np.random.Generator, levels: tuple[int, int], count: int, way: int
) -> LevelLinks:
    """Axes anywhere but for those of joints 2 and 3, whole tensors, a tool beside the flange."""
    axes = rng.normal(size=(6, 3)) * rng.uniform(0.1, 9.0, (6, 1))
    axes[2] = way * rng.uniform(0.1, 9.0) * axes[1]
    second = rng.uniform(0.01, 0.2, (6, 3))
    return LevelLinks(
        **EXACT,
        joints=count,
        joint_level=[0, 0, *levels, 0, 0],
        axis_origin=rng.uniform(-0.5, 0.5, (6, 3)),
        axis_direction=axes,
        mass=rng.uniform(0.5, 9.0, 6),
        center=rng.uniform(-0.2, 0.2, (6, 3)),
        inertia=second[:, [1, 2, 0]] + second[:, [2, 0, 1]],
        product=rng.uniform(-0.005, 0.005, (6, 3)),
        hand_offset=rng.uniform(-0.2, 0.2, 3),
        hand_mass=rng.uniform(0.5, 9.0),
        hand_center=rng.uniform(-0.2, 0.2, 3),
        hand_inertia=rng.uniform(0.1, 0.2, 3),
        hand_product=rng.uniform(-0.005, 0.005, 3),
        payload_center=[0.05, -0.03, 0.12],
        tool_place=[0.02, 0.01, -0.03],
        tool_turn=[20.0, -40.0, 70.0],
        start_joint=[*rng.uniform(-60, 60, count), *[0.0] * (6 - count)],
    )


class Tree:
    """The links with pivots as a tree of pinocchio, and how its joints follow the arm's."""

    def __init__(self, a: LevelLinks) -> None:
        origins, axes = axes_of(a)
        count, level = int(a.parameter("joints")), a.parameter("joint_level").astype(int)
        joints, before, rows = [], "l0", []
        hand = [a.parameter(f"hand_{n}") for n in ("mass", "center", "inertia", "product")]
        links = f'<link name="l0"/><link name="p3"/>{body("p4", *hand)}'
        total = np.zeros((7, count))  # turn of each link against the one before it, about axis 3
        same = np.sign(axes[1] @ axes[2])
        for k in range(6):
            kind = "continuous" if k < count else "fixed"
            share = np.eye(count)[k] if k < count else np.zeros(count)
            origin, turned = origins[k], np.zeros(count)
            if k in (2, 3):
                pivot = "continuous" if level[k] else "fixed"
                joints.append(
                    joint_line(f"q{k + 1}", pivot, (before, f"p{k + 1}"), origin, axes[2])
                )
                before, origin = f"p{k + 1}", a.parameter("hand_offset") if k == 3 else np.zeros(3)
                if level[k]:
                    turned = -sum(total[k - n] for n in range(level[k]))
                    rows.append(turned)
            joints.append(joint_line(f"j{k + 1}", kind, (before, f"l{k + 1}"), origin, axes[k]))
            if k < count:
                rows.append(share)
            total[k + 1] = (same if k == 1 else 1.0) * share + turned
            before = f"l{k + 1}"
        text = f'<robot name="arm">{links}{bodies_of(a)}{"".join(joints)}'
        text += joint_line("held", "fixed", ("l6", "load"), np.zeros(3), np.ones(3)) + "</robot>"
        self.model = pinocchio.buildModelFromXML(text)
        self.model.gravity.linear = np.array([0.0, 0.0, -float(a.parameter("gravity"))])
        self.data = self.model.createData()
        self.share = np.array(rows)

    def inverse(self, q: Any, v: Any, acceleration: Any) -> np.ndarray:
        """Torques of the arm's joints."""
        rates = self.share @ v, self.share @ acceleration
        tree = pinocchio.rnea(self.model, self.data, self._turned(q), *rates)
        return np.asarray(self.share.T @ tree)

    def forward(self, q: Any, v: Any, torque: Any) -> np.ndarray:
        """Accelerations of the arm's joints."""
        half = np.triu(pinocchio.crba(self.model, self.data, self._turned(q)))
        mass = self.share.T @ (half + np.triu(half, 1).T) @ self.share
        return np.linalg.solve(mass, torque - self.inverse(q, v, np.zeros(len(q))))

    def tool(self, a: LevelLinks, q: Any) -> pinocchio.SE3:
        """Frame of the tool's tip."""
        pinocchio.framesForwardKinematics(self.model, self.data, self._turned(q))
        A, B, C = np.radians(a.parameter("tool_turn"))
        foot = pinocchio.SE3(pinocchio.rpy.rpyToMatrix(A, B, C), a.parameter("tool_place"))
        along = pinocchio.SE3(np.eye(3), np.array([0, 0, float(a.parameter("tool_length"))]))
        return self.data.oMf[self.model.getFrameId("l6", pinocchio.BODY)] * foot * along

    def _turned(self, q: Any) -> np.ndarray:
        """Cosines and sines of all joints of the tree."""
        angles = self.share @ q
        return np.column_stack([np.cos(angles), np.sin(angles)]).ravel()


@pytest.mark.parametrize(("levels", "count", "way"), LEVELS)
def test_dynamics_and_tool_are_those_of_the_tree(
    levels: tuple[int, int], count: int, way: int
) -> None:
    """Forward and inverse dynamics of the largest, tip and attitude at random states: 1e-10."""
    rng = np.random.default_rng([SEED, *levels])
    here = np.arange(count)
    for _ in range(2):
        a = level_arm(rng, levels, count, way)
        tree = Tree(a)
        for k in range(STATES // 2):
            q, v = np.zeros((2, 6))
            q[:count], v[:count] = rng.uniform(-3, 3, (2, count))
            if k % 10 == 0:  # pivots at a quarter and half of a turn, too
                q[1:3] = np.pi / 2 * rng.integers(-2, 3, 2)
            motor = (q + rng.uniform(-3e-3, 3e-3, 6)) * a.parameter("gear_ratio")
            x = a.state(link_angle=q, link_speed=v, rotor_angle=motor, rotor_speed=v * 100)
            y = a.outputs(x, U)
            acceleration = a.rates(x, U)[a.places("link.speed")]
            torque = (y["gear_torque"] - a.parameter("link_viscous") * v)[here]
            exact = tree.forward(q[here], v[here], torque)
            size = max(np.abs(exact).max(), 9.81)
            assert acceleration[here] == pytest.approx(exact, abs=1e-10 * size)
            wanted = tree.inverse(q[here], v[here], acceleration[here])
            size = max(np.abs(wanted).max(), np.abs(torque).max())
            assert torque == pytest.approx(wanted, abs=1e-10 * size)
            there = tree.tool(a, q[here])
            assert y["tool_position"] == pytest.approx(there.translation, abs=1e-10)
            turn = pinocchio.Quaternion(*y["tool_quaternion"]).toRotationMatrix()
            assert turn == pytest.approx(there.rotation, abs=1e-10)


@pytest.mark.parametrize(("levels", "count", "way"), LEVELS)
def test_at_the_start_gears_hold_what_gravity_asks(
    levels: tuple[int, int], count: int, way: int
) -> None:
    """Links hang in their gears as behind ideal ones, pivots level: to 0.1 %."""
    rng = np.random.default_rng([SEED, 1, *levels])
    for _ in range(5):
        a = level_arm(rng, levels, count, way)
        held = a.outputs(a.start, U)["gear_torque"][:count]
        motors = a.start[a.places("rotor.angle")] / a.parameter("gear_ratio")
        wanted = Tree(a).inverse(motors[:count], np.zeros(count), np.zeros(count))
        assert held == pytest.approx(wanted, abs=1e-3 * np.abs(wanted).max())
        assert np.abs(wanted).max() > 10.0
