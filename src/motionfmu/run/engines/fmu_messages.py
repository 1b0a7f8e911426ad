"""Messages of FMUs in a run: warnings, and the error that ends the run."""

import re

from motionfmu.base.errors import InputError
from motionfmu.run.translated_places import in_source

WARNING, ERROR = 1, 3  # status in both FMI versions; from ERROR on a run cannot go on
# A run keeps so many different warnings of each component, and a line that tells of more.
_MOST = 20
_NAMED = re.compile(r"^\w+: ")


def unnamed(message: str) -> bool:
    """Whether a message does not begin with a component's name."""
    return _NAMED.match(message) is None


def keep(status: int, text: str, errors: list[str], warnings: list[str]) -> None:
    """Keep an error, or a warning of a component, each warning once."""
    text = in_source(text)
    if status >= ERROR:
        errors.append(text)
    elif status == WARNING and (named := _NAMED.match(text)) and text not in warnings:
        kept = sum(told.startswith(named[0]) for told in warnings)
        if kept < _MOST:
            warnings.append(text)
        elif kept == _MOST:
            warnings.append(f"{named[0]}more warnings than these {_MOST}, which are its first")


def failure(name: str, call: str, errors: list[str]) -> InputError:
    """The error for a call that failed: the message of the first component that gave one."""
    own = f"{name}: "
    inner = [m for m in errors if not m.startswith(own)]
    told = [*inner, *errors, f"{own}{call} failed without a message"]
    first = sorted(told[: len(inner)] or told[:1], key=unnamed)[0]
    place = first.partition(": line ")[0] + ": "
    return InputError(first, *(m for m in errors if m.startswith(place) and m != first))
