"""Names with a pattern in place of the component: one line for all components that have it."""

import fnmatch
from collections.abc import Mapping
from dataclasses import replace
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.scenarios import fmus
from motionfmu.scenarios.body import JUDGED
from motionfmu.scenarios.foreign import is_foreign
from motionfmu.scenarios.table_sources import Source

TABLES = ("set", *JUDGED)  # whose names may be patterns


def matches(name: str, pattern: str) -> bool:
    """Whether a name matches a pattern with ``*`` and ``?``; its brackets are plain letters."""
    return fnmatch.fnmatchcase(name, pattern.replace("[", "[[]"))


def is_pattern(name: str) -> bool:
    """Whether a name is of several components: ``*.p_gain``, ``rod_*.p_gain``."""
    return any(c in name.partition(".")[0] for c in "*?")


def spread(sources: list[Source]) -> list[Source]:
    """Sources with the names of components in the place of patterns."""
    # Of one source a name is stronger than a pattern, and of two patterns the later one.
    if not any(is_pattern(name) for s in sources for t in TABLES for name in _table(s, t)):
        return sources
    components: dict[str, Any] = {}
    for source in reversed(sources):
        for name, fmu in _table(source, "component").items():
            known = isinstance(fmu, str) and is_foreign(fmu)
            components[name] = str((source.folder / fmu).resolve()) if known else fmu
    return [_of(source, components) for source in sources]


def _table(source: Source, name: str) -> Mapping[str, Any]:
    table = source.tables.get(name)
    return table if isinstance(table, dict) else {}


def _of(source: Source, components: Mapping[str, Any]) -> Source:
    tables, written = dict(source.tables), dict(source.written)
    for table in TABLES:
        rows = _table(source, table)
        wide = [name for name in rows if is_pattern(name)]
        found = {name: rows[key] for key in wide for name in _fitting(components, key) or [key]}
        written |= {(table, n): key for key in wide for n in _fitting(components, key)}
        if wide:
            tables[table] = found | {n: value for n, value in rows.items() if n not in wide}
    return replace(source, tables=tables, written=written)


def _fitting(components: Mapping[str, Any], key: str) -> list[str]:
    """The variables that a pattern means."""
    found = []
    pattern, _, variable = key.partition(".")
    for component, fmu in components.items():
        if isinstance(fmu, str) and matches(component, pattern):
            try:
                known = fmus.ports(fmu)
            except InputError:  # it is told where components are looked up
                continue
            if variable in known or variable.partition("[")[0] in known:
                found.append(f"{component}.{variable}")
    return found
