"""A drawing: its lines by pen, where each stands in its file, and notes on what is left out."""

from collections.abc import Callable
from dataclasses import dataclass, field
from functools import cached_property

import numpy as np

from motionfmu.drawings.pen_path import Array, PenPath


@dataclass(frozen=True)
class Note:
    """Something of a file that is not drawn, or not as it is there."""

    line: int  # Where it stands first; line and column from 1, byte from 0; 0 if not known
    column: int
    byte: int
    count: int  # How many times
    text: str  # What it is
    told: str = "passed over"  # What became of it; "" if the text says it

    @property
    def words(self) -> str:
        """The note for a reader: what it is, how often, where first."""
        told = f"{self.told} {self.text}" if self.told else self.text
        told += f", {self.count} times" if self.count > 1 else ""
        place = f"line {self.line}" if self.line else ""
        if self.column:
            place += f", column {self.column}, byte {self.byte}"
        return f"{told} ({place})" if place else told


@dataclass(frozen=True)
class Polyline:
    """One move of the pen, down or up, along its path."""

    pen: int  # From 1; 0 draws nothing
    down: bool  # It draws
    path: PenPath  # [mm]
    first: int  # Where it stands in the file, as `Drawing.where` takes it
    speed: float = 0.0  # [mm/s] that the drawing asks for; 0 none

    @property
    def points(self) -> Array:
        """Its vertices, those of chords where it is curved [mm]."""
        return self.path.points


@dataclass(frozen=True)
class Drawing:
    """The drawing of a file, or of one page of it."""

    lines: list[Polyline]  # In the file's order, moves with the pen up between them
    notes: list[Note]  # Of all pages
    name: str = "drawing"  # Of the file
    text: bytes = b""  # Of it
    page: int = 1  # Which one, from 1
    pages: int = 1  # Of the file that draw something
    # A place of a line in words, behind "line "; a file that has none says what has the place.
    place: Callable[[int], str] = str
    # Whether its lines come in an order that was chosen, and one after the other where they meet
    ordered: bool = True
    pens: dict[int, str] = field(default_factory=dict)  # What a pen is in the file: layer, colour

    def where(self, first: int) -> str:
        """Say where a line of the drawing stands.

        Parameters
        ----------
        first : int
            As a `Polyline` has it.

        Returns
        -------
        str
            File and place, in words.
        """
        return f"{self.name}: {self.place(first)}"

    @property
    def order(self) -> str:
        """The order of its contours that is taken if none is chosen."""
        return "file" if self.ordered else "inside"

    @property
    def told(self) -> str:
        """All notes in one line; empty if there are none."""
        return f"{self.name}: " + "; ".join(n.words for n in self.notes) if self.notes else ""

    @property
    def paged(self) -> str:
        """Which page this is, if the file has several; else empty."""
        return f"page {self.page} of {self.pages}" if self.pages > 1 else ""

    @property
    def nothing(self) -> str:
        """The message of a drawing that draws nothing."""
        why = "; ".join(n.words for n in self.notes if n.told)
        return f"{self.name}: nothing is drawn" + (f" ({why})" if why else "")

    @cached_property
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
