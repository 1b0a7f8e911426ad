"""A diagram is drawn by both back ends: the same curves, names, titles and ends of axes."""

from typing import get_args

import numpy as np
import pytest
from matplotlib.collections import LineCollection
from page_curves import unpacked

from motionfmu.report import matplotlib_figure, plotly_figure
from motionfmu.report.diagram import (
    EQUAL,
    FREE,
    POLAR,
    BandMark,
    BarMark,
    Diagram,
    FieldMark,
    Heat,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    Subplot,
    ends_of,
    one,
    path_diagram,
    path_lines,
)
from motionfmu.report.samples import Samples

TIME = np.linspace(0.0, 2.0, 41)
ACROSS, UP = Scale("Time", "s", (0.0, 2.0)), Scale("Speed", "mm/s", (-1.5, 1.5))


def both(diagram: Diagram) -> tuple[dict, list]:
    """Plotly's figure and matplotlib's axes."""
    return plotly_figure.plotly_figure(diagram), matplotlib_figure.picture("", "", diagram).axes


def test_both_back_ends_know_every_mark() -> None:
    assert set(get_args(Mark)) == set(plotly_figure._TRACES) == set(matplotlib_figure._MARKS)


def test_curves_names_titles_and_ends_are_the_same() -> None:
    curves = [
        LineMark(TIME, np.sin(3.0 * TIME), "sine", "#0072b2"),
        SamplesMark(Samples(TIME, np.cos(TIME)), "cosine", "#d55e00"),
    ]
    rows = [Subplot(UP, [*curves, LevelMark(1.0, "most")]), Subplot(Scale("Stock"), curves[:1])]
    page, axes = both(Diagram((ACROSS,), rows))
    drawn, layout = page["data"], page["layout"]
    assert [t["name"] for t in drawn] == ["sine", "cosine", "sine"]
    assert [t["showlegend"] for t in drawn] == [True, True, False]
    told = [text.get_text() for text in axes[0].get_legend().get_texts()]
    assert told == ["sine", "cosine"] and axes[1].get_legend() is None
    assert np.allclose(unpacked(drawn[0]["y"]), np.sin(3.0 * TIME), atol=1e-6)
    for line, mark in zip(axes[0].lines, (np.sin(3.0 * TIME), np.cos(TIME)), strict=False):
        assert np.allclose(line.get_xdata(), TIME) and np.allclose(line.get_ydata(), mark)
    assert [t["line"]["color"] for t in drawn[:2]] == [c.get_color() for c in axes[0].lines[:2]]
    titles = [layout[k]["title"]["text"] for k in ("xaxis", "yaxis", "yaxis2")]
    assert titles == ["Time [s]", "Speed [mm/s]", "Stock"]
    assert [axes[1].get_xlabel(), *(a.get_ylabel() for a in axes)] == titles
    assert tuple(layout["yaxis"]["range"]) == axes[0].get_ylim() == (-1.5, 1.5)
    assert layout["annotations"][0]["text"] == axes[0].texts[0].get_text() == "most"
    assert layout["shapes"][0]["y0"] == axes[0].lines[2].get_ydata()[0] == 1.0


def test_an_error_is_coloured_by_its_size_and_interrupted_where_it_is_unknown() -> None:
    points = np.column_stack([TIME, TIME**2])
    points[20] = np.nan
    size = np.linspace(0.0, 8.0, len(TIME))
    heat = Heat(size, "Error [µm]", (0.0, 8.0))
    page, axes = both(path_diagram("XY", [path_lines(points, name="path", heat=heat)], 300.0))
    marker = page["data"][0]["marker"]
    assert np.allclose(unpacked(marker["color"]), size) and marker["cmax"] == 8.0
    assert marker["colorbar"]["title"]["text"] == axes[1].get_ylabel() == "Error [µm]"
    lines = next(c for c in axes[0].collections if isinstance(c, LineCollection))
    assert len(lines.get_segments()) == len(TIME) - 3  # NaN is an end of two
    assert lines.get_array().max() == 8.0
    assert page["layout"]["yaxis"]["scaleanchor"] == "x" and axes[0].get_aspect() == 1.0


def test_bars_stand_from_the_top_in_the_order_of_their_names() -> None:
    scale = Scale(ticks=((0.0, "lag"), (1.0, "friction")))
    marks = [BarMark([3.0, None], ["3 µm", ""], "run"), BarMark([2.0, 1.0], ["2", "1"], "theory")]
    page, (axes,) = both(one(Scale("Size", "µm"), scale, marks, 100.0))
    assert page["data"][0]["y"] == ["lag", "friction"] and page["data"][0]["x"] == [3.0, None]
    assert page["layout"]["yaxis"]["autorange"] == "reversed" and axes.yaxis_inverted()
    assert [bar.get_width() for bar in axes.patches] == [3.0, 0.0, 2.0, 1.0]
    assert axes.patches[0].get_y() < axes.patches[2].get_y() < axes.patches[1].get_y()
    assert [t.get_text() for t in axes.get_yticklabels()] == ["lag", "friction"]


