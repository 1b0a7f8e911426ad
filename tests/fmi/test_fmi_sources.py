"""Packed sources in a program of somebody else's: their names, alone and side by side."""

import re
import struct
import subprocess
import zipfile
from pathlib import Path
from xml.etree import ElementTree as ET

import pytest
from conftest import ROOT
from few_cases import few
from fmi_tools import Instance
from fmpy.model_description import read_build_description

from motionfmu.base.compiler import Compiler, compiler
from motionfmu.fmu import cores
from motionfmu.fmu.sources import NAMES, shown
from motionfmu.scenarios.fmus import fmu_names, fmu_path

every_fmu = pytest.mark.parametrize("name", fmu_names())
both = pytest.mark.parametrize("fmi", (2, 3))


def extracted(name: str, fmi: int, folder: Path) -> Path:
    """The sources of an FMU, unpacked."""
    with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
        archive.extractall(folder, [n for n in archive.namelist() if n.startswith("sources/")])
    return folder / "sources"


def files_of(folder: Path) -> list[str]:
    """C files that buildDescription.xml names."""
    root = ET.parse(folder / "buildDescription.xml").getroot()
    return [row.attrib["name"] for row in root[0].iter("SourceFile")]


def plain_compiler() -> Compiler:
    """A C compiler, used without options that hide names."""
    found = compiler()
    if found is None:
        pytest.skip("there is no C compiler")
    return found


