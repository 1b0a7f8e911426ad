"""Colours and fonts of all charts; the colour-blind can tell them apart."""

from collections.abc import Sequence

INK = "#1b2733"
MUTED = "#5b6b7a"
GRID = "#e4e9ee"
PATH = "#31465a"
RAPID = "#9aa8b5"
# Okabe and Ito's palette: X Y Z U V W
AXES = ("#0072b2", "#d55e00", "#009e73", "#cc79a7", "#a07800", "#56b4e9")
CCW, CW = AXES[0], AXES[1]
# Size of an error: lightness falls all the way, so it reads in grey as well.
HEAT = ("#f3c46b", "#ee8f45", "#d9533b", "#a8204a", "#5a0f45")
COLORSCALE = [[i / (len(HEAT) - 1), color] for i, color in enumerate(HEAT)]
# What stands on a dark page for each colour; there the lightness of an error's colours rises.
DARK = {
    "#ffffff": "#151f29",
    INK: "#e8eef4",
    MUTED: "#93a3b2",
    GRID: "#26333f",
    "#b8c4ce": "#3d4d5b",
    PATH: "#b9c7d4",
    RAPID: "#66768a",
    "#0072b2": "#4aa8e8",
    "#d55e00": "#f0803c",
    "#009e73": "#2fc79a",
    "#cc79a7": "#dd93bd",
    "#a07800": "#d0a92e",
    "#56b4e9": "#8fd0f5",
    "#f3c46b": "#6d4a86",
    "#ee8f45": "#a8487f",
    "#d9533b": "#e0604c",
    "#a8204a": "#f29a4b",
    "#5a0f45": "#fbe3a0",
    "#f0c9a8": "#4c4a55",
    "#9ec8e3": "#2f6d99",
    "#0b5cad": "#56a8f5",
    "#20307a": "#5566b8",
}
SHADES = 256  # that `heat` has
LIGHT = 0.13  # how much of the colour of a band is seen
FONT = "Inter, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif"


def heat(share: float) -> str:
    """The colour of `HEAT` at a share of the way through it, of 256 there are."""
    return _between(HEAT, min(int(share * SHADES), SHADES - 1))


def dark_colors() -> dict[str, str]:
    """What stands on a dark page for each colour and for each shade of `heat`."""
    dark = [DARK[color] for color in HEAT]
    return {_between(HEAT, k): _between(dark, k) for k in range(SHADES)} | DARK


def _between(colors: Sequence[str], shade: int) -> str:
    at = shade / (SHADES - 1) * (len(colors) - 1)
    first = min(int(at), len(colors) - 2)
    pairs = (
        (int(a[k : k + 2], 16), int(b[k : k + 2], 16))
        for a, b in [colors[first : first + 2]]
        for k in (1, 3, 5)
    )
    return "#" + "".join(f"{round(a + (at - first) * (b - a)):02x}" for a, b in pairs)
