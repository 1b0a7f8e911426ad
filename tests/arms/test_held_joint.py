"""A joint of an arm of seven is held: the six that are left move as the seven would."""

from pathlib import Path

import numpy as np
import pytest
from made_arm import told
from random_arms import PinocchioChain, RandomArm
from test_arm_import import SMALL, refused

from motionfmu import run
from motionfmu.arms import held, urdf_arm
from motionfmu.arms.urdf_reader import urdf_text_arm

# The small arm with one more joint that turns in its upper arm.
ONE_MORE = """<link name="collar"/>
<joint name="collar_turn" type="revolute"><parent link="upper_arm"/>
<child link="collar"/><origin xyz="0 0.17 0.02" rpy="-1.5707963267948966 0 0"/><axis xyz="0 0 1"/>
<limit lower="-2.5" upper="2.5" velocity="4" effort="0"/></joint>"""
BEND = (
    '<parent link="upper_arm"/><child link="elbow"/><origin xyz="0 0.34 0.02"/>',
    '<parent link="collar"/><child link="elbow"/>'
    '<origin xyz="0 0 0.17" rpy="1.5707963267948966 0 0"/>',
)


@pytest.fixture(scope="module")
def seven(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A URDF of seven joints."""
    text = SMALL.read_text(encoding="utf-8")
    assert BEND[0] in text
    text = text.replace(*BEND).replace("</robot>", ONE_MORE + "</robot>")
    file = tmp_path_factory.mktemp("seven") / "seven.urdf"
    file.write_text(text, encoding="utf-8")
    return file


@pytest.mark.parametrize("k", [0, 2, 6])
def test_tips_and_torques_are_those_of_all_joints(k: int) -> None:
    """Pinocchio has the seven of a random arm; the one that is held has no rate."""
    rng = np.random.default_rng(30 + k)
    for kinds in (("revolute",), ("revolute", "prismatic")):
        text = RandomArm(rng, kinds, joints=7).text()
        whole = urdf_text_arm(text, "random.urdf", "l7")
        oracle, others = PinocchioChain(text, whole), [i for i in range(7) if i != k]
        at = 0.7
        angle = 1e3 * at if whole.joints[k].slides else np.degrees(at)
        arm = held(whole, f"{whole.joints[k].name}={float(angle)!r}")
        assert [j.name for j in arm.joints] == [whole.joints[i].name for i in others]
        for _ in range(10):
            q, v, change = rng.uniform(-2, 2, (3, 6))
            all_q, all_v, all_change = np.zeros((3, 7))
            all_q[others], all_v[others], all_change[others] = q, v, change
            all_q[k] = at
            assert arm.forward(q) == pytest.approx(oracle.tip(all_q), abs=1e-10)
            torque = oracle.torque(all_q, all_v, all_change)[others]
            found = arm.inverse_dynamics(q, v, change)
            assert found == pytest.approx(torque, abs=1e-9 * np.abs(torque).max())


def test_the_third_is_held_where_none_is_named(seven: Path) -> None:
    whole = urdf_arm(seven)
    arm = held(whole)
    assert [j.name for j in arm.joints] == ["waist", "shoulder", "bend", "roll", "pitch", "twist"]
    assert "joint collar_turn is held at 0 °" in arm.notes[-1]
    # At 0 it is the small arm.
    q = np.array([0.3, -0.4, 0.5, 0.6, -0.7, 0.8])
    assert arm.forward(q) == pytest.approx(urdf_arm(SMALL).forward(q), abs=1e-12)
    six = urdf_arm(SMALL)
    assert held(six) is six
    low = urdf_text_arm(
        seven.read_text().replace('lower="-2.5" upper="2.5"', 'lower="0.5" upper="1.5"'), "a", None
    )
    assert f"held at {np.degrees(1.0):.6g} °" in held(low).notes[-1]


def test_an_arm_of_seven_runs(seven: Path) -> None:
    folder = seven.parent / "machine"
    shown = told("import", seven, "--hold", "collar_turn=15", "-o", folder)
    assert "joint collar_turn is held at 15 °: controller and card drive six joints" in shown
    assert "driven by its axes" in shown and "six joints" in shown
    result = run.machine(folder).scenario(folder / "example.job").run()
    assert result.ok


def test_what_cannot_be_held_is_named(seven: Path, tmp_path: Path) -> None:
    shown = refused("import", seven, "--hold", "collar_turm", "-o", tmp_path / "a")
    assert "no joint collar_turm; did you mean 'collar_turn'?" in shown
    shown = refused("import", seven, "--hold", "collar_turn=150", "-o", tmp_path / "a")
    assert "beyond the range of collar_turn, -143.239 .. 143.239 °" in shown
    shown = refused("import", seven, "--hold", "collar_turn=x", "-o", tmp_path / "a")
    assert "'x' is no number" in shown
    assert not (tmp_path / "a").exists()
