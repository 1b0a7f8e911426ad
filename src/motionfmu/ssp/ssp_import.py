"""Import of an SSP as a scenario: a folder with scenario.toml and the FMUs."""

import json
import re
import shutil
import tempfile
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path

from motionfmu.base.errors import Faults, InputError
from motionfmu.fmu.describe import TOOL
from motionfmu.ssp import declarations, drives
from motionfmu.ssp.declarations import DeclaredVariable, FmuDeclarations, Meaning
from motionfmu.ssp.flat_wires import SSC, SSD, Nodes, WirePath, shown
from motionfmu.ssp.flat_wires import Path as Inner
from motionfmu.ssp.parameter_sets import ParameterValue, given
from motionfmu.ssp.structure import OSP
from motionfmu.ssp.structure import SSD as STRUCTURE
from motionfmu.ssp.xml import Archive, number

_FMU = "application/x-fmu-sharedlibrary"
_WHOLE = "Integer Enumeration Int8 Int16 Int32 Int64 UInt8 UInt16 UInt32 UInt64".split()
_PLAIN = dict.fromkeys(_WHOLE, "int") | {"Boolean": "bool"}
_REAL = ("Real", "Float64", "Float32")
_NAMED = 8  # a message names so many of a long list
NAME_MAX = 64


@dataclass(frozen=True)
class Taken:
    """What was made of an SSP.

    Attributes
    ----------
    folder : Path
        With scenario.toml and the FMUs.
    components, wires, values : int
        How many.
    warnings : list of str
        What is not as the SSP says, or was not said there.
    """

    folder: Path
    components: int
    wires: int
    values: int
    warnings: list[str]


