"""A scenario as an SSP: what the file says, by its schemas, and what FMPy's master makes of it."""

import sys
import zipfile
from pathlib import Path
from typing import Any

import fmpy
import numpy as np
import pyssp_standard
import pytest
from conftest import FMUS, ROOT
from fmpy.ssp.simulation import simulate_ssp
from fmpy.ssp.ssd import read_ssd
from lxml import etree
from pyssp_standard.ssp import SSP

import motionfmu
from motionfmu import cli
from motionfmu.base.errors import InputError
from motionfmu.export import as_ssp, system_ssp
from motionfmu.export.stimuli import stimuli
from motionfmu.run.run_plan import Options

SCENARIOS = sorted(p.parent.name for p in (ROOT / "scenarios").glob("*/scenario.toml"))
STOP, STEP = 0.06, 1e-4  # [s]
NAMES = {"ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription"}
NAMES["ssc"] = "http://ssp-standard.org/SSP1/SystemStructureCommon"
NAMES["ssv"] = "http://ssp-standard.org/SSP1/SystemStructureParameterValues"


def schema(kind: str, fmi: int) -> etree.XMLSchema:
    """That of the Modelica Association, as installed packages have it."""
    package, folder = (fmpy, "ssp/schema") if fmi == 2 else (pyssp_standard, "resources/ssp2")
    place = Path(str(package.__file__)).parent
    return etree.XMLSchema(file=str(place / folder / f"SystemStructure{kind}.xsd"))


@pytest.fixture(scope="module")
def demo() -> motionfmu.Scenario:
    return motionfmu.load(ROOT / "scenarios/circle")


@pytest.fixture(scope="module", params=[2, 3])
def made(
    request: Any, demo: motionfmu.Scenario, tmp_path_factory: pytest.TempPathFactory
) -> tuple[int, Path]:
    file = tmp_path_factory.mktemp("ssp") / f"circle{request.param}.ssp"
    written = as_ssp(demo, file, request.param, {"mcc.p_gain": 150, "machine.backlash": 1e-5})
    assert (written.components, written.left_out) == (4, [])
    return request.param, file


def inside(file: Path, name: str) -> Any:
    with zipfile.ZipFile(file) as archive:
        return etree.fromstring(archive.read(name))


def test_the_file_is_as_its_schemas_want_it(made: tuple[int, Path]) -> None:
    fmi, file = made
    schema("Description", fmi).assertValid(inside(file, "SystemStructure.ssd"))
    for part in ("mcc", "card", "drives", "machine"):
        schema("ParameterValues", fmi).assertValid(inside(file, f"resources/{part}.ssv"))


@pytest.mark.parametrize("name", SCENARIOS)
def test_every_scenario_has_a_structure_by_the_schema(name: str) -> None:
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    system = scenario.resolved(Options())
    for fmi in (2, 3):
        driving, _ = stimuli(system)
        made = system_ssp._structure(scenario, system, scenario.ends, driving, fmi)
        schema("Description", fmi).assertValid(
            etree.fromstring(system_ssp.ssp.description(made, {}))
        )
        wired = {(c.target[0], c.target[1]) for c in made.connections}
        inputs = {
            (c.name, k.name) for c in made.components for k in c.connectors if k.kind == "input"
        }
        assert wired == inputs


def test_it_has_wires_values_units_times_and_files(made: tuple[int, Path]) -> None:
    fmi, file = made
    root = inside(file, "SystemStructure.ssd")
    assert root.get("version") == {2: "1.0", 3: "2.0"}[fmi]
    wires = root.findall(".//ssd:Connection", NAMES)
    assert len(wires) == {2: 238, 3: 39}[fmi]
    torque = {2: "torque[1]", 3: "torque"}[fmi]
    found = [w.attrib for w in wires if w.get("startConnector") == torque]
    assert found[0]["endConnector"] == torque.replace("torque", "torque_command")
    row = root.find(f".//ssd:Connector[@name='{torque}']", NAMES)
    assert row.get("kind") == "output" and row[0].get("unit") == "N.m"
    assert [s.get("size") for s in row.findall("ssc:Dimension", NAMES)] == (
        [] if fmi == 2 else ["6"]
    )
    unit = root.find("ssd:Units/ssc:Unit[@name='N.m']/ssc:BaseUnit", NAMES)
    assert dict(unit.attrib) == {"kg": "1", "m": "2", "s": "-2"}
    assert root.find("ssd:DefaultExperiment", NAMES).get("stopTime") == "8.0"
    step = root.find(".//{http://opensimulationplatform.com/SSP/OSPAnnotations}FixedStepAlgorithm")
    assert step.get("baseStepSize") == "0.0001"
    values = inside(file, "resources/mcc.ssv")
    gain = values.find(f".//ssv:Parameter[@name='p_gain{'[6]' if fmi == 2 else ''}']", NAMES)[0]
    assert gain.get("value") == ("150" if fmi == 2 else "150 150 150 150 150 150")
    program = values.find(".//ssv:Parameter[@name='program']/ssv:String", NAMES)
    assert program.get("value") == "resource:circle.ngc"
    with zipfile.ZipFile(file) as archive, archive.open("resources/mcc.fmu") as fmu:
        with zipfile.ZipFile(fmu) as inner:
            text = inner.read("resources/circle.ngc")
    assert text == (ROOT / "scenarios/circle/circle.ngc").read_bytes()


