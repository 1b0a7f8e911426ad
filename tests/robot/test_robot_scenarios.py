"""What the robot's scenarios claim, by kinematics that share no code with them."""

from pathlib import Path

import numpy as np
import py_opw_kinematics as opw
import pytest
from numpy.typing import NDArray

import motionfmu

ROOT = Path(__file__).parents[2]
PULSES = 2500 * np.array([100, 120, 120, 100, 100, 80]) / (2 * np.pi)  # [pulses/rad]


def arm() -> opw.Robot:
    lengths = {"a1": 0.15, "a2": -0.115, "b": 0, "c1": 0.445, "c2": 0.7, "c3": 0.795, "c4": 0.085}
    model = opw.KinematicModel(**lengths, offsets=(0, 0, -np.pi / 2, 0, 0, 0))
    return opw.Robot(model, degrees=False)


def tip(joints: NDArray[np.float64]) -> NDArray[np.float64]:
    """Of a tool of 150 mm [mm]."""
    robot = arm()
    poses = [robot.forward(q) for q in joints]
    return np.array([p.translation + p.rotation.as_matrix()[:, 2] * 0.15 for p in poses]) * 1e3


@pytest.fixture(scope="module")
def singular() -> motionfmu.Result:
    return motionfmu.load(ROOT / "scenarios/robot_singularity").run()


@pytest.mark.parametrize(("line", "y"), [(4, 0.0), (6, 0.1)])
def test_the_tip_keeps_its_line_through_a_singular_place(
    singular: motionfmu.Result, line: int, y: float
) -> None:
    on = np.flatnonzero((singular["soft.line"] == line) & (singular["soft.path_feed"] > 0.0))
    place = tip(singular["soft.joint_command"][on][::10])
    off = np.hypot(place[:, 0] - 1180.0, place[:, 1] - y)
    print(f"line {line}: {off.max():.2g} mm, z {place[:, 2].min():.3f} .. {place[:, 2].max():.3f}")
    assert off.max() < 1e-8
    assert np.ptp(place[:, 2]) > 299.0


def test_pulses_are_the_rounded_joints(singular: motionfmu.Result) -> None:
    want = np.rint(singular["soft.joint_command"] * PULSES)
    got = singular["card.pulse_count"] + want[0]
    # What a memory plays was told one to three rows before.
    told = np.stack([want[3 - k : len(want) - k] for k in range(4)])
    outside = np.maximum(told.min(axis=0) - got[3:], got[3:] - told.max(axis=0))
    fast = np.abs(np.diff(want, axis=0)).max()
    print(f"pulses outside by {outside.max()}, {fast} a cycle at most")
    assert outside.max() <= 1.0
    assert fast > 10.0
    assert (np.abs(got[-1] - want[-1]) <= 1.0).all()


def test_a_line_that_had_to_slow_is_refused_with_point_and_factor() -> None:
    result = motionfmu.load(ROOT / "scenarios/robot_singularity").run(set={"soft.singular": 1})
    (told,) = result.warnings
    print(told)
    assert "through.job: line 6: too near a singular place: wrist factor -0.0" in told
    assert "% of its path, X 1180 Y 0.1 Z 12" in told
    assert result["soft.error_line"][-1] == 6
    assert not result["soft.done"].any()


CHAIN = """# A program, controller and card.
stop = 6.0
step = 5e-5
leave = ["soft.start", "soft.hold", "soft.abort", "soft.single", "soft.override", "soft.jog*",
         "soft.teach", "soft.replay", "soft.reset", "card.di*", "card.ai", "card.emergency_stop",
         "card.drive_*"]

[component]
soft = "soft_controller"
card = "fpga_card"

[connect]
"card.host_*" = "soft.card_*"
"soft.card_*" = "card.*"

[record]
signals = ["soft.joint_command", "soft.status", "soft.error", "soft.error_line", "soft.done",
           "card.pulse_count", "card.stopped", "card.dropped"]
"""


def chain(folder: Path, settings: str, driven: tuple[str, ...] = ()) -> motionfmu.Scenario:
    """A scenario of its own in a folder."""
    text = CHAIN
    for name in driven:
        text = text.replace(f'"{name}",', "")
    (folder / "scenario.toml").write_text(text + settings)
    return motionfmu.load(folder)


