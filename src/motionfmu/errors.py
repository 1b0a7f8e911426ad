"""The exceptions for everything a user can get wrong, or can miss."""

import difflib
from collections.abc import Iterable

# How alike two words are from which on one may be meant for the other; 1 is the same.
ALIKE = 0.5


def suggestion(word: str, known: Iterable[str]) -> str:
    """What a misspelt word may be meant for, as the end of a message; else empty."""
    close = difflib.get_close_matches(word, list(known), 1, ALIKE)
    return f"; did you mean {close[0]!r}?" if close else ""


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


class NoNumber(InputError):
    """A run has no such number; the text is the reason.

    A check of it has failed; in a study its cell is empty.
    """
