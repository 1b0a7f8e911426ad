"""Protection in the mcc FMU: refused programs and parameters, the scenario's three stops."""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from few_cases import few
from fmi_tools import ERROR, OK, Instance

import motionfmu

LIMITS = {"check_over_travel": True, "high_limit": 60.0, "low_limit": -10.0, "hot_offset": 5.0}


def start(text: str, folder: Path, **values: Any) -> tuple[int, str]:
    """Status of the initialization with a program, and what was said."""
    (folder / "part.ngc").write_text(text)
    instance = Instance("mcc", 3)
    for name, value in {"program": str(folder / "part.ngc"), **values}.items():
        assert instance.set(name, value) == OK, instance.said
    status = instance.enter() or instance.call("ExitInitializationMode")
    instance.free()
    return status, instance.said


@pytest.mark.parametrize(
    ("text", "said"),
    [
        ("G1 X55\nG1 X55.001", 'line 2: path leaves the software limits "G1 X55.001" (X to 55.001'),
        (
            "G0 Z-10.5",
            'line 1: path leaves the software limits "G0 Z-10.5" (Z to -10.5 mm, limit -',
        ),
        ("G1 X50\n\nG3 Y12 J6", '"G3 Y12 J6" (X to 56 mm, limit 55 mm)'),
        ("G28 Y56", '"G28 Y56" (Y to 56 mm, limit 55 mm)'),
    ],
)
def test_path_beyond_the_software_limits_is_named(text: str, said: str, tmp_path: Path) -> None:
    status, message = start(text, tmp_path, **LIMITS)
    assert status == ERROR and said in message
    assert start(text, tmp_path)[0] == OK


def test_arc_within_the_limits_whose_circle_is_not(tmp_path: Path) -> None:
    assert start("G1 X50\nG2 Y12 J6", tmp_path, **LIMITS)[0] == OK


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({**LIMITS, "lot_offset": 66.0}, "check_over_travel[1]: the software limits leave no way"),
        ({"max_dda_acc": 9000}, "max_dda_acc[1] = 9000: a change is at most 8190 pulses"),
    ],
)
def test_bad_protection_is_named(values: dict[str, Any], said: str, tmp_path: Path) -> None:
    status, message = start("G1 X1", tmp_path, **values)
    assert status == ERROR and said in message


@pytest.mark.parametrize("engine", few(["native", "python"], ["native"]))
def test_three_stops(engine: str) -> None:
    result = motionfmu.load(ROOT / "scenarios" / "protection").run(engine=engine)
    assert result.ok
    error = result["mcc.error"].astype(int)
    begun = error[np.flatnonzero(np.diff(error)) + 1]
    assert begun.tolist() == [0xF301, 0, 0xF102, 0, 0xF801, 0]

    pulses, place = result["card.pulse_count"][:, :2], result["mcc.position"][:, :2] * 1e3
    for at in (0.75, 2.29, 2.49, 4.9, 8.4):  # at rest
        k = round(at / 1e-4)
        assert np.abs(place[k] - pulses[k]).max() <= 0.5
        assert not (pulses[k - 200 : k + 1] - pulses[k]).any()
    speed = np.abs(np.diff(pulses[::10], axis=0)).max(axis=1)  # [pulses/ms]
    ramp = np.abs(np.diff(speed[:700])).max()
    assert ramp <= 3  # 1 mm/s per ms, and the rounding of two counts
    assert pulses[20012, 0] == pulses[22900, 0]  # stands one DDA time after the button
