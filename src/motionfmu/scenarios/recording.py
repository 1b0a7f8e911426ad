"""Which signals go to which channel of which scope."""

import math
import os
import shutil
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from motionfmu.base.columns import ArrayPlace, Columns, kept
from motionfmu.base.errors import Faults
from motionfmu.scenarios import fmus
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import STEPS_MAX, End, Resolver, Setting, System, Wire
from motionfmu.scenarios.values import start_values, values_of

AXES = 6
# Channels of one scope FMU, by the type of their values: groups of six channels, and single ones.
SIZES = {"Float64": 8, "Int32": 4}  # [bytes]
# A scope holds its rows in memory; signals that are written as they come need room on the disk.
ROWS_MAX = STEPS_MAX
BYTES_MAX = 2_000_000_000
WIDTH = {"Float64": 8, "Int32": 4, "Boolean": 1}  # [bytes] of a value in a file
FILES = {"Float64": "real", "Int32": "int"}  # a scope's files, by the type of their values
# Inputs of a scope by type: name and how many there are, by width, in the order of the files.
GROUPS = {
    "Float64": {
        6: ("axes_real_", 10),
        1: ("real_", 4),
        3: ("triple_real_", 6),
        4: ("quad_real_", 3),
    },
    "Int32": {6: ("axes_int_", 9), 1: ("int_", 10)},
}


@dataclass(frozen=True)
class TraceColumn:
    """Where the trace files hold a signal."""

    end: End
    scope: int
    kind: str  # Float64 or Int32; a Boolean is recorded as Int32
    group: int  # counts from 0 within its width

    @property
    def width(self) -> int:
        """How many channels the signal takes."""
        return self.end.port.count


@dataclass(frozen=True)
class Recording:
    """All columns and the folder of the trace files."""

    columns: tuple[TraceColumn, ...]
    folder: Path
    scopes: int

    def load(self) -> Columns:
        """The signals of a run that has ended; their files make room for those of the next run."""
        scopes = [f"scope{i + 1}.{kind}.npy" for i in range(self.scopes) for kind in FILES.values()]
        own = kept(self.folder, scopes)
        parts = {}
        for c in self.columns:
            file = own / f"scope{c.scope + 1}.{FILES[c.kind]}.npy"
            mine = [o for o in self.columns if (o.scope, o.kind) == (c.scope, c.kind)]
            widths = list(GROUPS[c.kind])
            before = widths[: widths.index(c.width)]
            first = sum(o.width for o in mine if o.width in before) + c.width * c.group
            columns = slice(first, first + c.width) if c.end.port.shape else first
            parts[c.end.name] = ArrayPlace(file, columns, c.end.port.type == "Boolean")
        return Columns(parts, own)


def _kind(end: End) -> str:
    """Type of the channels of an output; a Boolean is recorded as Int32."""
    return "Int32" if end.port.type == "Boolean" else end.port.type


def recordable(end: End) -> bool:
    """Whether the scope has a channel of this type and width."""
    shape = end.port.shape
    return len(shape) < 2 and shape != (1,) and end.port.count in GROUPS.get(_kind(end), {})


def output(resolver: Resolver, name: str, table: str, key: str) -> End:
    """Find an output that can be recorded; a message names the table and key that ask for it."""
    end = resolver.end(name, table, key)
    if end.port.causality != "output":
        text = f"{name} is no output ({end.port.causality})"
        raise resolver.document.error(text, table, key, name)
    if not recordable(end):
        text = f"{name} is {end.port.type}: only {', '.join(WIDTH)}, single or in groups of six"
        text += " (Float64 also of three and four), can be recorded"
        raise resolver.document.error(text, table, key, name)
    return end


def elements(resolver: Resolver, name: str, table: str, key: str) -> tuple[End, tuple[int, ...]]:
    """The output that a name means, whole or one element of it, and its elements, from 1."""
    whole, bracket, rest = name.partition("[")
    if resolver.split(name) == (name, None):
        whole, bracket, rest = name, "", ""
    end = output(resolver, whole, table, key)
    shape = end.port.shape
    if not bracket:
        return end, tuple(range(1, end.port.count + 1)) if shape else ()
    index = rest.removesuffix("]")
    if not (shape and rest.endswith("]") and index.isascii() and index.isdigit()):
        kind = f"an array of {shape[0]}" if shape else "a single value"
        raise resolver.document.error(f"{name}: {whole} is {kind}", table, key, name)
    if not 1 <= int(index) <= shape[0]:
        text = f"{name}: {whole} has elements 1 to {shape[0]}"
        raise resolver.document.error(text, table, key, name)
    return end, (int(index),)