class _Import:
    """The parts of scenario.toml, from an open SSP."""

    def __init__(self, archive: Archive) -> None:
        self.archive = archive
        self.warnings: list[str] = []
        self.root = archive.root(STRUCTURE, f"{SSD}SystemStructureDescription")
        version = self.root.get("version", "")
        if not re.match(r"[12]\.", version):
            raise archive.error(f"SSP {version!r}; 1.0 or 2.0 wanted")
        system = self.root.find(f"{SSD}System")
        if system is None:
            raise archive.error("it has no system")
        self.nodes = Nodes(archive, system)
        self.system = system
        self.sources: dict[Inner, str] = {}
        self.fmus: dict[Inner, FmuDeclarations] = {}
        faults = Faults()
        for path, component in self.nodes.components.items():
            with faults.each():
                self._component(path, component.attrib)
        faults.tell()
        if not self.fmus:
            raise archive.error("it has no component")
        self.units = declarations.meanings(archive, self.root)
        self.given, self.lost = given(self.nodes)
        self.tables = {p: rows for p, fmu in self.fmus.items() if (rows := self._table(p, fmu))}
        for path in self.tables:  # a Stimulus becomes a [[drive]]
            del self.fmus[path]
        self.names = dict(zip(self.fmus, _names(self.fmus), strict=True))
        self.ways = list(self.nodes.ways())

    def _table(self, path: Inner, fmu: FmuDeclarations) -> list[tuple[float, int, float]]:
        """The rows of a Stimulus; none of any other FMU."""
        if (fmu.name, fmu.tool) != (drives.MODEL, TOOL):
            return []
        try:
            return drives.table(g.value for g in self.given if g.component == path)
        except (ValueError, IndexError) as error:
            raise self.archive.error(f"{shown(path)}: {error}") from None

    def _component(self, path: Inner, about: dict[str, str]) -> None:
        what, kind = shown(path), about.get("type", _FMU)
        if kind != _FMU:
            raise self.archive.error(f"{what}: {kind} is no FMU")
        if about.get("implementation", "any") not in ("any", "CoSimulation"):
            raise self.archive.error(f"{what}: {about['implementation']} is not run here")
        if "source" not in about:
            raise self.archive.error(f"{what}: it has no FMU")
        source = self.archive.place(about["source"], what)
        if not self.archive.has(source):
            raise self.archive.error(f"{what}: there is no {source} in it")
        self.sources[path] = source
        self.fmus[path] = declarations.fmu(self.archive, source, what)

    def times(self, stop: float | None, step: float | None) -> tuple[float, float]:
        """End and communication step [s]: those given, the SSP's, the FMUs'."""
        experiment = self.root.find(f"{SSD}DefaultExperiment")
        start = 0.0
        if experiment is not None:
            start = number(self.archive, experiment, "startTime", 0.0)
            if stop is None and "stopTime" in experiment.attrib:
                stop = number(self.archive, experiment, "stopTime", 0.0) - start
            for algorithm in experiment.iter(f"{{{OSP}}}FixedStepAlgorithm"):
                if step is None:
                    step = number(self.archive, algorithm, "baseStepSize", 0.0)
        if start:
            self.warnings.append(f"it begins at {start:g} s; a scenario begins at 0")
        if step is None:
            step = min((f.step for f in self.fmus.values() if f.step), default=None)
            self._guessed("step", step)
        if stop is None:
            stop = max((f.stop for f in self.fmus.values() if f.stop), default=None)
            self._guessed("stop", stop)
        if step is None or stop is None:
            raise self.archive.error("neither it nor an FMU says how long: --stop, --step [s]")
        return stop, step

    def _guessed(self, key: str, value: float | None) -> None:
        if value is not None:
            self.warnings.append(f"{key} = {value:g} s is that of its FMUs: it has none")

    def wires(self) -> Iterator[tuple[str, str]]:
        """Inputs and the outputs that feed them."""
        for way in self.ways:
            if way.source[0] in self.tables:
                continue
            source, target = (
                f"{self.names[path]}.{connector}" for path, connector in (way.source, way.target)
            )
            self._check(way)
            yield target, source

    def _check(self, way: WirePath) -> None:
        """Refuse a wire that changes what it carries."""
        what = f"connection of {shown(*way.source)} and {shown(*way.target)}"
        if (way.factor, way.offset) != (1.0, 0.0):
            line = f"factor {way.factor:g}, offset {way.offset:g}"
            raise self.archive.error(f"{what}: {line}: a wire here hands on what it gets")
        if way.source_index or way.target_index:
            raise self.archive.error(f"{what}: a wire here takes whole arrays")
        ends = []
        for path, name in (way.source, way.target):
            fmu = self.fmus[path]
            if name not in fmu.variables:
                raise self.archive.error(f"{what}: {self.sources[path]} has no {name}")
            unit = fmu.variables[name].unit
            ends.append(fmu.units.get(unit or ""))
        if not way.as_it_is and not declarations.alike(*ends):
            units = " and ".join(
                str(self.fmus[p].variables[n].unit) for p, n in (way.source, way.target)
            )
            raise self.archive.error(f"{what}: {units}: a wire here converts no units")

    def values(self) -> dict[str, str]:
        """Start values as TOML, by name; of several for one variable the last counts."""
        lost, values = self.lost, dict[str, str]()
        for one in self.given:
            if one.component in self.tables:
                continue
            about = self.fmus[one.component].variables.get(one.value.name)
            if about is None or about.causality not in ("parameter", "input"):
                lost.append(f"{shown(one.component)}.{one.value.name}")
                continue
            values[f"{self.names[one.component]}.{one.value.name}"] = self._toml(one)
        if lost:
            some = ", ".join(lost[:_NAMED]) + (" ..." if len(lost) > _NAMED else "")
            self.warnings.append(f"values of no parameter and no input, left out: {some}")
        return values

    def _toml(self, one: ParameterValue) -> str:
        """TOML text of a value, in the unit of its variable."""
        fmu, value = self.fmus[one.component], one.value
        about = fmu.variables[value.name]
        what = f"{shown(one.component)}.{value.name} = {' '.join(value.text)!r}"
        try:
            if about.type in _REAL:
                texts = [repr(x) for x in self._reals(one, fmu.units.get(about.unit or ""))]
            elif about.type in _WHOLE:
                texts = [str(self._whole(one, text)) for text in value.text]
            elif about.type == "Boolean":
                texts = [{"true": "true", "1": "true", "false": "false", "0": "false"}[t]
                         for t in value.text]  # fmt: skip
            elif about.type == "String":
                texts = [json.dumps(text, ensure_ascii=False) for text in value.text]
            else:
                raise ValueError(f"{about.type} is not set here")
        except (ValueError, KeyError) as error:
            told = error if isinstance(error, ValueError) else f"{about.type} wanted"
            raise self.archive.error(f"{what}: {told}") from None
        return texts[0] if len(texts) == 1 else f"[{', '.join(texts)}]"

    def _reals(self, one: ParameterValue, wanted: Meaning | None) -> list[float]:
        own = declarations.meanings(self.archive, one.source)
        unit = one.value.unit
        meaning = own.get(unit, self.units.get(unit)) if unit else None
        return declarations.converted((float(t) for t in one.value.text), meaning, wanted)

    def _whole(self, one: ParameterValue, text: str) -> int:
        """The whole number that a text means: a number, or the name of an enumeration's item."""
        if one.value.type != "Enumeration":
            return int(text)
        items = [e for root in (one.source, self.root) for e in root.iter(f"{SSC}Item")]
        numbers = {e.get("value", "") for e in items if e.get("name") == text}
        if len(numbers) != 1:
            raise ValueError(f"{len(numbers)} enumerations have such an item")
        return int(numbers.pop())

    def drives(self) -> dict[str, list[str]]:
        """Inputs that a Stimulus drives, and the lines of their tables."""
        found: dict[str, tuple[drives.InputSteps, str]] = {}
        for way in self.ways:
            rows = self.tables.get(way.source[0])
            if rows is None:
                continue
            path, connector = way.target
            name = f"{self.names[path]}.{connector}"
            drive, _ = found.setdefault(
                name,
                (
                    drives.InputSteps(name),
                    _PLAIN.get(self.fmus[path].variables[connector].type, "float"),
                ),
            )
            signal = drives.signal_of(way)
            element = way.target_index[0] - 1 if way.target_index else 0
            for at, number_, value in rows:
                if number_ == signal:
                    drive.steps.setdefault(at, {})[element] = value
        return {name: drive.toml(kind) for name, (drive, kind) in found.items() if drive.steps}

    def open_inputs(self, targets: Iterable[str]) -> Iterator[str]:
        """Unconnected inputs as patterns: one pattern for a component without any wire to it."""
        fed = set(targets)
        for path, fmu in self.fmus.items():
            name = self.names[path]
            inputs = [n for n, v in fmu.variables.items() if v.causality == "input"]
            if any(f"{name}.{n}" not in fed for n in inputs):
                yield f"{name}.*"

    def recorded(self) -> list[str]:
        """Outputs that are connectors, or all if none is, as far as a run can record them."""
        every, few = [], []
        for path, fmu in self.fmus.items():
            for name, about in fmu.variables.items():
                if about.causality == "output" and _recordable(about, fmu.fmi):
                    every.append(f"{self.names[path]}.{name}")
                    if self.nodes.kinds.get((path, name)) == "output":
                        few.append(every[-1])
        if not every:
            raise self.archive.error("no FMU of it has an output that is recorded here")
        return few or every


