"""Drawings in HP-GL (PLT files): their lines by pen, and notes on what is ignored."""

from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.drawings.drawing import Drawing, Note
from motionfmu.drawings.plt_plotter import Plotter
from motionfmu.drawings.plt_scan import Scanner


def read(
    file: Path,
    frame: tuple[float, float, float, float] | None = None,
    fills: bool = True,
    page: int = 1,
) -> Drawing:
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
) -> Drawing:
    """Read a page of the text of a PLT file."""
    scan = Scanner(text, name)
    plotter = Plotter(scan, frame, fills)
    plotter.run()
    pages = plotter.pages
    if not 1 <= page <= len(pages):
        there = "one page" if len(pages) == 1 else f"{len(pages)} pages"
        raise InputError(f"{name}: no page {page}, it has {there}")
    notes = [Note(*n) for n in plotter.scan.notes()]
    return Drawing(pages[page - 1], notes, name, text, page, len(pages), scan.in_words)
