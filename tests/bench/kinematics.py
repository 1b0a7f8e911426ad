"""What the kinematics of the arm cost, beside py-opw-kinematics and the PC that is modelled."""

import subprocess
import time
from pathlib import Path

import numpy as np
import py_opw_kinematics as opw
from medians import Medians

from motionfmu.virtual import robot

PROGRAM = Path(__file__).resolve().parents[2] / "build/tests/bench/kinematics_cost"
POSES = 20_000
# Of the program's figures: pose of joints, joints of a pose in all eight branches, a cycle of a
# line with path, joints and pose, a line planned; a UR5e by its axes: pose, all eight branches.
NAMES = ("forward", "inverse", "cycle", "plan", "axes", "branches")
MODELLED = 36e-6  # [s] the document's Celeron G530, 10^6 solutions in 36 s


class Kinematics:
    """Processor time each [s]: NAMES; all eight branches on arrays in Python, and by the other."""

    def __init__(self) -> None:
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
        self.rounds = Medians()

    def __call__(self) -> None:
        figures = map(float, subprocess.check_output([PROGRAM], text=True).split())
        for name, figure in zip(NAMES, figures, strict=True):
            self.rounds.add(name, figure)
        start = time.process_time()
        self.bound.inverse(self.matrices)
        self.rounds.add("python", (time.process_time() - start) / POSES)
        start = time.process_time()
        self.robot.reach(self.poses)
        self.rounds.add("other", (time.process_time() - start) / POSES)

    def table(self) -> None:
        """All of it in ns."""
        print(f"\n{'arm of six joints':44}{'ns':>8}")
        for what, figure in (
            ("pose of joints", self.rounds["forward"]),
            ("joints of a pose, all eight branches", self.rounds["inverse"]),
            ("the same on arrays in Python", self.rounds["python"]),
            ("the same by py-opw-kinematics", self.rounds["other"]),
            ("one solution of the PC that is modelled", MODELLED),
            ("a cycle of 100 us on a line", self.rounds["cycle"]),
            ("a line planned", self.rounds["plan"]),
            ("a UR5e by its axes: pose of joints", self.rounds["axes"]),
            ("joints of a pose, all eight branches", self.rounds["branches"]),
        ):
            print(f"  {what:42}{figure * 1e9:8.0f}")
