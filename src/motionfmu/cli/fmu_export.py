"""The part of `motionfmu export` that packs an FMU instead of a scenario."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any


def is_fmu(path: Path) -> bool:
    """Whether a path of the command line is the name of a built FMU and no existing file."""
    from motionfmu.scenarios.fmus import fmu_names

    return len(path.parts) == 1 and not path.exists() and path.name in fmu_names()


def pack(
    name: str, target: Path | None, fmi: int, program: Path | None, given: Mapping[str, Any]
) -> None:
    """Write an FMU with its files inside, and print what it holds."""
    from motionfmu.cli.run import warnings
    from motionfmu.export.single_fmu import packed, program_of

    values = {key.removeprefix(f"{name}."): value for key, value in given.items()}
    if program is not None:
        values[program_of(name)] = str(program)
    file = target or Path(f"{name}.fmu")
    files, refused = packed(name, file, fmi, values)
    inside = ", ".join(files) or "nothing"
    print(f"{file}: FMI {fmi}, {name} with {inside} in its resources, values set: {len(values)}")
    warnings([f"until other values are set: {line}" for line in refused.splitlines()])