def chosen(resolver: Resolver, patterns: Iterable[str]) -> list[End]:
    """Outputs that names and patterns mean, each once; patterns skip what cannot be recorded."""
    found: dict[str, End] = {}
    faults = Faults()
    for pattern in patterns:
        with faults.each():
            found.update({e.name: e for e in _matching(resolver, pattern)})
    faults.tell()
    return list(found.values())


def _matching(resolver: Resolver, pattern: str) -> list[End]:
    if "*" not in pattern and "?" not in pattern:
        return [output(resolver, pattern, "record", "signals")]
    ends = [e for e in resolver.matching(pattern, "output") if recordable(e)]
    if not ends and not resolver.lost:
        text = f"{pattern!r} matches no output"
        raise resolver.document.error(text, "record", "signals", pattern)
    return ends


def _allocate(ends: Iterable[End]) -> list[TraceColumn]:
    columns: list[TraceColumn] = []
    used: dict[tuple[int, str, int], int] = {}
    for end in ends:
        kind, width = _kind(end), end.port.count
        room = GROUPS[kind][width][1]
        scope = 0
        while used.get((scope, kind, width), 0) == room:
            scope += 1
        columns.append(TraceColumn(end, scope, kind, used.get((scope, kind, width), 0)))
        used[scope, kind, width] = used.get((scope, kind, width), 0) + 1
    return columns


def refused(system: System) -> tuple[str, str]:
    """The setting of a scope that would not work, and why; two empty texts if all would."""
    files: dict[str, str] = {}
    total = 0
    given = {s.end.name: s.values[0] for s in system.settings}
    for name in (n for n, fmu in system.components.items() if fmu == "scope"):
        ports = fmus.ports("scope")

        def value(key: str, name: str = name, ports: Mapping[str, Port] = ports) -> Any:
            return given.get(f"{name}.{key}", start_values(ports[key])[0])

        if not value("file"):
            continue
        file = os.path.realpath(value("file"))
        if file in files:
            return f"{name}.file", f"{name} and {files[file]} would both write {file}"
        files[file] = name
        rows = math.ceil(system.steps * system.step_ns / (value("period") * 1e9))
        if rows > ROWS_MAX:
            text = f"{name} would record {rows} rows; {ROWS_MAX} are the most"
            return f"{name}.period", text
        total += rows * sum(
            SIZES[kind] * width * value(f"{inputs}used")
            for kind, groups in GROUPS.items()
            for width, (inputs, _) in groups.items()
        )
        if total > BYTES_MAX:
            size, most = total * 1e-9, BYTES_MAX * 1e-9
            text = f"{rows} rows of {name} make a recording of {size:.3g} GB; {most:g} are the most"
            return f"{name}.period", text
    return "", ""


def size(system: System, ends: Iterable[End]) -> int:
    """The most bytes that the signals and times of a run take on the disk."""
    row = WIDTH["Float64"] + sum(WIDTH[e.port.type] * e.port.count for e in ends)
    return row * system.rows(system.steps)


def no_room(system: System, ends: Iterable[End], folder: Path) -> str:
    """Why a folder has no room for a run's signals; empty if it has room."""
    wanted, free = size(system, ends), shutil.disk_usage(folder).free
    if wanted <= free:
        return ""
    told = f"{system.rows(system.steps)} rows of all signals take {wanted * 1e-9:.3g} GB"
    return f"{told}; {folder} has {free * 1e-9:.3g} GB left: record less, or every 10th step"


def plan(system: System, ends: Iterable[End], folder: Path) -> tuple[System, Recording]:
    """Add the scopes that record these outputs to a system, and say where each will be recorded."""
    columns = _allocate(ends)
    scopes = 1 + max((c.scope for c in columns), default=-1)
    ports = fmus.ports("scope") if scopes else {}
    components, wires, settings = dict(system.components), list(system.wires), list(system.settings)
    for scope in range(scopes):
        name = f"_scope{scope + 1}"
        components[name] = "scope"
        given: dict[str, Any] = {
            "file": str(folder / f"scope{scope + 1}"),
            "period": system.sample_ns * 1e-9,
        }
        for kind, groups in GROUPS.items():
            mine = [c for c in columns if (c.scope, c.kind) == (scope, kind)]
            for width, (channel, _) in groups.items():
                given[f"{channel}used"] = sum(1 for c in mine if c.width == width)
            for c in mine:
                channel = f"{groups[c.width][0]}{c.group + 1}"
                wires.append(Wire(c.end, End(name, ports[channel])))
        for key, value in given.items():
            end = End(name, ports[key])
            settings.append(Setting(end, values_of(end, value)))
    added = replace(system, components=components, wires=tuple(wires), settings=tuple(settings))
    return added, Recording(tuple(columns), folder, scopes)
