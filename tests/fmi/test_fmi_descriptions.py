"""Every FMU found: schema, rules of two validators, and the library behind the description."""

import re
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import fmpy
import pytest
from conftest import ROOT
from few_cases import few
from fmi_tools import unpacked
from fmpy.validation import validate_fmu
from fmu_manipulation_toolbox.cli.fmutool import fmutool

from motionfmu.scenarios.fmus import fmu_names, fmu_path

every_fmu = pytest.mark.parametrize("name", fmu_names())
both = pytest.mark.parametrize("fmi", (2, 3))
# FMUs with few names, some of them of arrays; in a build that has neither, each FMU there is.
SHORT = {"logic_analyser", "stimulus"}.intersection(fmu_names()) or set(fmu_names())
HEADERS = Path(fmpy.__file__).parent / "c-code"
MODEL_EXCHANGE = {  # functions that an FMI 2.0 library without model exchange need not have
    f"fmi2{name}"
    for name in (
        "EnterEventMode NewDiscreteStates EnterContinuousTimeMode CompletedIntegratorStep SetTime"
        " SetContinuousStates GetDerivatives GetEventIndicators GetContinuousStates"
        " GetNominalsOfContinuousStates"
    ).split()
}


@pytest.mark.parametrize("name", few(fmu_names(), 4))
def test_fmpy_finds_nothing_wrong(name: str) -> None:
    assert validate_fmu(str(fmu_path(name, 3))) == []


# FMPy parses each name, and in FMI 2 each element of an array has one, some hundred of one pattern.
@pytest.mark.parametrize("name", few(fmu_names(), SHORT, pytest.mark.long))
def test_fmpy_finds_nothing_wrong_in_fmi_2(name: str) -> None:
    assert validate_fmu(str(fmu_path(name, 2))) == []


@every_fmu
def test_fmpy_reads_fmi_2_by_its_rules(name: str) -> None:
    found = fmpy.read_model_description(fmu_path(name, 2), validate_model_structure=True)
    assert found.fmiVersion == "2.0"


@both
@pytest.mark.parametrize("name", few(fmu_names()[::-1], 3))
def test_fmutool_finds_nothing_wrong(
    name: str, fmi: int, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    # In this process: a start of the command takes longer than what it checks.
    monkeypatch.setattr("sys.argv", ["fmutool", "-input", str(fmu_path(name, fmi)), "-check"])
    monkeypatch.setattr("fmu_manipulation_toolbox.cli.utils.init", lambda: None)  # of colours
    fmutool()
    told = capsys.readouterr().out
    assert f"compliant with FMI-{fmi}.0" in told
    assert f"No semantic error against the FMI-{fmi} standard" in told
    assert "ERROR" not in told


@every_fmu
def test_each_description_is_read_alone(name: str) -> None:
    """A tool shows a variable by its own, in an order of its own."""
    leans = re.compile(r"(Its|Their|The same|That|Those|Of these|Longest so far)\b")
    told = {
        v.name: v.description or ""
        for v in fmpy.read_model_description(fmu_path(name)).modelVariables
    }
    assert len(told) > 5 and all(told.values())
    assert [(n, text) for n, text in told.items() if leans.match(text)] == []


@both
@every_fmu
def test_the_library_exports_the_standard_and_nothing_else(name: str, fmi: int) -> None:
    library = next(Path(unpacked(name, fmi)[1]).glob("binaries/*/*"))
    text = (HEADERS / f"fmi{fmi}Functions.h").read_text()
    wanted = set(re.findall(rf"^\s*FMI{fmi}_Export\s+\w+TYPE\s+(\w+);", text, re.MULTILINE))
    listing = subprocess.run(
        ["nm", "-D", "--defined-only", str(library)], capture_output=True, text=True, check=True
    ).stdout
    exported = {line.split()[-1] for line in listing.splitlines()}
    assert len(wanted) > 40
    assert exported == wanted - MODEL_EXCHANGE


@every_fmu
def test_both_versions_describe_the_same_variables(name: str) -> None:
    two, three = (unpacked(name, fmi)[2] for fmi in (2, 3))
    assert list(two) == list(three)
    for key, v in two.items():
        w = three[key]
        assert v.refs[0] == w.refs[0]
        assert v.refs == list(range(v.refs[0], v.refs[0] + v.count))
        for field in ("type", "causality", "variability", "count", "min", "max"):
            assert getattr(v, field) == getattr(w, field), (key, field)


@both
@every_fmu
def test_outputs_and_initial_unknowns_are_complete(name: str, fmi: int) -> None:
    folder = unpacked(name, fmi)[1]
    root = ET.parse(Path(folder, "modelDescription.xml")).getroot()
    variables = list(root.find("ModelVariables") or [])
    structure = root.find("ModelStructure")
    assert structure is not None
    if fmi == 2:
        outputs = {i for i, v in enumerate(variables, 1) if v.get("causality") == "output"}
        listed = [{int(u.attrib["index"]) for u in structure.findall(f"{t}/Unknown")}
                  for t in ("Outputs", "InitialUnknowns")]  # fmt: skip
    else:
        outputs = {
            int(v.attrib["valueReference"]) for v in variables if v.get("causality") == "output"
        }
        listed = [{int(u.attrib["valueReference"]) for u in structure.findall(t)}
                  for t in ("Output", "InitialUnknown")]  # fmt: skip
    assert outputs
    assert listed[0] == outputs
    assert listed[1] >= outputs


@both
@every_fmu
def test_documents_and_sources_are_packed(name: str, fmi: int) -> None:
    with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
        names = archive.namelist()
        assert names == sorted(names)
        assert {i.date_time for i in archive.infolist()} == {(1980, 1, 1, 0, 0, 0)}
    assert "documentation/README.md" in names
    assert "sources/fmu_main.c" in names
    assert ("sources/buildDescription.xml" in names) == (fmi == 3)


def symbols(file: Path) -> set[str]:
    """What is defined in a library."""
    listing = subprocess.run(["nm", "--defined-only", file], capture_output=True, text=True)
    return {line.split()[-1] for line in listing.stdout.splitlines() if len(line.split()) == 3}


@every_fmu
def test_an_archive_carries_little_that_its_library_is_not_linked_from(name: str) -> None:
    library = symbols(ROOT / f"build/lib/{name}_fmi3.so")
    with zipfile.ZipFile(fmu_path(name, 3)) as archive:
        packed = {Path(n).name: archive.read(n) for n in archive.namelist() if n.endswith(".c")}
    elementary = {f.name for f in ROOT.glob("src/base/elementary/*.c")}  # comes whole, 30 kB packed
    files = packed.keys() - elementary - {"model.c", "fmu_main.c", "vars.c"}
    begins = re.compile(r"^[a-zA-Z][\w \*]*?\b(\w+)\([^;{]*\)\n\{", re.MULTILINE)
    spare = [f for f in files if not set(begins.findall(packed[f].decode())) & library]
    assert len(spare) <= 4, spare
