"""A scenario as read: which FMUs, how they are wired, set, driven, recorded and judged."""

import copy
from collections.abc import Mapping
from dataclasses import dataclass, replace
from pathlib import Path
from typing import Any

from pydantic import BaseModel, ValidationError

from motionfmu.base.axis_names import LINEAR, ControllerAxis
from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.base.toml_lines import is_file, ordered, shown
from motionfmu.scenarios import body as tables_
from motionfmu.scenarios.body import JUDGED, Body, MachineAxis
from motionfmu.scenarios.foreign import is_foreign
from motionfmu.scenarios.patterns import spread
from motionfmu.scenarios.table_sources import (
    ARRAYS,
    OF_A_SIGNAL,
    Source,
    Sources,
    Tables,
    chain,
    in_rows,
    merged,
    of_file,
)

# Tables whose keys are names that the user chooses.
OPEN = ("component", "connect", "set", *JUDGED, "limits")
ABOUT = "the first line is a comment that says what the scenario shows"
# The fewest entries that a list may have, by its key.
EMPTY = {"signals": 'the name of an output, or a pattern such as "card.*", wanted'}
# What stands in for a table that cannot be read, so that the other tables are still checked.
SOUND: Tables = {"stop": tables_.LONGEST, "step": 1e-4, "record": {"signals": ["*"]}}


@dataclass(frozen=True)
class Document:
    """A scenario's tables, and where each key stands."""

    name: str  # of its folder, or as a program says
    about: str  # what its first line says
    body: Body
    tables: Tables  # of all sources together
    sources: Sources  # the strongest first
    wrong: tuple[str, ...] = ()  # what is wrong with keys and types, which body does not have
    damaged: frozenset[str] = frozenset()  # tables and keys at the top of which something is wrong
    changed: bool = False  # whether it is another one with other tables

    @property
    def file(self) -> Path:
        """The scenario.toml, or ``<name>`` of one that a program made."""
        return Path(self.sources[0].name)

    @property
    def files(self) -> list[Path]:
        """The scenario.toml, those that it extends and its machine's."""
        return [Path(s.name) for s in self.sources if s.lines is not None]

    @property
    def axes(self) -> list[MachineAxis]:
        """The machine's axes, each with its row."""
        listed = enumerate(self.body.axis, 1)
        return [a if a.row else a.model_copy(update={"row": k}) for k, a in listed]

    @property
    def controller_axes(self) -> list[ControllerAxis]:
        """The six axes of a controller, as the machine names them."""
        found = list(LINEAR)
        for axis in self.axes:
            if axis.row and axis.row <= len(found):
                unit = "°" if axis.kind == "rotary" else "mm"
                found[axis.row - 1] = ControllerAxis(axis.name, unit)
        return found

    def beside(self, name: str) -> Path | None:
        """A file of this name beside the scenario, or beside one that it extends."""
        places = (s.folder / name for s in self.sources)
        return next((p for p in places if is_file(p)), None) if name else None

    def beside_config(self) -> Path | None:
        """The network card's configuration, which is that of the machine that names it."""
        name = self.body.signals.config
        folders = [s.folder for s in self.sources if s.has("signals", "config", None)]
        place = folders[0] / name if name and folders else None
        return place if place and is_file(place) else None

    def error(self, text: str, table: str = "", key: str = "", item: Any = None) -> InputError:
        """Make the error for a key; where it stands as in `Lines.of`, in a list for an item."""
        return InputError(f"{_place(self.sources, table, key, item)}: {text}")

    def place(self, table: str) -> str:
        """File and line of a table, or of a row of an array: ``contrary.0``."""
        return _place(self.sources, table, "")

    def refuse(self, lines: list[str]) -> None:
        """Raise an InputError with all faults in the order of their lines, if there are any."""
        Faults(ordered(lines, (s.name for s in self.sources))).tell()


def _place(every: Sources, table: str, key: str, item: Any = None) -> str:
    """Where a key, or the nearest table around it, stands in the strongest source that has it."""
    sources, table = every.of(table)
    tries = [(table, key, item), (table, key, None)]
    parts = table.split(".")
    tries += [(".".join(parts[:n]), "", None) for n in range(len(parts), 0, -1)]
    for wanted in tries if table or key else []:
        for source in sources:
            if source.has(*wanted):
                return source.place(table if source.lines else wanted[0], key)
    if sources[0].lines is None:
        return sources[0].place(table, key)
    return f"{sources[0].name}:{sources[0].lines.of(table, key)}"


