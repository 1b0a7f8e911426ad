"""Arms read from URDF: against pinocchio, what is folded, which chain, what is refused."""

from pathlib import Path

import numpy as np
import pytest
from random_arms import RandomArm, worst_differences

from motionfmu.arms import urdf_arm
from motionfmu.arms.urdf_reader import urdf_text_arm
from motionfmu.base.errors import InputError

INERTIAL = '<inertial><mass value="2"/><inertia ixx="1" iyy="1" izz="1"/></inertial>'
LINK = f'<link name="{{}}">{INERTIAL}</link>'


@pytest.mark.parametrize("mimics", [False, True], ids=["free", "mimic"])
def test_kinematics_and_dynamics_are_those_of_pinocchio(mimics):
    """40 random trees with fixed links, prismatic joints and branches, 25 states each."""
    rng = np.random.default_rng(5)
    place = torque = 0.0
    seen = set()
    for _ in range(40):
        random = RandomArm(rng, joints=int(rng.integers(2, 10)), mimics=mimics)
        text = random.text()
        try:
            arm = urdf_text_arm(text, "random.urdf", f"l{random.joints}")
        except InputError as error:
            assert "nothing moves" in str(error)
            continue
        seen |= {j.kind for j in arm.joints} | {"follows" for j in arm.joints if j.follows}
        found = worst_differences(text, arm, 25, rng)
        place, torque = max(place, found[0]), max(torque, found[1])
    print(f"tip {place:.1e}, torque {torque:.1e}")
    assert place < 1e-12 and torque < 1e-12
    assert seen >= {"revolute", "continuous", "prismatic"} | ({"follows"} if mimics else set())


def chain(*joints: str, more: str = "") -> str:
    """A URDF of links l0 .. with joints between them."""
    links = "".join(LINK.format(f"l{k}") for k in range(len(joints) + 1))
    rows = "".join(
        f'<joint name="j{k}" {j}<parent link="l{k - 1}"/><child link="l{k}"/></joint>'
        for k, j in enumerate(joints, 1)
    )
    return f'<robot name="r">\n{links}\n{rows}\n{more}</robot>'


TURN = 'type="revolute"><limit lower="-1" upper="2" velocity="3" effort="4"/>'


def test_what_a_urdf_says_is_there():
    text = chain(
        'type="revolute"><origin xyz="0 0 1" rpy="0 0 1.5707963267948966"/><axis xyz="0 0 2"/>'
        '<limit lower="-1" upper="2" velocity="3" effort="4"/>'
        '<dynamics damping="0.5" friction="7"/>',
        'type="continuous"><axis xyz="0 1 0"/>',
        'type="fixed"><origin xyz="0.5 0 0"/>',
        more='<transmission name="t"><joint name="j1"/><actuator name="a"><mechanicalReduction>-50'
        '</mechanicalReduction></actuator></transmission><transmission name="u"><joint name="j2"/>'
        '<actuator name="b"><mechanicalReduction>1</mechanicalReduction></actuator></transmission>',
    )
    arm = urdf_text_arm(text, "r.urdf")
    first, second = arm.joints
    assert (arm.name, arm.base.name, arm.tip) == ("r", "l0", "l3")
    assert (first.low, first.high, first.speed, first.effort) == (-1.0, 2.0, 3.0, 4.0)
    assert (first.damping, first.friction, first.ratio, second.ratio) == (0.5, 7.0, 50.0, None)
    assert first.axis.tolist() == [0.0, 0.0, 1.0]
    assert (second.low, second.speed) == (-np.inf, np.inf)
    tip = arm.forward([0.0, 0.0])
    assert tip[:3, 3] == pytest.approx([0.0, 0.5, 1.0], abs=1e-15)
    # The last link is fixed to the one before: 4 kg, centre half way, Steiner's share.
    assert second.link.mass == 4.0
    assert second.link.center.tolist() == [0.25, 0.0, 0.0]
    assert np.diag(second.link.tensor) == pytest.approx([2.0, 2.25, 2.25], abs=1e-15)


def test_the_chain_is_that_of_the_tip():
    branch = (
        LINK.format("f") + f'<joint name="k" {TURN}<parent link="l1"/><child link="f"/></joint>'
    )
    text = chain(TURN, TURN, more=branch + '<link name="tool0"/><joint name="e" type="fixed">'
                 '<parent link="l2"/><child link="tool0"/></joint>')  # fmt: skip
    arm = urdf_text_arm(text, "r.urdf", "f")
    assert [j.name for j in arm.joints] == ["j1", "k"]
    assert any("j2 (revolute) is beside the chain: held at 0" in n for n in arm.notes)
    with pytest.raises(InputError, match="--tip one of f, tool0, or l1, where they part"):
        urdf_text_arm(text, "r.urdf")
    straight = text.replace('<link name="f">', '<link name="g"/><link name="f">').replace(
        f'<joint name="k" {TURN}', '<joint name="k" type="fixed">'
    ).replace('<link name="g"/>', "")  # fmt: skip
    arm = urdf_text_arm(straight, "r.urdf")
    assert (arm.tip, arm.joints[0].link.mass) == ("tool0", 4.0)


