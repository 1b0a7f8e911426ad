"""What the prompt and a notebook show of a loop, a tuning, a comparison and a study."""

import base64
import io
import math
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import control
import numpy as np
import pytest
from conftest import ROOT
from matplotlib.colors import to_rgb
from matplotlib.figure import Figure
from PIL import Image
from test_sweep_page import synthetic

import motionfmu
from motionfmu.analysis.linear import margins
from motionfmu.base import extras
from motionfmu.base.extras import Missing
from motionfmu.compare import Comparison, compare
from motionfmu.report.dark_figure import COLORS, darkened
from motionfmu.report.notebook_view import NotebookFigure, png
from motionfmu.report.style import AXES, DARK, HEAT, INK
from motionfmu.study.tune import Tuned, problem, tune
from motionfmu.sweep import Outcome

LARGEST = 250_000  # [bytes] of a view


def shown(thing: Any) -> str:
    """Texts of a view, which is well-formed and has one picture for each look."""
    view = thing._repr_html_()
    assert len(view) < LARGEST
    tree = ElementTree.fromstring(view)
    pictures = [pixels(x.attrib["src"]) for x in tree.iter("img")]
    assert [tuple(p[1, 1]) for p in pictures] == [(255, 255, 255), (21, 31, 41)]
    assert all(p.std() > 10.0 for p in pictures)
    assert [x.attrib.get("hidden") for x in tree.iter("img")] == [None, "hidden"]
    return re.sub(r"\s+", " ", " ".join(tree.itertext()))


def pixels(source: str) -> np.ndarray[Any, Any]:
    head, _, data = source.partition(",")
    assert head == "data:image/png;base64"
    return np.array(Image.open(io.BytesIO(base64.b64decode(data))).convert("RGB"))


def loop(gain: float) -> Any:
    """gain / (s (s + 1) (s + 2)), of which the closed formulas say all."""
    return control.tf([gain], [1.0, 3.0, 2.0, 0.0])


def test_margins_are_told_in_lines_with_units() -> None:
    # The phase is -180 degrees at sqrt(2) rad/s, where |L| = gain / 6.
    found = margins(loop(1.5))
    hertz = math.sqrt(2.0) / (2.0 * math.pi)
    first, gain, phase, delay, *_ = str(found).splitlines()
    assert first == "Margins of a loop, stable when closed" and repr(found) == str(found)
    assert gain.split() == f"gain {20 * math.log10(4):.4g} dB (x 4) at {hertz:.4g} Hz".split()
    assert phase.split()[1] == f"{found.phase:.4g}°"
    assert delay.split()[1:] == [f"{found.delay * 1e3:.4g}", "ms"]
    assert "UNSTABLE" in str(margins(loop(7.0)))
    assert "gain        unlimited" in str(margins(control.tf([1.0], [1.0, 1.0])))


def test_a_notebook_shows_margins_with_the_bode_diagram() -> None:
    text = shown(margins(loop(1.5)))
    assert "Margins stable" in text and "12.0 dB at 0.225 Hz" in text and "°" in text
    assert "Margins UNSTABLE" in shown(margins(loop(7.0)))


@pytest.fixture(scope="module")
def tuned() -> Tuned:
    return tune(motionfmu.load(ROOT / "scenarios/mismatch_line"), problem({}), {})


def test_a_tuning_tells_gains_errors_and_what_stops_it(tuned: Tuned) -> None:
    name, gains, error, stopped = str(tuned).splitlines()
    assert name == "Tuned gains of mismatch_line"
    found = tuned.settings["mcc.p_gain"]
    assert gains.split(" = ")[1].startswith(f"[{found[0]:g}, {found[1]:g}, 0")
    assert gains.endswith("(before [200, 160, 0, 0, 0, 0])")
    for run in (tuned.before[0], tuned.after[0]):
        assert f"{run.fmus.rms * 1e3:.4g} µm, largest {run.fmus.max * 1e3:.4g} µm" in error
    assert stopped.strip() == f"stopped by {tuned.stopped_by[0]}"


def test_a_notebook_shows_a_tuning(tuned: Tuned) -> None:
    text = shown(tuned)
    assert "200, 160, 0, 0, 0, 0" in text and tuned.stopped_by[0] in text
    assert "axis 2, card.enc_phase" in text and "Contour error Before After" in text


@pytest.fixture(scope="module")
def compared() -> Comparison:
    square = motionfmu.load(ROOT / "scenarios/mismatch_line")
    return compare(square.run(stop=0.5), square.run(stop=0.5, set={"mcc.p_gain": 300}))


