"""Names of files on Windows, and here: in UTF-8, longer than 260 characters, two for one file."""

import os
import subprocess
import tomllib
from pathlib import Path

import bits
import pytest
from conftest import ROOT
from test_ports import EXPORTED, exported

from motionfmu.base.platforms import Platform, here

PLATFORMS = (here(), Platform("x86_64-windows"))
STEP = 1e-3  # [s]


def named(use: str) -> list[tuple[str, str]]:
    """FMUs and their parameters that name a file that is read, or written."""
    found = []
    for toml in sorted((ROOT / "fmus").glob("*/fmu.toml")):
        rows = tomllib.loads(toml.read_text()).get("parameter", {})
        found += [(toml.parent.name, key) for key, row in rows.items() if row.get("file") == use]
    return found


def run(name: str, strings: dict[str, str], platform: Platform, folder: Path) -> str:
    """What an FMU complains of."""
    if why := bits.missing(platform):
        pytest.skip(why)
    try:
        bits.hashes(EXPORTED / f"{name}.fmi3.fmu", platform, bits.Job(3, STEP, strings), folder)
    except subprocess.CalledProcessError as error:
        return str(error.stderr)
    return ""


@exported
@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda p: p.name)
@pytest.mark.parametrize(("name", "key"), named("read"))
def test_a_file_that_is_read(name: str, key: str, platform: Platform, tmp_path: Path) -> None:
    """One that is there is found, whatever is in it; one that is not is told by its name."""
    (tmp_path / "pärt_加工").write_text("")
    told = run(name, {key: "pärt_加工"}, platform, tmp_path)
    assert "No such file" not in told
    told = run(name, {key: "fehlt_加工"}, platform, tmp_path)
    assert "fehlt_加工" in told and "No such file" in told


@exported
@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda p: p.name)
@pytest.mark.parametrize(("name", "key"), named("written"))
def test_a_file_that_is_written(name: str, key: str, platform: Platform, tmp_path: Path) -> None:
    (tmp_path / "part").write_text("M2\n")
    begin = {"mcc": {"program": "part"}}.get(name, {})
    assert run(name, begin | {key: "Größe_線"}, platform, tmp_path) == ""
    assert [f for f in tmp_path.iterdir() if f.name.startswith("Größe_線")]


@exported
@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda p: p.name)
@pytest.mark.parametrize("root", (False, True), ids=("relative", "whole"))
def test_long_names(root: bool, platform: Platform, tmp_path: Path) -> None:
    """A program is read from, a trace and a path written to a folder of 400 characters."""
    deep = Path(*("Länge_" + "x" * 74 for _ in range(5)))
    (tmp_path / deep).mkdir(parents=True)
    (tmp_path / deep / "part.ngc").write_text("G91 G1 X5 Y3 F3000\nM2\n")
    place = tmp_path / deep if root else deep
    mcc = {"program": f"{place}/part.ngc", "path_file": f"{place}/path.csv"}
    assert run("mcc", mcc, platform, tmp_path) == ""
    assert run("scope", {"file": f"{place}/trace"}, platform, tmp_path) == ""
    made = sorted(f.name for f in (tmp_path / deep).iterdir())
    assert made == ["part.ngc", "path.csv", "trace.int.npy", "trace.real.npy"]
    assert "No such file" in run("mcc", {"program": f"{place}/x.ngc"}, platform, tmp_path)


@exported
@pytest.mark.parametrize("platform", PLATFORMS, ids=lambda p: p.name)
@pytest.mark.parametrize("other", ("link.ngc", "./part.ngc", "PART.NGC"))
def test_a_file_that_is_read_is_not_written(other: str, platform: Platform, tmp_path: Path) -> None:
    """Whatever it is called; a letter's size is no difference on Windows alone."""
    text = "G91 G1 X5 Y3 F3000\nM2\n"
    (tmp_path / "part.ngc").write_text(text)
    os.link(tmp_path / "part.ngc", tmp_path / "link.ngc")
    told = run("mcc", {"program": "part.ngc", "path_file": other}, platform, tmp_path)
    assert (tmp_path / "part.ngc").read_text() == text
    same = platform.system == "windows" or other != "PART.NGC"
    assert ("it is program" in told) == same, told
