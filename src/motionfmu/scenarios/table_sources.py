"""Where the tables of a scenario come from: files, one extending another, or a program."""

from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from motionfmu.base.errors import InputError, suggestion
from motionfmu.base.toml_lines import Lines, is_file, shown, tables_of, text_of
from motionfmu.scenarios import package_files

Tables = dict[str, Any]
DEPTH_MAX = 8  # scenarios that extend one another
# Lists that grow; any other list takes the place of the one it extends.
JOINED = (("", "leave"), ("record", "signals"))


@dataclass(frozen=True)
class Source:
    """Tables of one file, or of one call of a program."""

    name: str  # path of the file, or ``<name>`` of what a program gave
    folder: Path  # what its texts name lies here
    tables: Tables
    lines: Lines | None  # None if a program gave it
    about: str = ""  # what the first line says

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
            return f"{self.name}:{self.lines.of(table, key)}"
        parts = table.split(".") if table else []
        words, count = "", 0
        for part in parts:
            words, count = (words, int(part) + 1) if part.isdecimal() else (f"{words}.{part}", 0)
        if not parts:
            return f"{self.name}:{key and ' ' + key}".rstrip(":")
        head = words.lstrip(".")
        head = f"[[{head}]] {count}" if count else f"[{head}]"
        return f"{self.name}:{head}{key and ' ' + key}"


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
        hint = suggestion(file.name, near)
        if not hint and package_files.is_name(path):
            hint = package_files.unknown(str(path), package_files.scenarios)
        raise InputError(f"{file}: no such scenario{hint}")
    return file.resolve()


def of_file(path: str | Path) -> list[Source]:
    """A file and those that it extends, the strongest first."""
    return chain(_read(scenario_file(path)))


def chain(first: Source) -> list[Source]:
    """A source and those that it extends, the strongest first."""
    found = [first]
    while "extends" in found[-1].tables:
        last = found[-1]
        wanted, place = last.tables["extends"], last.place("", "extends")
        if not isinstance(wanted, str):
            raise InputError(f"{place}: extends = {shown(wanted)}: a scenario's folder wanted")
        try:
            file = scenario_file(last.folder / wanted)
        except InputError:
            raise InputError(f"{place}: extends = {shown(wanted)}: no such scenario") from None
        names = [s.name for s in found]
        if str(file) in names:
            way = " -> ".join(Path(n).parent.name for n in [*names, str(file)])
            raise InputError(f"{place}: extends goes in a circle: {way}")
        if len(found) == DEPTH_MAX:
            raise InputError(f"{place}: a scenario extends {DEPTH_MAX - 1} others at most")
        found.append(_read(file))
    return found


def _read(file: Path) -> Source:
    text = text_of(file)
    tables = tables_of(text, file)
    first = text.split("\n", 1)[0]
    about = first.lstrip("# ") if first.startswith("#") else ""
    return Source(str(file), file.parent, tables, Lines(text), about)


def merged(sources: Iterable[Source]) -> Tables:
    """The tables of all sources merged; an earlier source is stronger than a later one."""
    found: Tables = {}
    for source in reversed(list(sources)):
        found = _over(found, source.tables)
    return found


# CCN 16: four rules of merging, each a filter of keys: limits, extends, tables, what is taken away.
def _over(base: Tables, own: Mapping[str, Any]) -> Tables:
    """Two tables merged key by key; None, which a program can give, takes a key away."""
    out = {k: v for k, v in base.items() if k != "extends"}
    if "stop" in own and not isinstance(own["stop"], str):  # the limit was that of a signal
        out = {k: v for k, v in out.items() if k not in ("limit", "settle")}
    for name, value in own.items():
        if name == "extends":
            continue
        before = out.get(name)
        if isinstance(value, dict) and isinstance(before, dict):
            pairs = {k: _joined(name, k, before.get(k), v) for k, v in value.items()}
            out[name] = {k: v for k, v in (before | pairs).items() if v is not None}
        else:
            out[name] = _joined("", name, before, value)
    return {k: v for k, v in out.items() if v is not None}


def _joined(table: str, key: str, before: Any, value: Any) -> Any:
    if (table, key) in JOINED and isinstance(before, list) and isinstance(value, list):
        return [*before, *(x for x in value if x not in before)]
    return value
