"""Errors of an arm that are known, found in poses made by other people's and plain kinematics."""

from pathlib import Path

import numpy as np
import pytest

from motionfmu import InputError
from motionfmu.calibrate import ArmCalibrationOptions, PoseRecord, arm_calibration, pose_record
from motionfmu.run import machine
from motionfmu.virtual.robot import Kinematics

AXES = "zyyzyz"
# Without gravity and errors of the gears an arm is what its lengths say.
RIGID = {
    "arm.gravity": 0.0,
    "arm.lost_motion": 0.0,
    "arm.transmission_error_1": 0.0,
    "arm.transmission_error_2": 0.0,
    "arm.zero_error": 0.0,
    "arm.origin_error": 0.0,
}
LENGTHS = {"a1": 150.0, "a2": -115.0, "b": 0.0, "c1": 445.0, "c2": 700.0, "c3": 795.0, "c4": 85.0}
OFFSET = np.radians([0.0, 0.0, -90.0, 0.0, 0.0, 0.0])
REFLECTOR = np.array([40.0, -15.0, 230.0])  # in the flange [mm]
# What moves the tool as something that stands before it, of an arm in space with a free tool.
LEFT = {
    "zero_error[1]": "the base",
    "zero_error[6]": "the tool",
    "origin_error[1,1]": "the base",
    "origin_error[1,2]": "the base",
    "origin_error[1,3]": "the base",
    "origin_error[2,3]": "the base",
    "origin_error[3,1]": "zero_error[2] and zero_error[3]",
    "origin_error[3,2]": "origin_error[2,2]",
    "origin_error[4,2]": "origin_error[2,2]",
    "origin_error[5,3]": "origin_error[4,3]",
    "origin_error[6,2]": "origin_error[5,2]",
    "origin_error[6,3]": "the tool",
}


def turn(axis: str, angle: np.ndarray) -> np.ndarray:
    c, s, one, none = np.cos(angle), np.sin(angle), np.ones_like(angle), np.zeros_like(angle)
    rows = {
        "x": [[one, none, none], [none, c, -s], [none, s, c]],
        "y": [[c, none, s], [none, one, none], [-s, none, c]],
        "z": [[c, -s, none], [s, c, none], [none, none, one]],
    }[axis]
    return np.moveaxis(np.array(rows), 2, 0)