def _recordable(about: DeclaredVariable, fmi: str) -> bool:
    """Whether an engine can record a variable.

    That are single numbers, arrays of six, and real arrays of 3 and 4. Of FMI 3's whole numbers
    those of 32 bits are recorded; its enumerations have 64.
    """
    if about.type in ("Real", "Float64"):
        return about.shape in [(), (3,), (4,), (6,)]
    whole = about.type in ("Integer", "Int32", "Boolean")
    return (whole or (about.type, fmi[0]) == ("Enumeration", "2")) and about.shape in [(), (6,)]


def _names(paths: Iterable[Inner]) -> Iterator[str]:
    """Unique component names that a scenario allows, one for each path."""
    used: set[str] = set()
    for path in paths:
        name = re.sub(r"[^A-Za-z0-9_]", "_", "_".join(path))[: NAME_MAX - 4]
        name = name if name[:1].isalpha() else f"c{name}"
        while name in used:
            name += "_"
        used.add(name)
        yield name


def _listed(names: Iterable[str]) -> str:
    return "[\n" + "".join(f"    {json.dumps(n)},\n" for n in names) + "]"


def take(path: Path, folder: Path, stop: float | None = None, step: float | None = None) -> Taken:
    """Make a scenario of an SSP 1.0 or 2.0.

    Nested systems become one, names joined by ``_``; start values are in the units of their
    variables. Components are the FMUs as they are, under ``resources/``.

    Parameters
    ----------
    path : Path
        The .ssp.
    folder : Path
        Of the scenario; it must not be there yet.
    stop, step : float or None
        Instead of the SSP's [s].

    Raises
    ------
    InputError
        Of what cannot be taken over, with the component or connection. That is a model that is no
        FMU, an FMU that is missing, not for co-simulation or of FMI 1, a transformation, a
        conversion of units on a wire, or a signal dictionary.
    """
    if folder.exists():
        raise InputError(f"{folder}: it is there already")
    archive = Archive(path)
    made = _Import(archive)
    times = made.times(stop, step)
    wires = dict(made.wires())
    driven = made.drives()
    fed = {**wires, **driven}
    values = {name: text for name, text in made.values().items() if name not in fed}
    about = made.root.get("description") or made.system.get("description") or made.root.get("name")
    lines = [
        f"# {' '.join((about or 'System').split())}",
        f"stop = {times[0]!r}",
        f"step = {times[1]!r}",
        f"leave = {_listed(made.open_inputs(fed))}",
        "\n[component]",
        *(f'{name} = "resources/{name}.fmu"' for name in made.names.values()),
        "\n[connect]",
        *(f"{json.dumps(target)} = {json.dumps(source)}" for target, source in wires.items()),
        "\n[set]",
        *(f"{json.dumps(name)} = {text}" for name, text in values.items()),
        *(line for lines in driven.values() for line in lines),
        "\n[record]",
        f"signals = {_listed(made.recorded())}",
    ]
    try:
        folder.parent.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryDirectory(dir=folder.parent, prefix=f".{folder.name}") as scratch:
            whole = Path(scratch) / folder.name
            (whole / "resources").mkdir(parents=True)
            (whole / "scenario.toml").write_text("\n".join(lines) + "\n", encoding="utf-8")
            for inner, name in made.names.items():
                (whole / "resources" / f"{name}.fmu").write_bytes(
                    archive.bytes(made.sources[inner])
                )
            shutil.move(whole, folder)
    except OSError as error:
        raise InputError(f"cannot write {folder}: {error.strerror or error}") from None
    return Taken(folder, len(made.names), len(wires), len(values), made.warnings)
