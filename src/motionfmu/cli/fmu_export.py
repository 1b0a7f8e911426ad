"""What `motionfmu export` does with an FMU instead of a scenario."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any


def is_fmu(path: Path) -> bool:
    """Whether a command line names a built FMU, and nothing that is there by that name."""
    from motionfmu.scenarios.fmus import fmu_names

    return len(path.parts) == 1 and not path.exists() and path.name in fmu_names()


def pack(
    name: str, target: Path | None, fmi: int, program: Path | None, given: Mapping[str, Any]
) -> None:
    """Write an FMU with its files inside, and say what it has."""
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
