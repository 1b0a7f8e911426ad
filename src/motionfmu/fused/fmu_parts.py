"""The part that an FMU carries: its model without FMI, as an object to link with (fmu_part.h)."""

import re
import shutil
import subprocess
import tempfile
from dataclasses import dataclass
from pathlib import Path
from xml.etree import ElementTree

from motionfmu.base import disk_cache
from motionfmu.base.compiler import FLAGS, Compiler, NotCompiled, compiler
from motionfmu.base.platforms import here
from motionfmu.fmu.archive_names import MAIN_UNIT, PART_UNIT, PARTS
from motionfmu.scenarios.fmus import digest, opened

# Text in a part's object: version of the interface, sizes of instance and struct vars [bytes].
_MARK = re.compile(rb"motionfmu part 6 (\d{9}) (\d{9})\n")
_DEFINED = re.compile(r'^#define FMU_(\w+) "?([^"\n]*)"?$', re.MULTILINE)
_STRUCT = re.compile(r"^struct vars \{\n(.*?)^\};", re.MULTILINE | re.DOTALL)


class NotFused(Exception):
    """Why a system cannot be one program."""


class NoCompiler(NotFused):
    """The machine has no C compiler."""


@dataclass(frozen=True)
class FmuPart:
    """An FMU's model as an object."""

    identifier: str  # of the model; the object shows motionfmu_part_<identifier>
    tick_ns: int  # its steps are whole multiples of this [ns]
    members: str  # C text of the members of its struct vars
    size: int  # size of that struct [bytes]
    room: int  # size of an instance, which begins with that struct [bytes]
    code: bytes  # the object file


def c_files(build: bytes) -> list[str]:
    """C files of an FMU's model without FMI, as its buildDescription.xml names them."""
    listed = ElementTree.fromstring(build).find("BuildConfiguration/SourceFileSet")
    assert listed is not None, "an FMU has C files"
    names = [row.attrib["name"] for row in listed.iter("SourceFile")]
    return [PART_UNIT, *(name for name in names if name != MAIN_UNIT)]


def carried(name: str) -> bool:
    """Whether an FMU carries an object for this machine; NotFused if it has no C text either."""
    with opened(name) as archive:
        names = archive.namelist()
    if f"sources/{PART_UNIT}" not in names or "sources/buildDescription.xml" not in names:
        raise NotFused(f"{name} carries no part")
    there = f"{PARTS}/{here().name}.o" in names
    if not there and (compiler() is None or shutil.which("objcopy") is None):
        raise NotFused(f"{name} carries no part for this machine, and no compiler makes one")
    return there


def part(name: str) -> FmuPart:
    """Read the part of an FMU; NotFused if it has neither an object nor its C text."""
    there = carried(name)
    with opened(name) as archive:
        header = archive.read("sources/vars.h").decode()
        code = archive.read(f"{PARTS}/{here().name}.o") if there else _compiled(name)
    sizes, members = _MARK.search(code), _STRUCT.search(header)
    if sizes is None or members is None:
        raise NotFused(f"{name} carries a part of another version")
    defined = dict(_DEFINED.findall(header))
    text = members[1].replace("FMU_STRING_MAX", defined["STRING_MAX"])
    return FmuPart(
        identifier=defined["NAME"],
        tick_ns=int(defined["TICK_NS"]),
        members=text,
        size=int(sizes[2]),
        room=int(sizes[1]),
        code=code,
    )


def _compiled(name: str) -> bytes:
    """Compile the object of an FMU that carries none for this machine from its C text."""
    cc = compiler()
    assert cc is not None, "`carried` has looked for it"
    key = disk_cache.key(digest(name), cc.version, *cc.command)
    place = disk_cache.kept("parts", key, lambda folder: _compile(name, cc, folder))
    return (place / "part.o").read_bytes()


def _compile(name: str, cc: Compiler, folder: Path) -> None:
    with opened(name) as archive, tempfile.TemporaryDirectory(prefix="motionfmu-") as place:
        for entry in archive.namelist():
            if entry.startswith("sources/"):
                (Path(place) / Path(entry).name).write_bytes(archive.read(entry))
        files = c_files((Path(place) / "buildDescription.xml").read_bytes())
        cc.run([*FLAGS, "-O2", "-r", "-nostdlib", *files, "-o", "part.o"], Path(place))
        line = ["objcopy", "--localize-hidden", "part.o"]
        done = subprocess.run(line, cwd=place, capture_output=True, text=True, check=False)
        if done.returncode:
            raise NotCompiled(f"objcopy failed: {done.stderr.strip()}")
        shutil.copy(Path(place) / "part.o", folder)
