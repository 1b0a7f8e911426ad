"""Generate an FMU's C and XML, pack its .fmu files, make headers; called by the build.

python src/pack.py cmake
python src/pack.py needed   fmus build/gen
python src/pack.py generate fmus/epcio build/gen/epcio
python src/pack.py archive  fmus/epcio build/gen/epcio 3 epcio.o epcio.fmi3.fmu here=epcio.so
python src/pack.py headers  src build/include/motionfmu
python src/pack.py platforms
"""

import html
import json
import os
import posixpath
import re
import sys
import zipfile
import zlib
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from motionfmu.base import platforms
from motionfmu.base.errors import InputError
from motionfmu.base.platforms import Platform
from motionfmu.base.toml_lines import text_of
from motionfmu.fmu import (
    cores,
    ctables,
    documentation,
    fmu_toml,
    for_cmake,
    sources,
    start_values,
    terminals,
)
from motionfmu.fmu.archive_names import AGREE, EXTRA, GRID, MAIN_UNIT, PART_UNIT, PARTS, RESOURCES
from motionfmu.fmu.modeldescription import model_description

SOURCE = Path(__file__).resolve().parents[2]
# The earliest date that an archive can have: with a fixed date equal FMUs are equal files.
_DATE = (1980, 1, 1, 0, 0, 0)


def _write(path: Path, data: str | bytes) -> None:
    """Write a file only if its content changes, so that nothing is compiled needlessly."""
    raw = data.encode() if isinstance(data, str) else data
    if not path.exists() or path.read_bytes() != raw:
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_bytes(raw)


def is_modelica(fmu: Path) -> bool:
    """Whether the FMU in this folder is made from a Modelica class."""
    return fmu_toml.names_modelica(text_of(fmu / "fmu.toml"))


def generate(fmu: Path, out: Path) -> None:
    """Write all generated text of one FMU, from a folder with fmu.toml (and model.c).

    `out` receives vars.h, vars.c, fmi2/ and fmi3/ with fmu_main.c and modelDescription.xml, and
    plant.c, plant.h, ode.json for a Modelica class.
    """
    if is_modelica(fmu):
        from motionfmu.fmu.modelica import codegen

        d = codegen.write(fmu / "fmu.toml", out)
    else:
        d = fmu_toml.load(fmu / "fmu.toml")
    _write(out / "vars.h", ctables.header(d))
    _write(out / "vars.c", ctables.table(d))
    _write(out / documentation.VARIABLES, documentation.variables(d))
    _write(out / documentation.TERMINALS, terminals.described(d.terminals))
    _write(out / GRID, json.dumps({"grid": d.grid}) + "\n")
    _write(out / AGREE, json.dumps(dict(d.agree)) + "\n")
    compiled = [f.name for f in compiled_sources(fmu, out)]
    model = "plant_model.c" if is_modelica(fmu) else "model.c"
    _write(out / PART_UNIT, ctables.part_unit(model, d.name))
    for fmi in (2, 3):
        _write(out / f"fmi{fmi}/{MAIN_UNIT}", ctables.main_unit(model, fmi))
        xml = model_description(d, fmi, [MAIN_UNIT, *compiled])
        _write(out / f"fmi{fmi}/modelDescription.xml", xml)


def _core_files(fmu: Path) -> list[Path]:
    # A class is not translated for this, which takes seconds.
    if is_modelica(fmu):
        return cores.needed(SOURCE, cores.OF_PLANTS, (SOURCE / "plant").glob("*.[ch]"))
    return cores.needed(SOURCE, fmu_toml.load(fmu / "fmu.toml").cores, fmu.glob("*.[ch]"))


def needed(fmus: Path, out: Path) -> None:
    """Write which files of the cores each FMU needs into core_files.txt of its generated text."""
    for file in fmus.glob("*/fmu.toml"):
        names = [str(f.relative_to(SOURCE)) for f in _core_files(file.parent)]
        _write(out / file.parent.name / "core_files.txt", "\n".join([*names, ""]))


def compiled_sources(fmu: Path, out: Path) -> list[Path]:
    """C files that are compiled beside fmu_main.c; `out` is the folder of the generated text."""
    files = [f for f in _core_files(fmu) if f.suffix == ".c"]
    return files + ([out / "plant.c"] if is_modelica(fmu) else [])


def _packed_sources(fmu: Path, out: Path, fmi: int, identifier: str) -> dict[str, bytes]:
    import fmpy

    folders = [fmu, SOURCE / "plant"] if is_modelica(fmu) else [fmu]
    files = [f for folder in folders for f in sorted(folder.glob("*.[ch]"))]
    files += [*sorted(out.glob("*.[ch]")), out / f"fmi{fmi}/{MAIN_UNIT}"]
    files += [*cores.reached((SOURCE / "fmi").iterdir(), files), *_core_files(fmu)]
    headers = Path(fmpy.__file__).parent / "c-code"
    files += sorted(headers.glob(f"fmi{fmi}*.h"))
    compiled = [f.name for f in compiled_sources(fmu, out)]
    packed = sources.renamed(
        identifier, [MAIN_UNIT, PART_UNIT], compiled, {f.name: f.read_bytes() for f in files}
    )
    if fmi == 3:
        packed["buildDescription.xml"] = sources.build_description(
            identifier, [MAIN_UNIT, *compiled]
        )
    return packed


@dataclass(frozen=True)
class CompilerOutput:
    """Files that compilers made of an FMU."""

    libraries: Mapping[Platform, Path]
    part: Path  # fmu_part.h, for this machine