def read(path: str | Path) -> Document:
    """Read a scenario.toml, or the folder that holds it, and check its keys and their types."""
    document = parsed(of_file(path))
    document.refuse(list(document.wrong))
    return document


def made(tables: Mapping[str, Any], name: str, folder: Path, about: str) -> Document:
    """The document of a dictionary; texts name files beside a folder."""
    own = Source(f"<{name}>", folder, in_rows(plain(tables)), None, about)
    return parsed(chain(own), name)


def changed(document: Document, tables: Mapping[str, Any], name: str) -> Document:
    """A document with other tables, merged as those of a file that extends it."""
    own = Source(
        f"<{name}>", document.sources[0].folder, in_rows(plain(tables)), None, document.about
    )
    return replace(parsed([own, *document.sources], name), changed=True)


def plain(value: Any) -> Any:
    """A value from a program in the types that the TOML reader gives."""
    if isinstance(value, Mapping):
        return {str(k): plain(v) for k, v in value.items()}
    if hasattr(value, "tolist"):  # numpy's
        return value.tolist()
    if isinstance(value, list | tuple | set | frozenset):
        return [plain(v) for v in value]
    return str(value) if isinstance(value, Path) else value


def parsed(sources: list[Source], name: str = "") -> Document:
    """Check keys and types; the document lists the faults and holds the tables that are right."""
    tables, places = merged(spread(sources))
    sound = _numbers(copy.deepcopy(tables))
    wrong = [f"{s.name}:1: {ABOUT}" for s in sources if s.lines is not None and not s.about]
    damaged: set[str] = set()
    try:
        body = Body.model_validate(sound)
    except ValidationError as error:
        wrong += _told(error, places)
        damaged = {str(found["loc"][0]) for found in error.errors()}
        try:
            body = Body.model_validate(_without(sound, error))
        except ValidationError:  # nothing is left to look at
            Faults(ordered(wrong, (s.name for s in sources))).tell()
            raise
    if not damaged & {"stop", *OF_A_SIGNAL} and (told := _ending(body, places)):
        wrong += told
        damaged.add("stop")
    about = next((s.about for s in sources if s.about), name)
    name = name or sources[0].folder.name
    for component, fmu in body.component.items():
        if is_foreign(fmu):
            body.component[component] = _file(places, component, fmu)
    return Document(name, about, body, tables, places, tuple(wrong), frozenset(damaged))


def _file(sources: Sources, component: str, fmu: str) -> str:
    """The path of a foreign FMU, absolute; it is beside the source that names it."""
    owner = next((s for s in sources if component in s.tables.get("component", {})), sources[0])
    return str((owner.folder / fmu).resolve())


def _ending(body: Body, sources: Sources) -> list[str]:
    """What is wrong with stop, fault, limit and settle together."""
    if isinstance(body.stop, str) and body.limit is None:
        text = f"stop = {body.stop!r} is a signal: limit = seconds, the longest run, is missing"
        return [f"{_place(sources, '', 'stop')}: {text}"]
    found = []
    for key in OF_A_SIGNAL:
        if isinstance(body.stop, float) and getattr(body, key) is not None:
            text = f"{key} goes with a stop that is a signal; stop = {body.stop:g} is a time"
            found.append(f"{_place(sources, '', key)}: {text}")
    return found


# CCN 17: each table that has times or bounds, in all the forms that a file may give it.
def _numbers(tables: Tables) -> Tables:
    """Tables with floats where a time or a bound is a whole number, and tuples for pairs."""

    def number(x: Any) -> Any:
        if isinstance(x, list):
            return tuple(number(y) for y in x)
        return float(x) if isinstance(x, int) and not isinstance(x, bool) else x

    out = dict(tables)
    for key in ("stop", "limit", "settle", "step"):
        if key in out:
            out[key] = number(out[key])
    for row in out.get("drive", []) if isinstance(out.get("drive"), list) else []:
        if isinstance(row, dict) and isinstance(row.get("at"), list):
            row["at"] = [number(x) for x in row["at"]]
    checks = [out[table] for table in JUDGED if isinstance(out.get(table), dict)]
    for rows in (rows for table in checks for rows in table.values()):
        for row in rows if isinstance(rows, list) else [rows]:
            for key, x in list(row.items()) if isinstance(row, dict) else []:
                row[key] = number(x)
    return out


def _without(tables: Tables, error: ValidationError) -> Tables:
    """Tables without what pydantic refused; one wrong table of an array takes the array with it."""
    out = dict(tables)
    for found in error.errors():
        top, *rest = found["loc"]
        if top in OPEN and rest and isinstance(out.get(str(top)), dict):
            out[str(top)] = {k: v for k, v in out[str(top)].items() if k != rest[0]}
        elif top in SOUND:
            out[str(top)] = SOUND[str(top)]
        else:
            out.pop(str(top), None)
    return out


