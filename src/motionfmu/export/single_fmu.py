"""A single FMU, packed with its files and with start values of the user's."""

from collections.abc import Mapping
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import is_file
from motionfmu.export.export_choice import check_version
from motionfmu.export.program_check import check_alone
from motionfmu.export.resources import Resources
from motionfmu.fmu import places
from motionfmu.fmu.describe import BEGIN
from motionfmu.fmu.pack import repacked
from motionfmu.fmu.start_values import texts
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, Setting
from motionfmu.scenarios.values import values_of


def packed(name: str, target: Path, fmi: int, given: Mapping[str, Any]) -> tuple[list[str], str]:
    """Write a built FMU with these start values; files that it reads become its resources.

    Returns the names of these files, and why the FMU does not begin until other values are set;
    empty if it does. A part program that is wrong for any machine is an InputError. Paths are
    relative to the working directory.
    """
    check_version(fmi)
    ports = fmus.ports(name)
    resources = Resources()
    starts, settings = {}, []
    for variable, value in given.items():
        if variable not in ports:
            told = f"{name} has no variable {variable!r}"
            raise InputError(told + suggestion(variable, ports))
        try:
            end = End(name, ports[variable])
            values = values_of(end, value)
        except ValueError as error:
            raise InputError(str(error)) from None
        settings.append(Setting(end, values))
        said = texts(values)
        if ports[variable].file == "read" and (file := places.local(said[0])) is not None:
            if not is_file(file):
                raise InputError(f"{variable}: there is no file {file}")
            said = (resources.added(file, variable),)
        starts[variable] = " ".join(said)
    refused = check_alone(name, settings)
    repacked(fmus.fmu_path(name, fmi), target, resources.files, starts)
    return sorted(resources.files), refused


def program_of(name: str) -> str:
    """The one parameter that names a part program; else an InputError tells which there are."""
    reads = [p.name for p in fmus.ports(name).values() if p.file == "read" and p.name != BEGIN]
    if "program" in reads:
        return "program"
    which = ", ".join(f"--set {n}=FILE" for n in reads) or "it reads no file"
    raise InputError(f"--program: {name} has no parameter program: {which}")