def archive(folder: Path, out: Path, fmi: int, compiled: CompilerOutput, target: Path) -> None:
    """Pack one .fmu of its folder, generated text and library; equal input gives equal bytes."""
    xml = (out / f"fmi{fmi}/modelDescription.xml").read_bytes()
    match = re.search(rb'modelIdentifier="(\w+)"', xml)
    assert match, "the generated description has a model identifier"
    identifier = match[1].decode()
    made = {one: file.read_bytes() for one, file in compiled.libraries.items()}
    files = {
        "modelDescription.xml": xml,
        **platforms.libraries(fmi, identifier, made),
    }
    readme = "".join(file.read_text() for file in folder.glob("README.md"))
    about = re.search(rb'description="([^"]*)"', xml)
    words = html.unescape(about[1].decode()) if about else ""
    files |= documentation.files(
        fmi, out, (identifier, words), readme, documentation.icon_of(folder)
    )
    if readme:
        files["documentation/README.md"] = readme.encode()
    if fmi == 3:
        for extra in (
            *(file for file in folder.glob("*.toml") if file.name != "fmu.toml"),
            *out.glob("*.json"),
        ):
            files[f"{EXTRA}/{extra.name}"] = extra.read_bytes()
        files[f"{PARTS}/{platforms.here().name}.o"] = compiled.part.read_bytes()
    for name, data in _packed_sources(folder, out, fmi, identifier).items():
        files[f"sources/{name}"] = data
    target.parent.mkdir(parents=True, exist_ok=True)
    write_archive(target, files)


def write_archive(target: Path, files: Mapping[str, bytes]) -> None:
    """Write files by their names in the archive; equal input gives equal bytes."""
    with zipfile.ZipFile(target, "w") as archive_file:
        for path, data in sorted(files.items()):
            info = zipfile.ZipInfo(path, _DATE)
            info.compress_type = zipfile.ZIP_DEFLATED
            info.external_attr = 0o644 << 16
            archive_file.writestr(info, data)


def write_whole(target: Path, files: Mapping[str, bytes]) -> None:
    """Write an archive for the user, whole or not at all; an InputError if it cannot be written."""
    part = target.with_name(f".{target.name}.part{os.getpid()}")
    try:
        write_archive(part, files)
        part.replace(target)
    except OSError as error:
        raise InputError(f"cannot write {target}: {error.strerror or error}") from None
    finally:
        part.unlink(missing_ok=True)


def repacked(
    source: Path, target: Path, resources: Mapping[str, Path], starts: Mapping[str, str]
) -> None:
    """Copy an FMU with files added to its resources, by name, and with other start values.

    Instances begin with the new values, too, which only FMUs of this package support:
    ``{"program": "resource:part.ngc", "p_gain": "200 198 0 0 0 0"}``, one value or one for each
    element. Equal input gives equal bytes; `target` may be `source`.
    """
    try:
        with zipfile.ZipFile(source) as archive_file:
            files = {n: archive_file.read(n) for n in archive_file.namelist() if n[-1] != "/"}
    except (OSError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{source}: not a readable FMU ({error})") from None
    own = f"{RESOURCES}/{start_values.FILE}"
    for name, file in resources.items():
        path = f"{RESOURCES}/{name}"
        if path == own or "\\" in name or posixpath.normpath(path) != path or not name.strip("/."):
            raise InputError(f"{name}: no name for a file inside the resources of an FMU")
        try:
            files[path] = file.read_bytes()
        except OSError as error:
            raise InputError(f"{file}: {error.strerror or error}") from None
    if starts:
        xml, listed = files["modelDescription.xml"], files.get(own, b"")
        files["modelDescription.xml"], files[own] = start_values.changed(xml, listed, starts)
    write_whole(target, files)


def headers(source: Path, out: Path) -> None:
    """Write the headers of all cores into one folder, fit for C++, with the names of the installed
    libraries; beside it the list by which objcopy gives the libraries these names."""
    files = [f for core in cores.folders(source).values() for f in sorted(core.glob("*.[ch]"))]
    texts = {f: f.read_text() for f in files}
    names = sources.shown(texts.values())
    made = {f.name: sources.prefixed(cores.cxx(f), names) for f in files if f.suffix == ".h"}
    made["short_names.h"] = sources.short_names(names)
    for name, text in made.items():
        _write(out / name, text)
    for old in {f.name for f in out.iterdir()} - set(made):
        (out / old).unlink()
    rows = "".join(f"{name} {sources.PREFIX}{name}\n" for name in sorted(names))
    _write(out.with_name("symbols.txt"), rows)


def main(arguments: list[str]) -> int:
    """Run one of the six as in the module's first lines; 0, or 2 after one message on stderr."""
    try:
        two = {"needed": needed, "generate": generate, "headers": headers}
        if arguments == ["cmake"]:
            print(for_cmake.lists(SOURCE.parent), end="")
        elif arguments == ["platforms"]:
            print(*(f"{p.name} {p.target} {p.suffix}" for p in platforms.PLATFORMS), sep="\n")
        elif arguments[0] in two:
            two[arguments[0]](Path(arguments[1]), Path(arguments[2]))
        else:
            fmu, out, fmi, part, target, *made = arguments[1:]
            named = dict(row.split("=", 1) for row in made)
            libraries = {
                platforms.here() if name == "here" else Platform(name): Path(file)
                for name, file in named.items()
            }
            compiled = CompilerOutput(libraries, Path(part))
            archive(Path(fmu), Path(out), int(fmi), compiled, Path(target))
    except ValueError as error:
        print(error, file=sys.stderr)
        return 2
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
