"""What a variable or a number of an analysis is, in words beside its name."""

import re
from collections.abc import Sequence

from motionfmu.base.units import spelled
from motionfmu.report.contour_words import in_words
from motionfmu.run.checks import Verdict, parts
from motionfmu.scenarios.fault_advice import meanings
from motionfmu.scenarios.record_signals import overlays
from motionfmu.scenarios.system import Resolver

# Where the first clause of a description ends, and its first sentence.
_END, _SENTENCE = re.compile(r"[;:(\[]|, "), re.compile(r"[;(\[]|\. ")
# How bounds begin that hold for the value, not for how often or how fast it changes.
_OF_THE_VALUE = ("final", "|.|", ">=", "<=", "min", "max")


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


def of_check(resolver: Resolver, check: Verdict) -> tuple[str, str]:
    """Words and unit of a checked quantity, with what the value found means."""
    words, wanted, _ = parts(check.bounds)
    found = [check.value] if words.startswith(_OF_THE_VALUE) else []
    if words.startswith("order"):
        found = [float(n) for n in wanted.split(",")]
    return words_of(resolver, check.name, found)


def words_of(resolver: Resolver, name: str, values: Sequence[float] = ()) -> tuple[str, str]:
    """Words and unit of a quantity, with what these values of it mean; empty if nothing says it."""
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
    if port.declared and (known := meanings(port)):
        what = sentence(port.doc.replace(port.declared[1], "").rstrip(": "))
        words = ", ".join(known[int(v)] for v in values if v in known)
        return ": ".join(filter(None, (what, words))), ""
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
