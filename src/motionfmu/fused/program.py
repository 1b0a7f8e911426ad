"""A system compiled as one FMU, kept on the disk."""

import json
import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from motionfmu import kept
from motionfmu.compiler import FLAGS, Compiler, compiler
from motionfmu.fmu import ctables
from motionfmu.fmu.modeldescription import model_description
from motionfmu.fmu.pack import platform_folder
from motionfmu.fused import layer, text
from motionfmu.fused.description import TYPES, Job, described, roles
from motionfmu.fused.parts import NotFused, Part, digest, part
from motionfmu.scenarios.system import End, System, Values

_OPTIMIZED = "-O2"
_FMI_TYPES = {ours: fmi for fmi, ours in TYPES.items()}


@dataclass(frozen=True)
class Program:
    """A system as an FMU, unpacked.

    Attributes
    ----------
    folder : Path
        Where it is, with ``modelDescription.xml``, ``binaries/``, and ``program.json``: token,
        library, and type, first value reference and number of elements of each variable.
    fmi : int
        2 or 3.
    """

    folder: Path
    fmi: int


def program(system: System, recorded: Sequence[End], fmi: int = 3, name: str = "System") -> Program:
    """Make a system one program, or find the one that was made.

    A program depends on what the system is made of, not on values: settings, stimuli, the number of
    steps and what `every` says are given to it when it runs.

    Parameters
    ----------
    system : System
        Without scopes.
    recorded : sequence of End
        Outputs that it can record and shows.
    fmi : int
        2 or 3.
    name : str
        Model identifier.

    Raises
    ------
    NotFused
        It cannot be one program; the message says why.
    """
    return _made(system, recorded, fmi, name, None)


def exported(
    system: System, recorded: Sequence[End], fmi: int = 3, name: str = "System"
) -> Program:
    """As `program`, with the system's settings as start values.

    Parameters
    ----------
    system : System
        Without scopes; the end of its run becomes that of the default experiment.
    recorded, fmi, name :
        As of `program`.

    Raises
    ------
    NotFused
        It cannot be one program; the message says why.
    """
    return _made(system, recorded, fmi, name, {s.end.name: s.values for s in system.settings})


def _made(
    system: System,
    recorded: Sequence[End],
    fmi: int,
    name: str,
    given: Mapping[str, Values] | None,
) -> Program:
    cc = compiler()
    if cc is None:
        raise NotFused("there is no C compiler")
    key = _key(system, recorded, name, given)
    job = Job(system, recorded, fmi, name, key, given)
    whole = kept.key(key, str(fmi), layer.digest(), cc.version, *cc.command, *FLAGS, _OPTIMIZED)
    return Program(kept.kept("fused", whole, lambda folder: _make(folder, job, cc)), fmi)


def _key(
    system: System, recorded: Sequence[End], name: str, given: Mapping[str, Values] | None
) -> str:
    """A hash of what the system is, the same in both versions of FMI: states are, too."""
    fmus = dict.fromkeys(system.components.values())
    until, wired = system.until, {w.target.name for w in system.wires}
    lists: list[object] = [
        [f"{c} {fmu}" for c, fmu in system.components.items()],
        [digest(fmu) for fmu in fmus],
        [f"{w.target.name} {w.source.name}" for w in system.wires],
        sorted(wired & {s.end.name for s in system.settings}),
        [e.name for e in recorded],
        [name, until.name if until else ""],
        None if given is None else [repr(given), system.step_ns, system.steps],
    ]
    return kept.key(json.dumps(lists))


def _parts(system: System) -> dict[str, Part]:
    found = {fmu: part(fmu) for fmu in system.components.values()}
    identifiers = {p.identifier for p in found.values()}
    if len(identifiers) != len(found):
        raise NotFused("two FMUs have one model identifier")
    for wire in system.wires:
        a, b = wire.source.port, wire.target.port
        if (a.type, a.shape) != (b.type, b.shape):
            raise NotFused(f"{wire.target.name} and {wire.source.name} are of two types")
    return found


def _make(folder: Path, job: Job, cc: Compiler) -> None:
    parts, used = _parts(job.system), roles(job.system, job.recorded)
    tick = math.lcm(*(one.tick_ns for one in parts.values()))
    d = described(job, used, tick)
    sources = folder / "sources"
    sources.mkdir()
    texts = {
        "vars.h": ctables.header(d),
        "vars.c": ctables.table(d),
        "model.c": text.model(job.system, parts, used, job.recorded),
        "state_flags.h": text.FLAGS,
        "fmu_main.c": text.main_unit(job.fmi, quickly=job.given is None),
    }
    for file, content in texts.items():
        (sources / file).write_text(content)
    for one in parts.values():
        (sources / f"{one.identifier}.o").write_bytes(one.code)
    binaries = folder / "binaries" / platform_folder(job.fmi)
    binaries.mkdir(parents=True)
    included = [f"-I{place}" for place in layer.folders()]
    objects = [f"{one.identifier}.o" for one in parts.values()]
    library = cc.library(
        ["fmu_main.c", *objects], str(binaries / f"{job.name}.so"), sources, _OPTIMIZED, *included
    )
    for file in objects:
        (sources / file).unlink()
    (folder / "modelDescription.xml").write_bytes(model_description(d, job.fmi))
    rows = {
        v.name: [_FMI_TYPES[v.type], reference, v.count]
        for v, reference in zip(d.variables, d.references(), strict=True)
    }
    about = {"token": d.token, "library": str(library.relative_to(folder)), "variables": rows}
    (folder / "program.json").write_text(json.dumps(about))