def arm(joints: np.ndarray, zero: np.ndarray, origin: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Place [mm] and attitude of the flange, a product of six joints; errors in rad and mm."""
    n = LENGTHS
    nominal = [
        [0, 0, n["c1"]],
        [n["a1"], n["b"], 0],
        [0, 0, n["c2"]],
        [n["a2"], 0, 0],
        [0, 0, n["c3"]],
        [0, 0, n["c4"]],
    ]
    inner = np.radians(joints) - OFFSET + zero
    place, attitude = np.zeros((len(joints), 3)), np.tile(np.eye(3), (len(joints), 1, 1))
    for k in range(6):
        place = place + attitude @ (np.array(nominal[k]) + origin[k])
        attitude = attitude @ turn(AXES[k], inner[:, k])
    return place, attitude


def errors(seed: int, left: bool = False) -> tuple[np.ndarray, np.ndarray]:
    """Zero and origin errors; those that act as others are 0 unless `left`."""
    rng = np.random.default_rng(seed)
    zero, origin = 6e-4 * rng.normal(size=6), 0.4 * rng.normal(size=(6, 3))
    if not left:
        for name in LEFT:
            array, _, element = name.partition("[")
            place = tuple(int(n) - 1 for n in element.rstrip("]").split(","))
            (zero if array == "zero_error" else origin)[place] = 0.0
    return zero, origin


def record(
    truth: tuple[np.ndarray, np.ndarray], noise: float = 0.0, attitude: bool = True, count: int = 60
) -> PoseRecord:
    """Poses as an instrument that stands anywhere sees them; noise [mm] and [mrad]."""
    rng = np.random.default_rng(7)
    joints = rng.uniform([-70, -40, -60, -150, -90, -170], [70, 50, 40, 150, 90, 170], (count, 6))
    place, flange = arm(joints, *truth)
    base = turn("z", np.array([0.7]))[0] @ turn("x", np.array([0.2]))[0]
    place = (place + flange @ REFLECTOR) @ base.T + [2500.0, -800.0, 400.0]
    own = base @ flange @ turn("y", np.array([0.3]))[0]
    place = place + noise * rng.normal(size=place.shape)
    small = 1e-3 * noise * rng.normal(size=place.shape)
    for k, axis in enumerate("xyz"):
        own = own @ turn(axis, small[:, k])
    where = tuple(f"poses.csv:{k + 2}" for k in range(count))
    return PoseRecord("poses.csv", joints, place, own if attitude else None, where)


@pytest.fixture(scope="module")
def plan():
    return machine("robot6").plan()


def of_truth(truth: tuple[np.ndarray, np.ndarray]) -> dict[str, float]:
    """Errors by the names of columns."""
    names = {f"zero_error[{k + 1}]": truth[0][k] for k in range(6)}
    return names | {
        f"origin_error[{k + 1},{i + 1}]": truth[1][k, i] for k in range(6) for i in range(3)
    }


def test_errors_are_found_and_those_that_act_as_others_are_named(plan) -> None:
    truth = errors(1)
    found = arm_calibration(plan, record(truth), set=RIGID)
    assert found.after.sizes.max() < 1e-5 < 0.3 < found.before.sizes.max()
    assert np.nanmax(found.kept_back) < 1e-5
    values = of_truth(truth)
    for name, e in found.parameters.items():
        if name in LEFT:
            assert e.why == f"it acts as {LEFT[name]}", name
        elif name in values:
            scale = 1.0 if e.unit == "mm" else 1e-3
            assert e.value == pytest.approx(values[name], abs=1e-5 * scale), name
    tool = [found.parameters[f"tool {a}"].value for a in "XYZ"]
    assert tool == pytest.approx(list(REFLECTOR - [0, 0, 150.0]), abs=1e-5)
    plant = np.array(found.settings["arm.origin_error"]).reshape(6, 3)
    np.testing.assert_allclose(plant, 1e-3 * truth[1], atol=1e-8)


def test_what_acts_alike_leaves_nothing_at_the_tool(plan) -> None:
    found = arm_calibration(plan, record(errors(2, left=True)), set=RIGID)
    # a turn of joint 1 is one of the base to the first order of nothing: it is exact
    assert found.after.sizes.max() < 1e-4
    assert set(found.after.left) >= set(LEFT)


@pytest.mark.more
def test_values_are_within_their_deviations(plan) -> None:
    away = []
    for seed in range(6):
        truth = errors(seed)
        found = arm_calibration(plan, record(truth, noise=0.03), set=RIGID)
        for name, value in of_truth(truth).items():
            e = found.parameters[name]
            if e.told:
                away.append((e.value - value) / e.deviation)
        rms = np.sqrt(np.mean(found.after.places**2))
        assert rms == pytest.approx(0.03, rel=0.15)
        assert np.sqrt(np.mean(found.kept_back**2)) > np.sqrt(np.mean(found.after.sizes**2))
    assert len(away) >= 60
    assert np.abs(away).max() < 4.0
    assert 0.6 < np.sqrt(np.mean(np.square(away))) < 1.4


def test_a_joint_that_stands_still_and_a_tool_on_the_axis_leave_what_they_do_not_tell(plan) -> None:
    made = record(errors(3))
    joints = made.joints.copy()
    joints[:, 4] = 45.0
    place, flange = arm(joints, *errors(3))
    place = place + flange @ [0.0, 0.0, 230.0]
    poses = PoseRecord("poses.csv", joints, place, None, made.where)
    found = arm_calibration(plan, poses, ArmCalibrationOptions(known_base=True), set=RIGID)
    # joint 5 turns the tool by one place in its link, joint 6 moves what is fitted beside the axis
    assert "zero_error[5]" in found.parameters["origin_error[6,1]"].why
    assert found.parameters["zero_error[6]"].why == "it acts as the tool"
    # in the robot's own base its first joint and the heights of the first two are told
    assert found.parameters["zero_error[1]"].told
    assert found.parameters["origin_error[1,3]"].told
    assert found.parameters["origin_error[2,3]"].why == "it acts as origin_error[1,3]"
    assert found.after.sizes.max() < 1e-4


def test_few_poses_with_noise_tell_some_errors_to_a_size_only(plan) -> None:
    found = arm_calibration(plan, record(errors(3), 2.0, attitude=False, count=16), set=RIGID)
    whys = [e.why for e in found.parameters.values() if e.why.startswith("these poses tell it to")]
    assert whys and all(w.endswith(("mm only", "mrad only")) for w in whys)


def test_a_controller_that_is_told_meets_the_arm_better(plan) -> None:
    truth = errors(4)
    made = record(truth, attitude=False)
    found = arm_calibration(plan, made, set=RIGID)
    soft = {n.partition(".")[2]: v for n, v in found.compensated.items() if n.startswith("soft.")}
    assert {"a1", "c2", "joint_offset"} <= set(soft)
    tool = [found.known.frames.tool_place[k] + (150.0 if k == 2 else 0.0) for k in range(3)]

    def left(lengths: dict, frames) -> float:
        own = Kinematics(tool=[*frames[1], 0, 0, 0], **lengths).forward(made.joints)
        at = own[:, :3, 3] @ frames[0].base_turn.T + frames[0].base_place
        return float(np.sqrt(np.mean(np.sum((at - made.places) ** 2, axis=1))))

    # the controller's own kinematics, with what it can know, leaves what the page says
    rms = float(np.sqrt(np.mean(found.known.sizes**2)))
    assert left(soft, (found.known.frames, tool)) == pytest.approx(rms, rel=1e-6, abs=1e-6)
    assert rms < 0.5 * float(np.sqrt(np.mean(found.before.sizes**2)))
    # and the plant is where it was: nominal values and errors make it up together
    moved = {n: v for n, v in found.compensated.items() if n.startswith("arm.")}
    nominal = {"arm.zero_error": found.settings["arm.zero_error"]}
    nominal["arm.origin_error"] = found.settings["arm.origin_error"]
    both = [
        arm_calibration(plan, made, set={**RIGID, **given}).before.places
        for given in (moved, nominal)
    ]
    np.testing.assert_allclose(both[0], both[1], atol=1e-6)


def test_the_arm_is_that_of_its_fmu(plan, tmp_path: Path) -> None:
    """Poses of the FMU itself, hanging in its gears under gravity, are met to the last digit."""
    rng = np.random.default_rng(5)
    joints = np.round(rng.uniform(-60.0, 60.0, (8, 6)), 3)
    places = []
    from fmi_tools import Instance

    for q in joints:
        fmu = Instance("robot_arm", 3).initialize({"start_joint": q.tolist()})
        places.append(np.array(fmu.get("tool_position")) * 1e3)
        fmu.free()
    rows = [",".join(map(repr, map(float, [*q, *p]))) for q, p in zip(joints, places, strict=True)]
    file = tmp_path / "poses.csv"
    file.write_text("j1,j2,j3,j4,j5,j6,X [mm],Y [mm],Z [mm]\n" + "\n".join(rows) + "\n")
    poses = pose_record(file)
    found = arm_calibration(plan, poses, ArmCalibrationOptions(known_base=True, known_tool=True))
    assert found.before.sizes.max() < 1e-6


def test_a_pose_that_was_measured_wrong_is_named(plan) -> None:
    made = record(errors(1), noise=0.02)
    made.places[17] += [0.0, 0.9, 0.0]
    found = arm_calibration(plan, made, set=RIGID)
    assert len(found.notes) == 1 and "poses.csv:19" in found.notes[0]


def test_next_poses_lessen_the_deviations(plan) -> None:
    made = record(errors(1), noise=0.03, count=14)
    found = arm_calibration(plan, made, set=RIGID)
    assert len(found.next_poses) == 5
    low, high = made.joints.min(axis=0), made.joints.max(axis=0)
    assert (found.next_poses >= low - 0.1).all() and (found.next_poses <= high + 0.1).all()


GOOD = "".join(f"{k},{2 * k},3,4,5,{k * k},{100 + k},2,3\n" for k in range(9))
HEAD = "j1,j2,j3,j4,j5,j6,X [mm],Y [mm],Z [mm]\n"


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (HEAD.replace("j4", "j7") + GOOD, "j1, j2, ... wanted"),
        (HEAD.replace("Z [mm]", "height") + GOOD, "no column Z"),
        (HEAD + GOOD[:60], "poses, 8 at least"),
        (HEAD + GOOD + "1,2,3,4,5,6,7,8,\n", ":11: column 'Z': a value is missing"),
        (HEAD + GOOD + "1,2,3,4,x,6,7,8,9\n", ":11"),
        (
            HEAD.replace("\n", ",qw,qx,qy,qz\n") + GOOD.replace("\n", ",1,1,0,0\n"),
            "quaternion of length 1.414",
        ),
    ],
)
def test_wrong_poses_are_one_message(tmp_path: Path, text: str, told: str) -> None:
    file = tmp_path / "poses.csv"
    file.write_text(text)
    with pytest.raises(InputError, match=r"poses\.csv") as refused:
        pose_record(file)
    assert told in str(refused.value)


def test_a_machine_without_an_arm_is_refused() -> None:
    with pytest.raises(InputError, match="no component of it describes poses"):
        arm_calibration(machine("mill3").plan(), record(errors(1)))


def test_an_arm_of_other_joints_is_refused(plan) -> None:
    made = record(errors(1))
    short = PoseRecord("poses.csv", made.joints[:, :5], made.places)
    with pytest.raises(InputError, match="5 joints, the machine has 6"):
        arm_calibration(plan, short)
