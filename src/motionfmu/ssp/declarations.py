"""What the FMUs of an SSP declare, and what its units mean."""

import io
import math
import zipfile
import zlib
from collections.abc import Iterable
from dataclasses import dataclass
from xml.etree import ElementTree as ET

from motionfmu.base import units
from motionfmu.ssp.xml import Archive, number, plain

_BASE = "BaseUnit"


@dataclass(frozen=True)
class Meaning:
    """A unit as a factor and an offset to the base units, with their exponents."""

    exponents: tuple[int, ...]  # in the order of `units.BASE`
    factor: float = 1.0
    offset: float = 0.0


@dataclass(frozen=True)
class DeclaredVariable:
    """A variable of an FMU, FMI 2 or 3."""

    causality: str
    type: str  # name of its XML element: Real, Float64, ...
    unit: str | None
    shape: tuple[int, ...]


@dataclass(frozen=True)
class FmuDeclarations:
    """An FMU's description."""

    name: str  # of the model
    tool: str  # the tool that made the FMU
    fmi: str  # version of FMI
    variables: dict[str, DeclaredVariable]
    units: dict[str, Meaning]
    stop: float | None  # [s]
    step: float | None


def meanings(archive: Archive, parent: ET.Element) -> dict[str, Meaning]:
    """Units by name that an XML element of FMI or SSP defines."""
    found = {}
    for unit in (e for e in parent.iter() if plain(e) == "Unit"):
        for base in (e for e in unit if plain(e) == _BASE):
            exponents = tuple(int(number(archive, base, b, 0)) for b in units.BASE)
            factor = number(archive, base, "factor", 1.0)
            offset = number(archive, base, "offset", 0.0)
            found[unit.get("name", "")] = Meaning(exponents, factor, offset)
    return found


def fmu(archive: Archive, path: str, component: str) -> FmuDeclarations:
    """Read the description of an FMU in the archive; it must be one for co-simulation."""
    try:
        with zipfile.ZipFile(io.BytesIO(archive.bytes(path))) as inner:
            root = ET.fromstring(inner.read("modelDescription.xml"))
    except (zipfile.BadZipFile, zlib.error, KeyError, ET.ParseError) as error:
        raise archive.error(f"{component}: {path} is no readable FMU ({error})") from None
    version = root.get("fmiVersion", "1.0")
    if not version.startswith(("2", "3")):
        raise archive.error(f"{component}: {path} is FMI {version}; 2.0 or 3.0 wanted")
    if root.find("CoSimulation") is None:
        raise archive.error(f"{component}: {path} is not for co-simulation")
    variables = {}
    for row in root.iterfind("ModelVariables/*"):
        kind = row if version.startswith("3") else next(iter(row), row)
        shape = tuple(int(size.get("start", "0")) for size in row.iterfind("Dimension"))
        about = DeclaredVariable(row.get("causality", "local"), kind.tag, kind.get("unit"), shape)
        variables[row.get("name", "")] = about
    experiment = root.find("DefaultExperiment")
    times = [
        experiment.get(k) if experiment is not None else None for k in ("stopTime", "stepSize")
    ]
    stop, step = (None if t is None else float(t) for t in times)
    name, tool = root.get("modelName", ""), root.get("generationTool", "")
    return FmuDeclarations(name, tool, version, variables, meanings(archive, root), stop, step)


def converted(
    values: Iterable[float], given: Meaning | None, wanted: Meaning | None
) -> list[float]:
    """Numbers converted to another unit; a ValueError if that has another dimension."""
    if given is None or wanted is None or given == wanted:
        return list(values)
    if given.exponents != wanted.exponents:
        raise ValueError("units of two dimensions")
    if (given.factor, given.offset) == (wanted.factor, wanted.offset):
        return list(values)
    shift = given.offset - wanted.offset
    scale = given.factor / wanted.factor
    if shift == 0.0:
        return [scale * x for x in values]
    return [(given.factor * x + shift) / wanted.factor for x in values]


def alike(a: Meaning | None, b: Meaning | None) -> bool:
    """Whether a number means the same in both units; unknown units are taken to be alike."""
    if a is None or b is None:
        return True
    same = math.isclose(a.factor, b.factor, rel_tol=1e-12) and a.offset == b.offset
    return a.exponents == b.exponents and same
