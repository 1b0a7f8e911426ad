"""A figure of matplotlib in the colours of a dark page."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from functools import partial
from typing import Any

import numpy as np
from matplotlib.artist import Artist
from matplotlib.cm import ScalarMappable
from matplotlib.collections import Collection
from matplotlib.colors import LinearSegmentedColormap, to_hex, to_rgba
from matplotlib.figure import Figure
from matplotlib.lines import Line2D
from matplotlib.patches import Patch
from matplotlib.text import Text

from motionfmu.report.style import DARK, HEAT, INK, dark_colors

COLORS = LinearSegmentedColormap.from_list("heat", HEAT)
DARK_COLORS = LinearSegmentedColormap.from_list("dark heat", [DARK[color] for color in HEAT])
# Also of what nobody has given a colour.
_DARK = dark_colors() | {"#000000": DARK[INK]}


@contextmanager
def darkened(figure: Figure) -> Iterator[None]:
    """A figure has dark colours in the block; colours that are not the package's own stay."""
    # A copy cannot be had: what a user adds to a figure need not be copied by pickle.
    figure.draw_without_rendering()  # now every tick is there
    undo: list[Callable[[], Any]] = []
    try:
        for artist in figure.findobj():
            _darken(artist, undo)
        yield
    finally:
        for back in reversed(undo):
            back()


def _dark(color: Any) -> Any:
    """The colour, or each of several, of a dark page; its opacity stays."""
    if isinstance(color, np.ndarray) and color.ndim == 2:
        return [_dark(tuple(one)) for one in color]
    red, green, blue, alpha = to_rgba(color)
    plain = to_hex((red, green, blue))
    return to_rgba(_DARK.get(plain, plain), alpha)


def _darken(artist: Artist, undo: list[Callable[[], Any]]) -> None:
    names: tuple[str, ...] = ()
    if isinstance(artist, ScalarMappable) and artist.get_array() is not None:
        if artist.get_cmap().name == COLORS.name:
            undo.append(partial(artist.set_cmap, artist.get_cmap()))
            artist.set_cmap(DARK_COLORS)
    elif isinstance(artist, Collection | Patch):
        names = "facecolor", "edgecolor"
    elif isinstance(artist, Line2D):
        names = "color", "markerfacecolor", "markeredgecolor"
    elif isinstance(artist, Text):
        names = ("color",)
        if (box := artist.get_bbox_patch()) is not None:
            _darken(box, undo)
    for name in names:
        put, color = getattr(artist, f"set_{name}"), getattr(artist, f"get_{name}")()
        undo.append(partial(put, color))
        put(_dark(color))
