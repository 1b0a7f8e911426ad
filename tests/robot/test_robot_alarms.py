"""What stops a robot is told: a payload beyond a joint's torque, an underrun of the card."""

import numpy as np
from conftest import ROOT

import motionfmu

STOPPED = 8  # of soft.status


def overloaded(brake: float) -> motionfmu.Result:
    line = motionfmu.load(ROOT / "scenarios/robot_line")
    heavy = {"arm.payload_mass": 400.0, "drives.overload_time": 0.2, "drives.brake_torque": brake}
    return line.changed(record=["soft.status"]).run(set=heavy, stop=1.2)


def test_payload_beyond_a_joint_is_an_overload_that_stops() -> None:
    run = overloaded(brake=0.0)
    assert any("overload" in w and "0.2 s" in w for w in run.warnings)
    alarm = run["drives.alarm"][:, 1]
    assert set(alarm) == {0, 3}
    told = int(np.argmax(alarm == 3)) + 10  # [samples of 1 ms] card and controller have seen it
    assert set(run["soft.status"][told:]) == {STOPPED}
    assert (run["soft.path_feed"][told:] == 0.0).all()
    assert (np.ptp(run["soft.joint_command"][told:], axis=0) == 0.0).all()
    fallen = run["arm.link_angle"][-1, 1] - run["arm.link_angle"][told, 1]
    assert fallen > 1.0  # [rad]


def test_a_motor_that_is_too_hot_is_told() -> None:
    """Joint 2 bears more than 1 N.m where the line begins, five times what is called rated."""
    line = motionfmu.load(ROOT / "scenarios/robot_line")
    values = {"drives.rated_torque": 0.2, "drives.thermal_time": 0.5}
    run = line.changed(record=["drives.load_ratio", "soft.status"]).run(set=values, stop=1.2)
    told = [w for w in run.warnings if "overload" in w]
    assert told and all("RMS torque over thermal_time = 0.5 s" in w for w in told)
    assert run["drives.alarm"][-1, 1] == 3 and run["soft.status"][-1] == STOPPED


def test_a_brake_holds_what_its_drive_could_not() -> None:
    run = overloaded(brake=80.0)
    alarm = run["drives.alarm"][:, 1]
    first = int(np.argmax(alarm == 3))
    angle = run["arm.link_angle"][first:, 1]
    assert np.abs(angle - angle[0]).max() < 0.1  # [rad] 6 kN.m on the springs of a gear
    assert -run["drives.torque"][first:, 1].mean() > 10.0  # the drive's limit [N.m]
    assert run["soft.status"][-1] == STOPPED


def test_underruns_are_warnings_of_a_scenario() -> None:
    run = motionfmu.load(ROOT / "scenarios/bus_copy").run()
    told = [w for w in run.warnings if "underrun" in w]
    assert told and all(w.startswith("whole_card") for w in told) and len(told) <= 9
