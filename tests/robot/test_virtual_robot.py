"""The virtual robot beside the FMUs run by the native engine; each call and its refusal."""

import math
import tomllib
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import py_opw_kinematics as opw
import pytest
from conftest import ROOT

import motionfmu
import motionfmu.virtual.robot as robots
from motionfmu.base.errors import InputError
from motionfmu.virtual.robot import Kinematics, RobotError, VirtualRobot, matrix_of, pose_of

EXAMPLE = ROOT / "examples/virtual_robot"
JOB, POINTS = ((EXAMPLE / name).read_text() for name in ("plate.job", "plate.points"))
PART = (
    "G21 G90\nG0 X1000 Y0 Z900\nG64 P1\nG1 X1050 F9000\nM62 P2\nG1 Y60\nG4 P0.02\nG1 Y0 C170\nM2\n"
)

SCENARIO = """# Soft controller and card.
stop = {stop}
step = 5e-5
leave = ["soft.start", "soft.hold", "soft.abort", "soft.single", "soft.reset", "soft.override",
         "soft.jog*", "soft.teach", "soft.replay", "card.di*", "card.ai", "card.emergency_stop",
         "card.drive*"]

[component]
soft = "soft_controller"
card = "fpga_card"

[connect]
"card.host_*" = "soft.card_*"
"soft.card_*" = "card.*"

[set]
"soft.program" = "{program}"
"soft.points" = "{points}"
"soft.pc" = "own"
"soft.irq_mean" = 4e-6
"soft.irq_longest" = 1e-4

[record]
signals = ["card.pulse_count", "card.dout", "card.irq_clock", "soft.status", "soft.tool_position",
           "soft.cycle_time", "card.underruns"]
every = 20
"""


@pytest.mark.parametrize(("text", "stop"), [(JOB, 3.0), (PART, 1.5)], ids=["job", "part"])
def test_robot_is_the_fmus_bit_by_bit(text: str, stop: float, tmp_path: Path) -> None:
    gcode = text == PART
    name = "a.ngc" if gcode else "a.job"
    (tmp_path / name).write_text(text)
    (tmp_path / "a.points").write_text(POINTS)
    scenario = SCENARIO.format(stop=stop, program=name, points="" if gcode else "a.points")
    (tmp_path / "scenario.toml").write_text(scenario)
    fmus = motionfmu.load(tmp_path).run()
    robot = VirtualRobot(irq_mean=4e-6, irq_longest=1e-4)
    robot.start(text, "" if gcode else POINTS, language="gcode" if gcode else "inform")
    names = ("pulses", "outputs", "irq_clock", "status", "pose_command", "cycle_time", "underruns")
    mine = robot.record(stop, 1e-3, *names)
    theirs = [np.asarray(fmus[f"card.{n}"]) for n in ("pulse_count", "dout", "irq_clock")]
    rows = np.rint(fmus.time * 1e3).astype(int)
    mine = {name: values[rows] for name, values in mine.items()}
    np.testing.assert_allclose(mine["time"], fmus.time, atol=1e-12)
    assert len(rows) > 1000 and np.ptp(mine["pulses"], axis=0).max() > 1000
    # What the PC works out at the first instant shows at the next one: the FMU is idle before.
    for key, values in zip(names, theirs, strict=False):
        np.testing.assert_array_equal(mine[key], values.reshape(mine[key].shape))
    np.testing.assert_array_equal(mine["status"][1:], np.ravel(fmus["soft.status"])[1:])
    np.testing.assert_array_equal(
        mine["pose_command"][:, :3] * 1e-3, np.asarray(fmus["soft.tool_position"])
    )
    np.testing.assert_array_equal(mine["cycle_time"], np.ravel(fmus["soft.cycle_time"]))
    np.testing.assert_array_equal(mine["underruns"], np.ravel(fmus["card.underruns"]))
    assert mine["outputs"].max() > 0 and len(set(mine["cycle_time"])) > 50


