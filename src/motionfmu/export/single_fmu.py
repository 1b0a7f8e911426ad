"""A single FMU, packed with its files and with start values of the user's."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import is_file
from motionfmu.export.export_choice import check_version
from motionfmu.export.resources import Resources
from motionfmu.fmu import places
from motionfmu.fmu.pack import repacked
from motionfmu.fmu.start_values import texts
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End
from motionfmu.scenarios.values import values_of


def packed(name: str, target: Path, fmi: int, given: Mapping[str, Any]) -> list[str]:
    """Write a built FMU with these start values; files that it reads become its resources.

    Returns the names of the files. Their paths are relative to the working directory.
    """
    check_version(fmi)
    ports = fmus.ports(name)
    resources = Resources()
    starts = {}
    for variable, value in given.items():
        if variable not in ports:
            told = f"{name} has no variable {variable!r}"
            raise InputError(told + suggestion(variable, ports))
        try:
            values = values_of(End(name, ports[variable]), value)
        except ValueError as error:
            raise InputError(str(error)) from None
        said = texts(values)
        if ports[variable].file == "read" and (file := places.local(said[0])) is not None:
            if not is_file(file):
                raise InputError(f"{variable}: there is no file {file}")
            said = (resources.added(file, variable),)
        starts[variable] = " ".join(said)
    repacked(fmus.fmu_path(name, fmi), target, resources.files, starts)
    return sorted(resources.files)


def program_of(name: str) -> str:
    """The one parameter that names a part program; else an InputError tells which there are."""
    reads = [port.name for port in fmus.ports(name).values() if port.file == "read"]
    if "program" in reads:
        return "program"
    which = ", ".join(f"--set {n}=FILE" for n in reads) or "it reads no file"
    raise InputError(f"--program: {name} has no parameter program: {which}")
