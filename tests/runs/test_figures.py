"""Figures of a scenario show the recorded numbers, and wrong ones get one message."""

from pathlib import Path

import matplotlib.image
import numpy as np
import pytest
from page_curves import curve, page_data, unwoven

import motionfmu
from motionfmu.base.toml_lines import Lines
from motionfmu.report.matplotlib_figure import BUCKETS, picture, thinned
from motionfmu.report.plotly_figure import plotly_figure
from motionfmu.report.result_folder import Kept, save
from motionfmu.report.samples import COARSE, Samples
from motionfmu.report.signal_chart import signal_chart
from motionfmu.run.figures import OVERVIEW, Chart, Curve, Panel

# What they share is made once, by one worker.
pytestmark = pytest.mark.xdist_group("figures")

# 1 V is 300 rpm: 5 turns of 10 mm, 50 000 encoder counts per second.
SPEED, COUNTS = 0.05, 50_000.0
PLAIN = """# A voltage step on an axis whose encoder the card counts.
stop = 0.3
step = 1e-4
leave = ["card.*"]

[component]
machine = "velocity_axes"
card = "epcio"

[connect]
"card.enc_phase" = "machine.motor_phase"

[[drive]]
input = "machine.voltage"
at = [0.0, 0.1, 0.2]
value = [0.0, [2.0, -1.0, 0.0, 0.0, 0.0, 0.0], 0.0]

[[drive]]
input = "card.io_stop"
at = [0.0, 0.15, 0.1501]
value = [false, true, false]

[record]
signals = ["machine.table_position"]

[check]
"machine.table_position[1]" = { final = [0.0099, 0.0101] }
"""
FIGURES = """
[[figure]]
title = "Position & speed"
note = "A note."

[[figure.plot]]
signals = ["machine.table_position[1]", "machine.table_position[2]"]
label = "position [mm]"
scale = 1e3
names = ["X", "Y"]
levels = { "10 mm" = 10 }

[[figure.plot]]
signals = ["card.enc_count"]
label = "count rate [1/s]"
rate = 2e-3

[[figure]]
title = "Stop"
window = [0.1495, 0.1515]

[[figure.plot]]
signals = ["card.stopped"]
label = "stopped"

[[figure.plot]]
signals = ["machine.table_position[1]"]
label = "position [m]"
steps = true
"""


def scenario(folder: Path, text: str) -> Path:
    folder = folder / "mine"
    folder.mkdir()
    (folder / "scenario.toml").write_text(text)
    return folder


