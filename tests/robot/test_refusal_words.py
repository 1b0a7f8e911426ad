"""Every refusal of the robot core has its name in the binding."""

import re

from conftest import ROOT

from motionfmu.virtual.robot.refusal import STATUS

ENUM = re.search(
    r"enum robot_status \{(.*?)\};", (ROOT / "src/controllers/robot/robot.h").read_text(), re.S
)


def test_names_are_those_of_the_core() -> None:
    assert ENUM
    assert tuple(re.findall(r"^\s+ROBOT_([A-Z_]+)", ENUM[1], re.M)) == STATUS
