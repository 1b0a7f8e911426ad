"""Where the tables of a scenario come from: its file, what it extends, its machine, a program."""

import os
from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import Lines, is_file, shown, tables_of, text_of
from motionfmu.scenarios import package_files

Tables = dict[str, Any]
NO_SCENARIO = (
    "no scenario, which is a .toml file or its folder; a program runs on a machine: --machine NAME"
    " (motionfmu machines lists them)"
)
DEPTH_MAX = 8  # files that extend one another
# Lists to which a file adds; any other list takes the place of the one it extends.
JOINED = (("", "leave"), ("record", "signals"))
# Arrays of tables, to which a file adds, too.
ARRAYS = ("axis", "drive", "figure", "waveform", "contrary")
# Of these, a table whose keys are one entry of each row: [drive] by inputs, [contrary] by words.
KEYED = {"drive": "input", "contrary": "off"}
# Keys that say where tables come from, and are none of theirs.
ORIGINS = ("extends", "without")
# Keys that go with a stop that is a signal.
OF_A_SIGNAL = ("fault", "limit", "settle")
# What a machine does not say, for it has no job.
NOT_OF_A_SCENARIO = ("drawing",)  # its program is a file that the controller reads
NOT_OF_A_MACHINE = (
    "machine",
    "begin",
    "stop",
    *OF_A_SIGNAL,
    "drive",
    "expect",
    "contrary",
)


@dataclass(frozen=True)
class Source:
    """Tables of one file, or of one call of a program."""

    name: str  # path of the file, or ``<name>`` of what a program gave
    folder: Path  # what its texts name lies here
    tables: Tables
    lines: Lines | None  # None if a program gave it
    about: str = ""  # what the first line says
    # The pattern from which a name has come, by table and name.
    written: Mapping[tuple[str, str], str] = field(default_factory=dict)

    def find(self, table: str, key: str) -> Any:
        """The value at a place, named as `Lines.of` names it; a KeyError if there is none."""
        here: Any = self.tables
        for part in [*(table.split(".") if table else ()), *([key] if key else ())]:
            if isinstance(here, list):
                part = int(part) if part.isdecimal() else len(here)
                if part >= len(here):
                    raise KeyError(part)
            elif not isinstance(here, dict):
                raise KeyError(part)
            here = here[part]
        return here

    def has(self, table: str, key: str, item: Any) -> bool:
        """Whether this source has the place and, if an item is given, lists the item there."""
        try:
            found = self.find(table, key)
        except KeyError:
            return False
        return item is None or (isinstance(found, list) and item in found)

    def place(self, table: str, key: str) -> str:
        """Name of a place, for messages."""
        if self.lines is not None:
            return f"{self.name}:{self.lines.of(table, self.written.get((table, key), key))}"
        parts = table.split(".") if table else []
        words, count = "", 0
        for part in parts:
            words, count = (words, int(part) + 1) if part.isdecimal() else (f"{words}.{part}", 0)
        if not parts:
            return f"{self.name}:{key and ' ' + key}".rstrip(":")
        head = words.lstrip(".")
        head = f"[[{head}]] {count}" if count else f"[{head}]"
        return f"{self.name}:{head}{key and ' ' + key}"


class Sources(tuple[Source, ...]):
    """All sources of a scenario, the strongest first, and which one has each row of an array."""

    rows: dict[str, tuple[Source, str]]  # source and place there, by place: "figure.2"

    def of(self, table: str) -> tuple[tuple[Source, ...], str]:
        """The sources that may have a table, and its name in these."""
        array, _, rest = table.partition(".")
        number, dot, inner = rest.partition(".")
        if found := self.rows.get(f"{array}.{number}"):
            return (found[0],), f"{found[1]}{dot}{inner}"
        return tuple(self), table


def scenario_file(path: str | Path) -> Path:
    """The scenario.toml, absolute, that a user's path or name of a scenario means.

    A path is the file's or its folder's; a name, where there is no such path, that of a folder in
    ./scenarios or of a scenario that comes with the package.
    """
    if not isinstance(path, str | Path):
        raise InputError(f"{shown(path)}: the path of a scenario wanted")
    file = package_files.scenario(path) or Path(path)
    file = file / "scenario.toml" if is_file(file / "scenario.toml") else file
    if not is_file(file):
        beside = file.parent.iterdir() if file.parent.is_dir() else ()
        near = [p.name for p in beside if is_file(p / "scenario.toml")]
        hint = suggestion(file.name, near) or package_files.no_scenario(path)
        raise InputError(f"{file}: no such scenario{hint}")
    return file.resolve()


