"""Arms of any kind against other people's libraries: poses, branches, what is iterated."""

import ctypes

import numpy as np
import pinocchio
import pytest
from conftest import ROOT
from eaik.IK_HP import HPRobot
from numpy.typing import NDArray
from public_arms import ARMS, PublicArm, turned_at_zero
from robot_batch import ARMS as OPW_ARMS
from robot_batch import Arm as OpwArm
from robot_batch import inverse as opw_inverse
from robot_batch import pointer

Array = NDArray[np.float64]
LIBRARY = ctypes.CDLL(str(ROOT / "build/lib/chain_batch.so"))
BRANCHES, JOINTS = 8, 7
ARM_ANGLE = -2
POSES = 1000
KINDS = {
    "UR5e": "three parallel",
    "UR10e": "three parallel",
    "KR 6 R700": "wrist, 2 and 3 parallel",
    "IRB 2600": "wrist, 2 and 3 parallel",
    "LR Mate 200iD": "wrist, 2 and 3 parallel",
    "Puma 560": "wrist, 2 and 3 parallel",
    "RH-6FH55": "SCARA",
    "IRB 460": "wrist, 2 and 3 parallel",
    "iiwa 7": "shoulder and wrist",
    "Panda": "wrist, 1 and 2 meet, reversed",
    "CRX-10iA": "iterated",
    "gantry": "gantry",
    "gantry of four": "gantry",
}
NUMBERS = {
    "iterated": 0,
    "wrist, 2 and 3 parallel": 1,
    "wrist, 1 and 2 meet": 2,
    "three parallel": 5,
    "SCARA": 6,
    "gantry": 7,
    "shoulder and wrist": 8,
    "wrist, 1 and 2 meet, reversed": 102,
}
HELD = {"iiwa 7": ARM_ANGLE, "Panda": 6}


class Chain:
    """An arm as the core takes it; one at a time."""

    def __init__(self, arm: PublicArm, held: int = -1) -> None:
        self.arm, self.count = arm, len(arm.joints)
        self.origins, self.axes, self.at, self.turn = arm.straight()
        self.slides = np.array([joint.slides for joint in arm.joints], np.int32)
        level = np.array([joint.level for joint in arm.joints], np.int32)
        flange = np.concatenate([self.at, self.turn.ravel()])
        deviation = ctypes.c_double()
        numbers = map(pointer, (self.origins, self.axes, self.slides, level, flange))
        self.kind = LIBRARY.chain_batch_arm(self.count, *numbers, held, ctypes.byref(deviation))
        self.deviation = deviation.value

    def anywhere(self, count: int, seed: int) -> Array:
        """Joints (count, 7)."""
        joints = np.zeros((count, JOINTS))
        joints[:, : self.count] = np.random.default_rng(seed).uniform(
            -3.1, 3.1, (count, self.count)
        )
        joints[:, : self.count] *= np.where(self.slides, 0.2, 1.0)
        return joints

    def forward(self, joints: Array) -> Array:
        """Poses (n, 12): place, rows of the rotation."""
        poses = np.empty((len(joints), 12))
        joints = np.ascontiguousarray(joints)
        LIBRARY.chain_batch_forward(ctypes.c_int64(len(joints)), pointer(joints), pointer(poses))
        return poses

    def jacobian(self, joints: Array) -> Array:
        """Columns (n, 7, 6) of velocity and turning."""
        columns = np.zeros((len(joints), JOINTS, 6))
        LIBRARY.chain_batch_jacobian(ctypes.c_int64(len(joints)), pointer(joints), pointer(columns))
        return columns

    def inverse(self, poses: Array, near: Array) -> Array:
        """Joints of all branches (n, 8, 7), NaN where there is none."""
        joints = np.full((len(poses), BRANCHES, JOINTS), np.nan)
        there = np.zeros(len(poses), np.uint32)
        places = map(pointer, (poses, near, joints, there))
        LIBRARY.chain_batch_inverse(ctypes.c_int64(len(poses)), *places)
        joints[(there[:, None] >> np.arange(BRANCHES) & 1) == 0] = np.nan
        return joints

    def branches(self, joints: Array) -> tuple[Array, NDArray[np.int32]]:
        """Factors and branches of joints."""
        joints = np.ascontiguousarray(joints)
        factors, angles = np.empty((len(joints), 3)), np.empty(len(joints))
        branches = np.empty(len(joints), np.int32)
        places = map(pointer, (joints, factors, branches, angles))
        LIBRARY.chain_batch_branches(ctypes.c_int64(len(joints)), *places)
        return factors, branches

    def apart(self, a: Array, b: Array) -> Array:
        """Largest difference of joints, whole turns of those that turn left out."""
        off = (a - b)[..., : self.count]
        off = np.where(self.slides, off, np.remainder(off + np.pi, 2 * np.pi) - np.pi)
        return np.abs(off).max(axis=-1)


@pytest.fixture(params=ARMS)
def name(request: pytest.FixtureRequest) -> str:
    return str(request.param)


def chain_of(name: str) -> Chain:
    return Chain(ARMS[name], HELD.get(name, -1))


def test_every_public_arm_has_the_form_of_its_kind(name: str) -> None:
    chain = chain_of(name)
    assert chain.kind == NUMBERS[KINDS[name]]
    assert KINDS[name] == "iterated" or chain.deviation < 1e-13