def test_taught_points_written_and_read_lead_to_the_same_joints(tmp_path: Path) -> None:
    jog = motionfmu.load(ROOT / "scenarios/robot_jog").run(
        set={"soft.teach_file": str(tmp_path / "taught.txt")}, stop=8.5
    )
    text = (tmp_path / "taught.txt").read_text()
    assert len(text.splitlines()) == 3
    (tmp_path / "back.job").write_text("MOVJ P000\nMOVJ P001\nMOVJ P002\nEND\n")
    again = chain(
        tmp_path, '[set]\n"soft.program" = "back.job"\n"soft.points" = "taught.txt"\n'
    ).run()
    assert again["soft.done"][-1]
    for at in (2.5, 4.5, 8.0):
        taught = jog["soft.joint_command"][np.searchsorted(jog.time, at)]
        off = np.abs(again["soft.joint_command"] - taught).max(axis=1).min()
        print(f"taught at {at} s: met within {np.degrees(off):.2g} deg")
        # 1e-6 deg in the file; a row is a cycle, near rest slow.
        assert off < 1e-4 if at < 8.0 else off < 1e-7


def test_an_emergency_stop_ends_the_program_and_the_arm_is_where_the_card_counted(
    tmp_path: Path,
) -> None:
    (tmp_path / "swing.ngc").write_text("G0 X900 Y300 Z600 A180 B0 C180\nG0 X900 Y-300\nM2\n")
    scenario = chain(
        tmp_path,
        '[set]\n"soft.program" = "swing.ngc"\n'
        '[[drive]]\ninput = "card.emergency_stop"\nat = [0.5, 1.0]\nvalue = [true, false]\n'
        '[[drive]]\ninput = "soft.reset"\nat = [1.5, 1.6]\nvalue = [true, false]\n'
        '[[drive]]\ninput = "soft.start"\nat = [1.2, 1.3, 2.0, 2.1]\n'
        "value = [true, false, true, false]\n",
        ("soft.start", "soft.reset", "card.emergency_stop"),
    )
    run = scenario.run()
    row = np.searchsorted(run.time, [0.49, 0.7, 1.4, 1.9, 6.0])
    assert list(run["soft.status"][row[:4]]) == [1, 8, 8, 0]
    counted = run["card.pulse_count"][row[3]] / PULSES
    start = run["soft.joint_command"][0]
    off = np.abs(run["soft.joint_command"][row[3]] - start - counted).max()
    print(f"dropped {run['card.dropped'][row[3]]}, joints off by {np.degrees(off):.2g} deg")
    assert np.abs(run["card.dropped"][row[3]]).max() > 0
    assert off < 0.6 / PULSES.min()
    assert (run["card.pulse_count"][row[1]] == run["card.pulse_count"][row[3]]).all()
    assert run["soft.done"][-1]
    end = tip(run["soft.joint_command"][-1:])[0] - [0, 0, -150]
    np.testing.assert_allclose(end, [900, -300, 600], atol=1e-6)


@pytest.mark.parametrize(
    ("name", "program", "settings", "words"),
    [
        ("a.ngc", "G0 X900\nG1 X950 U5 F600\n", "", ["a.ngc", "line 2", "U5"]),
        ("a.ngc", "G0 X900 A180 C180\nG1 X9000 F600\n", "", ["a.ngc", "line 2", "out of reach"]),
        ("a.ngc", "G1 X900 F-600\n", "", ["a.ngc", "line 1", "F-600"]),
        ("a.job", "MOVJ P000\nMOVL P777 V=10\n", "", ["a.job", "2", "P777"]),
        ("a.job", "MOVJ P000 V=9\n", "", ["a.job", "1", "V"]),
        ("a.job", "MOVJ P000\n", '"soft.job" = "NONE"\n', ["a.job", "NONE"]),
        ("a.job", "MOVJ P000\n", '"soft.language" = "basic"\n', ["basic", "inform or gcode"]),
        (
            "a.job",
            "MOVJ P000\n",
            '"soft.joint_sign" = [1, 0, 1, 1, 1, 1]\n',
            ["joint_sign = 0 (element 2)"],
        ),
        ("a.job", "MOVJ P000\n", '"soft.bus_period" = 5.001e-5\n', ["bus_period", "25 ns"]),
    ],
)
def test_what_is_wrong_is_named_and_nothing_moves(
    tmp_path: Path, name: str, program: str, settings: str, words: list[str]
) -> None:
    (tmp_path / name).write_text(program)
    (tmp_path / "p.txt").write_text("P000 J1=10 J2=0 J3=0 J4=0 J5=90 J6=0\n")
    scenario = chain(
        tmp_path, f'[set]\n"soft.program" = "{name}"\n"soft.points" = "p.txt"\n{settings}'
    )
    with pytest.raises(motionfmu.InputError) as told:
        scenario.run(stop=0.01)
    print(told.value)
    for word in words:
        assert word in str(told.value)