def machine_file(path: str | Path, folder: Path) -> Path:
    """The machine.toml, absolute, that a path or the name of a machine means.

    A path is the file's or its folder's, in `folder` if it is relative; a name, where there is no
    such path, that of a folder in ./machines, or of a machine or rig that comes with the package.
    """
    file = folder / path
    if package_files.is_name(path) and not os.path.lexists(file):
        known = package_files.rigs() | package_files.machines()
        file = known.get(str(path), file)
    file = file / package_files.MACHINE if is_file(file / package_files.MACHINE) else file
    if not is_file(file):
        hint = ""
        if len(Path(path).parts) == 1:
            hint = package_files.unknown(str(path), package_files.machines)
        raise InputError(f"machine = {shown(str(path))}: no such machine{hint}")
    return file.resolve()


def of_file(path: str | Path) -> list[Source]:
    """A file, what it extends and its machine, the strongest first."""
    file = scenario_file(path)
    try:
        first = _read(file)
    except InputError:
        if file.suffix.lower() in ("", ".toml"):
            raise
        raise InputError(f"{file}: {NO_SCENARIO}") from None
    return chain(first)


def chain(first: Source) -> list[Source]:
    """A source, those that it extends, then its machine and what that extends."""
    found = _extended(first, _scenario_beside)
    for own in found:
        for key in NOT_OF_A_SCENARIO:
            if key in own.tables and own.lines is not None:
                raise InputError(f"{own.place('', key)}: {key} is a machine's, no scenario's")
    named = next((s for s in found if "machine" in s.tables), None)
    if named is None:
        return found
    wanted, place = named.tables["machine"], named.place("", "machine")
    if not isinstance(wanted, str | Path):
        raise InputError(f"{place}: machine = {shown(wanted)}: a machine's name or folder wanted")
    try:
        file = machine_file(wanted, named.folder)
    except InputError as error:
        raise InputError(f"{place}: {error}") from None
    machines = _extended(_read(file), machine_file)
    for machine in machines:
        for key in NOT_OF_A_MACHINE:
            if key in machine.tables:
                told = "is a scenario's, no machine's"
                raise InputError(f"{machine.place('', key)}: {key} {told}")
    return [*found, *machines]


def _scenario_beside(wanted: str | Path, folder: Path) -> Path:
    return scenario_file(folder / wanted)


def _extended(first: Source, file_of: Callable[[str, Path], Path]) -> list[Source]:
    """A source and those that it extends, the strongest first."""
    found = [first]
    kind = "machine" if file_of is machine_file else "scenario"
    while "extends" in found[-1].tables:
        last = found[-1]
        wanted, place = last.tables["extends"], last.place("", "extends")
        if not isinstance(wanted, str):
            raise InputError(f"{place}: extends = {shown(wanted)}: a {kind}'s folder wanted")
        try:
            file = file_of(wanted, last.folder)
        except InputError:
            raise InputError(f"{place}: extends = {shown(wanted)}: no such {kind}") from None
        names = [s.name for s in found]
        if str(file) in names:
            way = " -> ".join(Path(n).parent.name for n in [*names, str(file)])
            raise InputError(f"{place}: extends goes in a circle: {way}")
        if len(found) == DEPTH_MAX:
            raise InputError(f"{place}: a {kind} extends {DEPTH_MAX - 1} others at most")
        found.append(_read(file))
    return found


def _read(file: Path) -> Source:
    text = text_of(file)
    tables = tables_of(text, file)
    first = text.split("\n", 1)[0]
    about = first.lstrip("# ") if first.startswith("#") else ""
    return Source(str(file), file.parent, in_rows(tables), Lines(text), about)


def in_rows(tables: Tables) -> Tables:
    """Tables in which those that may be keyed are arrays of rows."""
    return {name: _rows_of(name, value) for name, value in tables.items()}


def _rows_of(name: str, value: Any) -> Any:
    if name not in KEYED or not isinstance(value, dict):
        return value
    own = KEYED[name]
    return [{own: k} | row if isinstance(row, dict) else row for k, row in value.items()]


