"""Pages of the files that a user writes: their tables and keys, from the models that read them."""

import types
from collections.abc import Iterator, Mapping
from dataclasses import dataclass, field
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel
from pydantic.fields import FieldInfo

from site_pages.key_words import words_of
from site_pages.markdown import code, plain, table

WORDS = {float: "number", int: "whole number", str: "text", bool: "true or false", Any: "value"}
SIGNS = (("gt", "> "), ("ge", ">= "), ("lt", "< "), ("le", "<= "))


@dataclass(frozen=True)
class TomlFile:
    """A kind of file: its name, what it is, and its model."""

    name: str
    about: str
    model: type[BaseModel]
    # Models of tables whose type the field does not tell, by the path of the table.
    more: Mapping[str, type[BaseModel]] = field(default_factory=dict)


def files() -> list[TomlFile]:
    """The files that a user writes, and those that belong to an FMU."""
    from motionfmu.analysis.collisions import cell
    from motionfmu.analysis.explain.cause_switches import Switch
    from motionfmu.arms import arm_table
    from motionfmu.cards.config import CardConfig
    from motionfmu.identify.arm_dynamics.arm_options import ArmTables
    from motionfmu.identify.arm_dynamics.arm_plant import ArmTable
    from motionfmu.identify.free_parameters import Identifiable
    from motionfmu.identify.identify_file import AxisTables
    from motionfmu.live.panel import OperatorPanel
    from motionfmu.scenarios.body import Body
    from motionfmu.study import study_axes
    from motionfmu.study.study_file import StudyBody
    from motionfmu.study.tune.problem import Problem

    axis = {
        "axis.NAME (a range)": study_axes.Span,
        "axis.NAME (normal)": study_axes.Normal,
        "axis.NAME (values)": study_axes.ListedValues,
    }
    return [
        TomlFile(
            "scenario.toml",
            "A scenario: which FMUs, how they are wired, set, driven, recorded and judged."
            " A machine.toml has the same keys; a scenario that names a machine extends it."
            " At the top, extends takes the tables of another file;"
            " without takes some of them away.",
            Body,
        ),
        TomlFile("sweep.toml", "A study: one scenario with many values.", StudyBody, axis),
        TomlFile("tune.toml", "A tuning: which gains are found, and what they must keep.", Problem),
        TomlFile(
            "identify.toml",
            "An identification of an axis, beside its scenario: what the record's columns are.",
            AxisTables,
        ),
        TomlFile(
            "identify.toml for an arm",
            "An identification of an arm, beside its scenario: what the record's columns are.",
            ArmTables,
        ),
        TomlFile(
            "identify.toml of an FMU",
            "What a record of a motion can tell of an FMU.",
            Identifiable,
            {"arm": ArmTable},
        ),
        TomlFile("cell.toml", "What stands around an arm.", cell._CellFile),
        TomlFile("arm.toml", "An arm as a table of its geometry.", arm_table._TableFile),
        TomlFile("card.toml", "A card in a network, its axes and tasks.", CardConfig),
        TomlFile("panel.toml", "What an operator has of an FMU.", OperatorPanel),
        TomlFile("causes.toml", "How an FMU switches a cause of error off.", _by_name(Switch)),
    ]


def _by_name(model: type[BaseModel]) -> type[BaseModel]:
    """A file that has a table of the model under each name."""
    from pydantic import RootModel

    return RootModel[dict[str, model]]  # type: ignore[valid-type]


def page(file: TomlFile) -> str:
    """The page of a file."""
    text = f"# {file.name}\n\n{plain(file.about)}\n\n"
    for path, model in tables(file):
        rows = [_row(name, f, words_of(model)) for name, f in fields_of(model).items()]
        if rows:
            head = ("key", "type", "default", "meaning")
            text += _heading(path) + _about(model) + table(head, rows) + "\n"
    return text


def _heading(path: str) -> str:
    return f"## {code(path)}\n\n" if path else "## Keys at the top\n\n"


def _about(model: type[BaseModel]) -> str:
    own = vars(model).get("__doc__") or ""
    told = own.split("\n\n")[0].strip()
    return f"{plain(told)}\n\n" if told else ""


