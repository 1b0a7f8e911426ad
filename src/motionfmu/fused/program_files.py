"""The files of a system's program, and the folder that is filled with them."""

import json
import math
from pathlib import Path

from motionfmu.base.compiler import Compiler
from motionfmu.base.platforms import here
from motionfmu.fmu import ctables, documentation, terminals
from motionfmu.fmu.describe import Description
from motionfmu.fmu.modeldescription import model_description
from motionfmu.fmu.pack import RESOURCES
from motionfmu.fused import cross_build, layer, text
from motionfmu.fused.fmu_parts import FmuPart, NotFused, part
from motionfmu.fused.resource_files import carrying
from motionfmu.fused.system_variables import TYPES, ProgramPlan, described, roles
from motionfmu.scenarios.system import System

FMI_TYPES = {ours: fmi for fmi, ours in TYPES.items()}


def _parts(system: System) -> dict[str, FmuPart]:
    found = {fmu: part(fmu) for fmu in system.components.values()}
    models: dict[str, FmuPart] = {}
    for one in found.values():  # several FMUs may have one model, with different start values
        if models.setdefault(one.identifier, one) != one:
            raise NotFused(f"two FMUs with the model identifier {one.identifier} differ")
    for wire in system.wires:
        a, b = wire.source.port, wire.target.port
        if (a.type, a.shape) != (b.type, b.shape):
            raise NotFused(f"{wire.target.name} and {wire.source.name} are of two types")
    return found


def _unpack_resources(folder: Path, system: System) -> None:
    for component, files in carrying(system).items():
        for name, data in files.items():
            place = folder / RESOURCES / component / name
            place.parent.mkdir(parents=True, exist_ok=True)
            place.write_bytes(data)


def make(folder: Path, job: ProgramPlan, cc: Compiler) -> None:
    """Fill a folder with an unpacked FMU."""
    parts, used = _parts(job.system), roles(job.system, job.recorded)
    tick = math.lcm(*(one.tick_ns for one in parts.values()))
    d = described(job, used, tick)
    _unpack_resources(folder, job.system)
    sources = folder / "sources"
    sources.mkdir()
    texts = {
        "vars.h": ctables.header(d),
        "vars.c": ctables.table(d),
        "model.c": text.model(job.system, parts, used, job.recorded),
        "fmu_main.c": text.main_unit(job.fmi, quickly=job.given is None),
    }
    for file, content in texts.items():
        (sources / file).write_text(content)
    if job.platforms:
        files = cross_build.compile_all(folder, job, {p.identifier: f for f, p in parts.items()})
        (folder / "modelDescription.xml").write_bytes(model_description(d, job.fmi, files))
        _show(folder, d)
        _tell(folder, d, "")
        return
    models = {one.identifier: one for one in parts.values()}
    for one in models.values():
        (sources / f"{one.identifier}.o").write_bytes(one.code)
    binaries = folder / "binaries" / here().folder(job.fmi)
    binaries.mkdir(parents=True)
    included = [f"-I{place}" for place in layer.folders()]
    objects = [f"{name}.o" for name in models]
    library = cc.library(
        ["fmu_main.c", *objects],
        str(binaries / f"{job.name}.so"),
        sources,
        layer.OPTIMIZED,
        *included,
    )
    for file in objects:
        (sources / file).unlink()
    (folder / "modelDescription.xml").write_bytes(model_description(d, job.fmi))
    if job.given is not None:
        _show(folder, d)
    _tell(folder, d, str(library.relative_to(folder)))


def _show(folder: Path, d: Description) -> None:
    """Write the documentation of an exported system."""
    (folder / documentation.VARIABLES).write_text(documentation.variables(d))
    (folder / documentation.TERMINALS).write_bytes(terminals.described(d.terminals))


def _tell(folder: Path, d: Description, library: str) -> None:
    """Write program.json, which a run reads instead of the description."""
    rows = {
        v.name: [FMI_TYPES[v.type], reference, v.count]
        for v, reference in zip(d.variables, d.references(), strict=True)
    }
    about = {"token": d.token, "library": library, "variables": rows}
    (folder / "program.json").write_text(json.dumps(about))
