"""Moves that flow: nearly as quick as toppra's bound along their way, quicker than stops."""

import numpy as np
import pytest
import toppra
from toppra import algorithm, constraint

from motionfmu.virtual.robot import RobotError, VirtualRobot

toppra.setup_logging("ERROR")
SPEED = np.radians([175.0, 175.0, 175.0, 300.0, 300.0, 375.0])
ACC = np.radians([500.0, 500.0, 500.0, 1000.0, 1000.0, 1500.0])
PICK, PLACE = [800, -500, 350, 180, 0, 180], [800, 500, 350, 180, 0, 180]
CYCLE = 1e-4


def above(pose: list[float]) -> list[float]:
    """150 mm higher."""
    return [*pose[:2], pose[2] + 150, *pose[3:]]


def to_rest(robot: VirtualRobot) -> np.ndarray:
    """Commanded joints [rad] in every cycle until the arm rests."""
    rows, rests = [], False
    while not rests:
        now = robot.run(CYCLE)
        rows.append(now.joint_command)
        rests = now.rests
    return np.radians(np.array(rows))


def pick_and_place(zone: float, **settings: float) -> np.ndarray:
    """Joints from rest above the pick, down, over to the place, down, up and back."""
    robot = VirtualRobot(acceleration=20000.0, ik_time=1e-6, **settings)
    robot.move_pose(above(PICK), share=1.0)
    to_rest(robot)
    robot.move_line(PICK)
    robot.move_line(above(PICK), zone=zone)
    robot.move_pose(above(PLACE), share=1.0, zone=zone)
    robot.move_line(PLACE)
    robot.move_line(above(PLACE), zone=zone)
    robot.move_pose(above(PICK), share=1.0, zone=zone)
    robot.move_line(PICK)
    return to_rest(robot)


def moving(joints: np.ndarray) -> list[np.ndarray]:
    """The stretches between rests, in which a joint goes on in every cycle."""
    still = np.abs(np.diff(joints, axis=0)).max(axis=1) < 1e-9
    slow = np.convolve(np.abs(np.diff(joints, axis=0)).sum(axis=1), np.ones(3), "same") < 3e-6
    edges = np.flatnonzero(np.diff(np.r_[1, still | slow, 1]))
    pairs = zip(edges[::2], edges[1::2], strict=True)
    return [joints[a : b + 1] for a, b in pairs if b - a > 100]


def bound(joints: np.ndarray) -> float:
    """Least time along the way of these joints from rest to rest, by toppra. [s]"""
    way = np.r_[0.0, np.cumsum(np.linalg.norm(np.diff(joints, axis=0), axis=1))]
    grid = np.linspace(0.0, way[-1], 600)
    path = toppra.SplineInterpolator(
        grid, np.array([np.interp(grid, way, q) for q in joints.T]).T, "natural"
    )
    limits = [
        constraint.JointVelocityConstraint(np.c_[-SPEED, SPEED]),
        constraint.JointAccelerationConstraint(
            np.c_[-ACC, ACC], constraint.DiscretizationType.Interpolation
        ),
    ]
    solver = algorithm.TOPPRA(
        limits, path, np.linspace(0.0, way[-1], 1200), solver_wrapper="seidel"
    )
    speed = solver.compute_parameterization(0, 0)[1]
    return float((2 * np.diff(solver.gridpoints) / (speed[1:] + speed[:-1])).sum())


@pytest.mark.more
def test_toppra() -> None:
    """A pick and place takes at most 1.1 of the bound, and 25 % less than with stops."""
    flowing = pick_and_place(50.0, flow=True)
    stretches = moving(flowing)
    took, least = sum(len(s) for s in stretches) * CYCLE, sum(bound(s) for s in stretches)
    assert len(stretches) == 3  # down, over and down, back and down
    assert 0.99 * least <= took <= 1.1 * least
    stopping = sum(len(s) for s in moving(pick_and_place(50.0))) * CYCLE
    assert took <= 0.75 * stopping


JOB = """NOP
MOVJ P001 VJ=100.00 PL=8
MOVJ P002 VJ=100.00 PL=8
MOVL P003 V=1000.0 CR=40.0
MOVJ P001 VJ=100.00
END
"""
POINTS = """P001 J1=-20 J2=10 J3=-10 J4=0 J5=80 J6=0
P002 J1=20 J2=10 J3=-10 J4=0 J5=80 J6=0
P003 J1=30 J2=20 J3=-5 J4=10 J5=70 J6=0
"""


def job_time(flow: bool) -> float:
    """Time of the job to its end. [s]"""
    robot = VirtualRobot(flow=flow, ik_time=1e-6)
    robot.start(JOB, POINTS)
    return float(robot.run_until_stop().time)


def test_a_job_flows() -> None:
    """PL of joint moves and CR count; the pose at its end is the same."""
    assert job_time(True) < 0.85 * job_time(False)


SPLINE = """NOP
MOVJ P001 VJ=50.00
MOVS P002 V=200.0
MOVS P003 V=200.0
MOVS P004 V=200.0 ACC=50
MOVS P005 V=200.0
END
"""
ROW = [[900, -200, 500], [1000, -100, 550], [950, 50, 500], [1000, 200, 600]]
ROW_POINTS = "P001 J1=-20 J2=10 J3=-10 J4=0 J5=80 J6=0\n" + "".join(
    f"P00{k + 2} X={x} Y={y} Z={z} A={175 + k} B={2 * k} C=180\n" for k, (x, y, z) in enumerate(ROW)
)


@pytest.mark.parametrize("flow", [True, False])
def test_a_spline_passes_its_points(flow: bool) -> None:
    """One after another, without a stop, to a rest at the last; whether other moves flow or not."""
    robot = VirtualRobot(flow=flow, ik_time=1e-6, tool=[0, 0, 150, 0, 0, 0])
    robot.start(SPLINE, ROW_POINTS)
    places, rests = [], False
    while not rests:
        now = robot.run(10 * CYCLE)
        places.append(now.pose_command[:3])
        rests = bool(now.done)
    off = np.linalg.norm(np.array(places)[:, None] - np.array(ROW), axis=2)
    at = off.argmin(axis=0)
    assert (off.min(axis=0) < 0.2).all()
    assert (np.diff(at) > 0).all()
    step = np.linalg.norm(np.diff(places[at[0] : at[-1]], axis=0), axis=1) / (10 * CYCLE)
    assert step[300:-200].min() > 180.0
    assert step.max() < 200.5


@pytest.mark.parametrize("wrong", [{"part": 0.6}, {"radius": -1.0}, {"zone": np.inf}])
def test_wrong_corners_are_refused(wrong: dict[str, float]) -> None:
    """A message with the value; nothing moves."""
    robot = VirtualRobot(flow=True)
    with pytest.raises(RobotError, match=next(iter(wrong))):
        robot.move_joints([10, 0, 0, 0, 90, 0], **wrong)
    assert robot.read().move == 0


def test_a_move_by_the_wrist_waits_for_rest() -> None:
    """It does not flow: not now, until the arm rests."""
    robot = VirtualRobot(flow=True)
    robot.move_joints([10, 0, 0, 0, 90, 0], zone=10)
    target = robot.kinematics.forward([12, 0, 0, 0, 90, 0])
    with pytest.raises(RobotError) as told:
        robot.move_line(target, singular="wrist")
    assert told.value.status == "BUSY"
    robot.run_until_stop()
    robot.move_line(target, singular="wrist")
    assert np.allclose(robot.run_until_stop().pose[:3], target[:3, 3], atol=0.1)
