"""An FMU that is broken gives one message with file and cause, in every engine."""

import re
import shutil
import zipfile
from collections.abc import Callable
from pathlib import Path

import pytest
from conftest import FMUS, ROOT

import motionfmu
from motionfmu import sweep
from motionfmu.scenarios import fmus

NAME = "velocity_axes"
Files = dict[str, bytes]
MAPPED = Path("/proc/self/maps")


def library(files: Files) -> str:
    return next(n for n in files if n.startswith("binaries/"))


def without(files: Files) -> Files:
    return {n: d for n, d in files.items() if n != library(files)}


def filled(data: bytes) -> Callable[[Files], Files]:
    return lambda files: files | {library(files): data}


def other(files: Files) -> Files:
    """A library that loads and is no FMU."""
    import math

    return files | {library(files): Path(math.__file__).read_bytes()}


def nameless(files: Files) -> Files:
    return {n: d for n, d in files.items() if n != "modelDescription.xml"}


@pytest.fixture
def broken(tmp_path: Path, monkeypatch: pytest.MonkeyPatch):
    """Make FMUs of which one is broken, and use them."""

    def make(change: Callable[[Files], Files] | None, raw: Callable[[bytes], bytes]) -> Path:
        folder = tmp_path / "fmus"
        shutil.copytree(FMUS, folder, copy_function=shutil.os.symlink)
        for fmi in (2, 3):
            file = folder / f"{NAME}.fmi{fmi}.fmu"
            with zipfile.ZipFile(file) as whole:
                files = {n: whole.read(n) for n in whole.namelist()}
            file.unlink()
            with zipfile.ZipFile(file, "w") as archive:
                for name, data in (change(files) if change else files).items():
                    archive.writestr(name, data)
            file.write_bytes(raw(file.read_bytes()))
        monkeypatch.setenv("MOTIONFMU_FMUS", str(folder))
        fmus._ports.cache_clear()
        return folder

    yield make
    monkeypatch.undo()
    fmus._ports.cache_clear()


def same(data: bytes) -> bytes:
    return data


FAULTS = [
    (without, "no library for this machine (binaries/"),
    (filled(b"text\n" * 99), "VelocityAxes.so does not load: invalid ELF header"),
    (filled(b""), "VelocityAxes.so does not load: file too short"),
    (other, "VelocityAxes.so does not load: it has no fmi"),
]


@pytest.mark.parametrize(("change", "what"), FAULTS)
def test_a_library_that_does_not_load_is_named_with_the_cause(broken, change, what) -> None:
    folder = broken(change, same)
    scenario = motionfmu.load(ROOT / "scenarios/circle_theory")
    for engine, fmi in (("native", 3), ("native", 2), ("python", 3), ("fmpy", 2)):
        with pytest.raises(motionfmu.InputError) as caught:
            scenario.run(engine=engine, fmi=fmi, stop=0.001)
        text = str(caught.value)
        assert text.startswith(f"{scenario.document.file}: {folder}/{NAME}.fmi{fmi}.fmu: ")
        assert what in text and "\n" not in text


@pytest.mark.skipif(not MAPPED.exists(), reason="the system does not list what is loaded")
@pytest.mark.parametrize("change", [None, other])
def test_a_library_that_was_looked_at_is_unloaded(broken, change) -> None:
    """Its file is gone; a study would keep one for each FMU of each machine."""
    folder, before = broken(change, same), loaded()
    if change is None:
        assert fmus.runnable(NAME, 3).parent == folder
    else:
        with pytest.raises(motionfmu.InputError):
            fmus.runnable(NAME, 3)
    assert loaded() == before


def loaded() -> list[str]:
    """Files of libraries of the FMU that this process has loaded."""
    return sorted({x.split()[5] for x in MAPPED.read_text().splitlines() if "VelocityAxes" in x})


@pytest.mark.parametrize(
    ("change", "raw", "what"),
    [
        (None, lambda data: b"garbage", "not a zip file"),
        (None, lambda data: data[: len(data) // 2], "not a zip file"),
        (nameless, same, "no item named 'modelDescription.xml'"),
        (lambda files: files | {"modelDescription.xml": b"<fmi"}, same, "line 1"),
    ],
)
def test_a_broken_archive_is_named_with_the_cause(broken, change, raw, what) -> None:
    folder = broken(change, raw)
    with pytest.raises(motionfmu.InputError) as caught:
        motionfmu.load(ROOT / "scenarios/circle_theory")
    text = str(caught.value)
    assert f"machine.toml:8: {folder}/{NAME}.fmi3.fmu: no readable modelDescription.xml" in text
    assert what in text and "\n" not in text


@pytest.mark.parametrize(("engine", "which"), [("native", 0), ("fused", 1)])
def test_code_that_is_torn_inside_the_archive(
    broken, engine, which, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """The library, and the model without FMI, of which no program is kept yet."""

    def torn(data: bytes) -> bytes:
        at = [m.start() for m in re.finditer(b"\x7fELF", data)][-which] + 2000
        return data[:at] + bytes(b ^ 0xFF for b in data[at : at + 50]) + data[at + 50 :]

    broken(None, torn)
    monkeypatch.setenv("MOTIONFMU_CACHE", str(tmp_path / "cache"))
    with pytest.raises(motionfmu.InputError, match=r"fmi3.fmu: not a whole archive \(Bad CRC-32"):
        motionfmu.load(ROOT / "scenarios/circle_theory").run(stop=0.001, engine=engine)


def test_a_study_with_a_broken_library_does_not_begin(
    broken, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MOTIONFMU_ENGINE", "native")
    broken(filled(b""), same)
    given = {"axis": {"mcc.p_gain": [100]}, "results": ["mcc.error.absmax"], "stop": 0.001}
    study = sweep.study(ROOT / "scenarios/circle_theory/scenario.toml", given)
    with pytest.raises(motionfmu.InputError, match="does not load: file too short"):
        sweep.conduct(study, tmp_path / "s", sweep.Ways(workers=1))
    assert not (tmp_path / "s").exists()