def test_a_joint_that_mimics_one_that_mimics():
    """Twice the first and 0.3; a tenth less that: -2 q - 0.2."""
    one = TURN + '<mimic joint="j1" multiplier="2" offset="0.3"/>'
    two = TURN + '<mimic joint="j2" multiplier="-1" offset="0.1"/>'
    arm = urdf_text_arm(chain(TURN, one, two), "r.urdf")
    assert arm.all_joints([0.5]) == pytest.approx([0.5, 1.3, -1.2], abs=1e-15)
    assert [j.name for j in arm.driven] == ["j1"]


def test_a_joint_beside_the_chain_is_held_within_its_range():
    """A slide that begins at 0.5 m: its 2 kg are there, and so is the middle of the 4 kg."""
    slide = '<axis xyz="0 0 1"/><limit lower="0.5" upper="1"/>'
    side = f'<joint name="k" type="prismatic">{slide}<parent link="l1"/><child link="f"/></joint>'
    arm = urdf_text_arm(chain(TURN, more=LINK.format("f") + side), "r.urdf", "l1")
    assert arm.joints[0].link.center == pytest.approx([0.0, 0.0, 0.25], abs=1e-15)
    assert "joint k (prismatic) is beside the chain: held at 0.5" in arm.notes


WRONG = {
    "no end": ("<robot", "r.urdf:1: no XML: unclosed token"),
    "another root": ("<sdf/>", "r.urdf:1: <sdf>: the root of a URDF is <robot>"),
    "entities": ("<!DOCTYPE a []><robot/>", "r.urdf:1: a document type is not read"),
    "xacro": (chain(TURN, more="<xacro:x/>"), "r.urdf:4: <xacro:x>: xacro is not read; expand it"),
    "no link": (chain(TURN).replace('"l1"/></', '"l7"/></'), "<joint> j1: child 'l7' is no link"),
    "two parents": (
        chain(TURN, more=f'<joint name="k" {TURN}<parent link="l0"/><child link="l1"/></joint>'),
        "<joint> k: l1 is the child of j1, too; a URDF is a tree",
    ),
    "two roots": (chain(TURN, more='<link name="x"/>'), "2 links without a parent (l0, x)"),
    "circle": (
        chain(TURN, more='<link name="x"/><link name="y"/>'
              '<joint name="a" type="fixed"><parent link="x"/><child link="y"/></joint>'
              '<joint name="b" type="fixed"><parent link="y"/><child link="x"/></joint>'),
        "stands in a circle",
    ),
    "twice": (chain(TURN, more='<link name="l1"/>'), "l1: there is one of this name on line 2"),
    "range": (chain(TURN.replace('"2"', '"-1"')), "<limit>: of joint j1: lower = -1, upper = -1"),
    "no limit": (chain('type="revolute">'), "<joint> j1: <limit> is missing"),
    "kind": (chain('type="planar">'), "type = 'planar': fixed, revolute, continuous, prismatic"),
    "axis": (chain('type="continuous"><axis xyz="0 0 0"/>'), "xyz = 0 0 0 is no direction"),
    "number": (chain(TURN + '<origin xyz="0 0"/>'), "<origin>: xyz = '0 0': 3 numbers wanted"),
    "word": (chain(TURN + '<origin xyz="0 a 0"/>'), "xyz = '0 a 0': 3 numbers wanted"),
    "nan": (chain(TURN + '<origin xyz="0 0 nan"/>'), "xyz = '0 0 nan': 3 numbers wanted"),
    "mass": (chain(TURN).replace('value="2"', 'value="-2"'), "of link l0: value = -2 is negative"),
    "inertia": (
        chain(TURN).replace('ixx="1"', 'ixx="-1"'),
        "<inertia>: of link l0: principal moments -1, 1, 1 kg·m²: none may be negative",
    ),
    "mimic": (chain(TURN + '<mimic joint="j9"/>'), "'j9' is no joint before it in the chain"),
    "ratio": (
        chain(TURN, more='<transmission name="t"><joint name="j1"/><actuator name="a">'
              "<mechanicalReduction>0</mechanicalReduction></actuator></transmission>"),
        "<mechanicalReduction>: '0': a number that is not 0 wanted",
    ),
    "geometry": (
        chain(TURN, more='<link name="v"><visual><geometry><torus/></geometry></visual></link>'
              '<joint name="w" type="fixed"><parent link="l1"/><child link="v"/></joint>'),
        "<torus>: a box, cylinder, sphere or mesh wanted",
    ),
    "nothing": (chain('type="fixed">'), "r.urdf: nothing moves between l0 and l1"),
}  # fmt: skip


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_is_told_with_its_place(name):
    text, told = WRONG[name]
    with pytest.raises(InputError) as error:
        urdf_text_arm(text, "r.urdf")
    assert told in str(error.value)
    assert str(error.value).startswith("r.urdf:")


def test_a_tensor_of_no_body_is_read_and_told():
    arm = urdf_text_arm(chain(TURN).replace('izz="1"', 'izz="3"'), "r.urdf")
    assert "link l1: no body has the principal moments 1, 1, 3 kg·m²" in " ".join(arm.notes)


def test_a_file_or_a_tip_that_is_not_there(tmp_path: Path):
    with pytest.raises(InputError, match="No such file"):
        urdf_arm(tmp_path / "none.urdf")
    file = tmp_path / "r.urdf"
    file.write_text(chain(TURN), encoding="utf-8")
    with pytest.raises(InputError, match="no link 'l9'; did you mean 'l"):
        urdf_arm(file, "l9")