def test_bands_rings_and_fields_are_drawn_by_both() -> None:
    page, (axes,) = both(one(ACROSS, UP, [BandMark(TIME, TIME - 1.0, TIME, "band")], 100.0))
    assert page["data"][1]["fill"] == "tonexty" and len(axes.collections) == 1
    ring = Scale(unit="µm", ends=(-2.0, 1.0), ticks=((0.0, "0"),))
    turn = LineMark(np.array([0.0, 90.0]), np.array([0.5, -0.5]), "turn")
    page, (axes,) = both(one(Scale(ticks=((0.0, "+X"),)), ring, [turn], 100.0, POLAR))
    assert np.allclose(unpacked(page["data"][0]["theta"]), [0.0, 90.0])
    assert np.allclose(axes.lines[0].get_xdata(), [0.0, np.pi / 2])
    assert page["layout"]["polar"]["radialaxis"]["range"] == [-2.0, 1.0] == list(axes.get_ylim())
    cost = Heat(np.array([[1.0, 10.0], [10.0, 100.0]]), "cost", (1.0, 100.0), True, (1, 10, 100))
    field = FieldMark(np.array([0.0, 1.0]), np.array([0.0, 1.0]), cost)
    page, axes = both(one(Scale("a"), Scale("b"), [field], 200.0))
    assert page["data"][0]["z"] == [[0.0, 1.0], [1.0, 2.0]] and len(axes[0].collections) == 2
    assert page["data"][0]["colorbar"]["ticktext"] == ["1", "10", "100"]


@pytest.mark.parametrize(("shape", "slim"), [(EQUAL, True), (FREE, False)])
def test_a_straight_path_has_room_beside_it(shape: str, slim: bool) -> None:
    x, y = np.zeros(2), np.array([0.0, 100.0])
    _, (axes,) = both(one(Scale("X"), Scale("Y"), [LineMark(x, y)], 200.0, shape))
    assert (np.ptp(axes.get_xlim()) > 25.0) == slim


def test_room_is_about_all_that_is_finite() -> None:
    low, high = ends_of([np.array([1.0, np.nan]), np.array([3.0])], share=0.1)
    assert (low, high) == pytest.approx((0.8, 3.2))
    assert ends_of([np.array([2.0, 4.0])], zero=True, share=0.0)[0] <= 0.0
    low, high = ends_of([np.zeros(0)])
    assert low < 0.0 and high > 1.0


def test_points_of_a_matrix_share_the_axes_of_their_row_and_column() -> None:
    points = PointMark(TIME, TIME, "runs")
    rows = [Subplot(Scale("b"), [points]), Subplot(Scale("cost"), [points], beside=[[points]])]
    page, axes = both(Diagram((Scale("a"), Scale("b")), rows))
    places = [(t["xaxis"], t["yaxis"]) for t in page["data"]]
    assert places == [("x", "y"), ("x", "y2"), ("x2", "y2")] and len(axes) == 3
    assert axes[1].get_shared_x_axes().joined(axes[0], axes[1])


@pytest.mark.parametrize("log", [False, True])
@pytest.mark.parametrize("upright", [False, True])
def test_a_level_and_its_text_are_at_the_same_place(log: bool, upright: bool) -> None:
    scale = Scale("size", "", (0.1, 1000.0), log=log)
    diagram = Diagram((scale,), [Subplot(scale, [LevelMark(130.0, "asked", upright=upright)])])
    layout = plotly_figure.plotly_figure(diagram)["layout"]
    (line,), (told,) = layout["shapes"], [a for a in layout["annotations"] if a["text"] == "asked"]
    axis = "x" if upright else "y"
    assert line[f"{axis}0"] == 130.0  # of the data, on any axis
    assert told[axis] == pytest.approx(np.log10(130.0) if log else 130.0)


@pytest.mark.parametrize("way", ["x", "y"])
def test_numbers_along_an_axis_are_those_of_its_scale(way: str) -> None:
    """A logarithm, names of states, and a spacing, on either axis of both back ends."""
    line = [LineMark(TIME + 1.0, TIME + 1.0, "line", "#0072b2")]
    scales = {
        "log": Scale("Frequency", log=True),
        "names": Scale("State", ticks=((1.0, "idle"), (2.0, "moves"))),
        "spaced": Scale("Turns", spacing=0.25),
    }
    found = {}
    for name, scale in scales.items():
        across, up = (scale, UP) if way == "x" else (ACROSS, scale)
        page, (axes,) = both(Diagram((across,), [Subplot(up, line)]))
        found[name] = page["layout"][f"{way}axis"], getattr(axes, f"{way}axis")
    assert found["log"][0]["type"] == found["log"][1].get_scale() == "log"
    told = [text.get_text() for text in found["names"][1].get_ticklabels()]
    assert found["names"][0]["ticktext"] == told == ["idle", "moves"]
    assert np.allclose(np.diff(found["spaced"][1].get_majorticklocs()), 0.25)
