"""A system compiled as one FMU, kept on the disk."""

import json
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from motionfmu.base import disk_cache
from motionfmu.base.compiler import FLAGS, compiler, cross, none
from motionfmu.base.extras import install
from motionfmu.base.platforms import Platform
from motionfmu.fused import layer
from motionfmu.fused.fmu_parts import NoCompiler, NotFused
from motionfmu.scenarios.fmus import digest
from motionfmu.scenarios.system import End, System, Values


@dataclass(frozen=True)
class FusedProgram:
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


def program(
    system: System, recorded: Sequence[End], fmi: int = 3, name: str = "System"
) -> FusedProgram:
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
    system: System,
    recorded: Sequence[End],
    fmi: int = 3,
    name: str = "System",
    platforms: Sequence[Platform] = (),
) -> FusedProgram:
    """As `program`, with the system's settings as start values.

    Parameters
    ----------
    system : System
        Without scopes; the end of its run becomes that of the default experiment.
    recorded, fmi, name :
        As of `program`.
    platforms : sequence of Platform
        For which it is made, from the C text of its FMUs, which it carries. Without any it is made
        of their objects, for this machine, and carries no text.

    Raises
    ------
    NotFused
        It cannot be one program; the message says why.
    """
    given = {s.end.name: s.values for s in system.settings}
    return _made(system, recorded, fmi, name, _Exported(given, platforms))


@dataclass(frozen=True)
class _Exported:
    given: Mapping[str, Values]  # start values
    platforms: Sequence[Platform]


def _made(
    system: System,
    recorded: Sequence[End],
    fmi: int,
    name: str,
    to_export: "_Exported | None",
) -> FusedProgram:
    given = to_export.given if to_export else None
    platforms = to_export.platforms if to_export else ()
    cc = cross() if platforms else compiler()
    if cc is None:
        raise NotFused(f"there is no zig: {install('export')}") if platforms else NoCompiler(none())
    key = _key(system, recorded, name, given)
    whole = disk_cache.key(
        key,
        str(fmi),
        layer.digest(),
        cc.version,
        *cc.command,
        *FLAGS,
        layer.OPTIMIZED,
        *(p.target for p in platforms),
    )

    def make(folder: Path) -> None:
        from motionfmu.fused import program_files  # what generates C is needed here only

        program_files.make(
            folder,
            program_files.ProgramPlan(system, recorded, fmi, name, key, given, platforms),
            cc,
        )

    return FusedProgram(disk_cache.kept("fused", whole, make), fmi)


def _key(
    system: System, recorded: Sequence[End], name: str, given: Mapping[str, Values] | None
) -> str:
    """A hash of what the system is; both versions of FMI have the same, as they have states."""
    fmus = {fmu: digest(fmu) for fmu in system.components.values()}
    until, wired = system.until, {w.target.name for w in system.wires}
    lists: list[object] = [
        [f"{c} {Path(fmu).name} {fmus[fmu]}" for c, fmu in system.components.items()],
        list(fmus.values()),
        [f"{w.target.name} {w.source.name}" for w in system.wires],
        sorted(wired & {s.end.name for s in system.settings}),
        [e.name for e in recorded],
        [name, *(s.name for s in (until.signals if until else ()))],
        None if given is None else [repr(given), system.step_ns, system.steps],
    ]
    return disk_cache.key(json.dumps(lists))