def parameters(fmu: str) -> dict[str, Any]:
    return tomllib.loads((ROOT / f"fmus/{fmu}/fmu.toml").read_text())["parameter"]


def test_settings_start_and_end_as_the_parameters_of_the_fmu() -> None:
    have, soft = robots.defaults(), parameters("soft_controller")
    texts = {n for n, p in soft.items() if p["type"] == "string"}
    for name in set(soft) - texts:
        assert np.array_equal(*np.broadcast_arrays(have[name][0], soft[name]["start"])), name
        for end, beyond in (("min", -math.inf), ("max", math.inf)):
            if (edge := soft[name].get(end)) is None:
                continue
            step = -1 if end == "min" else 1
            real = soft[name]["type"] == "f64"
            wrong = math.nextafter(edge, beyond) if real else edge + step
            with pytest.raises(RobotError, match=rf"^{name} = .* is wanted") as e:
                VirtualRobot(**{name: wrong})
            assert e.value.limit == edge and e.value.value == wrong
    card = parameters("fpga_card")
    for name in set(card) - set(soft):
        assert have[name][0] == card[name]["start"], name
    assert set(have) == (set(soft) - texts) | set(card)


def test_line_of_the_document_keeps_its_place() -> None:
    robot = VirtualRobot()
    robot.move_pose([1000, -200, 800, 180, 0, 180])
    robot.run_until_stop()
    robot.move_line([1000, 200, 800, 180, 0, 180], feed=250)
    found = robot.record(2.0, 1e-3, "pose", "path_feed", "pulses")
    pulse = np.radians(1) * 1300 / (2500 * 80 / 360)  # the coarsest joint at the arm's length [mm]
    assert np.abs(found["pose"][:, [0, 2]] - [1000, 800]).max() < pulse
    assert found["path_feed"].max() == pytest.approx(250, rel=1e-6)
    assert found["pose"][-1, 1] == pytest.approx(200, abs=pulse)


def moved(robot: VirtualRobot, joint: float = 30.0) -> None:
    robot.move_joints([joint, 0, 0, 0, 90, 0], share=0.2)
    robot.run(0.3)


def test_hold_override_and_abort() -> None:
    robot = VirtualRobot()
    moved(robot)
    robot.hold()
    held = robot.run(0.5)
    assert held.status == robots.HOLD and robot.run(0.2).pulses[0] == held.pulses[0]
    robot.hold(False)
    robot.override(0.5)
    a = robot.run(0.3)
    b = robot.run(0.1)
    assert (b.joint[0] - a.joint[0]) / 0.1 == pytest.approx(0.5 * 0.2 * 175, rel=0.01)
    robot.abort()
    end = robot.run_until_stop()
    assert held.joint[0] < end.joint[0] < 30 and end.status == robots.IDLE


def test_jog_goes_so_far_or_until_release() -> None:
    robot = VirtualRobot()
    robot.jog([0, 0, 0, 0, 0, -1], robots.JOINTS, way=2.5)
    step = robot.run_until_stop()
    assert step.joint == pytest.approx([0, 0, 0, 0, 90, -2.5], abs=1e-3)
    assert robot.run(0.5).pulses.tolist() == step.pulses.tolist()
    robot.jog([0, 0, 1, 0, 0, 0], robots.TOOL, way=10.0)
    down = robot.run_until_stop()
    assert down.pose[2] - step.pose[2] == pytest.approx(-10, abs=0.02)
    robot.jog([0, 0, 0, 0, 0, 1], robots.BASE, way=3.0)
    turned = robot.run_until_stop()
    turn = pose_of(np.linalg.inv(matrix_of(down.pose)) @ matrix_of(turned.pose))[5]
    assert abs(turn) == pytest.approx(3, abs=0.01)
    robot.jog([1, 0, 0, 0, 0, 0])
    assert robot.run(0.5).status == robots.JOG
    robot.release()
    end = robot.run_until_stop()
    assert 3 < end.joint[0] < 15 and end.status == robots.IDLE


