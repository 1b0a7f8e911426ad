"""The demo's SSP, and an FMU with its program inside, here and under wine: the bits of a run here.

A small master of its own reads the SSP: there is no importer for Windows that a registry has.
"""

import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import bits
import pytest
from conftest import ROOT
from few_cases import few
from test_ports import EXPORTED, exported

import motionfmu
from motionfmu.base.platforms import Platform, here
from motionfmu.export import as_ssp
from motionfmu.export.single_fmu import packed

SOURCE = Path(__file__).with_name("coupled_bits.c")
WINDOWS = Platform("x86_64-windows")
STEPS, STEP = 1200, 1e-4
NAMES = {
    "ssd": "http://ssp-standard.org/SSP1/SystemStructureDescription",
    "ssv": "http://ssp-standard.org/SSP1/SystemStructureParameterValues",
}
KINDS = {"Real": "real", "Integer": "int", "Boolean": "bool", "String": "string"}
SHOWN = {"d": "Real", "i": "Integer", "b": "Boolean"}
TABLE = [f"table_position[{k}]" for k in range(1, 7)]
platforms = pytest.mark.parametrize("platform", [here(), WINDOWS], ids=lambda p: p.name)


def demo(folder: Path) -> Path:
    """The SSP 1.0 of the demo, whose program has a name that no code page of Europe has."""
    program = folder / "pärt_加工.ngc"
    program.write_bytes((ROOT / "scenarios/circle/circle.ngc").read_bytes())
    scenario = motionfmu.load(ROOT / "scenarios/circle")
    as_ssp(scenario, folder / "demo.ssp", 2, {"mcc.program": str(program)})
    program.unlink()
    return folder / "demo.ssp"


def coupled(ssp: Path, platform: Platform, folder: Path) -> list[str]:
    """Hashes of the table's position at each communication point, by what the SSP says."""
    place = folder / platform.name
    with zipfile.ZipFile(ssp) as archive:
        archive.extractall(place)
    root = ET.parse(place / "SystemStructure.ssd").getroot()
    numbers: dict[str, int] = {}
    references: dict[tuple[str, str], tuple[int, str]] = {}
    arguments = ["2", f"{platform.name}/wires.txt"]
    for component in root.iterfind(".//ssd:Component", NAMES):
        name = component.attrib["name"]
        inner = place / name
        with zipfile.ZipFile(place / component.attrib["source"]) as archive:
            archive.extractall(inner)
        shown = TABLE if name == "machine" else ["none"]
        rows, _, identifier = bits.job_rows(inner, bits.Job(STEPS, STEP, shown=shown))
        for v in ET.parse(inner / "modelDescription.xml").iterfind(".//ScalarVariable"):
            references[name, v.attrib["name"]] = int(v.attrib["valueReference"]), v[0].tag
        for binding in component.iterfind(".//ssd:ParameterBinding", NAMES):
            for parameter in ET.parse(place / binding.attrib["source"]).iterfind(
                ".//ssv:Parameter", NAMES
            ):
                kind = KINDS[parameter[0].tag.rpartition("}")[2]]
                text = parameter[0].attrib["value"]
                text = {"true": "1", "false": "0"}.get(text, text) if kind == "bool" else text
                rows += f"{kind} {references[name, parameter.attrib['name']][0]} {text}\n"
        (inner / "job.txt").write_text(rows, encoding="utf-8")
        binaries = inner / "binaries" / platform.folder(2)
        library = next(binaries.glob(f"{identifier}.*")).relative_to(folder)
        arguments += [str(library), f"{platform.name}/{name}/job.txt"]
        numbers[name] = len(numbers)
    wires = ""
    for wire in root.iterfind(".//ssd:Connection", NAMES):
        ends = [
            (wire.attrib[f"{e}Element"], wire.attrib[f"{e}Connector"]) for e in ("start", "end")
        ]
        (a, kind), (b, other) = (references[e] for e in ends)
        assert kind == other
        letter = next(k for k, v in SHOWN.items() if v == kind)
        wires += f"{letter} {numbers[ends[0][0]]} {a} 1 {numbers[ends[1][0]]} {b}\n"
    (place / "wires.txt").write_text(wires)
    lines = bits.ran(bits.program(platform, SOURCE), platform, arguments, folder)
    return [line.split()[1] for line in lines[len(numbers) - 1 :: len(numbers)]]


@exported
@platforms
def test_the_ssp_of_the_demo_has_the_bits_of_a_run(
    platform: Platform, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    if why := bits.missing(platform):
        pytest.skip(why)
    run = motionfmu.load(ROOT / "scenarios/circle").run(stop=STEPS * STEP)
    wanted = [bits.hash_of(row.tobytes()) for row in run["machine.table_position"]]
    assert len(set(wanted)) > STEPS / 2
    monkeypatch.setenv("MOTIONFMU_FMUS", str(EXPORTED))
    assert coupled(demo(tmp_path), platform, tmp_path) == wanted


@exported
@pytest.mark.parametrize(
    "platform", few([here(), WINDOWS], 1, pytest.mark.long), ids=lambda p: p.name
)
def test_a_packed_program_runs_from_its_resources(
    platform: Platform, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Without a call that names it: a job gives no text. Another program has other bits."""
    if why := bits.missing(platform):
        pytest.skip(why)
    monkeypatch.setenv("MOTIONFMU_FMUS", str(EXPORTED))
    found = []
    for k, way in enumerate(("X5 Y3", "X0.01")):
        program = tmp_path / "pärt_加工.ngc"
        program.write_text(f"G91 G0 X0 Y0\nG1 {way} F3000\nM2\n")
        target = tmp_path / f"mcc{k}.fmu"
        packed("mcc", target, 2, {"program": str(program), "dry_run": True})
        program.unlink()
        job = bits.Job(50, 1e-3, shown=["queue", "error"])
        found.append([bits.hashes(target, p, job, tmp_path) for p in (here(), platform)])
    assert found[0][0] == found[0][1] and found[1][0] == found[1][1]
    assert found[0][0][-1] != found[1][0][-1]
    wrong = bits.Job(1, 1e-3, strings={"program": "resource:fehlt.ngc"})
    with pytest.raises(subprocess.CalledProcessError) as error:
        bits.hashes(target, platform, wrong, tmp_path)
    assert "there are: pärt_加工.ngc" in error.value.stderr