def test_another_reader_finds_the_same(made: tuple[int, Path]) -> None:
    fmi, file = made
    if fmi == 2:
        system = read_ssd(str(file)).system
        assert [c.name for c in system.elements] == ["mcc", "card", "drives", "machine"]
        assert len(system.connections) == 238
        return
    with SSP(str(file), mode="r") as read, read.system_structure as ssd:
        assert len(ssd.system.connections) == 39


def test_equal_input_gives_equal_bytes(demo: motionfmu.Scenario, tmp_path: Path) -> None:
    for name in ("a.ssp", "b.ssp"):
        as_ssp(demo, tmp_path / name, 2, {})
    assert (tmp_path / "a.ssp").read_bytes() == (tmp_path / "b.ssp").read_bytes()


def test_fmpy_finds_the_bits_of_a_run(demo: motionfmu.Scenario, tmp_path: Path) -> None:
    """Its master has no parameter sets, begins all wires with 0 and shows what follows a step."""
    program = tmp_path / "pärt_加工.ngc"
    program.write_bytes((ROOT / "scenarios/circle/circle.ngc").read_bytes())
    given = {"mcc.p_gain": 150, "mcc.program": str(program)}
    as_ssp(demo, tmp_path / "circle.ssp", 2, given)
    found = simulate_ssp(str(tmp_path / "circle.ssp"), stop_time=STOP - 1.5 * STEP, step_size=STEP)
    run = demo.run(stop=STOP, set=given)
    assert len(found) == len(run.time) - 1 and np.ptp(run["machine.table_position"]) > 1e-4
    for name in ("machine.table_position", "card.pulse_count", "card.dac", "drives.torque"):
        for k in range(2):
            column = found[f"{name}[{k + 1}]"].astype(run[name].dtype)
            assert column.tobytes() == np.ascontiguousarray(run[name][1:, k]).tobytes(), name


def test_driven_inputs_have_an_fmu_that_drives_them(tmp_path: Path) -> None:
    scenario = motionfmu.load(ROOT / "scenarios/hydraulic_load")
    at, value = [0.01, 0.02, 0.03], [4000.0, -2000.0, 0.0]
    scenario = scenario.changed(drive=[{"input": "axis.force", "at": at, "value": value}])
    written = as_ssp(scenario, tmp_path / "x.ssp", 2, {})
    assert (written.components, written.left_out) == (3, [])
    stop = 0.05
    found = simulate_ssp(str(tmp_path / "x.ssp"), stop_time=stop - 1.5 * STEP, step_size=STEP)
    position = scenario.run(stop=stop)["axis.table_position"]
    assert found["axis.table_position"].tobytes() == position[1:].tobytes()
    still = scenario.changed(drive=[], set={"axis.force": 0.0}).run(stop=stop)
    assert not np.array_equal(still["axis.table_position"], position)


def test_what_a_file_cannot_say_is_told(demo: motionfmu.Scenario, tmp_path: Path) -> None:
    drive = [{"input": "mcc.cycle_start", "at": [0.01], "value": [True]}]
    scenario = demo.changed(drive=drive, stop="mcc.done", limit=1.0)
    assert as_ssp(scenario, tmp_path / "y.ssp", 2, {}).left_out == [
        "[[drive]] mcc.cycle_start: no wire of an SSP leads to a parameter",
        "stop = mcc.done: an SSP ends by time, here by limit",
    ]


def test_the_command_says_what_it_made(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command = ["motionfmu", "export", str(ROOT / "scenarios/mismatch_line"), "--ssp"]
    monkeypatch.setattr(sys, "argv", [*command, "--inner", "mcc.hold", "--inner", "card.irq_*"])
    cli.main()
    said = capsys.readouterr().out
    assert said.startswith("mismatch_line.ssp: SSP 1.0, FMI 2, ") and "steps of 0.0001 s" in said
    root = inside(tmp_path / "mismatch_line.ssp", "SystemStructure.ssd")
    names = {c.get("name") for c in root.findall(".//ssd:Connector", NAMES)}
    assert {"hold", "irq_flags[9]"} < names and "override" not in names
    monkeypatch.setattr(sys, "argv", [*command, "--inner", "mcc.hlod"])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 2 and "did you mean 'mcc.hold'" in capsys.readouterr().err


def test_a_version_of_fmi_that_is_not(demo: motionfmu.Scenario, tmp_path: Path) -> None:
    with pytest.raises(InputError, match="FMI 1: 2 or 3"):
        as_ssp(demo, tmp_path / "x.ssp", 1, {})


def test_a_component_of_fmi_3_alone_is_named(demo: motionfmu.Scenario, tmp_path: Path) -> None:
    own = demo.changed(component={"drives": str(FMUS / "servo_drives.fmi3.fmu")})
    with pytest.raises(InputError, match=r"drives is FMI 3, which no SSP 1\.0 has: --fmi 3$"):
        as_ssp(own, tmp_path / "x.ssp", 2, {})
    assert not (tmp_path / "x.ssp").exists()