def test_emergency_stop_and_reset() -> None:
    robot = VirtualRobot()
    moved(robot)
    robot.set_stop(True)
    stop = robot.run(0.01)
    assert stop.stopped and stop.status == robots.STOPPED and stop.servo == 0
    assert robot.run(0.1).pulses.tolist() == stop.pulses.tolist()
    with pytest.raises(RobotError, match="the card has stopped: reset it") as e:
        robot.move_joints([0, 0, 0, 0, 90, 0])
    assert e.value.status == "BUSY"
    robot.reset()
    assert robot.run(0.01).stopped  # its cause lasts
    robot.set_stop(False)
    robot.reset()
    free = robot.run(0.01)
    assert not free.stopped and free.servo == 63
    robot.move_joints([0, 0, 0, 0, 90, 0])
    assert robot.run_until_stop().pulses.tolist() == [0] * 6
    robot.set_alarms(2)
    assert robot.run(0.01).stopped


def test_program_sees_inputs_and_sets_outputs() -> None:
    robot = VirtualRobot()
    job = "WAIT IN#(3)=ON\nDOUT OT#(2) ON\nAIN R001 AI#(1)\n"
    job += "AOUT AO#(2) R001\nPAUSE\nDOUT OT#(2) OFF\n"
    robot.set_analog_input(1, 2.5)
    robot.start(job)
    waits = robot.run(0.1)
    assert waits.status == robots.WAITING and waits.outputs == 0
    with pytest.raises(RobotError, match="a program runs"):
        robot.start(job)
    robot.set_inputs(3, 32)
    on = robot.run(0.1)
    assert on.inputs == 1 << 2 | 1 << 31 and on.outputs == 2 and on.status == robots.PAUSED
    assert on.ao[1] == pytest.approx(2.5, abs=20 / 65535)
    robot.go_on()
    assert robot.run_until_stop().outputs == 0 and robot.read().done
    robot.set_output(5, True)
    robot.set_analog_output(8, -10.0)
    end = robot.run(0.001)
    assert end.outputs == 16 and end.ao[7] == -10.0
    robot.start("DIN B001 OT#(5)\nJUMP *E IF B001=0\nDOUT OT#(6) ON\n*E\n")
    assert robot.run_until_stop().outputs == 48


def test_outputs_wait_for_the_moves_before_them() -> None:
    robot = VirtualRobot()
    moved(robot)
    robot.set_output(1, True)
    assert robot.run(0.1).outputs == 0
    found = robot.record(1.5, 1e-3, "outputs", "joint")
    first = int(np.argmax(found["outputs"]))
    assert found["joint"][first, 0] == pytest.approx(30, abs=1e-3)
    assert found["joint"][first - 2, 0] < 30


def test_teach_replay_and_tool() -> None:
    robot = VirtualRobot()
    robot.set_tool([0, 0, 100, 0, 0, 0])
    at = robot.read().pose
    assert robot.kinematics.forward([0, 0, 0, 0, 90, 0])[:3, 3] == pytest.approx(at[:3])
    assert at[2] == pytest.approx(1075)
    robot.teach()
    moved(robot)
    with pytest.raises(RobotError, match="set_tool: not now: the arm moves"):
        robot.set_tool([0] * 6)
    robot.run_until_stop()
    robot.teach()
    robot.run(0.001)
    points = robot.taught().splitlines()
    assert len(points) == 2 and points[1].startswith("P001 J1=30")
    robot.replay()
    robot.run(0.001)
    assert robot.run_until_stop().joint[0] == pytest.approx(30, abs=1e-3)


def test_a_move_of_joints_takes_no_inverse_kinematics() -> None:
    robot = VirtualRobot()
    robot.move_joints([60, 0, 0, 0, 90, 0])
    end = robot.run_until_stop()
    assert end.points_computed <= 1 and end.deadline_misses == end.underruns == 0
    robot.move_line([600, 800, 900, 180, 0, 180], feed=100)
    before, after = end.path_length, robot.run_until_stop().path_length
    points = robot.read().points_computed
    assert points == pytest.approx((after - before) / 0.1, abs=2)


