"""The planned path as the library wrote it: a text, or a long one in a file without a name."""

import io
import os
import weakref
from pathlib import Path
from typing import TYPE_CHECKING

from motionfmu.base.columns import LARGE

if TYPE_CHECKING:
    from motionfmu.analysis.contour import Path as ContourPath
    from motionfmu.analysis.contour.pulse_path import PulsePaths

CALLED = "planned path"  # in messages


class PlannedText:
    """The text of a file that the library wrote; a long one is open, and its name is free."""

    def __init__(self, file: Path) -> None:
        self._text: str | None = None
        self._opened = -1
        if file.stat().st_size < LARGE:
            self._text = file.read_text(encoding="utf-8")
            return
        self._opened = os.open(file, os.O_RDONLY)
        weakref.finalize(self, os.close, self._opened)
        file.unlink()

    def text(self) -> str:
        """All of it."""
        if self._text is not None:
            return self._text
        with self._stream() as stream:
            return stream.read()

    def path(self, known: "PulsePaths") -> "ContourPath":
        """The path that it tells of, which other runs may have told of before."""
        from motionfmu.analysis.contour.planned_geometry import path_of, path_of_text

        if self._text is not None:
            return known.path(self._text, lambda text: path_of_text(text, CALLED))
        with self._stream() as stream:
            return path_of(stream, CALLED)

    def _stream(self) -> io.TextIOWrapper:
        again = os.dup(self._opened)
        os.lseek(again, 0, os.SEEK_SET)
        return open(again, encoding="utf-8", newline="")