def object_of(name: str, folder: Path) -> tuple[Path, set[str]]:
    """All of an FMU's C files as one object, and the names that it shows."""
    sources = extracted(name, 3, folder)
    plain_compiler().run(
        ["-std=c11", "-ffp-contract=off", "-r", "-nostdlib", *files_of(sources), "-o", "all.o"],
        sources,
    )
    told = subprocess.run(
        ["nm", "-g", "--defined-only", sources / "all.o"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    return sources / "all.o", {line.split()[-1] for line in told.splitlines()}


@pytest.mark.parametrize("core", cores.folders(ROOT / "src"))
def test_every_name_that_a_core_shows_is_found_in_its_text(core: str) -> None:
    texts = [f.read_text() for f in cores.folders(ROOT / "src")[core].glob("*.[ch]")]
    told = subprocess.run(
        ["nm", "-g", "--defined-only", ROOT / f"build/lib{core}.a"],
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    there = {row[2] for line in told.splitlines() if len(row := line.split()) == 3}
    assert there
    assert there <= shown(texts)


@pytest.mark.parametrize(("option", "there"), [("-DOTHER", True), ("-DEL_PLAIN", False)])
def test_a_header_of_one_kind_of_machine_is_included_there_alone(
    option: str, there: bool, tmp_path: Path
) -> None:
    sources = extracted("ball_screw_axes", 3, tmp_path)
    told = subprocess.run(
        [*plain_compiler().command, "-M", "-DFMU_CORE", option, NAMES],
        cwd=sources,
        capture_output=True,
        text=True,
        check=True,
    ).stdout
    assert ("/cpuid.h" in told) == there and "stddef.h" in told


@every_fmu
def test_names_have_the_prefix_of_the_model(name: str) -> None:
    with zipfile.ZipFile(fmu_path(name)) as archive:
        text = archive.read(f"sources/{NAMES}").decode()
        identifier = re.search(r'FMU_NAME "(\w+)"', archive.read("sources/vars.h").decode())
    assert identifier is not None
    rows = re.findall(r"^#define (\w+) (\w+)$", text, re.MULTILINE)
    prefix = f"{identifier[1]}_"
    assert [new for old, new in rows if not old.startswith("FMI") and new != prefix + old] == []
    assert {new for old, new in rows if old.startswith("FMI")} == {prefix}


@every_fmu
def test_the_build_is_described_the_same_for_all_machines(name: str, tmp_path: Path) -> None:
    folder = extracted(name, 3, tmp_path)
    read_build_description(str(tmp_path), validate=True)
    root = ET.parse(folder / "buildDescription.xml").getroot()
    assert [(c.get("platform"), [lib.attrib for lib in c.iter("Library")]) for c in root] == [
        ("x86_64-linux", [{"name": "m", "external": "true"}]),
        ("aarch64-linux", [{"name": "m", "external": "true"}]),
        (None, []),
    ]
    for configuration in root:
        assert configuration[0].get("compilerOptions") == "-ffp-contract=off"
        assert all((folder / f.attrib["name"]).is_file() for f in configuration.iter("SourceFile"))


@pytest.mark.more
def test_two_fmus_are_linked_into_one_program(tmp_path: Path) -> None:
    """mcc and epcio have cores in common; both run as their libraries do."""
    objects, told, wanted = [], [], []
    for name, identifier in (("mcc", "Mcc"), ("epcio", "Epcio")):
        made, names = object_of(name, tmp_path / name)
        objects.append(made)
        assert {n for n in names if not n.startswith(f"{identifier}_")} == set()
        one = Instance(name, 3)
        reals = [n for n, v in one.variables.items() if (v.causality, v.type) == ("output", "f64")]
        rows = [f"{{{one.variables[n].refs[0]}, {one.variables[n].count}}}" for n in reals]
        told += [
            f'#define {identifier.upper()}_TOKEN "{one.description.guid}"',
            f"static const struct {{ uint32_t ref, count; }} {name}_outputs[] = "
            f"{{{', '.join(rows)}, {{0, 0}}}};",
        ]
        wanted.append(hashed(one.initialize({}), reals))
    (tmp_path / "two_fmus.h").write_text("\n".join(told) + "\n")
    headers = [f"-I{tmp_path}", f"-I{tmp_path / 'mcc/sources'}"]
    program = [ROOT / "tests/ports/two_fmus.c", *objects, "-o", "two", "-lm"]
    plain_compiler().run(["-std=c11", *headers, *program], tmp_path)
    done = subprocess.run([tmp_path / "two"], capture_output=True, text=True, check=False)
    assert (done.returncode, done.stderr) == (0, "")
    assert done.stdout.split() == wanted


def hashed(one: Instance, names: list[str]) -> str:
    """FNV-1a of outputs in ten steps."""
    found = 0xCBF29CE484222325
    for _ in range(10):
        assert one.step(1e-4) == 0
        for byte in b"".join(struct.pack("<d", x) for name in names for x in one.get(name)):
            found = (found ^ byte) * 0x100000001B3 % 2**64
    return f"{found:016x}"


@both
@pytest.mark.parametrize("name", few(("msp430_positioner", "velocity_axes"), 1))
def test_a_library_made_of_them_shows_the_functions_of_the_standard_alone(
    name: str, fmi: int, tmp_path: Path
) -> None:
    """With a compiler that has been told no more than it must."""
    folder = extracted(name, fmi, tmp_path)
    files = [f.name for f in folder.glob("*.c") if f.name in files_of_both(name)]
    plain = ["-std=c11", "-fPIC", "-shared", f"-DFMI{fmi}_OVERRIDE_FUNCTION_PREFIX"]
    plain_compiler().run([*plain, *files, "-o", "made.so", "-lm"], folder)
    assert exported(folder / "made.so") == exported_by_the_fmu(name, fmi, tmp_path)


def files_of_both(name: str) -> set[str]:
    with zipfile.ZipFile(fmu_path(name)) as archive:
        root = ET.fromstring(archive.read("sources/buildDescription.xml"))
    return {row.attrib["name"] for row in root[0].iter("SourceFile")}


def exported(library: Path) -> set[str]:
    """Names that a shared library shows."""
    told = subprocess.run(
        ["nm", "-D", "--defined-only", library], capture_output=True, text=True, check=True
    ).stdout
    return {line.split()[-1] for line in told.splitlines()}


def exported_by_the_fmu(name: str, fmi: int, folder: Path) -> set[str]:
    with zipfile.ZipFile(fmu_path(name, fmi)) as archive:
        binary = next(n for n in archive.namelist() if re.fullmatch(r"binaries/.*\.so", n))
        return exported(Path(archive.extract(binary, folder)))
