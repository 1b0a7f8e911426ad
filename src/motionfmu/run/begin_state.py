"""The saved state in which a scenario begins: a file with what each FMU serialized."""

import hashlib
import json
import zipfile
import zlib
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from motionfmu.analysis.gcode.subprogram_files import called
from motionfmu.base import disk_cache
from motionfmu.base.errors import InputError
from motionfmu.fmu.describe import BEGIN
from motionfmu.run.program_translation import GCODE
from motionfmu.scenarios import fmus
from motionfmu.scenarios.system import End, Resolver, Setting, Stimulus, System, Values
from motionfmu.scenarios.values import start_values

FORMAT = 1
ABOUT, STATE = "state.json", ".state"  # in the archive; the states are COMPONENT.state
BYTES_MAX = 4 << 30  # [bytes] of an unpacked state


@dataclass(frozen=True)
class BeginState:
    """A saved state: when it was, and what led to it."""

    name: str  # of its file, for messages
    ns: int  # simulated time [ns]
    given: Mapping[str, Values]  # settings with which the machine had begun
    force: Mapping[str, Values]  # inputs and tunable parameters that had other values by then
    files: Mapping[str, Mapping[str, str]]  # of a parameter that names one: hash of each, by name
    states: Mapping[str, Path]  # by component

    def begun(self, resolver: Resolver, system: System) -> System:
        """The system that begins here; an InputError if it cannot.

        What is given now and was not given then acts from here on; fixed parameters are compared by
        the FMUs themselves.
        """
        document = resolver.document
        if self.ns % system.sample_ns:
            told = f"{self.name} is of {self.ns / 1e9:.9g} s, no whole number of recorded steps"
            raise document.error(f"{told}, {system.sample_ns / 1e9:.9g} s", "", "begin")
        begin = self.ns // system.step_ns
        if begin >= system.steps:
            last = system.steps * system.step_ns / 1e9
            told = f"{self.name} is of {self.ns / 1e9:.9g} s, and the run ends at {last:.9g} s"
            raise document.error(told, "", "begin")
        self._check_files(resolver, system)
        wired = {w.target.name for w in system.wires}
        now = {s.end.name: (s.end, s.values) for s in system.settings}
        ends = {n: resolver.end(n, "", "begin") for n in self.given} | {
            n: end for n, (end, _) in now.items()
        }
        changed = [
            Stimulus(end, begin, values)
            for name, end in ends.items()
            if name not in wired and (end.port.causality == "input" or end.port.tunable)
            if not _same(
                values := now[name][1] if name in now else start_values(end.port),
                self.given.get(name) or start_values(end.port),
            )
        ]
        own = tuple(
            Setting(End(component, fmus.ports(fmu)[BEGIN]), (str(self.states[component]),))
            for component, fmu in system.components.items()
        )
        return replace(
            system,
            begin=begin,
            settings=(*system.settings, *own),
            stimuli=tuple(sorted((*changed, *system.stimuli), key=lambda s: s.step)),
        )

    def _check_files(self, resolver: Resolver, system: System) -> None:
        """Refuse a program that is another one now: the state is in the middle of it."""
        there = {name: dict(hashes) for name, hashes in file_hashes(system.settings).items()}
        for name in dict.fromkeys((*self.files, *there)):
            was, now = self.files.get(name, {}), there.get(name, {})
            for file in dict.fromkeys((*was, *now)):
                if was.get(file) != now.get(file):
                    told = f"{name}: {file} is not as it was when {self.name} was saved"
                    raise resolver.document.error(told, "", "begin")


def _same(a: Values, b: Values) -> bool:
    """Whether two settings are the same, of which one may be one value for all elements."""
    count = max(len(a), len(b))
    return (a * count if len(a) == 1 else a) == (b * count if len(b) == 1 else b)


def files_of(setting: Setting) -> list[Path]:
    """The file that a setting has an FMU read, and those that it calls if it is a program."""
    path, port = Path(str(setting.values[0])), setting.end.port
    if port.file != "read" or port.name == BEGIN or not path.is_file():
        return []
    return [path, *(called(path) if path.suffix.lower() in GCODE else [])]


def file_hashes(settings: Iterable[Setting]) -> dict[str, dict[str, str]]:
    """Hashes of the files that FMUs read, and of those that a program calls, by their names."""
    found: dict[str, dict[str, str]] = {}
    for s in settings:
        several = files_of(s)
        if not several:
            continue
        # The program by its parameter: a copy may have another name.
        names = ["the file", *(f.name for f in several[1:])]
        hashes = [hashlib.sha256(f.read_bytes()).hexdigest() for f in several]
        found[s.end.name] = dict(zip(names, hashes, strict=True))
    return found


