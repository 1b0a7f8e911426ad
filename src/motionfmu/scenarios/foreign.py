"""FMUs of other people, by their paths: what they declare, and whether they can run here."""

import functools
import math
import zipfile
import zlib
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from xml.etree import ElementTree

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.fmu.describe import TOOL
from motionfmu.scenarios.port import Port

ENDING = ".fmu"
_FMI2 = {"Real": "Float64", "Integer": "Int32", "Enumeration": "Int32"}
# Clocks tick in event mode only, which no engine of this package uses.
_PASSED_OVER = ("Clock",)
_ROOT = "fmiModelDescription"


def is_foreign(fmu: str) -> bool:
    """Whether the FMU of a component is a file by its path."""
    return fmu.endswith(ENDING)


@dataclass(frozen=True)
class Foreign:
    """What the description of a foreign FMU says of it."""

    fmi: int  # 2 or 3
    identifier: str  # name of its library for co-simulation
    about: str
    ports: Mapping[str, Port]
    once: bool  # a process can have one instance of it only
    tool: bool  # it needs the tool that made it on this machine
    ours: bool  # this package made it, and it carries the C text of its model


def read(name: str) -> Foreign:
    """Read an FMU's description; what is wrong with the file is an InputError."""
    path = Path(name)
    if not is_file(path):
        raise InputError(f"no such FMU: {path}")
    stat = path.stat()
    return _read(path, (stat.st_mtime_ns, stat.st_size))


@functools.cache
def _read(path: Path, state: tuple[int, int]) -> Foreign:
    try:
        with zipfile.ZipFile(path) as archive:
            text = archive.read("modelDescription.xml")
    except KeyError:
        raise InputError(f"{path}: no FMU: it has no modelDescription.xml") from None
    except (OSError, zipfile.BadZipFile, zlib.error) as error:
        raise InputError(f"{path}: no FMU, which is a zip archive ({error})") from None
    try:
        root = ElementTree.fromstring(text)
        return _described(path, root)
    except (SyntaxError, KeyError, ValueError) as error:
        told = f"{type(error).__name__}: {error}"
        raise InputError(f"{path}: modelDescription.xml cannot be read ({told})") from None


def _described(path: Path, root: ElementTree.Element) -> Foreign:
    if root.tag != _ROOT:
        raise InputError(f"{path}: modelDescription.xml begins with {root.tag}, not {_ROOT}")
    version = root.get("fmiVersion", "")
    if not version.startswith(("2.", "3.")):
        raise InputError(f"{path}: FMI {version or 'without a version'}; 2.0 and 3.0 can run")
    fmi = int(version[0])
    kind = root.find("CoSimulation")
    if kind is None:
        others = [t for t in ("ModelExchange", "ScheduledExecution") if root.find(t) is not None]
        only = f", only {' and '.join(others)}" if others else ""
        raise InputError(f"{path}: it has no CoSimulation{only}")
    rows = root.find("ModelVariables")
    listed = list(() if rows is None else rows)
    types = {row.attrib["name"]: _base(row) for row in root.iterfind("TypeDefinitions/*")}
    found = _ports2(listed, types) if fmi == 2 else _ports3(listed, types)
    ours = root.get("generationTool") == TOOL and fmi == 3
    own = _with_meanings(root, listed, found) if ours else found
    return Foreign(
        fmi,
        kind.attrib["modelIdentifier"],
        root.get("description", ""),
        {port.name: port for port in own if port.causality != "independent"},
        kind.get("canBeInstantiatedOnlyOncePerProcess") == "true",
        kind.get("needsExecutionTool") == "true",
        ours,
    )


def _with_meanings(
    root: ElementTree.Element, rows: list[ElementTree.Element], ports: Iterator[Port]
) -> Iterator[Port]:
    """Variables of one of our FMUs, with the type definitions that say what they mean."""
    types = {t.attrib["name"]: t.get("description", "") for t in root.iterfind("TypeDefinitions/*")}
    declared = {row.attrib["name"]: row.get("declaredType") for row in rows}
    for port in ports:
        name = declared[port.name]
        yield replace(port, declared=(name, types[name])) if name else port


def _base(row: ElementTree.Element) -> Mapping[str, str]:
    """Attributes that a type definition gives its variables; in FMI 2 an element holds them."""
    inner = row[0] if row.tag == "SimpleType" and len(row) else row
    return {k: v for k, v in inner.attrib.items() if k in ("unit", "min", "max", "nominal")}


def _ports2(
    rows: list[ElementTree.Element], types: Mapping[str, Mapping[str, str]]
) -> Iterator[Port]:
    for row in rows:
        inner = next(iter(row), None)
        if inner is None:
            raise ValueError(f"variable {row.get('name')} has no type")
        yield _port(row, inner, _FMI2.get(inner.tag, inner.tag), types)


def _ports3(
    rows: list[ElementTree.Element], types: Mapping[str, Mapping[str, str]]
) -> Iterator[Port]:
    starts = {row.attrib["valueReference"]: row.get("start", "") for row in rows}
    for row in rows:
        if row.tag in _PASSED_OVER:
            continue
        kind = "Int64" if row.tag == "Enumeration" else row.tag
        shape = tuple(
            int(size.get("start") or starts[size.attrib["valueReference"]])
            for size in row.findall("Dimension")
        )
        yield _port(row, row, kind, types, shape)


def _port(
    row: ElementTree.Element,
    values: ElementTree.Element,
    kind: str,
    types: Mapping[str, Mapping[str, str]],
    shape: tuple[int, ...] = (),
) -> Port:
    """Make the port of a variable; `values` has its start, unit and limits."""
    given = {**types.get(values.get("declaredType", ""), {}), **values.attrib}
    texts = [start.get("value", "") for start in values.findall("Start")]
    return Port(
        row.attrib["name"],
        kind,
        row.get("causality", "local"),
        row.get("variability") == "tunable",
        row.get("description", ""),
        shape,
        given.get("unit"),
        int(row.attrib["valueReference"]),
        " ".join(texts) if texts else given.get("start"),
        float(given.get("min", -math.inf)),
        float(given.get("max", math.inf)),
        row.get("variability", "continuous") == "continuous" and kind == "Float64",
        float(given["nominal"]) if "nominal" in given else None,
    )
