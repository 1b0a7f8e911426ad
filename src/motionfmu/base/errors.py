"""The exceptions for everything a user can get wrong, or can miss."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

T = TypeVar("T")
# Things that are wrong and told at once.
TOLD_MAX = 50

# How alike two words are from which on one may be meant for the other; 1 is the same.
ALIKE = 0.5


def suggestion(word: str, known: Iterable[str]) -> str:
    """What a misspelt word may be meant for, as the end of a message; else empty."""
    import difflib

    small = {name.lower(): name for name in known}
    close = difflib.get_close_matches(word.lower(), list(small), 1, ALIKE)
    return f"; did you mean {small[close[0]]!r}?" if close else ""


class InputError(ValueError):
    """Wrong input; the text is the message a user reads.

    The message says file, line and value where they exist, on one line for each thing that is
    wrong. The console command prints it and ends with status 2.

    Parameters
    ----------
    *lines : str
        What cannot be printed, such as an end of line in a name, is shown by its escape.
    """

    def __init__(self, *lines: str) -> None:
        shown = ("".join(c if c.isprintable() else repr(c)[1:-1] for c in t) for t in lines)
        super().__init__(*shown)

    def __str__(self) -> str:
        return "\n".join(self.args)


class Faults:
    """Gathers what is wrong, to be told at once.

    An `InputError` without a line is one of which the cause is told elsewhere.
    """

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self.lines = list(lines)

    @contextlib.contextmanager
    def each(self) -> Iterator[None]:
        """Keep an error of the block; what follows the block goes on."""
        try:
            yield
        except InputError as error:
            self.lines += error.args

    def of(self, make: Callable[[], T]) -> T | None:
        """What a function makes; None if it finds an error, which is kept."""
        with self.each():
            return make()
        return None

    def tell(self) -> None:
        """Raise what was gathered as one error; nothing if there is none."""
        lines = list(dict.fromkeys(self.lines))
        if len(lines) > TOLD_MAX:
            lines = [*lines[:TOLD_MAX], f"and {len(lines) - TOLD_MAX} more"]
        if lines:
            raise InputError(*lines)


class NoNumber(InputError):
    """A run has no such number; the text is the reason.

    A check of it has failed; in a study its cell is empty.
    """


class UnknownSignal(InputError, KeyError):
    """A result has no such signal, or a signal no such element."""