def test_underruns_are_told() -> None:
    robot = VirtualRobot(ik_time=80e-6)  # 2 m/s: two points in 100 us
    robot.move_line([1000, 400, 900, 180, 0, 180], feed=2000)
    with pytest.warns(
        RuntimeWarning, match=r"underruns of the card until .* s: cycles of the driver"
    ):
        robot.run(1.0)
    assert robot.read().underruns > 0


@pytest.mark.parametrize("huge", [1e308, 1.4e154, 1e153, 1e30, 1.0000001e6])
def test_extremes_are_refused_with_value_and_limit(huge: float) -> None:
    robot = VirtualRobot()
    for at in range(6):
        pose = list(START)
        pose[at] = -huge if at % 2 else huge
        calls: list[Call] = [
            lambda r, pose=pose: r.move_line(pose),
            lambda r, pose=pose: r.move_pose(pose),
            lambda r, pose=pose: r.move_joints(pose),
            lambda r, pose=pose: r.move_circle(UP, pose),
            lambda r, pose=pose: r.jog(pose, robots.BASE),
            lambda r, pose=pose: r.jog(pose, robots.JOINTS),
            lambda r, pose=pose: r.set_tool(pose),
        ]
        for call in calls:
            with pytest.raises(RobotError) as e:
                call(robot)
            assert (e.value.status, abs(e.value.value)) == ("VALUE", huge)
            assert abs(e.value.limit) in (1e6, 1e4)
    with pytest.raises(RobotError, match=r"^via\[0\] = "):
        robot.move_circle([huge, 0, 0], UP)
    assert robot.read().rests and robot.read().move == 0


@pytest.mark.more
def test_jog_that_turns_keeps_all_limits() -> None:
    robot = VirtualRobot()
    robot.jog([1, 0, 0, 0, 0, 1], robots.BASE, speed=0.3, way=50.265)
    found = robot.record(12.0, 1e-4, "joint_command")["joint_command"]
    limits = {n: robots.defaults()[n][0] for n in ("joint_speed", "joint_acc", "joint_high")}
    rate = np.diff(found, axis=0) * 1e4
    assert np.abs(rate).max() > 1
    assert (np.abs(rate) <= np.array(limits["joint_speed"]) * (1 + 1e-6)).all()
    room = np.array(limits["joint_acc"]) * (1 + 1e-6) + 1e-4  # [deg/s2] rounding of degrees
    assert (np.abs(np.diff(rate, axis=0)) * 1e4 <= room).all()
    assert (np.abs(found) <= np.array(limits["joint_high"]) + 1e-7).all()


