"""A variable's name of an earlier version is refused with the name that it has now."""

import re
from pathlib import Path

import pytest
from conftest import ROOT

import motionfmu
from motionfmu.scenarios import fmus
from motionfmu.scenarios.former_names import RENAMED

ROWS = [
    (version, fmu, old, new)
    for version, listed in RENAMED.items()
    for fmu, names in listed.items()
    for old, new in names.items()
]


@pytest.mark.parametrize(("version", "fmu", "old", "new"), ROWS)
def test_an_fmu_has_the_new_name_alone(version: str, fmu: str, old: str, new: str) -> None:
    ports = fmus.ports(fmu)
    assert new in ports and old not in ports


@pytest.mark.parametrize(("version", "fmu", "old", "new"), ROWS)
def test_the_changelog_has_the_row(version: str, fmu: str, old: str, new: str) -> None:
    """In the version's table: the FMU, its old names and, in their order, its new ones."""
    text = (ROOT / "CHANGELOG.md").read_text().split(f"\n## {version}", 1)[1].split("\n## ", 1)[0]
    (row,) = re.findall(rf"^\| {fmu} \| (.*) \| (.*) \|$", text, re.MULTILINE)
    was, now = (re.findall(r"`(\w+)`", cell) for cell in row)
    assert (old, new) in [*zip(was, now, strict=False)]


def test_a_scenario_with_an_old_name_is_told_the_new_one(tmp_path: Path) -> None:
    (tmp_path / "scenario.toml").write_text(
        "# An axis.\n"
        'stop = 1\nstep = 1e-3\ncomponent = { axis = "hydraulic_axis" }\n'
        'leave = ["axis.*"]\nset = { "axis.load_force" = 3.0 }\n'
        'record = { signals = ["axis.position", "axis.table_sped"] }\n'
    )
    with pytest.raises(motionfmu.InputError) as told:
        motionfmu.load(tmp_path).run(stop=0.01)
    assert [line.partition("toml:")[2] for line in str(told.value).splitlines()] == [
        "6: axis.load_force: hydraulic_axis has no variable 'load_force'; since 0.2 it is 'force'",
        "7: axis.position: hydraulic_axis has no variable 'position';"
        " since 0.2 it is 'table_position'",
        "7: axis.table_sped: hydraulic_axis has no variable 'table_sped';"
        " did you mean 'table_speed'?",
    ]
