"""Random arms as URDF texts, with what pinocchio says of them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import pinocchio

from motionfmu.arms import ArmDescription

MOVING = ("revolute", "continuous", "prismatic")


@dataclass
class RandomArm:
    """A chain with fixed links in it, beside it and behind it, and joints that hang on it."""

    rng: np.random.Generator
    kinds: Sequence[str] = ("revolute", "continuous", "prismatic", "fixed")
    joints: int = 6
    mimics: bool = False

    def text(self) -> str:
        """The URDF; joints are j1 .., links l0 .., the tip is l`joints`."""
        parts, movers = [self._link("l0")], []
        for k in range(1, self.joints + 1):
            kind = str(self.rng.choice(self.kinds))
            parts += [self._link(f"l{k}"), self._joint(f"j{k}", kind, f"l{k - 1}", f"l{k}", movers)]
            if kind != "fixed":
                movers.append(f"j{k}")
            if self.rng.random() < 0.4:
                aside = str(self.rng.choice(["fixed", "revolute", "prismatic"]))
                parts += [self._link(f"s{k}"), self._joint(f"a{k}", aside, f"l{k}", f"s{k}", [])]
        return f'<robot name="random">{"".join(parts)}</robot>'

    def _numbers(self, reach: float, count: int = 3) -> str:
        return " ".join(repr(float(x)) for x in self.rng.uniform(-reach, reach, count))

    def _link(self, name: str) -> str:
        if self.rng.random() < 0.2:
            return f'<link name="{name}"/>'
        half = self.rng.uniform(0.0, 1.0, 3)  # second moments, so that a body can have them
        xx, yy, zz = float(half[1] + half[2]), float(half[2] + half[0]), float(half[0] + half[1])
        return (
            f'<link name="{name}"><inertial><origin xyz="{self._numbers(0.3)}" '
            f'rpy="{self._numbers(3.0)}"/><mass value="{float(self.rng.uniform(0.1, 9.0))!r}"/>'
            f'<inertia ixx="{xx!r}" iyy="{yy!r}" izz="{zz!r}" ixy="0" ixz="0" iyz="0"/>'
            "</inertial></link>"
        )

    def _joint(self, name: str, kind: str, parent: str, child: str, movers: list[str]) -> str:
        more = ""
        if kind != "fixed":
            more = f'<axis xyz="{self._numbers(1.0)}"/>'
            more += '<limit lower="-2" upper="2.5" velocity="1.5" effort="9"/>'
        if self.mimics and movers and kind != "fixed" and self.rng.random() < 0.4:
            leader = str(self.rng.choice(movers))
            more += f'<mimic joint="{leader}" multiplier="{self._numbers(2.0, 1)}" offset="0.3"/>'
        return (
            f'<joint name="{name}" type="{kind}"><parent link="{parent}"/><child link="{child}"/>'
            f'<origin xyz="{self._numbers(0.6)}" rpy="{self._numbers(3.0)}"/>{more}</joint>'
        )


class PinocchioChain:
    """The chain of an arm in pinocchio, joints beside it held at 0."""

    def __init__(self, text: str, arm: ArmDescription) -> None:
        whole = pinocchio.buildModelFromXML(text)
        own = {j.name for j in arm.joints}
        beside = [k for k, name in enumerate(whole.names) if k and name not in own]
        self.model = pinocchio.buildReducedModel(whole, beside, pinocchio.neutral(whole))
        self.data = self.model.createData()
        self.arm = arm
        self.ids = [self.model.getJointId(j.name) for j in arm.joints]

    def tip(self, q: np.ndarray) -> np.ndarray:
        """Its frame at angles of all joints."""
        pinocchio.framesForwardKinematics(self.model, self.data, self._configuration(q))
        frame = self.model.getFrameId(self.arm.tip, pinocchio.BODY)
        return np.array(self.data.oMf[frame].homogeneous)

    def torque(self, q: np.ndarray, v: np.ndarray, acceleration: np.ndarray) -> np.ndarray:
        """Of all joints, free fall as pinocchio has it."""
        rates, changes = np.zeros((2, self.model.nv))
        places = [self.model.joints[k].idx_v for k in self.ids]
        rates[places], changes[places] = v, acceleration
        state = self._configuration(q), rates, changes
        return np.array(pinocchio.rnea(self.model, self.data, *state))[places]

    def _configuration(self, q: np.ndarray) -> np.ndarray:
        found = np.zeros(self.model.nq)
        for k, angle in zip(self.ids, q, strict=True):
            at = self.model.joints[k].idx_q
            if self.model.joints[k].nq == 2:  # a continuous joint: cosine and sine
                found[at : at + 2] = np.cos(angle), np.sin(angle)
            else:
                found[at] = angle
        return found


def worst_differences(
    text: str, arm: ArmDescription, states: int, rng: np.random.Generator
) -> tuple[float, float]:
    """Of the tip's frame, and of torques as a share of the largest, at random states."""
    oracle = PinocchioChain(text, arm)
    q, v, a = rng.uniform(-3.0, 3.0, (3, states, len(arm.driven)))
    gravity = oracle.model.gravity.linear
    torques, tips = arm.inverse_dynamics(q, v, a, gravity), arm.forward(q)
    # How all joints follow the driven ones, by differences, which are exact for a linear law.
    share = np.array([arm.all_joints(e) - arm.all_joints(0.0 * e) for e in np.eye(len(arm.driven))])
    place = torque = 0.0
    for k in range(states):
        full = arm.all_joints(q[k])
        place = max(place, float(np.abs(oracle.tip(full) - tips[k]).max()))
        exact = share @ oracle.torque(full, v[k] @ share, a[k] @ share)
        size = max(1.0, float(np.abs(exact).max()))
        torque = max(torque, float(np.abs(exact - torques[k]).max()) / size)
    return place, torque
