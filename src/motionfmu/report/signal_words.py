"""What a variable or a number of an analysis is, in words beside its name."""

import re

from motionfmu.base.units import spelled
from motionfmu.report.contour_words import in_words
from motionfmu.scenarios.record_signals import overlays
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
    if table == "record":
        return _of_record(resolver, name)
    port = resolver.ports.get(table, {}).get(own)
    if port is None:
        return "", ""
    return sentence(port.doc), spelled(port.unit)


def _of_record(resolver: Resolver, name: str) -> tuple[str, str]:
    """Words and unit of a number of a record over its run: ``record.position.nrmse``."""
    whole, _, own = name.partition(".")[2].rpartition(".")
    over = [o for o in overlays(resolver) if whole in (o.signal, o.column)]
    words, unit = MATCH_WORDS.get(own, ("", ""))
    text = f"{words}, run against record {over[0].column}" if over else words
    return text, spelled(over[0].unit) if over and unit == "signal" else unit


# Numbers of a match, in words and with their units.
MATCH_WORDS = {
    "max": ("Largest difference", "signal"),
    "rms": ("RMS of the difference", "signal"),
    "mean": ("Mean difference", "signal"),
    "at": ("Time of the largest difference", "s"),
    "nrmse": ("Norm of the difference over the record's", ""),
    "nrmse_centred": ("Norm of the difference over that of the record less its mean", ""),
    "lag": ("Lag by correlation", "s"),
    "correlation": ("Correlation at the lag", ""),
    "samples": ("Common samples", ""),
}
