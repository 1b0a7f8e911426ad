"""Arms from tables of their geometry, against arithmetic of the conventions and other people's."""

from pathlib import Path

import numpy as np
import pytest

from motionfmu.arms import opw_geometry, table_arm
from motionfmu.base.errors import InputError

# Puma 560 by both conventions (Corke, Robotics, Vision and Control), lengths [mm], angles [deg].
PUMA = [(672, 0, 90), (0, 431.8, 0), (150.05, 20.3, -90), (431.8, 0, 90), (0, 0, -90), (0, 0, 0)]
RANGE = "low = -170\nhigh = 170\n"


def file(folder: Path, text: str) -> Path:
    path = folder / "arm.toml"
    path.write_text(text, encoding="utf-8")
    return path


def rows(table: list[tuple[float, float, float]], more: str = RANGE) -> str:
    return "".join(f"[[joint]]\nd = {d}\na = {a}\nalpha = {t}\n{more}" for d, a, t in table)


def step(d: float, a: float, alpha: float, q: float) -> np.ndarray:
    """Denavit and Hartenberg's matrix as textbooks print it [m]."""
    c, s, ca, sa = np.cos(q), np.sin(q), np.cos(alpha), np.sin(alpha)
    return np.array([[c, -s * ca, s * sa, a * c], [s, c * ca, -c * sa, a * s],
                     [0, sa, ca, d], [0, 0, 0, 1]])  # fmt: skip


def test_dh_is_the_product_of_its_matrices(tmp_path):
    arm = table_arm(file(tmp_path, f'name = "puma"\nconvention = "dh"\n{rows(PUMA)}'))
    for q in np.random.default_rng(1).uniform(-3, 3, (50, 6)):
        frame = np.eye(4)
        for (d, a, t), angle in zip(PUMA, q, strict=True):
            frame = frame @ step(d / 1e3, a / 1e3, np.radians(t), angle)
        assert arm.forward(q) == pytest.approx(frame, abs=1e-14)
    assert arm.joints[0].low == pytest.approx(np.radians(-170.0))


def test_modified_dh_is_the_same_arm(tmp_path):
    """a and alpha of a row move to the next one; the last row's are the tool's."""
    shifted = [
        (d, a, t) for (d, _, _), (_, a, t) in zip(PUMA, [(0, 0, 0), *PUMA[:-1]], strict=True)
    ]
    one = table_arm(file(tmp_path, f'name = "puma"\nconvention = "dh"\n{rows(PUMA)}'))
    text = f'name = "puma"\nconvention = "modified_dh"\n{rows(shifted)}'
    other = table_arm(file(tmp_path, text))
    q = np.random.default_rng(2).uniform(-3, 3, (50, 6))
    assert other.forward(q) == pytest.approx(one.forward(q), abs=1e-14)
    # Its published wrist, 150.05 mm beside the arm's plane.
    assert opw_geometry(one).lengths[2] == pytest.approx(-0.15005, abs=1e-12)


def test_masses_of_dh_links_are_in_their_frames(tmp_path):
    """A pendulum of 2 kg at the end of 0.5 m: m g l, and m l2 + I at the joint."""
    text = ('name = "pendulum"\nconvention = "dh"\n[[joint]]\na = 500\nalpha = 30\nlow = -90\n'
            'high = 90\nmass = 2\ncenter = [-100, 0, 0]\n'
            "inertia = [0.1, 0.1, 0.1, 0, 0, 0]\n")  # fmt: skip
    arm = table_arm(file(tmp_path, text))
    still = np.zeros(1)
    held = arm.inverse_dynamics(still, still, still, (0, -9.81, 0))
    assert held == pytest.approx([2 * 9.81 * 0.4], rel=1e-12)
    swung = arm.inverse_dynamics(still, still, np.ones(1), (0, 0, 0))
    assert swung == pytest.approx([2 * 0.16 + 0.1], rel=1e-12)


def test_lengths_of_opw_are_an_arm(tmp_path):
    text = (
        'name = "kr6"\nconvention = "opw"\ntool = [0, 0, 100, 0, 90, 0]\n[opw]\na1 = 25\na2 = -35\n'
        "c1 = 400\nc2 = 455\nc3 = 420\nc4 = 80\noffset = [0, -90, 0, 0, 0, 0]\n"
        "sign = [-1, 1, 1, -1, 1, -1]\n" + 6 * ("[[joint]]\n" + RANGE)
    )
    arm = table_arm(file(tmp_path, text))
    found = opw_geometry(arm)  # its c4 ends at the tip, which lies 100 mm before the flange
    assert found.lengths == pytest.approx([0.025, -0.035, 0, 0.4, 0.455, 0.42, 0.18], abs=1e-12)
    assert found.signs == (-1, 1, 1, -1, 1, -1)
    # Forward at 0: 25 + 455 + 420 + 80 along x, 400 + 35 high; the tool lies 100 further.
    assert arm.forward(np.zeros(6))[:3, 3] == pytest.approx([1.08, 0.0, 0.435], abs=1e-12)


WRONG = {
    "key": ("ratoi = 3\n", "arm.toml:9: joint.0.ratoi = 3: Extra inputs are not permitted"),
    "speed": ("speed = -1\n", "arm.toml:9: joint.0.speed = -1: Input should be greater than 0"),
    "text": (
        "mass = 'heavy'\n",
        "arm.toml:9: joint.0.mass = 'heavy': Input should be a valid number",
    ),
    "kind": (
        "kind = 'ball'\n",
        "arm.toml:9: joint.0.kind = 'ball': Input should be 'revolute', 'con",
    ),
    "three": ("center = [1, 2]\n", "arm.toml:9: joint.0.center"),
}


@pytest.mark.parametrize("name", WRONG)
def test_what_is_wrong_has_its_line(tmp_path, name):
    line, told = WRONG[name]
    text = f'name = "x"\nconvention = "dh"\n{rows(PUMA[:1], RANGE + line)}'
    with pytest.raises(InputError) as error:
        table_arm(file(tmp_path, text))
    assert told in str(error.value)


@pytest.mark.parametrize(
    ("text", "told"),
    [
        ('name = "x"\nconvention = "dh"\n[[joint]]\nd = 1\n', "low and high are missing"),
        ('name = "x"\nconvention = "dh"\n[[joint]]\nlow = 5\nhigh = 5\n', "low = 5 is not below"),
        ('name = "x"\nconvention = "opw"\n[[joint]]\nlow = 1\nhigh = 2\n', "belong together"),
        ('convention = "dh"\n[[joint]]\nlow = 1\nhigh = 2\n', "name"),
        ('name = "x"\nconvention = "dh"\n', "joint"),
        ("name = \n", "arm.toml:1"),
    ],
)  # fmt: skip
def test_what_does_not_fit_together_is_told(tmp_path, text, told):
    with pytest.raises(InputError) as error:
        table_arm(file(tmp_path, text))
    assert told in str(error.value) and "arm.toml:" in str(error.value)
