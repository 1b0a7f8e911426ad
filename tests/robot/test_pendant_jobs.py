"""Jobs as pendants write them, run by the robot: positions in pulses and frames, jobs beside."""

from pathlib import Path

import numpy as np
import pytest
from fmi_tools import Instance
from numpy.typing import NDArray
from py_opw_kinematics import KinematicModel, Robot
from scipy.spatial.transform import Rotation

import motionfmu

Array = NDArray[np.float64]
RATIO = np.array([100, 120, 120, 100, 100, 80])
PULSES = RATIO * 2500 / 360  # a degree
HOME = [0.0, 20.0, 10.0, 0.0, 60.0, 0.0]
TOOLS = "TOOL 1 X=0 Y=0 Z=150 A=0 B=0 C=0\nUSER 3 X=900 Y=100 Z=300 A=0 B=0 C=90\n"
HEAD = """/JOB
//NAME {name}
//POS
///NPOS 9,0,0,0,0,0
///TOOL 1
///POSTYPE PULSE
///PULSE
{pulses}///USER 3
///POSTYPE {kind}
///RECTAN
{places}//INST
///DATE 2026/01/01 12:00
///ATTR SC,RW
///GROUP1 RB1
NOP
{text}END
"""


def position(number: int, values: list[float]) -> str:
    return f"C{number:05d}=" + ",".join(f"{x:.9f}" for x in values) + "\n"


def pulses(number: int, joints: list[float]) -> str:
    whole = np.rint(np.array(joints) * PULSES)
    return f"C{number:05d}=" + ",".join(f"{x:.0f}" for x in whole) + "\n"


def run(folder: Path) -> motionfmu.Result:
    """The controller and its card, without drives and arm."""
    (folder / "tools.points").write_text(TOOLS)
    values = {
        "soft.program": str(folder / "MAIN.JBI"),
        "soft.points": str(folder / "tools.points"),
        "soft.start_joint": HOME,
    }
    panel = ("start", "hold", "abort", "single", "reset", "override", "jog*", "teach", "replay")
    text = {
        "stop": "soft.done",
        "limit": 6.0,
        "step": 5e-5,
        "leave": [
            *(f"soft.{name}" for name in panel),
            *("card.di*", "card.ai", "card.emergency_stop", "card.drive*"),
        ],
        "component": {"soft": "soft_controller", "card": "fpga_card"},
        "connect": {"card.host_*": "soft.card_*", "soft.card_*": "card.*"},
        "set": values,
        "record": {"signals": ["soft.joint_command", "soft.error", "card.dout"], "every": 20},
    }
    return motionfmu.scenario(text).run()


def arm() -> Robot:
    lengths = {"a1": 0.15, "a2": -0.115, "b": 0, "c1": 0.445, "c2": 0.7, "c3": 0.795, "c4": 0.085}
    return Robot(KinematicModel(**lengths, offsets=(0, 0, -np.pi / 2, 0, 0, 0)), degrees=False)


def tip(joints: Array) -> tuple[Array, Array]:
    """Place [mm] and turn of the tip of tool 1 for joints [deg], by another library."""
    pose = arm().forward(tuple(np.radians(joints)))
    turn = pose.rotation.as_matrix()
    return pose.translation * 1e3 + turn[:, 2] * 150.0, turn


def joints_at_rest(result: motionfmu.Result) -> list[np.ndarray]:
    """Commanded joints [deg] wherever the arm rests for 20 ms."""
    q = np.degrees(result["soft.joint_command"])
    rests = [k for k in range(20, len(q)) if np.ptp(q[k - 20 : k + 1], axis=0).max() == 0.0]
    found: list[np.ndarray] = []
    for k in rests:
        if not found or np.abs(q[k] - found[-1]).max() > 1e-9:
            found.append(q[k])
    return found


def test_pulses_are_joints_and_a_shift_moves_them(tmp_path: Path) -> None:
    there = [10.0, 25.0, 5.0, 20.0, 50.0, -30.0]
    text = (
        "MOVJ C00000 VJ=50.00\nTIMER T=0.05\nSFTON P010\nMOVJ C00000 VJ=50.00\nTIMER T=0.05\n"
        "SFTON P010 UF#(3)\nMOVL C00000 V=200.0\nTIMER T=0.05\nSFTOF\n"
    )
    places = "P0010=10.0,0,-20.0,0,0,0\n"
    main = HEAD.format(name="MAIN", kind="BASE", pulses=pulses(0, there), places=places, text=text)
    (tmp_path / "MAIN.JBI").write_text(main)
    result = run(tmp_path)
    assert result.done_at is not None and result["soft.error"][-1] == 0, result.warnings
    rests = joints_at_rest(result)[-3:]
    exact = np.rint(np.array(there) * PULSES) / PULSES
    np.testing.assert_allclose(rests[0], exact, atol=1e-9)
    tips = [tip(q)[0] for q in rests]
    np.testing.assert_allclose(tips[1] - tips[0], [10, 0, -20], atol=1e-6)
    np.testing.assert_allclose(tips[2] - tips[0], [0, 10, -20], atol=1e-6)


