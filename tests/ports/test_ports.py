"""The FMUs of `make export`: what their libraries are, and that they run as those of this machine.

MOTIONFMU_EXPORTED names another folder than build/export/fmus.
"""

import os
import re
import shutil
import subprocess
import zipfile
from collections.abc import Callable
from pathlib import Path

import bits
import fmpy
import pytest
from binary import library, mac_faults, pe, standard
from conftest import ROOT

from motionfmu.base.platforms import PLATFORMS, Platform, here, universal

EXPORTED = Path(os.environ.get("MOTIONFMU_EXPORTED", ROOT / "build/export/fmus"))
FMUS = sorted(EXPORTED.glob("*.fmu"))
NEWEST_GLIBC = (2, 17)
MADE = "make export has not run"
every_fmu = pytest.mark.parametrize("fmu", FMUS or [Path("none")], ids=lambda f: f.stem)


def exported(test: Callable[..., None]) -> Callable[..., None]:
    """A test that looks at exports."""
    return pytest.mark.more(pytest.mark.skipif(not FMUS, reason=MADE)(test))


@exported
@every_fmu
def test_an_archive_has_all_platforms(fmu: Path) -> None:
    fmi = int(fmu.stem[-1])
    with zipfile.ZipFile(fmu) as archive:
        folders = {n.split("/")[1] for n in archive.namelist() if n.startswith("binaries/")}
    two = {"linux64", "aarch64-linux", "win64", "darwin64"}
    assert folders == (two if fmi == 2 else {p.name for p in PLATFORMS})


@exported
@every_fmu
def test_linux_libraries_load_where_glibc_is_old(fmu: Path, tmp_path: Path) -> None:
    for platform in PLATFORMS[:2]:
        file = tmp_path / platform.name
        file.write_bytes(library(fmu, int(fmu.stem[-1]), platform))
        told = subprocess.run(
            ["readelf", "-W", "--dyn-syms", "-V", file], capture_output=True, text=True, check=True
        ).stdout
        versions = {tuple(map(int, v.split("."))) for v in re.findall(r"GLIBC_([\d.]+)", told)}
        assert versions and max(versions) <= NEWEST_GLIBC, versions
        rows = [line.split() for line in told.splitlines()]
        defined = [
            r for r in rows if len(r) == 8 and r[4] == "GLOBAL" and r[6] not in ("UND", "Ndx")
        ]
        assert {r[7].split("@")[0] for r in defined} == standard(int(fmu.stem[-1]))


@exported
@every_fmu
def test_a_windows_library_shows_the_standard_and_loads_what_windows_has(fmu: Path) -> None:
    found = pe(library(fmu, int(fmu.stem[-1]), Platform("x86_64-windows")))
    assert found.machine == 0x8664
    assert found.made == 0  # else each build has other bytes
    assert found.shown == standard(int(fmu.stem[-1]))
    assert all(re.match(r"api-ms-win-crt-|KERNEL32|ntdll", name) for name in found.loaded)


@exported
@every_fmu
def test_mac_libraries(fmu: Path) -> None:
    """Symbols, name, oldest system and signature, which a Mac with an ARM processor demands."""
    assert mac_faults(fmu, int(fmu.stem[-1])) == []


@exported
@every_fmu
def test_no_library_names_a_place_of_this_machine(fmu: Path) -> None:
    places = [str(ROOT), str(Path.home()), "/tmp/", str(Path.cwd()), ".cache", ".zig-cache"]
    for platform in PLATFORMS:
        data = library(fmu, int(fmu.stem[-1]), platform)
        assert [p for p in places if len(p) > 1 and p.encode() in data] == []


@exported
@every_fmu
@pytest.mark.parametrize(
    "platform", [p for p in PLATFORMS if p.name in bits.RUNNERS], ids=lambda p: p.name
)
def test_other_platforms_give_the_same_bits(fmu: Path, platform: Platform, tmp_path: Path) -> None:
    if why := bits.missing(platform):
        pytest.skip(why)
    job = bits.Job(40, step_of(fmu), given(fmu, tmp_path), driven(fmu))
    there, other = (bits.hashes(fmu, p, job, tmp_path) for p in (here(), platform))
    assert len(there) == job.steps + 1
    assert bits.different(there, other) == ""


