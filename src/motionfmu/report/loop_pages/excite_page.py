"""The report of an excitation: its signal, its spectrum, and what it moves."""

import math
from html import escape
from typing import Any

import numpy as np

from motionfmu.base.units import spelled
from motionfmu.excite import AxisExcitation, PositionProgram
from motionfmu.report.diagram import Diagram, Mark, PointMark, SamplesMark, Scale, one
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, facts, overrides, table
from motionfmu.report.numbers import figure, label
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES

_WIDTH, _HEIGHT = 1.2, 220  # [pixel] of a curve, of a plot
FOOTER = (
    "Peaks are those of the scenario's linear model; friction is what the plant's equation asks at"
    " the mean speed. <code>motionfmu run scenario</code> drives the FMUs with it,"
    " <code>motionfmu identify scenario --frf --record RECORD</code> takes what was recorded."
    ' Every number is in <a href="result.json">result.json</a>.'
)


def excite_page(made: AxisExcitation, program: PositionProgram | None) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(made))
    page.section("What it is", escape(" ".join(sentences(made))), _facts(made))
    if made.notes:
        page.section("To be known", "", "".join(f"<p>{escape(n)}</p>" for n in made.notes))
    note = "Mean and the peak of what is added, beside what limits the signal."
    page.section("Within the limits", note, _moves(made))
    both = page.place("signal", _signal(made), True) + page.place("period", _period(made))
    page.section("Signal", "", both)
    note = "Amplitudes of the lines, as large as what they move allows."
    page.section("Spectrum", note, page.place("spectrum", _spectrum(made)))
    if program is not None:
        page.section("Part program", escape(" ".join(program.words)), _program(page, program))
    if made.given:
        given = overrides(f"{n} = {v}" for n, v in made.given.items())
        page.section("Set beside the scenario", "", given)
    scenario = made.axis.scenario
    frame = PageFrame(
        f"{scenario.name}, axis {made.axis.axis}",
        scenario.document.about,
        "excitation",
        [],
        FOOTER,
    )
    return page.text(frame)


def sentences(made: AxisExcitation) -> list[str]:
    """What it is, in sentences."""
    o = made.options
    phases = "phases with low peaks" if o.seed is None else f"random phases of seed {o.seed}"
    kind = "speed" if made.is_rate else "position"
    crests = ", ".join(f"{n} {c:.3f}" for n, c in made.crests.items())
    found = [
        f"{len(made.hertz)} lines from {made.hertz[0]:.4g} to {made.hertz[-1]:.4g} Hz,"
        f" {1 / o.period:.4g} Hz apart, {phases}, added to a {kind} command at {made.input}.",
        f"{made.lead:.3g} s of start, a period of {o.period:.4g} s to settle, {o.periods} to be"
        f" measured, {made.lead:.3g} s to stop: {made.time[-1]:.4g} s.",
        f"The motor turns at {made.speed:.4g} rad/s on the mean"
        + (f"; the load moves by {1e3 * made.way:.4g} mm." if made.way else "."),
        f"Crest factors: {crests}.",
    ]
    return found


def _cards(made: AxisExcitation) -> str:
    worst = max(made.moves, key=lambda m: m.share)
    torque = made.crests[made.moves_source]
    return cards(
        [
            ("Lines", str(len(made.hertz)), f"{made.hertz[0]:.4g} to {made.hertz[-1]:.4g} Hz"),
            ("Crest factor of the torque", f"{torque:.3f}", "a sine has 1.414"),
            ("Nearest to its limit", f"{100 * worst.share:.0f} %", escape(worst.signal)),
            ("Way", f"{1e3 * made.way:.4g} mm" if made.way else "not known", "of the load"),
        ]
    )


def _facts(made: AxisExcitation) -> str:
    rows = [
        ("Input", escape(label(made.input, made.unit))),
        ("Samples", f"{len(made.time)}, {1e6 * made.interval:.4g} µs apart"),
        ("Files", "excitation.csv, scenario/: time [s], command"),
    ]
    return facts(rows)


def _moves(made: AxisExcitation) -> str:
    rows = []
    for m in made.moves:
        ever = "" if m.continuous is None else f"{figure(m.rms)} of {figure(m.continuous)}"
        cells = [figure(m.mean), figure(m.peak), figure(m.limit), ever, f"{100 * m.share:.0f} %"]
        rows.append([escape(m.signal), spelled(m.unit), *cells])
    heads = ["signal", "unit", "mean", "peak", "limit", "RMS and what is allowed", "used"]
    return table(heads, rows, 2)


def _signal(made: AxisExcitation) -> Diagram:
    curve = Samples(made.time, made.command, steps=True)
    marks: list[Mark] = [SamplesMark(curve, made.input, AXES[0], _WIDTH)]
    return one(Scale("Time", "s"), Scale("Command", spelled(made.unit)), marks, _HEIGHT)


def _period(made: AxisExcitation) -> Diagram:
    curve = Samples(1e3 * made.time[: len(made.one)], made.one, steps=True)
    marks: list[Mark] = [SamplesMark(curve, "one period", AXES[1], _WIDTH)]
    return one(Scale("Time", "ms"), Scale("One period", spelled(made.unit)), marks, _HEIGHT)


def _spectrum(made: AxisExcitation) -> Diagram:
    marks: list[Mark] = [PointMark(made.hertz, made.amplitudes, made.input, AXES[0], size=4.0)]
    return one(
        Scale("Frequency", "Hz", log=True),
        Scale("Amplitude", spelled(made.unit), log=True),
        marks,
        _HEIGHT,
    )


def _program(page: Page, program: PositionProgram) -> str:
    marks: list[Mark] = [
        SamplesMark(Samples(program.time, program.feed), "feed of each line", AXES[0], _WIDTH)
    ]
    drawn = one(Scale("Time", "s"), Scale("Feed", "mm/min"), marks, _HEIGHT)
    return page.place("program", drawn, True)


def excite_numbers(made: AxisExcitation, program: PositionProgram | None) -> dict[str, Any]:
    """All numbers, as result.json has them."""
    o = made.options
    found: dict[str, Any] = {
        "scenario": made.axis.scenario.name,
        "axis": made.axis.axis,
        "input": made.input,
        "unit": made.unit,
        "commands": "speed" if made.is_rate else "position",
        "interval": made.interval,
        "period": o.period,
        "periods": o.periods,
        "seed": o.seed,
        "duration": float(made.time[-1]),
        "lead": made.lead,
        "motor_speed": made.speed,
        "way": made.way,
        "crest_factors": dict(made.crests),
        "frequency": made.hertz.tolist(),
        "amplitude": np.asarray(made.amplitudes).tolist(),
        "moves": [
            {
                "signal": m.signal,
                "unit": m.unit,
                "mean": m.mean,
                "peak": m.peak,
                "limit": m.limit,
                "rms": m.rms,
                "continuous": m.continuous,
                "share": m.share,
            }
            for m in made.moves
        ],
        "notes": list(made.notes),
    }
    if program is not None:
        found["program"] = {
            "lines": len(program.feed),
            "highest": program.high,
            "duration": float(program.time[-1]),
            "largest_feed": float(program.feed.max()),
        }
    assert math.isfinite(made.speed)
    return found
