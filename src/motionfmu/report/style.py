"""Colours and type of all pictures, safe for the colour-blind."""

from typing import Any

from numpy.typing import NDArray

from motionfmu.report.packed import packed

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
FONT = "Inter, 'Segoe UI', 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif"


def plotted(
    x: NDArray[Any], y: NDArray[Any], name: str, color: str, exact: bool = False, **line: Any
) -> dict[str, Any]:
    """A curve as plotly draws it, with `packed` points."""
    ends = {"x": packed(x, exact), "y": packed(y, exact)}
    plain = {"type": "scatter", "mode": "lines", "name": name}
    return plain | ends | {"line": {"color": color} | line}


def axis(title: str, **more: Any) -> dict[str, Any]:
    """An axis of a plotly figure."""
    plain = {
        "title": {"text": title, "standoff": 8, "font": {"size": 13, "color": INK}},
        "gridcolor": GRID,
        "linecolor": MUTED,
        "zerolinecolor": "#b8c4ce",
        "zerolinewidth": 1,
        "ticks": "outside",
        "tickcolor": GRID,
        "tickfont": {"size": 12, "color": MUTED},
        "automargin": True,
    }
    return plain | more


def layout(height: int, **more: Any) -> dict[str, Any]:
    """Layout of a plotly figure, its legend above the plot."""
    # The height is in pixels.
    plain = {
        "height": height,
        "margin": {"l": 64, "r": 20, "t": 34, "b": 48},
        "paper_bgcolor": "#ffffff",
        "plot_bgcolor": "#ffffff",
        "font": {"family": FONT, "size": 13, "color": INK},
        "hoverlabel": {"font": {"family": FONT, "size": 12}},
        "legend": {
            "orientation": "h",
            "x": 0,
            "xanchor": "left",
            "y": 1.0,
            "yanchor": "bottom",
            "font": {"size": 12},
            "bgcolor": "rgba(255, 255, 255, 0)",  # a mark at the upper edge stays whole
        },
    }
    return plain | more


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
