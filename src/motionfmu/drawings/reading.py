"""A drawing from its file, in any language that is known."""

from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.drawings.drawing import Drawing

PLT = (".plt", ".hpgl", ".hgl", ".plo")
SVG, DXF = ".svg", ".dxf"
ENDINGS = (*PLT, SVG, DXF)

Frame = tuple[float, float, float, float]


def is_drawing(file: Path) -> bool:
    """Whether a file's ending is that of a drawing."""
    return file.suffix.lower() in ENDINGS


def read(file: Path, frame: Frame | None = None, page: int = 1) -> Drawing:
    """Read a drawing; P1 and P2 of the machine and a page are for HP-GL."""
    if Path(file).suffix.lower() in (SVG, DXF):
        needed("drawing")
    try:
        text = Path(file).read_bytes()
    except OSError as error:
        raise InputError(f"cannot read {file}: {error.strerror}") from None
    return parse(text, str(file), frame, page)


def parse(text: bytes, name: str, frame: Frame | None = None, page: int = 1) -> Drawing:
    """Read the text of a drawing, whose name ends as its language does; else it is HP-GL."""
    ending = Path(name).suffix.lower()
    if ending not in (SVG, DXF):
        from motionfmu.drawings import plt

        return plt.parse(text, name, frame, page=page)
    if frame is not None or page != 1:
        raise InputError(f"{name}: a frame and pages are for HP-GL")
    needed("drawing")
    from motionfmu.drawings import dxf, svg

    return (svg if ending == SVG else dxf).parse(text, name)
