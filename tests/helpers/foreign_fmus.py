"""The FMUs of tests/foreign, compiled and packed for this machine."""

import re
import subprocess
import zipfile
from pathlib import Path

import fmpy
from conftest import ROOT

from motionfmu.base.compiler import compiler
from motionfmu.base.platforms import here

SOURCES = ROOT / "tests" / "foreign"
HEADERS = Path(fmpy.__file__).parent / "c-code"


def built(name: str, fmi: int, folder: Path, target: str = "") -> Path:
    """Make the archive of one of them in a folder; `target` is its name there, else its own."""
    archived = folder / f"{target or name}.fmu"
    xml = (SOURCES / name / f"fmi{fmi}.xml").read_text()
    found = re.search(r'modelIdentifier="(\w+)"', xml)
    cc = compiler()
    assert found and cc
    library = folder / f"{found[1]}.so"
    source = next(f for f in (SOURCES / name).glob("*.c") if f'"fmi{fmi}_rest.h"' in f.read_text())
    flags = ["-std=c11", "-Wall", "-Wextra", "-Werror", "-shared", "-fPIC", "-ffp-contract=off"]
    command = [
        *cc.command,
        *flags,
        f"-I{HEADERS}",
        f"-I{SOURCES}",
        str(source),
        "-lm",
        "-o",
        str(library),
    ]
    subprocess.run(command, check=True)
    with zipfile.ZipFile(archived, "w") as archive:
        archive.writestr("modelDescription.xml", xml)
        archive.write(library, f"binaries/{here().folder(fmi)}/{library.name}")
    return archived
