"""The pure functions of the live page's scripts, against NumPy and against what they must be."""

import csv
import functools
import io
import json
import math
import re
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from hypothesis import given
from hypothesis import strategies as st
from py_mini_racer import MiniRacer

PAGE = ROOT / "src/motionfmu/live/serving/page"
MODULES = ("words", "contour", "trace_ring", "spectrum", "trace_files", "scope_scale")


def script(name: str) -> str:
    """A module's text as a plain script: its imports are there already, its exports global."""
    text = (PAGE / f"{name}.js").read_text()
    text = re.sub(r"^import .*?;$", "", text, flags=re.M | re.S)
    return re.sub(r"^export ", "", text, flags=re.M)


def function(name: str, wanted: str) -> str:
    """The text of one exported function of a module that needs a page."""
    found = re.search(rf"^export (function {wanted}\b.*?^}})", script_text(name), re.M | re.S)
    assert found
    return found.group(1)


def script_text(name: str) -> str:
    return (PAGE / f"{name}.js").read_text()


@functools.cache
def loaded() -> MiniRacer:
    made = MiniRacer()
    for name in MODULES:  # each in a function, so that their constants do not meet
        names = re.findall(r"^export (?:function|class|const) (\w+)", script_text(name), re.M)
        given = f"return {{ {', '.join(names)} }};"
        made.eval(f"Object.assign(globalThis, (() => {{ {script(name)}\n{given} }})())")
    return made


@pytest.fixture
def engine() -> MiniRacer:
    return loaded()


def of(engine: MiniRacer, expression: str) -> Any:
    return json.loads(engine.eval(f"JSON.stringify({expression})"))


