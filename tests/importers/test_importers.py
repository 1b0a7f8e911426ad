"""The demo's system in importers of other people: the project's own result, bit for bit.

A tool is run if `make importers` has installed it; FMPy always.
"""

import importers
import matrix
import numpy as np
import pytest

import motionfmu
from motionfmu.export import as_fmu, as_ssp

STEPS = 6000  # to within the first circle: all axes, pulses and interrupts are at work
TOOLS = [tool for tool in importers.tools() if tool.quick and not tool.checks]
DEMO = importers.ROOT / "scenarios" / "circle"


@pytest.fixture(scope="module")
def systems(tmp_path_factory: pytest.TempPathFactory) -> dict[importers.Case, np.ndarray]:
    """The exported system of each FMI version, its SSP, and the rows of a run here."""
    folder = tmp_path_factory.mktemp("systems")
    scenario = motionfmu.load(DEMO)
    step = scenario.document.body.step
    ran = scenario.run(stop=(STEPS + 1) * step, engine="native")
    found = {}
    for fmi in (2, 3):
        case = importers.Case("circle", fmi, folder / f"circle.fmi{fmi}.fmu")
        as_fmu(scenario, case.file, fmi, {})
        names = importers.job(case, folder).names
        found[case] = np.column_stack([importers.column(ran, name) for name in names])
        if fmi == 2:
            ssp = importers.Case("circle.ssp", 2, folder / "circle.ssp", step, tuple(names))
            as_ssp(scenario, ssp.file, 2, {})
            found[ssp] = found[case]
    return found


@pytest.mark.more
@pytest.mark.parametrize("tool", TOOLS, ids=lambda tool: tool.folder)
def test_an_exported_system_gives_the_projects_bits(
    tool: importers.Tool, systems: dict[importers.Case, np.ndarray]
) -> None:
    if missing := tool.missing():
        pytest.skip(f"{tool.name} needs {missing}")
    if tool.install and not tool.installed():
        pytest.skip(f"{tool.name} is installed by make importers")
    # FMPy's master of an SSP takes long; tests/runs/test_ssp.py has it.
    own = {c: rows for c, rows in systems.items() if c.file.suffix != ".ssp" or tool.install}
    found = list(importers.verdicts(tool, own))
    assert len(found) == len(tool.fmi) + (tool.ssp and bool(tool.install))
    told = {(v.fmu, v.fmi): v.verdict for v in found}
    assert {v for v in told.values() if not tool.why(v)} == {importers.EQUAL}, told


def test_the_page_is_what_the_command_writes_of_every_fmu() -> None:
    """A new FMU: `tests/importers/matrix.py --fmus NAME` writes its rows."""
    page = matrix.PAGE.read_text()
    assert matrix.page(matrix.merged([], page)) == page
    names = {file.parent.name for file in importers.ROOT.glob("fmus/*/fmu.toml")}
    for part in page.split("\n## FMI ")[1:]:
        rows = {line.split(" | ")[0].removeprefix("| ") for line in part.splitlines()[4:]}
        assert names == {row for row in rows if row.isidentifier()}, part[:1]


def test_a_cell_of_the_page_is_kept_until_its_tool_is_run_again() -> None:
    page = matrix.PAGE.read_text()
    tool = importers.tool("ecos")
    why = next(iter(tool.known))
    new = importers.Verdict("scope", 3, "ecos", tool.version, tool.platform, why, "ecos")
    other = matrix.page(matrix.merged([new], page))
    before, after = (
        {(v.fmu, v.fmi, v.folder): v for v in matrix.cells(text)} for text in (page, other)
    )
    assert {k for k in after if after[k] != before.get(k)} == {("scope", 3, "ecos")}
    assert after["scope", 3, "ecos"] == new and len(after) == len(before) > 300
    # Of another version of a tool, and of an FMU that nobody has run, the page tells nothing.
    less = page.replace(f"<br>{tool.version} |", "<br>0.0 |").replace("| scope |", "| scoop |")
    told = matrix.merged([], less)
    assert {v.verdict for v in told if v.folder == "ecos"} == {importers.NOT_RUN}
    assert {v.verdict for v in told if v.fmu == "scope"} == {importers.NOT_RUN}
    assert {v.fmu for v in told} == {v.fmu for v in matrix.merged([], page)}


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
    remark = "of what is no array"
    blank = rows.copy()
    blank[:, 2] = np.nan
    assert importers.compared(blank, rows, names, remark) == f"{importers.EQUAL} {remark}"
    blank[3, 0] = 0.0
    assert importers.compared(blank, rows, names, remark).endswith("from row 3 on: a")
    assert importers.compared(np.full_like(rows, np.nan), rows, names, remark) != importers.EQUAL
