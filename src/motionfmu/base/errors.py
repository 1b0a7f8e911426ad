"""The exceptions for everything that a user can get wrong, or that a run cannot give."""

import contextlib
from collections.abc import Callable, Iterable, Iterator
from typing import TypeVar

T = TypeVar("T")
# A message tells so many faults at once.
TOLD_MAX = 50

# Similarity from which on one word may be meant for another; 1 is that of equal words.
ALIKE = 0.5


def suggestion(word: str, known: Iterable[str]) -> str:
    """The end of a message with the word that a misspelt one may be meant for; empty if none."""
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
    """Gathers faults, so that a user is told all of them at once.

    An `InputError` without a line is one whose cause is told elsewhere.
    """

    def __init__(self, lines: Iterable[str] = ()) -> None:
        self.lines = list(lines)

    @contextlib.contextmanager
    def each(self) -> Iterator[None]:
        """Keep an InputError of the block and go on behind it."""
        try:
            yield
        except InputError as error:
            self.lines += error.args

    def of(self, make: Callable[[], T]) -> T | None:
        """The result of a function; None if it raises an InputError, which is kept."""
        with self.each():
            return make()
        return None

    def tell(self) -> None:
        """Raise one InputError with all faults, if there are any."""
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