def test_a_spectrum_is_that_of_numpy(engine: MiniRacer) -> None:
    step, count = 1e-4, 4096
    time = step * np.arange(count)
    data = 3.0 + 2.0 * np.sin(2 * np.pi * 40 / (count * step) * time) + 0.01 * np.cos(9000.0 * time)
    found = of(
        engine,
        f"(({{frequency, amplitude}}) => [Array.from(frequency), Array.from(amplitude)])"
        f"(spectrum(Float64Array.from({data.tolist()}), {step}))",
    )
    window = np.hanning(count + 1)[:-1]
    own = 4 * np.abs(np.fft.rfft(window * (data - data.mean())))[: count // 2] / count
    own[0] /= 2
    assert np.allclose(found[1], own, atol=1e-12)
    assert np.allclose(found[0], np.fft.rfftfreq(count, step)[:-1])
    assert found[1][40] == pytest.approx(2.0, rel=1e-3)  # what a sine of 2 must give


@pytest.mark.parametrize("count", [0, 1, 3])
def test_of_too_few_samples_there_is_no_spectrum(engine: MiniRacer, count: int) -> None:
    assert of(engine, f"spectrum(new Float64Array({count}), 1).frequency") == []


numbers = st.floats(allow_nan=False, allow_infinity=False)


@given(st.lists(numbers, min_size=1, max_size=40), st.text('äß,"xyz[]1.', min_size=1, max_size=9))
def test_files_give_back_every_bit(values: list[float], name: str) -> None:
    made = loaded()
    columns = json.dumps([{"name": n, "data": values} for n in (name, "time")])
    packed = bytes(of(made, f"Array.from(npz({columns}))"))
    with np.load(io.BytesIO(packed)) as found:
        assert found[name].tobytes() == np.array(values).tobytes()
        assert found["time"].dtype == np.float64
    head, *rows = csv.reader(io.StringIO(made.eval(f"csv({columns})")))
    assert head == [name, "time"]
    assert [float(r[1]) for r in rows] == [v + 0.0 for v in values]


RING = """(() => { const ring = new TraceRing(["a", "b"], 256); const peaks = [0, 0];
  const data = %s, seen = []; let begin = 0;
  for (const rows of %s) {
    ring.add(begin, rows, Float64Array.from(data.slice(2 * begin, 2 * (begin + rows))));
    begin += rows;
  }
  for (const [from, to] of %s) { ring.peaks(1, from, to, peaks); seen.push([...peaks]); }
  const kept = Array.from(ring.slice(1, 0, 1e9));
  return { begin: ring.begin, end: ring.end, seen, kept }; })()"""


def test_peaks_by_blocks_are_those_of_all_samples(engine: MiniRacer) -> None:
    random = np.random.default_rng(4)
    data = random.normal(size=(700, 2))
    parts = [1, 62, 3, 130, 64, 200, 240]
    spans = [[int(a), int(a + n)] for a, n in random.integers((444, 1), (690, 250), (200, 2))]
    found = of(engine, RING % (data.ravel().tolist(), parts, spans))
    assert (found["begin"], found["end"]) == (700 - 256, 700)
    assert found["kept"] == data[444:, 1].tolist()
    for (a, b), peaks in zip(spans, found["seen"], strict=True):
        own = data[max(a, 444) : min(b, 700), 1]
        assert peaks == [own.min(), own.max()]


def test_a_ring_after_a_gap_or_a_step_back_has_only_what_came_since(engine: MiniRacer) -> None:
    made = """(() => { const ring = new TraceRing(["a"], 128), peaks = [0, 0];
      ring.add(0, 100, new Float64Array(100).fill(9));
      ring.add(40, 10, new Float64Array(10).fill(1));
      ring.peaks(0, 0, 100, peaks); return [ring.begin, ring.end, ...peaks]; })()"""
    assert of(engine, made) == [40, 50, 1, 1]


def circle(radius: float, angles: Any) -> list[list[float]]:
    return [[radius * math.cos(a), radius * math.sin(a), 0.0] for a in angles]


def test_the_distance_from_an_arc_is_not_that_from_its_chords(engine: MiniRacer) -> None:
    """R 50 at 100 mm/s, 50 points a second: the chords alone are off by 10 µm."""
    angles = np.arange(0, 3.0, 2.0 / 50.0)
    points, bow, turn = circle(50.0, angles), 2.0**2 / (8 * 50.0), 2.0 / 50.0
    least = bow / 16**2 + bow * turn**2 / 4  # of a sixteenth of a chord; slopes of parabolas
    for a in np.arange(0.5, 2.5, 0.0371):
        tool = circle(50.0 - 0.044, [a])[0]
        assert of(engine, f"fromCommand({tool}, {points})") == pytest.approx(0.044, abs=least)


def test_a_corner_is_not_rounded_and_what_is_too_coarse_is_not_told(engine: MiniRacer) -> None:
    corner = [[0.3 * k, 0, 0] for k in range(10)] + [[2.7, 0.3 * k, 0] for k in range(1, 10)]
    assert of(engine, f"fromCommand([2.7, -0.2, 0], {corner})") == pytest.approx(0.2)
    assert of(engine, f"fromCommand([1.0, 0.05, 0], {corner})") == pytest.approx(0.05)
    coarse = circle(50.0, np.arange(0, 3, 0.8))
    assert of(engine, f"fromCommand([49.9, 0, 0], {coarse})") is None  # NaN
    straight = [[0, 0, 0], [40, 0, 0], [80, 0, 0], [120, 0, 0]]
    assert of(engine, f"fromCommand([50, 0.02, 0], {straight})") == pytest.approx(0.02)


@given(st.floats(-1e6, 1e6), st.floats(1e-6, 1e6))
def test_the_ends_of_a_scale_are_round_and_hold_the_signal(low: float, span: float) -> None:
    made = loaded()
    high = low + span
    ends = of(made, f"roundEnds({low!r}, {high!r})")
    assert ends[0] <= low and high <= ends[1]
    assert ends[1] - ends[0] <= 1.6 * max(
        high - low, 1e-9 * abs(low) + 1e-300
    ) or span < 1e-9 * abs(low)
    marks = of(made, f"ticks({ends[0]!r}, {ends[1]!r}, 5)")
    assert 2 <= len(marks) <= 12


@pytest.mark.parametrize(
    ("call", "words"),
    [
        ("fixed(-0.0004)", "0.000"),
        ("fixed(-1.23456)", "\N{MINUS SIGN}1.235"),
        ("fixed(NaN)", "\N{EN DASH}"),
        ("figures(5e-7, 5)", "5e\N{MINUS SIGN}7"),
        ("figures(true)", "on"),
        ("figures(123456.7, 4)", "123500"),
        ("clock(3723.0456)", "1:02:03.045"),
        ("clock(61.5)", "01:01.500"),
        ("advice({advice: {7: 'Mend it.'}}, 7)", "Mend it."),
        ("advice({advice: {7: 'Mend it.'}}, 8)", "Find the cause, then reset."),
        ("advice(undefined, 8)", "Find the cause, then reset."),
        ("meaning({type: 'Int32', words: {2: 'hold'}}, 2)", "hold"),
        ("meaning({type: 'Int32', words: {}}, 7)", "7"),
    ],
)
def test_numbers_and_states_in_words(engine: MiniRacer, call: str, words: str) -> None:
    assert of(engine, call) == words


def test_a_program_of_any_length_is_scrolled_to_every_line(engine: MiniRacer) -> None:
    made = MiniRacer()
    made.eval("const HEIGHT = 22, TALLEST = 8e6;")
    made.eval(function("program", "firstLine") + "\n" + function("program", "scrollOf"))
    for count in (3, 100, 200_000, 2_000_000):
        for line in (0, count // 3, count - 1):
            scroll = of(made, f"scrollOf({line}, {count}, 400)")
            first = of(made, f"firstLine({scroll}, {count}, 400)")
            shown = 400 / 22
            assert first == pytest.approx(min(line, max(count - shown, 0)), abs=1e-3)


def test_lines_typed_before_come_again_in_their_order(engine: MiniRacer) -> None:
    made = MiniRacer()
    made.eval("const KEPT = 3;" + function("mdi", "historyOf"))
    made.eval("const h = historyOf(['a', 'b']); h.add('b'); h.add('c'); h.add('d');")
    assert of(made, "h.lines") == ["b", "c", "d"]
    assert [of(made, f"h.go({way}, 'half')") for way in (-1, -1, -1, -1, 1, 1, 1, 1)] == [
        "d", "c", "b", "b", "c", "d", "half", "half",
    ]  # fmt: skip


def test_a_number_may_differ_by_a_share_of_it_or_a_little(engine: MiniRacer) -> None:
    made = MiniRacer()
    usual = re.search(
        r"^const SHARE.*?^export const usualRoom[^\n]*", script_text("journal"), re.M | re.S
    )
    assert usual
    made.eval(usual.group().replace("export ", ""))
    rooms = of(made, "[0.05, -2, 1e-9, 0, true, 'a.ngc'].map(usualRoom)")
    assert rooms == pytest.approx([5e-5, 2e-3, 1e-6, 1e-6, 1e-3, 1e-6])