def _identity(fmu: str) -> dict[str, str]:
    """What tells an FMU and its version: they are in its states, too."""
    root = ElementTree.fromstring(fmus.description_text(fmu))
    return {
        "name": root.get("modelName", ""),
        "token": root.get("instantiationToken", ""),
        "made": root.get("generationTool", ""),
    }


def write(file: Path, system: System, ns: int, states: Mapping[str, bytes], force: Any) -> None:
    """Write a saved state of a system: what each component serialized, and what led to it."""
    about = {
        "format": FORMAT,
        "ns": ns,
        "components": {c: _identity(fmu) for c, fmu in system.components.items()},
        "given": {s.end.name: s.values for s in system.settings if not s.end.port.file},
        "force": force,
        "files": file_hashes(system.settings),
    }
    with zipfile.ZipFile(file, "w", zipfile.ZIP_DEFLATED) as archive:
        # Without a date: equal states have equal bytes.
        archive.writestr(zipfile.ZipInfo(ABOUT), json.dumps(about, indent=1))
        for component, data in states.items():
            info = zipfile.ZipInfo(f"{component}{STATE}")
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, data)


def read(resolver: Resolver) -> BeginState | None:
    """The state that a scenario names; None if it names none.

    An InputError says what is wrong with the file, and of which component.
    """
    document = resolver.document
    name = document.body.begin
    if name is None:
        return None
    file = document.beside(name)
    if file is None:
        raise document.error(f"begin = {name!r}: there is no such file", "", "begin")
    try:
        found = _read(file, name, document.body.component)
    except (OSError, zipfile.BadZipFile, zlib.error, EOFError, NotImplementedError) as error:
        raise document.error(f"{name} is damaged: {error}", "", "begin") from None
    except (ValueError, TypeError, KeyError, AttributeError) as error:
        raise document.error(f"{name} is no saved state: {error}", "", "begin") from None
    except InputError as error:
        raise document.error(f"{name}: {error}", "", "begin") from None
    return found


def _read(file: Path, name: str, components: Mapping[str, str]) -> BeginState:
    data = file.read_bytes()
    with zipfile.ZipFile(file) as archive:
        there = {i.filename: i.file_size for i in archive.infolist()}
        if ABOUT not in there or sum(there.values()) > BYTES_MAX:
            raise ValueError(f"it has no {ABOUT}" if ABOUT not in there else "it is too large")
        about = json.loads(archive.read(ABOUT))
        if about["format"] != FORMAT:
            raise ValueError(f"format {about['format']!r}; {FORMAT} is known here")
        _check_components(about["components"], components, there)
        states = {c: archive.read(f"{c}{STATE}") for c in components}

    def make(folder: Path) -> None:
        for component, state in states.items():
            (folder / f"{component}{STATE}").write_bytes(state)

    place = disk_cache.kept("states", disk_cache.key(data), make)
    ns = about["ns"]
    if isinstance(ns, bool) or not isinstance(ns, int) or ns <= 0:
        raise ValueError(f"ns = {ns!r}")
    return BeginState(
        name,
        ns,
        {n: tuple(v) for n, v in about["given"].items()},
        {n: tuple(v) for n, v in about["force"].items()},
        {n: dict(v) for n, v in about["files"].items()},
        {c: place / f"{c}{STATE}" for c in components},
    )


def _check_components(
    saved: Mapping[str, Mapping[str, str]], here: Mapping[str, str], there: Mapping[str, int]
) -> None:
    """Refuse the state of other components, or of other FMUs than these."""
    for component, fmu in here.items():
        if BEGIN not in fmus.ports(fmu):
            raise InputError(f"{component}: {Path(fmu).name} cannot begin in a saved state")
        if component not in saved or f"{component}{STATE}" not in there:
            raise InputError(f"it has no state of component {component}")
        was, now = dict(saved[component]), _identity(fmu)
        if was["name"] != now["name"]:
            raise InputError(f"{component}: it is the state of a {was['name']}, not {now['name']}")
        if was != now:
            told = (
                f"{was['name']} of {was['made']} {was['token']}, not {now['made']} {now['token']}"
            )
            raise InputError(f"{component}: it is the state of another version: {told}")
    for component in saved:
        if component not in here:
            raise InputError(f"it is of another scenario: {component} is no component here")
