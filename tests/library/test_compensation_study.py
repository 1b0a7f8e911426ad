"""The study of screw compensation: its ISO 230-2 figures, and a short version of it."""

import importlib.util
import math
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from conftest import ROOT

FOLDER = ROOT / "scenarios/compensation"


@pytest.fixture(scope="module")
def study() -> ModuleType:
    spec = importlib.util.spec_from_file_location("compensation_study", FOLDER / "study.py")
    assert spec and spec.loader
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_a_screw_is_identified_and_compensated(study, tmp_path: Path) -> None:
    """Backlash 15 um, wave of 6 um over 130 mm, 45 um/m; table points 20 mm apart."""
    table = study.measure(study.grid(60.0), 2, None)
    study.write_table(table, tmp_path / "screw.csv")
    assert 13.5e-3 < table.figures()["B"] < 15.0e-3
    # the slope, and the first crest and trough of the wave
    x, mean = table.targets, sum(table.means) / 2.0
    expected = 45e-6 * x + 6e-3 * np.sin(2.0 * np.pi * x / 130.0)
    assert mean - mean[x == 0.0] == pytest.approx(expected, abs=0.05e-3)
    targets = study.between(60.0)
    before = study.measure(targets, 2, None).figures()
    after = study.measure(targets, 2, tmp_path / "screw.csv").figures()
    assert 27e-3 < before["A"] < 30e-3
    # What is left is the wave beside its chord, 6 um (1 - cos(pi 20/130)), and a pulse of 0.2 um.
    chord = 6e-3 * (1.0 - math.cos(math.pi * 20.0 / 130.0))
    assert chord < after["A"] < 2.0 * chord + 0.4e-3
    assert 0.0 < after["B"] < 0.4e-3
    assert 0.0 < after["M"] < 2.0 * chord + 0.2e-3


def test_the_table_of_the_scenario_is_the_studys(study) -> None:
    rows = (FOLDER / "screw.csv").read_text().splitlines()[4:]
    home = [int(n) for n in rows[10].split(",")]
    assert len(rows) == len(study.grid()) == 21
    assert home[:3] == [1, 10, 0] and -75 < home[3] < -68