def step_of(fmu: Path) -> float:
    """The default communication step [s]."""
    d = fmpy.read_model_description(str(fmu), validate=False)
    return float(d.defaultExperiment.stepSize)


def driven(fmu: Path) -> dict[str, list[float]]:
    """Numbers for all real inputs, within their limits: else most outputs stay 0."""
    d = fmpy.read_model_description(str(fmu), validate=False)
    found: dict[str, list[float]] = {}
    for v in d.modelVariables:
        if v.causality == "input" and v.type in ("Real", "Float64"):
            low, high = (float(x) if x else limit for x, limit in ((v.min, -1e9), (v.max, 1e9)))
            numbers = [0.7 + 0.1 * (len(found) + k) for k in range(bits.elements(v))]
            found[v.name] = [min(max(x, low), high) for x in numbers]
    return found


def given(fmu: Path, folder: Path) -> dict[str, str]:
    """Files that an FMU reads or writes, in the folder in which it runs."""
    d = fmpy.read_model_description(str(fmu), validate=False)
    names = {v.name for v in d.modelVariables}
    found = {}
    if "program" in names and fmu.stem.startswith("mcc."):
        (folder / "pärt.ngc").write_text("G91 G0 X0 Y0\nG1 X5 Y3 F3000\nG2 I2 J0\nM2\n")
        found["program"] = "pärt.ngc"
    if "file" in names:
        found["file"] = "trace"
    return found


@exported
@pytest.mark.parametrize("fmi", (2, 3))
@pytest.mark.parametrize("platform", [here(), Platform("x86_64-windows")], ids=lambda p: p.name)
def test_names_of_files_are_utf_8(fmi: int, platform: Platform, tmp_path: Path) -> None:
    """A part program is read, a trace written, with names that no code page of Europe has."""
    if why := bits.missing(platform):
        pytest.skip(why)
    step = 1e-3
    (tmp_path / "pärt_加工.ngc").write_text("G91 G1 X5 Y3 F3000\nM2\n")
    fmu = EXPORTED / f"mcc.fmi{fmi}.fmu"
    job = bits.Job(40, step, strings={"program": "pärt_加工.ngc"})
    bits.hashes(fmu, platform, job, tmp_path)
    with pytest.raises(subprocess.CalledProcessError) as error:
        wrong = bits.Job(1, step, strings={"program": "fehlt_加工.ngc"})
        bits.hashes(fmu, platform, wrong, tmp_path)
    assert "No such file" in error.value.stderr
    (tmp_path / "Schräge_形").mkdir()
    trace = bits.Job(3, step, strings={"file": "Schräge_形/Größe_線"})
    bits.hashes(EXPORTED / f"scope.fmi{fmi}.fmu", platform, trace, tmp_path)
    made = sorted(f.name for f in (tmp_path / "Schräge_形").iterdir())
    assert made == ["Größe_線.int.npy", "Größe_線.real.npy"]


def test_a_universal_file_has_each_library_on_a_page() -> None:
    """By a reader that is not the writer's: Debian's llvm-lipo or file, where there is one."""
    codes = [bytes.fromhex("cffaedfe") + n.to_bytes(4, "little") + bytes(k) for n, k in
             ((0x01000007, 9000), (0x0100000C, 20001))]  # fmt: skip
    made = universal(codes)
    for k, code in enumerate(codes):
        at = int.from_bytes(made[8 + 20 * k + 8 : 8 + 20 * k + 12], "big")
        assert at % 2**14 == 0
        assert made[at : at + len(code)] == code
    assert made[:8] == bytes.fromhex("cafebabe00000002")
    assert len(made) == 2**15 + len(codes[1])


@exported
@pytest.mark.skipif(shutil.which("file") is None, reason="apt-get install file")
def test_another_reader_sees_both_processors(tmp_path: Path) -> None:
    (tmp_path / "one").write_bytes(
        library(EXPORTED / "scope.fmi2.fmu", 2, Platform("x86_64-darwin"))
    )
    told = subprocess.run(["file", tmp_path / "one"], capture_output=True, text=True).stdout
    assert "universal binary with 2 architectures" in told
    assert "x86_64" in told and "arm64" in told