@pytest.fixture(scope="module")
def drawn(tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("figures")
    result = motionfmu.load(scenario(folder, PLAIN + FIGURES)).run()
    return result, save(result, folder / "out", Kept(pictures=True)).parent


def figures_on(folder: Path) -> list[dict]:
    return page_data(folder / "report.html")["figures"]


def on_page(folder: Path, figure: int) -> list[tuple[np.ndarray, np.ndarray]]:
    data = page_data(folder / "report.html")
    return [curve(data, t) for t in data["figures"][figure]["data"]]


def in_picture(chart: Chart) -> list[tuple[np.ndarray, np.ndarray]]:
    """Curves of the matplotlib picture, without the levels."""
    drawn = picture(chart.title, chart.note, signal_chart(chart))
    lines = [line for axes in drawn.axes for line in axes.lines]
    return [line.get_data() for line in lines if len(line.get_xdata()) > 2]


def both(drawn, figure: int) -> list[list[tuple[np.ndarray, np.ndarray]]]:
    result, folder = drawn
    return [on_page(folder, figure), in_picture(result.figures()[figure])]


def test_curves_hold_the_recorded_numbers(drawn) -> None:
    result, _ = drawn
    recorded = 1e3 * result["machine.table_position"]
    for curves in both(drawn, 0):
        assert len(curves) == 2 + 6
        for axis, (time, values) in enumerate(curves[:2]):
            rows = np.rint(time / 1e-4).astype(int)
            assert np.allclose(time, result.time[rows], rtol=0, atol=1e-12)
            near = COARSE * np.ptp(recorded[:, axis])
            assert np.abs(values - recorded[rows, axis]).max() <= near
            assert abs(values.max() - recorded[:, axis].max()) <= near
            assert abs(values.min() - recorded[:, axis].min()) <= near


def test_rate_is_the_slope_of_a_ramp(drawn) -> None:
    for curves in both(drawn, 0):
        for axis, (volts, (time, rate)) in enumerate(
            zip((2.0, -1.0, 0.0, 0.0, 0.0, 0.0), curves[2:], strict=True)
        ):
            assert time[0] == pytest.approx(2e-3, abs=1e-12)
            still = (time < 0.0999) | (time > 0.203)
            moving = (time > 0.103) & (time < 0.1999)
            # a whole number of counts over 2 ms
            assert np.abs(rate[moving] - volts * COUNTS).max() <= 1 / 2e-3, axis
            assert np.abs(rate[still]).max() <= 1e-9, axis


def test_rate_of_a_ramp_made_by_hand(drawn) -> None:
    result, _ = drawn
    ramp = 7 * np.arange(len(result.time), dtype=np.int32)[:, None] * np.arange(1, 7)
    given = {**result.signals, "card.enc_count": ramp.astype(np.int32)}
    hand = motionfmu.Result(result.scenario, result.time, given, {})
    for axis, line in enumerate(hand.figures()[0].panels[1].curves, 1):
        assert np.allclose(line.values, 7 * axis / 1e-4)
        assert len(line.values) == len(result.time) - 20


def test_a_window_shows_its_samples_as_steps(drawn) -> None:
    result, folder = drawn
    stopped = result["card.stopped"]
    assert stopped.dtype == bool and 0 < stopped.sum() < 10
    for curves in both(drawn, 1):
        time, values = curves[0]
        assert time[0] <= 0.1495 and 0.1515 <= time[-1] < 0.1517
        row = np.searchsorted(time, result.time[1490:1520] + 1e-9) - 1
        held = values[np.clip(row, 0, None)]
        assert np.array_equal(held[5:26], stopped[1495:1516])
    whole, own, _ = figures_on(folder)  # and the speed of the tool
    assert whole["over_time"] and not own["over_time"]
    assert own["layout"]["xaxis"]["range"] == [0.1495, 0.1515]
    assert {t["line"]["shape"] for t in own["data"]} == {"hv"}
    assert {t["line"]["shape"] for t in whole["data"]} == {"linear"}


def test_the_page_says_what_the_figure_says(drawn) -> None:
    result, folder = drawn
    page = (folder / "report.html").read_text()
    assert "<h2>Position &amp; speed</h2>" in page and "A note." in page
    assert page.index("<h2>Verdict</h2>") < page.index("<h2>Position")
    assert "the check holds" in page or "all 2 checks hold" in page
    figure = figures_on(folder)[0]
    assert [t["name"] for t in figure["data"]][:3] == ["X", "Y", "card.enc_count[1]"]
    assert figure["layout"]["yaxis2"]["title"]["text"] == "count rate [1/s]"
    assert [a["text"] for a in figure["layout"]["annotations"]] == ["10 mm"]
    assert figure["layout"]["shapes"][0]["y0"] == 10.0
    low, high = figure["layout"]["yaxis"]["range"]
    assert low < -5.0 and high > 10.0
    assert result["card.enc_count"].shape == (3000, 6)  # recorded for the figure


def test_pictures_are_pictures(drawn) -> None:
    _, folder = drawn
    assert {p.name for p in folder.glob("figure*")} == {
        f"figure{i}.{kind}" for i in (1, 2) for kind in ("png", "svg")
    }
    for i in (1, 2):
        picture = matplotlib.image.imread(folder / f"figure{i}.png")
        assert picture.shape[1] == 9 * 130 and picture.shape[0] > 400
        assert len(np.unique(picture[::3, ::3].reshape(-1, 4), axis=0)) > 50
        assert (folder / f"figure{i}.svg").read_text().lstrip().startswith("<?xml")


def test_figures_change_no_recorded_value(drawn, tmp_path: Path) -> None:
    result, _ = drawn
    plain = motionfmu.load(scenario(tmp_path, PLAIN)).run()
    assert set(plain.signals) == {"machine.table_position"}
    assert set(result.signals) == {"machine.table_position", "card.enc_count", "card.stopped"}
    for name, values in plain.signals.items():
        assert np.array_equal(values, result[name])
    assert [(v.value, v.ok) for v in plain.checks] == [(v.value, v.ok) for v in result.checks]


def test_without_figures_the_report_shows_the_signals(tmp_path: Path) -> None:
    more = 'signals = ["machine.*", "card.s*", "card.o*", "card.e*"]'
    text = PLAIN.replace('signals = ["machine.table_position"]', more)
    result = motionfmu.load(scenario(tmp_path, text)).run()
    folder = save(result, tmp_path / "out").parent
    figures = [f for f in figures_on(folder) if f["id"] != "speed"]
    assert len(result.signals) > len(figures) == OVERVIEW
    page = (folder / "report.html").read_text()
    assert f"{OVERVIEW} of {len(result.signals)} recorded signals are shown" in page
    assert not list(folder.glob("figure*"))
    for (name, data), figure in zip(result.signals.items(), figures, strict=False):
        assert name in figure["layout"]["yaxis"]["title"]["text"]
        for column, trace in zip(data.reshape(len(data), -1).T, figure["data"], strict=True):
            values = unwoven(trace["samples"]["values"])
            assert abs(values.max() - column.max()) <= COARSE * np.ptp(column.astype(float))


def test_a_shorter_run_leaves_a_later_window_empty(tmp_path: Path) -> None:
    result = motionfmu.load(scenario(tmp_path, PLAIN + FIGURES)).run(stop=1e-3)
    folder = save(result, tmp_path / "out").parent
    rate, stopped = on_page(folder, 0)[2], on_page(folder, 1)[0]
    assert len(rate[0]) == 0 and len(stopped[0]) <= 1


@pytest.mark.parametrize("steps", [False, True])
def test_thinning_keeps_peaks_and_steps(steps: bool) -> None:
    time = np.arange(100_000) * 1e-4
    values = np.sin(time)
    values[12_345], values[54_321] = 9.0, -9.0
    part = thinned(Samples(time, values, steps))
    assert len(part.values) <= 2 * BUCKETS + 2 and 9.0 in part.values and -9.0 in part.values
    staircase = np.floor(time)
    part = thinned(Samples(time, staircase, True))
    held = part.values[np.searchsorted(part.time, time, side="right") - 1]
    assert np.array_equal(held, staircase) and len(part.values) == 11


def test_a_label_is_text_and_nothing_else() -> None:
    curve = Curve("<b>x_1$", np.arange(3.0), np.array([1.0, np.nan, 1.0]), False)
    panel = Panel("$a$ <i> [m]", (curve,), {"<u>$": 2.0}, True)
    chart = Chart("$t", "", (0.0, 2.0), True, (panel,))
    drawn = plotly_figure(signal_chart(chart))
    assert drawn["layout"]["yaxis"]["title"]["text"] == "$a$ &lt;i&gt; [m]"
    shown = picture(chart.title, chart.note, signal_chart(chart))
    shown.canvas.draw()
    assert shown.axes[0].get_ylabel() == panel.label


@pytest.mark.parametrize(
    ("old", "new", "line", "what"),
    [
        ('["card.enc_count"]', '["card.enc_cout"]', "signals", "did you mean 'enc_count'?"),
        ('["card.enc_count"]', '["cart.enc_count"]', "signals", "did you mean 'card'?"),
        ('["card.enc_count"]', '["card.enc_count[7]"]', "signals", "has elements 1 to 6"),
        ('["card.enc_count"]', '["card.enc_count[0]"]', "signals", "has elements 1 to 6"),
        ('["card.enc_count"]', '["card.enc_count[1,2]"]', "signals", "is an array of 6"),
        ('["card.enc_count"]', '["card.enc_count[1"]', "signals", "is an array of 6"),
        ('["card.enc_count"]', '["card.stopped[1]"]', "signals", "is a single value"),
        ('["card.enc_count"]', '["card.io_volts"]', "signals", "is no output (input)"),
        ('["card.enc_count"]', '["card.irq_flags[1]"]', "signals", "Boolean, single or in"),
        ('["card.enc_count"]', "[]", "signals", "the name of an output"),
        ("rate = 2e-3", "rate = 2.5e-5", "rate", "2.5e-05 s is no whole number of steps of 0.0001"),
        ("rate = 2e-3", "rate = 0.0", "rate", "rate = 0.0 s is no whole number"),
        ("rate = 2e-3", "rate = -1e-3", "rate", "rate = -0.001 s is no whole number"),
        ("rate = 2e-3", "rate = 0.3", "rate", "longer than the run"),
        ("rate = 2e-3", "rate = inf", "rate", "finite number"),
        ("rate = 2e-3", "rat = 2e-3", "rat ", "unknown key 'rat'"),
        ('["X", "Y"]', '["X"]', "names", "1 names for 2 curves"),
        ("scale = 1e3", "scale = true", "scale", "True"),
        ("{ ", '{ "low" = "no", ', "levels", "'no'"),
        ('label = "stopped"\n', "", "[[figure.plot]]", "label is missing"),
        ('title = "Stop"\n', "", "[[figure]]", "title is missing"),
        ('title = "Stop"', 'title = "Stop"\ncolour = "red"', "colour", "unknown key 'colour'"),
        ("[0.1495, 0.1515]", "[0.1515, 0.1495]", "window", "[0.1515, 0.1495]: from and to"),
        ("[0.1495, 0.1515]", "[0.15, 0.15]", "window", "within 0 .. 0.3 s"),
        ("[0.1495, 0.1515]", "[-0.1, 0.15]", "window", "within 0 .. 0.3 s"),
        ("[0.1495, 0.1515]", "[0.15, 0.31]", "window", "within 0 .. 0.3 s"),
        ("[0.1495, 0.1515]", "[0.15]", "window", "at least 2 items"),
    ],
)
def test_a_wrong_figure(tmp_path: Path, old: str, new: str, line: str, what: str) -> None:
    text = PLAIN + FIGURES
    at = text.rindex(old)
    folder = scenario(tmp_path, text[:at] + new + text[at + len(old) :])
    rows = (text[:at] + new).splitlines()
    number = max(i for i, row in enumerate(rows, 1) if row.startswith(line))
    with pytest.raises(motionfmu.InputError) as caught:
        motionfmu.load(folder)
    message = str(caught.value)
    assert message.startswith(f"{folder}/scenario.toml:{number}: "), message
    assert what in message and "\n" not in message


def test_a_rate_that_does_not_fit_another_step(tmp_path: Path) -> None:
    text = (PLAIN + FIGURES).replace("0.1501", "0.152").replace("2e-3", "2.2e-3")
    mine = motionfmu.load(scenario(tmp_path, text))
    with pytest.raises(motionfmu.InputError, match=r"no whole number of steps of 0\.0004 s"):
        mine.run(step=4e-4)


def test_lines_of_nested_tables() -> None:
    text = (
        "# t\n[[a]]\nx = 1\n[[a.b]]\ny = 1\n[[a.b]]\ny = 2\n[a.b.c]\nz = 1\n[[a]]\n[[a.b]]\ny = 3\n"
    )
    lines = Lines(text + "[[d]]\nb = [{ y = 1 }]\n")
    assert [lines.of(f"a.{i}") for i in range(2)] == [2, 10]
    assert [lines.of(f"a.{i}.b.{j}", "y") for i, j in ((0, 0), (0, 1), (1, 0))] == [5, 7, 12]
    assert lines.of("a.0.b.1.c", "z") == 9 and lines.of("a.0.b.1", "none") == 6
    assert lines.of("d.0.b.0", "y") == 14 and lines.of("e.0", "y") == 1