UP = [1000.0, 0.0, 1000.0, 180.0, 0.0, 180.0]
START = [1000.0, 0.0, 900.0, 180.0, 0.0, 180.0]
BRANCH = "the path does not lead to the configuration of the target: shoulder"
FAULTS = 'line 1: unknown word "M666", column 1\nline 2: unexpected character "$", column 4'
Call = Callable[[VirtualRobot], Any]
REFUSED: list[tuple[Call, str, str, float, float]] = [
    (lambda r: r.move_joints([0, 96, 0, 0, 0, 0]), "joint 2 to 96 deg", "OUTSIDE", 96, 95),
    (lambda r: r.move_line([1800, 0, 900, 180, 0, 180]), "out of reach at", "FAR", 0, 0),
    (lambda r: r.move_circle([1000, 0, 950], UP), "three points on one", "NO_CIRCLE", 0, 0),
    (lambda r: r.move_line([1000, 50, 900, 180, 0, 180], branch=4), BRANCH, "OTHER_BRANCH", 0, 0),
    (lambda r: r.move_line(START, feed=-1), "feed = -1: 0 to 1e+06", "VALUE", -1, 0),
    (lambda r: r.move_joints(START, share=1.5), "share = 1.5: 0.001 to 1", "VALUE", 1.5, 1),
    (lambda r: r.move_line(START, branch=8), "branch = 8: -1 to 7", "VALUE", 8, 7),
    (lambda r: r.move_line(START, singular="no"), "one of slow, refuse, wrist", "VALUE", 0, 0),
    (lambda r: r.move_line(START, speed=5), "move_line: no 'speed'", "VALUE", 0, 0),
    (lambda r: r.move_line([1, 2, 3]), "finite numbers of shape (6,)", "VALUE", 0, 0),
    (lambda r: r.move_line([math.nan] * 6), "finite numbers", "VALUE", 0, 0),
    (lambda r: r.jog([0] * 6), "jog: a number is out of range", "PARAMETER", 0, 0),
    (lambda r: r.jog([1, 0, 0, 0, 0, 0], 3), "frame = 3: 0 to 2", "VALUE", 3, 2),
    (lambda r: r.override(2.1), "override = 2.1: 0 to 2", "VALUE", 2.1, 2),
    (lambda r: r.set_output(0, True), "output = 0: 1 to 32", "VALUE", 0, 1),
    (lambda r: r.set_analog_output(1, 11), "volts = 11: -10 to 10", "VALUE", 11, 10),
    (lambda r: r.set_inputs(33), "input = 33: 1 to 32", "VALUE", 33, 32),
    (lambda r: r.start("MOVL P001\n"), 'line 1: point not in the points', "PROGRAM", 0, 0),
    (lambda r: r.start("NOP\n", "P001 X=1\n"), "points: line 1: needs X Y", "PROGRAM", 0, 0),
    (lambda r: r.start("NOP\n", job="X"), 'no job "X"', "PROGRAM", 0, 0),
    (lambda r: r.start("G1 X9000 F1\n", language="gcode"), "1: out of reach", "PROGRAM", 0, 0),
    (lambda r: r.start("M666\nX1 $", language="gcode"), FAULTS, "PROGRAM", 0, 0),
    (lambda r: r.start("NOP\n", language="x"), "inform or gcode", "VALUE", 0, 0),
    (lambda r: r.kinematics.forward([1, 2]), "shape (6,)", "VALUE", 0, 0),
    (lambda r: r.kinematics.inverse(np.eye(4), np.zeros((2, 6))), "near: shape", "VALUE", 0, 0),
]  # fmt: skip


def seen(robot: VirtualRobot) -> str:
    """All but the pose at the end of the path, which is taken anew from the joints."""
    return repr({n: v for n, v in vars(robot.read()).items() if n != "pose_command"})


@pytest.mark.parametrize(("call", "said", "status", "value", "limit"), REFUSED)
def test_refused_call_says_value_and_limit_and_changes_nothing(
    call: Call, said: str, status: str, value: float, limit: float
) -> None:
    robot = VirtualRobot()
    robot.move_line(START, feed=300)
    robot.run_until_stop()
    before = seen(robot)
    with pytest.raises(RobotError) as e:
        call(robot)
    assert said in str(e.value) and e.value.status == status
    if limit:
        assert (e.value.value, e.value.limit) == pytest.approx((value, limit))
    assert seen(robot) == before
    assert robot.run(0.05).pulses.tolist() == robot.read().pulses.tolist()


def test_ring_of_moves_is_full_in_the_end() -> None:
    robot = VirtualRobot()
    with pytest.raises(RobotError, match="not now") as e:
        for k in range(1000):
            robot.move_joints([k % 2, 0, 0, 0, 90, 0])
    assert e.value.status == "BUSY" and k > 50
    robot.run(0.5)
    assert robot.move_joints([0, 0, 0, 0, 90, 0]) == k + 1