def test_poses_and_velocities_are_those_of_pinocchio(name: str) -> None:
    chain, arm = chain_of(name), ARMS[name]
    joints = chain.anywhere(POSES, 1)
    poses, columns = chain.forward(joints), chain.jacobian(joints)
    model, motion = arm.model()
    data = model.createData()
    frame = model.nframes - 1
    for q, pose, column in zip(joints, poses, columns, strict=True):
        place = motion @ q[: chain.count]
        pinocchio.framesForwardKinematics(model, data, place)
        assert np.abs(data.oMf[frame].translation - pose[:3]).max() < 1e-12
        assert np.abs(data.oMf[frame].rotation.ravel() - pose[3:]).max() < 1e-12
        around = pinocchio.ReferenceFrame.LOCAL_WORLD_ALIGNED
        theirs = pinocchio.computeFrameJacobian(model, data, place, frame, around) @ motion
        assert np.abs(theirs.T - column[: chain.count]).max() < 1e-12


def test_every_branch_leads_back_to_its_pose(name: str) -> None:
    chain = chain_of(name)
    joints = chain.anywhere(POSES, 2)
    poses = chain.forward(joints)
    branches = chain.inverse(poses, joints)
    there = np.isfinite(branches[..., 0])
    again = chain.forward(branches[there])
    assert np.abs(again - np.repeat(poses[:, None], BRANCHES, 1)[there]).max() < 1e-9
    assert chain.apart(branches, joints[:, None]).min(axis=1, initial=9.0, where=there).max() < 1e-6
    factors, flags = chain.branches(branches[there])
    sure = np.abs(factors).min(axis=1) > 1e-6
    own = np.broadcast_to(np.arange(BRANCHES), there.shape)[there]
    assert (flags[sure] == own[sure]).all()
    assert sure.mean() > 0.999


@pytest.mark.parametrize(
    ("name", "held"),
    [(name, -1) for name, kind in KINDS.items() if "parallel" in kind and name != "IRB 460"]
    + [("iiwa 7", 2), ("iiwa 7", 6), ("Panda", 6)],
)
def test_branches_are_those_of_subproblems_in_geometry(name: str, held: int) -> None:
    chain = Chain(ARMS[name], held)
    joints = chain.anywhere(POSES if held < 0 else POSES // 4, 3)
    poses = chain.forward(joints)
    ways = np.vstack([chain.origins, chain.at])
    found = 0
    for q, pose, branches in zip(joints, poses, chain.inverse(poses, joints), strict=True):
        model = HPRobot(chain.axes, ways, [(held, q[held])] if held >= 0 else [])
        end = np.eye(4)
        end[:3, :3], end[:3, 3] = pose[3:].reshape(3, 3) @ chain.turn.T, pose[:3]
        solution = model.IK(end)
        exact = [s for s, least in zip(solution.Q, solution.is_LS, strict=True) if not least]
        there = branches[np.isfinite(branches[:, 0]), : chain.count]
        if len(exact) != len(there):
            continue  # one of them at the edge of reach
        between = chain.apart(there[:, None], np.array(exact)[None])
        assert between.min(axis=1).max() < 1e-6
        assert between.min(axis=0).max() < 1e-6
        found += 1
    assert found > 0.95 * len(joints)


def as_chain(arm: OpwArm) -> PublicArm:
    """An arm of seven lengths joint by joint, its zeros those of its maker."""
    a1, a2, b, c1, c2, c3, c4 = arm.lengths
    turns = np.array([(0, 0, 1), (0, 1, 0), (0, 1, 0), (0, 0, 1), (0, 1, 0), (0, 0, 1)])
    ways = [(0, 0, c1), (a1, b, 0), (0, 0, c2), (a2, 0, c3), (0, 0, 0), (0, 0, 0)]
    return turned_at_zero(turns * np.array(arm.signs)[:, None], ways, (0, 0, c4), arm.offsets)


@pytest.mark.parametrize("name", OPW_ARMS)
def test_an_arm_of_seven_lengths_has_the_same_branches_and_joints(name: str) -> None:
    arm = OPW_ARMS[name]
    chain = Chain(as_chain(arm))
    joints = chain.anywhere(20 * POSES, 4)
    poses = chain.forward(joints)
    theirs = opw_inverse(arm, poses, np.ascontiguousarray(joints[:, :6]))
    mine = chain.inverse(poses, joints)
    # A flag tells two sides apart; which of them it names depends on the directions of the axes.
    sides = [
        swap
        for swap in range(BRANCHES)
        if np.nanmedian(chain.apart(mine[:, swap], theirs[:, 0] @ np.eye(6, JOINTS))) < 1e-9
    ]
    assert len(sides) == 1
    mine = mine[:, np.arange(BRANCHES) ^ sides[0]]
    both = np.isfinite(mine[..., 0]) & np.isfinite(theirs[..., 0])
    assert (np.isfinite(mine[..., 0]) == np.isfinite(theirs[..., 0])).mean() > 0.9999
    factors, _ = chain.branches(joints)
    sure = (np.abs(factors).min(axis=1) > 0.05)[:, None] & both
    between = chain.apart(mine, theirs @ np.eye(6, JOINTS))
    assert sure.sum() > 50 * POSES
    assert between[sure].max() < 1e-12


def test_joints_near_a_pose_lead_to_it_where_there_is_no_closed_form() -> None:
    chain = chain_of("CRX-10iA")
    joints = chain.anywhere(POSES, 5)
    poses = chain.forward(joints)
    near = joints.copy()
    near[:, :6] += np.random.default_rng(6).uniform(-1e-3, 1e-3, (POSES, 6))
    found = near.copy()
    status = np.empty(POSES, np.int32)
    places = map(pointer, (poses, found, status))
    LIBRARY.chain_batch_iterate(ctypes.c_int64(POSES), *places)
    assert np.abs(chain.forward(found) - poses).max() < 1e-12
    followed = status == 2
    assert followed.mean() > 0.99
    assert chain.apart(found, joints)[followed].max() < 1e-9
