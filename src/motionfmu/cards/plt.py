"""Drawings in HP-GL (PLT files): their lines by pen, and notes on what is ignored."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from motionfmu.base.errors import InputError
from motionfmu.cards.plt_plotter import Plotter, Polyline
from motionfmu.cards.plt_scan import Scanner

__all__ = ["Note", "PltDrawing", "Polyline", "parse", "read"]


@dataclass(frozen=True)
class Note:
    """An instruction of a file that is ignored."""

    line: int  # Where it stands first; line and column from 1, byte from 0
    column: int
    byte: int
    count: int  # How many times
    text: str  # What it is


@dataclass(frozen=True)
class PltDrawing:
    """The drawing of one page of a PLT file."""

    lines: list[Polyline]  # In the file's order, moves with the pen up between them
    notes: list[Note]  # Of all pages
    name: str = "drawing"  # Of the file
    text: bytes = b""  # Of it
    page: int = 1  # Which one, from 1
    pages: int = 1  # Of the file that draw something

    def where(self, byte: int) -> str:
        """Say where a byte stands, in words."""
        return Scanner(self.text, self.name).where(byte)

    @property
    def layers(self) -> dict[int, list[Polyline]]:
        """Drawn lines by pen."""
        pens = sorted({p.pen for p in self.lines if p.down})
        return {n: [p for p in self.lines if p.down and p.pen == n] for n in pens}

    @property
    def extent(self) -> np.ndarray:
        """Lowest and highest place of the drawn lines."""
        drawn = [p.points for p in self.lines if p.down]
        if not drawn:
            return np.zeros((2, 2))
        every = np.vstack(drawn)
        return np.stack([every.min(axis=0), every.max(axis=0)])


def read(
    file: Path,
    frame: tuple[float, float, float, float] | None = None,
    fills: bool = True,
    page: int = 1,
) -> PltDrawing:
    """Read a page of a PLT file."""
    try:
        text = Path(file).read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None
    return parse(text, str(file), frame, fills, page)


def parse(
    text: bytes,
    name: str = "drawing",
    frame: tuple[float, float, float, float] | None = None,
    fills: bool = True,
    page: int = 1,
) -> PltDrawing:
    """Read a page of the text of a PLT file."""
    plotter = Plotter(Scanner(text, name), frame, fills)
    plotter.run()
    pages = plotter.pages
    if not 1 <= page <= len(pages):
        there = "one page" if len(pages) == 1 else f"{len(pages)} pages"
        raise InputError(f"{name}: no page {page}, it has {there}")
    notes = [Note(*n) for n in plotter.scan.notes()]
    return PltDrawing(pages[page - 1], notes, name, text, page, len(pages))