def _told(error: ValidationError, sources: Sources) -> list[str]:
    """A line of text for each place at which pydantic found a fault."""
    found: dict[tuple[str, ...], str] = {}
    missing: dict[tuple[str, ...], list[str]] = {}
    for one in error.errors():
        if one["type"] == "missing":
            *around, key = (str(p) for p in one["loc"])
            missing.setdefault(tuple(around), []).append(key)
    meant: set[tuple[str, ...]] = set()
    unknown_first = sorted(error.errors(), key=lambda e: e["type"] != "extra_forbidden")
    for one in unknown_first:
        place = tuple(str(p) for p in one["loc"])
        if one["type"] == "extra_forbidden":
            close, likely = _meant(place, missing.get(place[:-1], []))
            meant.add((*place[:-1], likely))
            what = "table" if len(place) == 1 and isinstance(one["input"], dict | list) else "key"
            named = f"[{place[-1]}]" if what == "table" else repr(place[-1])
            found[place] = f"{_spot(sources, place)}: unknown {what} {named}{close}"
        elif place not in meant:
            place, text = _one(one, place, sources)
            found.setdefault(place, text)
    return list(found.values())


def _meant(place: tuple[str, ...], missing: list[str]) -> tuple[str, str]:
    """Words that suggest what an unknown key may be meant for, and the key that is suggested."""
    model: type[BaseModel] = Body
    for part in place[:-1]:
        if part in tables_.MODELS:
            model = tables_.MODELS[part]
    for known in (missing, list(model.model_fields)):
        if close := suggestion(place[-1], known):
            return close, close.split("'")[1]
    return "", ""


def _missing(found: Any, place: tuple[str, ...], sources: Sources) -> str:
    """The text of a key that is missing, or of a list that is too short."""
    if len(place) == 1:
        return f"{sources[0].name}: {place[0]} is missing"
    if isinstance(found["loc"][-1], int):
        few = list(found["input"])
        shorter = [p for i, p in enumerate(place[:-1]) if not (place[0] in JUDGED and i == 2)]
        told = f"{'.'.join(shorter)} = {shown(few)}: too few values"
        return f"{_spot(sources, place)}: {told}"
    return f"{_place(sources, *_table_key(place[:-1]))}: {place[-1]} is missing"


# CCN 18: each table that pydantic names in its own way has its exception here.
def _one(found: Any, place: tuple[str, ...], sources: Sources) -> tuple[tuple[str, ...], str]:
    """A fault's place, without pydantic's names for the alternatives of a type, and its text."""
    top = place[0]
    if top == "limits":
        place = place[:3]
    elif top in OPEN and top not in JUDGED:
        place = place[:2]  # what follows is a type, or the place in a list
    elif top in ("stop", "limit", "settle", "step"):
        place = place[:1]
    if found["type"] == "missing":
        return place, _missing(found, place, sources)
    spot = _spot(sources, place)
    name = list(place[1:] if top == "set" else place)
    if top in JUDGED:
        del name[2:3]  # number of the table: the key names them all
    value = found["input"]
    if top in ("set", "connect", "component") and isinstance(value, dict) and found["loc"][1:]:
        dotted = f"{place[-1]}.{next(iter(value), '')}"
        owner = next((s for s in sources if s.has(top, place[-1], None)), sources[0])
        text = f'a name with a dot wants quotes: "{dotted}"'
        return place, f"{owner.place(top, dotted)}: {dotted}: {text}"
    value = "..." if isinstance(value, dict) and value else value
    value = list(value) if isinstance(value, tuple) else value
    told = found["msg"].lower()
    if found["type"] == "too_short" and not value:
        told = EMPTY.get(place[-1], "it is empty")
    return place, f"{spot}: {'.'.join(name)} = {shown(value)}: {told}"


def _spot(sources: Sources, place: tuple[str, ...]) -> str:
    return _place(sources, *_table_key(place))


def _table_key(place: tuple[str, ...]) -> tuple[str, str]:
    """Table and key, as `Lines` knows them, of a place that pydantic names."""
    if len(place) == 1:
        return "", place[0]
    depth = 1
    if place[0] == "limits":
        depth = 2
    elif place[0] in ARRAYS:
        depth = 4 if place[2:3] == ("plot",) and len(place) > 3 else 2
    return ".".join(place[:depth]), place[depth] if len(place) > depth else ""
