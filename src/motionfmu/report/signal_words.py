"""What a variable or a number of an analysis is, in words beside its name."""

import re

from motionfmu.report.contour_words import in_words
from motionfmu.scenarios.system import Resolver
from motionfmu.units import spelled

# Where the first clause of a description ends.
_END = re.compile(r"[;:(\[]|, ")


def head(doc: str) -> str:
    """The first clause of a description, for a title."""
    return _END.split(doc, maxsplit=1)[0].strip()


def titled(name: str, doc: str) -> str:
    """A title: in words, and the variable's name."""
    return f"{words} ({name})" if (words := head(doc)) else name


def words_of(resolver: Resolver, name: str) -> tuple[str, str]:
    """What is checked, and its unit as on all pages; both empty where nothing says so."""
    whole = name.partition("[")[0]
    table, _, own = whole.partition(".")
    if table == "contour":
        text, unit = in_words(name.partition(".")[2])
        return text, spelled(unit)
    port = resolver.ports.get(table, {}).get(own)
    return (head(port.doc), spelled(port.unit)) if port is not None else ("", "")
