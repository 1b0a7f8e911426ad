"""Names of earlier versions that still work: whoever uses one is told so, once in a process."""

import sys
import warnings

_told: set[str] = set()


class OldNameWarning(FutureWarning):
    """A name is one of an earlier version. Python shows it without being asked."""


def renamed(old: str, new: str, ends: str) -> None:
    """Tell that a name is an old one: what it is called now, and the version that refuses it.

    The warning names the line of whoever called the package.
    """
    if old in _told:
        return
    _told.add(old)
    text = f"{old} is {new} now; version {ends} refuses the old name"
    warnings.warn(text, OldNameWarning, stacklevel=_depth_of_caller())


def _depth_of_caller() -> int:
    """How many frames above `renamed` the first one outside the package is."""
    frame, depth = sys._getframe(1), 1
    while frame.f_back and frame.f_globals.get("__name__", "").partition(".")[0] == "motionfmu":
        frame, depth = frame.f_back, depth + 1
    return depth


_formatted = warnings.formatwarning


def one_line(
    message: Warning | str,
    category: type[Warning],
    filename: str,
    lineno: int,
    line: str | None = None,
) -> str:
    """In place of `warnings.formatwarning` in a console command: an old name's is one line."""
    if issubclass(category, OldNameWarning):
        return f"motionfmu: warning: {message}\n"
    return _formatted(message, category, filename, lineno, line)