@pytest.mark.parametrize("flip", [0, 1])
@pytest.mark.parametrize("four", [40.0, -150.0])
def test_the_first_number_of_rconf_is_the_side_of_joint_4(
    tmp_path: Path, flip: int, four: float
) -> None:
    """Flip is |R| <= 90 deg, whichever side joint 5 is on; of the pose's two wrists one is."""
    taken = [5.0, 20.0, 10.0, four, 50.0, 20.0]
    there, attitude = tip(np.array(taken))
    at = np.array([900.0, 100.0, 300.0])
    turn = np.array([[0.0, -1, 0], [1, 0, 0], [0, 0, 1]])  # of user frame 3
    place = turn.T @ (there - at)
    angles = Rotation.from_matrix(turn.T @ attitude).as_euler("xyz", degrees=True)
    places = f"///RCONF {flip},0,0,0,0,0,0,0\n" + position(0, [*place, *angles])
    main = HEAD.format(
        name="MAIN",
        kind="USER",
        pulses="",
        places=places,
        text="MOVJ C00000 VJ=50.00\nTIMER T=0.02\n",
    )
    (tmp_path / "MAIN.JBI").write_text(main)
    result = run(tmp_path)
    assert result.done_at is not None and result["soft.error"][-1] == 0, result.warnings
    q = np.degrees(result["soft.joint_command"][-1])
    np.testing.assert_allclose(tip(q)[0], there, atol=1e-6)
    wrapped = (q[3] + 180.0) % 360.0 - 180.0
    assert (abs(wrapped) <= 90.0) == (flip == 0)


def test_a_pulse_goes_off_by_itself(tmp_path: Path) -> None:
    """On behind its move for 50 ms, whatever else goes on; a DOUT in between ends it."""
    text = (
        "MOVJ C00000 VJ=50.00\nPULSE OT#(2) T=0.05\nPULSE OT#(3) T=0.05\nTIMER T=0.02\n"
        "DOUT OT#(3) ON\nTIMER T=0.1\n"
    )
    main = HEAD.format(name="MAIN", kind="BASE", pulses=pulses(0, HOME), places="", text=text)
    (tmp_path / "MAIN.JBI").write_text(main)
    result = run(tmp_path)
    assert result.done_at is not None and result["soft.error"][-1] == 0, result.warnings
    two, three = (result["card.dout"] >> n & 1 for n in (1, 2))
    assert np.abs(np.diff(two)).sum() == 2 and two[-1] == 0
    assert two.sum() * 1e-3 == pytest.approx(0.05, abs=2e-3)
    assert np.abs(np.diff(three)).sum() == 1 and three[-1] == 1


def test_jobs_that_are_called_lie_beside_the_program(tmp_path: Path) -> None:
    call = "MOVJ C00000 VJ=50.00\nCALL JOB:SUB-1 ARGF2\nMOVJ C00000 VJ=50.00\n"
    sub = "GETARG LB000 IARG#(1)\nFOR LB001=1 TO LB000\nMOVJ C00000 VJ=50.00\n"
    sub += "CALL JOB:LAST\nNEXT LB001\n"
    first, second = pulses(0, HOME), pulses(0, [5.0, *HOME[1:]])
    for name, where, text in (("MAIN", first, call), ("SUB-1", second, sub), ("LAST", "", "RET\n")):
        job = HEAD.format(name=name, kind="BASE", pulses=where, places="", text=text)
        (tmp_path / f"{name}.JBI").write_text(job)
    result = run(tmp_path)
    assert result.done_at is not None and result["soft.error"][-1] == 0, result.warnings
    assert result["soft.joint_command"][:, 0].max() == pytest.approx(np.radians(5.0), abs=1e-5)


@pytest.mark.parametrize(
    ("wrong", "said"),
    [
        ("MOVJ C00007 VJ=5\n", 'SUB.JBI: line 17: position not in this job "C00007"'),
        ("CALL JOB:NOBODY\n", 'SUB.JBI: line 17: no such job "NOBODY"'),
        ("ARCON\n", 'SUB.JBI: line 17: INFORM that this controller lacks "ARCON"'),
    ],
)
def test_a_wrong_line_is_told_with_its_file(tmp_path: Path, wrong: str, said: str) -> None:
    (tmp_path / "tools.points").write_text(TOOLS)
    for name, text in (("MAIN", "CALL JOB:SUB\n"), ("SUB", wrong)):
        job = HEAD.format(name=name, kind="BASE", pulses=pulses(0, HOME), places="", text=text)
        (tmp_path / f"{name}.JBI").write_text(job)
    fmu = Instance("soft_controller", 3)
    fmu.set("program", str(tmp_path / "MAIN.JBI"))
    fmu.set("points", str(tmp_path / "tools.points"))
    fmu.enter()
    assert fmu.call("ExitInitializationMode") != 0
    assert any(said in text for _, _, text in fmu.messages), fmu.messages
    fmu.free()
