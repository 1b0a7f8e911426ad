"""What a variable or a number of an analysis is, in words beside its name."""

import re

from motionfmu.base.units import spelled
from motionfmu.report.contour_words import in_words
from motionfmu.scenarios.system import Resolver

# Where the first clause of a description ends, and its first sentence.
_END, _SENTENCE = re.compile(r"[;:(\[]|, "), re.compile(r"[;(\[]|\. ")


def head(doc: str) -> str:
    """The first clause of a description, for a title; empty if it is a list of values."""
    first = _END.split(doc, maxsplit=1)[0].strip()
    return "" if first[:1].isdigit() else first


def sentence(doc: str) -> str:
    """The first sentence of a description, for a table."""
    return _SENTENCE.split(doc, maxsplit=1)[0].strip()


def titled(name: str, doc: str) -> str:
    """A title: in words, and the variable's name."""
    return f"{words} ({name})" if (words := head(doc)) else name


def words_of(resolver: Resolver, name: str) -> tuple[str, str]:
    """Words and unit of what is checked; both are empty where no description has them."""
    whole = name.partition("[")[0]
    table, _, own = whole.partition(".")
    if table == "contour":
        text, unit = in_words(name.partition(".")[2])
        return text, spelled(unit)
    port = resolver.ports.get(table, {}).get(own)
    if port is None:
        return "", ""
    return sentence(port.doc), spelled(port.unit)