def test_a_comparison_tells_differences_and_the_verdict(compared: Comparison) -> None:
    text = str(compared)
    assert "  mcc.p_gain: [200, 160, 0, 0, 0, 0] → 300" in text
    first = compared.apart[0]
    assert f"{first.element}: " in text and f"at {first.at:.6g} s" in text
    shares = [abs(s.largest) / s.span for s in compared.apart if s.span]
    assert shares == sorted(shares, reverse=True) and len(shares) > 3
    count = len(compared.apart)
    assert f"{count} signals differ (B \N{MINUS SIGN} A)" in text
    assert text.splitlines()[-1].strip() == (
        "no verdict is worse" if compared.ok else f"FAILED in B: {', '.join(compared.worse)}"
    )


def test_a_notebook_shows_a_comparison_with_and_without_a_contour(compared: Comparison) -> None:
    assert compared.a.track
    text = shown(compared)
    assert "largest contour error" in text and "mcc.p_gain" in text
    assert all(s.element in text for s in compared.apart[:5])
    valve = motionfmu.load(ROOT / "scenarios/hydraulic_valve")
    other = compare(valve.run(stop=0.1), valve.run(stop=0.2))
    assert not other.a.track and not other.apart
    assert "<img" not in other._repr_html_()
    assert "0 signals differ" in other._repr_html_()


@pytest.fixture(scope="module")
def outcome(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Outcome]:
    yield synthetic(["mcc.p_gain"], "grid", 9, tmp_path_factory.mktemp("sweep"))


def test_a_study_tells_its_runs_and_the_best(outcome: Outcome) -> None:
    # The cost is (log10 x - 1.5)^2 at nine points a factor of 10^(3/8) apart:
    # the fifth, 10^1.5 = 32, is the best.
    name, runs, checks, smallest, place, folder = map(str.strip, str(outcome).splitlines())
    assert name == f"Study {outcome.study.name}" and runs == "9 runs (grid), 1 with an error"
    assert checks == "checks hold in 8 of 9 runs"
    assert re.fullmatch(r"smallest \S+: \S+( \S+)? in run 4", smallest)
    assert place == "at mcc.p_gain = 32" and folder.endswith(str(outcome.folder))


def test_a_notebook_shows_a_study(outcome: Outcome, tmp_path: Path) -> None:
    text = shown(outcome)
    assert "9 runs (grid), 1 with an error" in text and "4 ✓ 32 " in text
    assert outcome._repr_html_().count("✓") == 5  # the best ones
    empty = synthetic(["mcc.p_gain"], "grid", 2, tmp_path)
    for row in empty.rows:
        object.__setattr__(row, "values", (None,) * 3)
    assert "<img" not in empty._repr_html_() and "2 runs" in empty._repr_html_()


def test_what_cannot_be_drawn_says_what_it_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(extras, "missing", lambda extra: ["matplotlib"])
    with pytest.raises(Missing, match=r"a picture, an explanation .* needs matplotlib"):
        margins(loop(1.5))._repr_html_()


def test_a_figure_is_as_it_was_after_its_dark_picture() -> None:
    figure = Figure()
    axes = figure.subplots()
    (line,) = axes.plot([0, 1], [1, 0], color=AXES[0])
    (own,) = axes.plot([0, 1], [1, 2], color="#123456")
    points = axes.scatter([0, 1], [0, 1], c=[0, 1], cmap=COLORS)
    axes.set_title("title", color=INK)
    before = png(figure, 300.0)
    with darkened(figure):
        assert (line.get_color()[:3], own.get_color()[:3]) == (rgb(DARK[AXES[0]]), rgb("#123456"))
        assert axes.title.get_color()[:3] == rgb(DARK[INK])
        assert points.get_cmap()(0.0)[:3] == rgb(DARK[HEAT[0]])
        assert png(figure, 300.0) != before
    assert png(figure, 300.0) == before


def rgb(color: str) -> tuple[float, ...]:
    return to_rgb(color)


def test_what_plot_returns_is_shown_in_both_looks() -> None:
    figure = NotebookFigure(figsize=(4.0, 2.0))
    axes = figure.subplots()
    axes.plot([0, 1], [0, 1])
    axes.xaxis.set_major_formatter(lambda value, place: f"{value:.1f} s")  # no pickle copies it
    assert ".motionfmu" in shown(figure)
