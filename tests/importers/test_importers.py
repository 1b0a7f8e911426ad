"""The demo's system in importers of other people: the project's own result, bit for bit.

A tool is run if `make importers` has installed it; FMPy always.
"""

from pathlib import Path

import importers
import numpy as np
import pytest

import motionfmu
from motionfmu.export import as_fmu

STEPS = 6000  # to within the first circle: all axes, pulses and interrupts are at work
TOOLS = importers.tools()
DEMO = importers.ROOT / "scenarios" / "circle"


@pytest.fixture(scope="module")
def systems(tmp_path_factory: pytest.TempPathFactory) -> dict[Path, np.ndarray]:
    """The exported system of each FMI version, and the rows of a run here."""
    folder = tmp_path_factory.mktemp("systems")
    scenario = motionfmu.load(DEMO)
    ran = scenario.run(stop=(STEPS + 1) * scenario.document.body.step, engine="native")
    found = {}
    for fmi in (2, 3):
        file = folder / f"circle.fmi{fmi}.fmu"
        as_fmu(scenario, file, fmi, {})
        names = importers.job(file, folder).names
        found[file] = np.column_stack([_column(ran, name) for name in names])
    return found


def _column(ran: motionfmu.Result, name: str) -> np.ndarray:
    whole, _, rest = name.partition("[")
    element = int(rest.removesuffix("]")) - 1 if rest else 0
    values = np.asarray(ran[whole], dtype=float)
    return values.reshape(len(values), -1)[:, element]


@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.folder)
def test_an_exported_system_gives_the_projects_bits(
    tool: importers.Tool, systems: dict[Path, np.ndarray]
) -> None:
    if not tool.quick or tool.checks:
        pytest.skip(f"{tool.name} is for make importers")
    if missing := tool.missing():
        pytest.skip(f"{tool.name} needs {missing}")
    if tool.install and not tool.installed():
        pytest.skip(f"{tool.name} is installed by make importers")
    found = list(importers.verdicts(tool, list(systems), systems))
    assert len(found) == len(tool.fmi)
    told = {f"FMI {v.fmi}": v.verdict for v in found if not tool.knows(v.verdict)}
    assert told and set(told.values()) == {importers.EQUAL}, told


def test_a_bit_is_a_difference() -> None:
    rows = np.arange(12.0).reshape(4, 3)
    other = rows.copy()
    other[2, 1] = np.nextafter(other[2, 1], np.inf)
    names = ["a", "b", "c"]
    assert importers.compared(rows, rows.copy(), names) == importers.EQUAL
    told = importers.compared(other, rows, names)
    assert told.startswith("1 outputs differ by up to 8.88e-16 from row 2 on: b")
    blank = rows.copy()
    blank[0] = np.nan
    assert importers.compared(blank, rows, names) == importers.EQUAL
    blank[1] = np.nan
    assert importers.compared(blank, rows, names) != importers.EQUAL
    assert importers.compared(rows[1:], rows, names) == "(3, 3) values for (4, 3)"
