"""What the kinematics of the arm cost, beside py-opw-kinematics and the PC that is modelled."""

import subprocess
import time
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import py_opw_kinematics as opw

from motionfmu.virtual import robot

PROGRAM = Path(__file__).resolve().parents[2] / "build/tests/bench/kinematics_cost"
POSES = 20_000
MODELLED = 36e-6  # [s] the document's Celeron G530, 10^6 solutions in 36 s


@dataclass
class Kinematics:
    """Seconds of processor time each, best of all rounds."""

    forward: float = np.inf
    inverse: float = np.inf  # all eight branches
    cycle: float = np.inf  # of a line: path, joints, pose
    plan: float = np.inf  # of a line
    axes: float = np.inf  # pose of joints of a UR5e by its axes
    branches: float = np.inf  # joints of a pose, all eight of its branches
    python: float = np.inf  # all eight branches by motionfmu.virtual.robot
    other: float = np.inf  # py-opw-kinematics, all eight branches

    def __post_init__(self) -> None:
        names = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
        lengths = dict(zip(names, (0.15, -0.115, 0, 0.445, 0.7, 0.795, 0.085), strict=True))
        model = opw.KinematicModel(
            **lengths, offsets=(0, 0, -np.pi / 2, 0, 0, 0), flip_axes=(False,) * 6
        )
        self.robot = opw.Robot(model, degrees=False)
        joints = np.random.default_rng(1).uniform(-3.1, 3.1, (POSES, 6))
        self.poses = self.robot.batch_forward(joints)
        self.bound = robot.Kinematics()
        self.matrices = self.bound.forward(np.degrees(joints))

    def __call__(self) -> None:
        figures = map(float, subprocess.check_output([PROGRAM], text=True).split())
        names = ("forward", "inverse", "cycle", "plan", "axes", "branches")
        for name, figure in zip(names, figures, strict=True):
            setattr(self, name, min(getattr(self, name), figure))
        start = time.process_time()
        self.bound.inverse(self.matrices)
        self.python = min(self.python, (time.process_time() - start) / POSES)
        start = time.process_time()
        self.robot.reach(self.poses)
        self.other = min(self.other, (time.process_time() - start) / POSES)

    def table(self) -> None:
        """All of it in ns."""
        print(f"\n{'arm of six joints':44}{'ns':>8}")
        for what, figure in (
            ("pose of joints", self.forward),
            ("joints of a pose, all eight branches", self.inverse),
            ("the same on arrays in Python", self.python),
            ("the same by py-opw-kinematics", self.other),
            ("one solution of the PC that is modelled", MODELLED),
            ("a cycle of 100 us on a line", self.cycle),
            ("a line planned", self.plan),
            ("a UR5e by its axes: pose of joints", self.axes),
            ("joints of a pose, all eight branches", self.branches),
        ):
            print(f"  {what:42}{figure * 1e9:8.0f}")