def merged(sources: Iterable[Source]) -> tuple[Tables, Sources]:
    """The tables of all sources merged; an earlier source is stronger than a later one."""
    every = Sources(sources)
    found: Tables = {}
    for source in reversed(every):
        found = _over(_less(found, source), source.tables, adds=source.lines is not None)
    every.rows = _rows(found, every)
    return found, every


def _rows(tables: Tables, sources: Sources) -> dict[str, tuple[Source, str]]:
    """Of each row of an array the source that has it, and its place there; merging copies none."""
    own = {
        id(row): (source, place)
        for source in sources
        for place, row in _numbered_rows(source.tables)
    }
    return {place: own[id(row)] for place, row in _numbered_rows(tables)}


def _numbered_rows(tables: Tables) -> Iterator[tuple[str, Any]]:
    """Each row of an array, behind its place: "figure.2"."""
    for array in ARRAYS:
        rows = tables.get(array)
        yield from (
            (f"{array}.{k}", x) for k, x in enumerate(rows if isinstance(rows, list) else [])
        )


def _less(base: Tables, source: Source) -> Tables:
    """What a source inherits, less what its `without` names."""
    names = source.tables.get("without", [])
    place = source.place("", "without")
    if not isinstance(names, list) or not all(isinstance(n, str) for n in names):
        raise InputError(f"{place}: without = {shown(names)}: a list of names wanted")
    out = {k: (dict(v) if isinstance(v, dict) else v) for k, v in base.items()}
    for name in names:
        if not _taken(out, name):
            told = "nothing that is inherited has this name (TABLE, TABLE.KEY or LIST.ITEM)"
            raise InputError(f"{place}: without {shown(name)}: {told}{_near(base, name)}")
    return out


def _taken(tables: Tables, name: str) -> bool:
    """Take away a table, a key of it, an entry of a list or a row by its title."""
    top, _, key = name.partition(".")
    here = tables.get(top)
    if here is None:
        return False
    if not key:
        del tables[top]
        return True
    if isinstance(here, list):
        tables[top] = [x for x in here if key not in (x, *_titles(x))]
        return len(tables[top]) < len(here)
    if not isinstance(here, dict):
        return False
    if key in here:
        del here[key]
        return True
    inner, _, item = key.partition(".")
    listed = here.get(inner)
    if not isinstance(listed, list) or item not in listed:
        return False
    here[inner] = [x for x in listed if x != item]
    return True


def _titles(row: Any) -> list[Any]:
    """What names a row: a figure's title, an axis, a driven input, what a contrary is off."""
    names = ("title", "name", "input", "off")
    return [row.get(key) for key in names] if isinstance(row, dict) else []


def _near(tables: Tables, name: str) -> str:
    """Words that suggest which inherited name may be meant."""
    top, _, key = name.partition(".")
    inside = tables.get(top)
    if not key or inside is None:
        return suggestion(top, list(tables))
    names = list(inside) if isinstance(inside, dict) else []
    names += [str(t) for x in inside for t in (x, *_titles(x)) if isinstance(t, str)]
    return suggestion(key, names)


def _over(base: Tables, own: Mapping[str, Any], adds: bool) -> Tables:
    """Two tables merged key by key; None, which a program can give, takes a key away."""
    out = dict(base)
    if "stop" in own and not isinstance(own["stop"], str):  # the limit was that of a signal
        out = {k: v for k, v in out.items() if k not in OF_A_SIGNAL}
    for name, value in own.items():
        if name not in ORIGINS:
            out[name] = _of_both(name, out.get(name), value, adds)
    return {k: v for k, v in out.items() if v is not None}


def _of_both(name: str, before: Any, value: Any, adds: bool) -> Any:
    """What becomes of a table or key that is inherited and given anew."""
    if isinstance(value, dict) and isinstance(before, dict):
        pairs = {k: _joined(name, k, before.get(k), v) for k, v in value.items()}
        return {k: v for k, v in (before | pairs).items() if v is not None}
    if adds and name in ARRAYS and isinstance(value, list) and isinstance(before, list):
        return [*before, *value]
    return _joined("", name, before, value)


def _joined(table: str, key: str, before: Any, value: Any) -> Any:
    if (table, key) in JOINED and isinstance(before, list) and isinstance(value, list):
        return [*before, *(x for x in value if x not in before)]
    return value