def tables(file: TomlFile) -> Iterator[tuple[str, type[BaseModel]]]:
    """All tables of a file with their paths as TOML has them."""
    done: set[tuple[str, type]] = set()
    waiting = [("", "", file.model), *((f"[{n}]", n, m) for n, m in file.more.items())]
    while waiting:
        heading, path, model = waiting.pop(0)
        if (heading, model) in done:
            continue
        done.add((heading, model))
        yield heading, model
        inner = []
        for name, f in model.model_fields.items():
            for form, kind in _models(f.annotation):
                key = "" if name == "root" else f.alias or name
                whole = ".".join(p for p in (path, key, "NAME" * (form == "dict")) if p)
                inner.append((f"[[{whole}]]" if form == "list" else f"[{whole}]", whole, kind))
        waiting = inner + waiting


def _models(kind: Any, form: str = "") -> Iterator[tuple[str, type[BaseModel]]]:
    """Models within an annotation, and whether they stand in a list or a dictionary."""
    if isinstance(kind, type) and issubclass(kind, BaseModel):
        yield form, kind
        return
    origin = get_origin(kind)
    if origin is Annotated:
        yield from _models(get_args(kind)[0], form)
        return
    inside = {list: "list", tuple: "list", dict: "dict"}.get(origin, form)
    for part in get_args(kind) if origin is not Literal else ():
        yield from _models(part, form if form == "dict" else inside)


def fields_of(model: type[BaseModel]) -> dict[str, FieldInfo]:
    """Keys of a table that are no tables themselves."""
    return {
        name: f
        for name, f in model.model_fields.items()
        if not list(_models(f.annotation)) and name != "root"
    }


def _row(name: str, f: FieldInfo, words: Mapping[str, str]) -> tuple[str, ...]:
    own = next((m for m in f.metadata if hasattr(m, "words") and hasattr(m, "unit")), None)
    told = words.get(name, "") or (own.words if own else "")
    unit = f" [{own.unit}]" if own and own.unit else ""
    limits = ", ".join(dict.fromkeys(_limits(f.metadata) + _inner_limits(f.annotation)))
    told_type = kind(f.annotation) + (f", {limits}" if limits else "")
    return code(f.alias or name), plain(told_type), _default(f), plain(told + unit)


def kind(annotation: Any) -> str:
    """What a value is, in words."""
    if annotation in WORDS:
        return WORDS[annotation]
    origin, parts = get_origin(annotation), get_args(annotation)
    if origin is Annotated:
        return kind(parts[0])
    if origin is Literal:
        return " or ".join(f'"{p}"' if isinstance(p, str) else str(p) for p in parts)
    if origin in (Union, types.UnionType):
        return ", or ".join(dict.fromkeys(kind(p) for p in parts if p is not types.NoneType))
    if origin is dict:
        return f"table: {kind(parts[1])} by name"
    if origin is tuple and parts[-1] is not Ellipsis:
        return f"{len(parts)} of: {kind(parts[0])}"
    if origin in (list, tuple):
        return f"list of: {kind(parts[0])}"
    return str(getattr(annotation, "__name__", annotation))


def _limits(metadata: Any) -> list[str]:
    found = [
        f"{sign}{getattr(m, key):g}"
        for m in metadata
        for key, sign in SIGNS
        if getattr(m, key, None) is not None
    ]
    if least := [m.min_length for m in metadata if getattr(m, "min_length", None)]:
        found.append(f"{least[0]} entr{'y' if least[0] == 1 else 'ies'} or more")
    return found


def _inner_limits(annotation: Any) -> list[str]:
    """Limits within an annotation, as of the entries of a list; only those of numbers."""
    if get_origin(annotation) is Literal:
        return []
    parts = get_args(annotation)
    if get_origin(annotation) is Annotated:
        inner = [n for m in parts[1:] for n in (m.metadata if isinstance(m, FieldInfo) else [m])]
        return [t for t in _limits(inner) if "entr" not in t] + _inner_limits(parts[0])
    return [text for part in parts for text in _inner_limits(part)]


def _default(f: FieldInfo) -> str:
    if f.is_required():
        return "required"
    value = f.get_default(call_default_factory=True)
    return "" if value in (None, {}, [], "") else code(_toml(value))


def _toml(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, list | tuple):
        return f"[{', '.join(map(_toml, value))}]"
    return f'"{value}"' if isinstance(value, str) else f"{value:.10g}"
