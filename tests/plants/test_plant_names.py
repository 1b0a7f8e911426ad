"""Whatever drives a table or a motor, what is the same has one name and one unit in all plants."""

import zipfile
from collections import defaultdict
from collections.abc import Iterable
from xml.etree import ElementTree as ET

from conftest import FMUS, ROOT

# FMU, name, unit, description of a variable.
Row = tuple[str, str, str, str]


def rows() -> list[Row]:
    """All variables of the FMUs that are made of a Modelica class."""
    found = []
    for file in sorted(ROOT.glob("fmus/*/fmu.toml")):
        if "\nmodelica " not in file.read_text():
            continue
        fmu = file.parent.name
        with zipfile.ZipFile(FMUS / f"{fmu}.fmi3.fmu") as archive:
            variables = ET.fromstring(archive.read("modelDescription.xml")).find("ModelVariables")
        assert variables is not None
        for v in variables:
            told = (v.get(key, "") for key in ("name", "unit", "description"))
            found.append((fmu, *told))
    return found


def differing(all_rows: Iterable[Row]) -> list[set[tuple[str, str]]]:
    """Names and units that mean the same by name, or by description, and are not one."""
    groups: dict[str, set[tuple[str, str]]] = defaultdict(set)
    for _, name, unit, description in all_rows:
        groups[f"name {name}"].add((name, unit))
        groups[description].add((name, unit))
    return [pairs for pairs in groups.values() if len(pairs) > 1]


def test_one_quantity_has_one_name_and_unit_in_all_plants() -> None:
    told = rows()
    assert len({fmu for fmu, *_ in told}) >= 5
    assert differing(told) == []


def test_two_names_and_two_units_are_found() -> None:
    scale = [("a", "load_phase", "1", "Scale"), ("b", "table_phase", "1", "Scale")]
    assert differing(scale) == [{("load_phase", "1"), ("table_phase", "1")}]
    lead = [("a", "lead", "m", "Travel per turn"), ("b", "lead", "mm", "Travel of a turn")]
    assert differing(lead) == [{("lead", "m"), ("lead", "mm")}]
