"""MachineFrame against the product of its shears."""

import numpy as np
import pytest
from fmi_tools import OK, Instance

ANGLES = {"squareness_xy": 3e-4, "squareness_zx": -2e-4, "squareness_yz": 5e-4}
PLACE = [0.3, -0.2, 0.4, 1.0, 2.0, 3.0]


@pytest.mark.parametrize("fmi", [2, 3])
def test_guides_enclose_90_degrees_and_their_squareness(fmi: int) -> None:
    axes = []
    for k in range(3):
        frame = Instance("machine_frame", fmi).initialize(ANGLES)
        frame.set("axis_position", [float(i == k) for i in range(6)])
        assert frame.step(1e-4) == OK, frame.said
        axes.append(np.array(frame.get("tool_position"))[:3])
        frame.free()
    x, y, z = (a / np.linalg.norm(a) for a in axes)
    found = [np.arccos(a @ b) - np.pi / 2 for a, b in ((x, y), (z, x), (y, z))]
    # the third pair also sees the product of the two others
    assert found == pytest.approx(list(ANGLES.values()), abs=1e-7)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_square_frame_gives_its_inputs_and_all_rows_pass(fmi: int) -> None:
    frame = Instance("machine_frame", fmi).initialize({})
    frame.set("axis_position", PLACE)
    assert frame.step(1e-4) == OK, frame.said
    assert frame.get("tool_position") == PLACE
    frame.free()
