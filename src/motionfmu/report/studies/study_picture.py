"""The look that the pictures of all studies share."""

from pathlib import Path

from matplotlib.figure import Figure

DPI = 130


def save(figure: Figure, picture: Path) -> None:
    """Give all axes the common look, write the file and print where it is."""
    for axes in figure.axes:
        axes.grid(alpha=0.25)
        axes.spines[["top", "right"]].set_visible(False)
    figure.tight_layout()
    figure.savefig(picture, dpi=DPI)
    print(f"picture: {picture}")