def test_wrong_settings_are_named() -> None:
    with pytest.raises(InputError, match="no setting 'feeds'; did you mean 'feed'"):
        VirtualRobot(feeds=1)
    with pytest.raises(RobotError, match=r"joint_low = 90 \(element 1\): not below joint_high"):
        VirtualRobot(joint_low=90, joint_high=[180, 90, 180, 180, 180, 180])
    with pytest.raises(
        RobotError, match=r"irq_every = 0\.000100025.*: not a whole number of slots"
    ):
        VirtualRobot(irq_every=100.025e-6)


def test_a_run_in_pieces_is_a_run_in_one_go() -> None:
    robots_ = VirtualRobot(irq_mean=3e-6), VirtualRobot(irq_mean=3e-6)
    for robot in robots_:
        robot.start(JOB, POINTS)
    cuts = np.sort(np.random.default_rng(1).integers(0, 40_000_000, 500))
    for clock in cuts:
        robots_[0].run_to(int(clock))
    last = [robot.run_to(40_000_000) for robot in robots_]
    assert repr(last[0]) == repr(last[1]) and last[0].pulses.any()


def test_kinematics_within_limits_and_near_a_place() -> None:
    arm = Kinematics(tool=[0, 0, 150, 0, 0, 0])
    assert repr(arm) == "<Kinematics: joints at 0, tip at [1180, 0, 1260, 0, 90, 0]>"  # no -0
    random = np.random.default_rng(2)
    low, high = (np.array(robots.defaults()[n][0]) for n in ("joint_low", "joint_high"))
    joints = random.uniform(low, high, (50, 40, 6))
    found, branch = arm.nearest(arm.forward(joints), joints)
    factors, own = arm.singular(joints)
    assert found.shape == joints.shape and branch.shape == factors.shape[:2] == (50, 40)
    assert np.abs(found - joints).max() < 1e-5 and (branch == own).mean() > 0.999
    far = matrix_of([5000, 0, 0, 0, 0, 0])
    assert np.isnan(arm.nearest(far, joints[0, 0])[0]).all()
    assert arm.nearest(far, joints[0, 0])[1] == -1
    assert np.isnan(arm.inverse(far)).all()
    poses = pose_of(arm.forward(joints))
    assert np.abs(matrix_of(poses) - arm.forward(joints)).max() < 1e-9
    with pytest.raises(AttributeError, match="no reading 'pulse'"):
        _ = VirtualRobot().read().pulse


def test_kinematics_on_arrays_are_those_of_the_other_library() -> None:
    lengths = {n: robots.defaults()[n][0] for n in ("a1", "a2", "b", "c1", "c2", "c3", "c4")}
    offsets = (0, 0, -np.pi / 2, 0, 0, 0)
    model = opw.KinematicModel(**lengths, offsets=offsets, flip_axes=(False,) * 6)
    other, arm = opw.Robot(model, degrees=False), Kinematics()
    joints = np.random.default_rng(3).uniform(-170, 170, (20_000, 6))
    theirs, mine = other.batch_forward(np.radians(joints)), arm.forward(joints)
    matrices = np.array(theirs.as_matrix())
    matrices[:, :3, 3] *= 1e3
    assert np.abs(mine - matrices).max() < 1e-9  # [mm]
    # Its slots count 4 for the wrist, 2 for the shoulder, 1 for the elbow.
    slots = [4 * (k & 1) + 2 * (k >> 2) + (k >> 1 & 1) for k in range(8)]
    reached = np.degrees(np.asarray(other.reach(theirs).joints)[:, slots])
    found = arm.inverse(mine, joints)
    there, known = (np.isfinite(x).all(axis=2) for x in (found, reached))
    assert (there & known).sum() > 100_000 and (there ^ known).sum() < 15
    apart = np.abs(np.remainder(found - reached + 180, 360) - 180)[there & known].max(axis=1)
    assert np.quantile(apart, 0.999) < 1e-7 and apart.max() < 1e-3  # [deg] near singular places
