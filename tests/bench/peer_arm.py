"""The six-axis arm by pinocchio: forward dynamics and forward kinematics, beside ours."""

import ctypes
import tempfile
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

import kinematics
import numpy as np
import pinocchio
import robot_arm
from medians import Medians
from peers import ROUNDS, Row, agree
from plant_library import BUILD, ROOT, Library, equations

from motionfmu.virtual import robot

HERE = Path(__file__).parent
STATES = 2000
TURNS = 10  # times our loop of all of them is run: it is short
EQUAL = 1e-9  # of the largest acceleration, of a length of 1 m
WIND_UP = 3e-3  # [rad] of a gear


def _loop(call: Callable[..., Any], arguments: Sequence[tuple[Any, ...]]) -> float:
    """Processor time of a call from Python [s]."""
    start = time.process_time()
    for row in arguments:
        call(*row)
    return (time.process_time() - start) / len(arguments)


class Rows:
    """Processor time of one evaluation [us], pinocchio's without its call from Python.

    The call is measured with a model that has no joints.
    """

    def __init__(self) -> None:
        self.missing: list[str] = []
        self._rounds = Medians()
        self._empty = pinocchio.Model()
        self._no_data, none = self._empty.createData(), np.zeros(0)
        self._none = [(self._empty, self._no_data, none, none, none)] * STATES
        self._dynamics()
        self._poses()

    def _dynamics(self) -> None:
        """States at random; both must find the same accelerations."""
        self._arm = arm = robot_arm.Arm()
        other = robot_arm.Pinocchio(arm)
        draw = np.random.default_rng(1)
        q, v = draw.uniform(-3, 3, (2, STATES, 6))
        motor = (q + draw.uniform(-WIND_UP, WIND_UP, q.shape)) * arm.parameter("gear_ratio")
        speed = v * arm.parameter("gear_ratio")
        self._x = np.array(
            [
                arm.state(link_angle=q[k], link_speed=v[k], rotor_angle=motor[k], rotor_speed=w)
                for k, w in enumerate(speed)
            ]
        )
        self._u = np.zeros(len(arm.ode.inputs))
        self._library = self._compiled()
        self._c = np.zeros(4 * len(arm.p))
        self._library.arm_constants(*map(_place, (arm.p, self._c)))
        self._dx = np.empty_like(self._x)
        self._rates()
        viscous = arm.parameter("link_viscous")
        torque = [
            arm.outputs(x, self._u)["gear_torque"] - viscous * w
            for x, w in zip(self._x, v, strict=True)
        ]
        self._joints = [
            (other.model, other.data, *row) for row in zip(q, v, np.array(torque), strict=True)
        ]
        found = np.array([pinocchio.aba(*row) for row in self._joints])
        gap = np.abs(self._dx[:, arm.places("link.speed")] - found).max() / np.abs(found).max()
        agree("accelerations of the arm", gap < EQUAL, f"by {gap:.1e} of the largest")

    def _compiled(self) -> ctypes.CDLL:
        """Our equations as the build has compiled them."""
        self._folder = tempfile.TemporaryDirectory(prefix="motionfmu-")
        file = Path(self._folder.name) / "arm_rates.so"
        Library.compile(
            [HERE / "arm_rates.c", *equations("robot_arm")],
            file,
            [BUILD / "gen/robot_arm", ROOT / "src/plant", ROOT / "src/fmi"],
        )
        made, place = ctypes.CDLL(str(file)), ctypes.c_void_p
        made.arm_rates.argtypes = [ctypes.c_long, place, place, place, place]
        made.arm_constants.argtypes = [place, place]
        return made

    def _rates(self) -> None:
        """Rates of all states at random."""
        arrays = (self._x, self._u, self._c, self._dx)
        self._library.arm_rates(len(self._x), *map(_place, arrays))

    def _poses(self) -> None:
        """Joints at random; both must find the same pose of the flange."""
        arm = robot_arm.Arm(**robot_arm.EXACT)
        other = robot_arm.Pinocchio(arm)
        joints = np.random.default_rng(2).uniform(-3, 3, (STATES, 6))
        inner = arm.parameter("joint_sign") * joints - np.radians(arm.parameter("joint_offset"))
        self._places = [(other.model, other.data, row) for row in inner]
        ours = robot.Kinematics().forward(np.degrees(joints))
        gap = 0.0
        for row, pose in zip(self._places, ours, strict=True):
            pinocchio.forwardKinematics(*row)
            flange = other.data.oMi[6]
            far = np.abs(pose[:3, 3] / 1e3 - flange.translation).max()  # [m]
            gap = max(gap, far, np.abs(pose[:3, :3] - flange.rotation).max())
        agree("pose of the arm", gap < EQUAL, f"by {gap:.1e} m or of 1")
        self._ours = kinematics.Kinematics()

    def __call__(self) -> None:
        start = time.process_time()
        for _ in range(TURNS):
            self._rates()
        self._rounds.add("rates", (time.process_time() - start) / TURNS / STATES)
        call = _loop(pinocchio.aba, self._none)
        self._rounds.add("aba", _loop(pinocchio.aba, self._joints) - call)
        call = _loop(pinocchio.forwardKinematics, [row[:3] for row in self._none])
        self._rounds.add("poses", _loop(pinocchio.forwardKinematics, self._places) - call)
        self._ours()

    def rows(self) -> list[Row]:
        """A row for the dynamics and one for the kinematics."""
        tool = f"pinocchio {pinocchio.__version__}, without its call"
        told = "accelerations of a six-axis arm; ours with gears, friction, motors: 30 rates"
        return [
            Row(told, "µs", tool, *self._us(self._rounds["rates"], "aba"), ROUNDS),
            Row(
                "pose of its flange; theirs of every joint",
                "µs",
                tool,
                *self._us(self._ours.rounds["forward"], "poses"),
                ROUNDS,
            ),
        ]

    def _us(self, ours: float, theirs: str) -> tuple[float, float]:
        return 1e6 * ours, 1e6 * self._rounds[theirs]


def _place(array: np.ndarray) -> Any:
    return array.ctypes.data
