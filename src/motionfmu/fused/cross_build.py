"""A system compiled for any platform from the C text of its FMUs, which it carries as they do."""

import tempfile
from collections.abc import Mapping
from pathlib import Path

from motionfmu.base import platforms
from motionfmu.base.compiler import FLAGS, cross
from motionfmu.fmu import cores
from motionfmu.fmu.archive_names import MAIN_UNIT
from motionfmu.fmu.sources import NAMES, build_description, renamed
from motionfmu.fused import layer
from motionfmu.fused.fmu_parts import NotFused, c_files
from motionfmu.fused.system_variables import ProgramPlan
from motionfmu.scenarios.fmus import is_foreign, opened

_FLAGS = (*FLAGS, layer.OPTIMIZED, "-shared", "-s", "-DFMU_PART_INSIDE")


def compile_all(folder: Path, job: ProgramPlan, models: Mapping[str, str]) -> list[str]:
    """Fill ``sources`` and ``binaries`` of a folder; returns names of the C files to compile.

    `models` gives the FMU of each model identifier.
    """
    sources = folder / "sources"
    files = [MAIN_UNIT]
    for identifier, fmu in models.items():
        files += _part(fmu, identifier if is_foreign(fmu) else fmu, sources)
    places = layer.folders()
    own, headers = places[0], places[-1]
    texts = [f for f in sources.iterdir() if f.is_file()]
    standard = sorted(headers.glob(f"fmi{job.fmi}*.h"))
    for file in (*cores.reached(own.iterdir(), texts), *standard):
        (sources / file.name).write_bytes(file.read_bytes())
    made = {platform: _compile(platform, job.name, files, folder) for platform in job.platforms}
    for name, code in platforms.libraries(job.fmi, job.name, made).items():
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_bytes(code)
    main = sources / MAIN_UNIT
    packed = renamed(job.name, [MAIN_UNIT], [], {MAIN_UNIT: main.read_bytes()})
    if job.fmi == 3:
        packed["buildDescription.xml"] = build_description(job.name, files)
    for name, data in packed.items():
        (sources / name).write_bytes(data)
    return files


def _part(fmu: str, own: str, sources: Path) -> list[str]:
    """Unpack the C text of an FMU into a folder of its own; returns the C files to compile."""
    with opened(fmu) as archive:
        names = [n for n in archive.namelist() if n.startswith("sources/")]
        if f"sources/{NAMES}" not in names:
            raise NotFused(f"{fmu} carries no C text that can be linked with others")
        for name in names:
            place = sources / own / Path(name).name
            place.parent.mkdir(exist_ok=True)
            if not place.name.startswith(("fmi3", MAIN_UNIT)):
                place.write_bytes(archive.read(name))
        found = c_files(archive.read("sources/buildDescription.xml"))
    (sources / own / "buildDescription.xml").unlink()
    return [f"{own}/{name}" for name in found]


def _compile(platform: platforms.Platform, name: str, files: list[str], folder: Path) -> bytes:
    cc, library = cross(), f"{name}{platform.suffix}"
    assert cc is not None, "whoever asks for platforms has looked for it"
    options = ["-target", platform.target, *_FLAGS, "-ffile-prefix-map=" + str(folder) + "=."]
    if platform.system == "darwin":
        options.append(f"-Wl,-install_name,@rpath/{library}")
    with tempfile.TemporaryDirectory(prefix="motionfmu-") as place:  # zig leaves more than it
        target = Path(place) / library
        cc.run([*options, *files, "-o", target, "-lm"], folder / "sources")
        return target.read_bytes()
