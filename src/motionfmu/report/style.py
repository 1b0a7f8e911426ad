"""Colours and fonts of all charts; the colour-blind can tell them apart."""

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
LIGHT = 0.13  # how much of the colour of a band is seen
FONT = "Inter, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif"


def heat(share: float) -> str:
    """The colour of `HEAT` at a share of the way through it, of 256 there are."""
    at = min(int(share * 256), 255) / 255 * (len(HEAT) - 1)
    first = min(int(at), len(HEAT) - 2)
    pairs = (
        (int(a[k : k + 2], 16), int(b[k : k + 2], 16))
        for a, b in [HEAT[first : first + 2]]
        for k in (1, 3, 5)
    )
    return "#" + "".join(f"{round(a + (at - first) * (b - a)):02x}" for a, b in pairs)
