"""The report on the loops of an axis."""

import math
from collections.abc import Sequence
from dataclasses import asdict, replace
from html import escape
from typing import Any

import numpy as np

from motionfmu.analysis.freq.loop_study import LoopStudy
from motionfmu.analysis.linear import AxisModel, LoopGain, gain_of
from motionfmu.analysis.linear.gains import in_lines, in_words
from motionfmu.analysis.linear.loops import Limit
from motionfmu.analysis.linear.stability import Margins
from motionfmu.analysis.linear.tuning_parts import held, worst
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, overrides, table
from motionfmu.report.loop_pages.margin_charts import bode, locus, nyquist, sensitivity, step
from motionfmu.report.numbers import MINUS, figure
from motionfmu.report.signal_words import words_of

FOOTER = (
    "L is the open loop, cut at the input named, once around, with all delays of the FMUs, of their"
    " sampling and of the communication step; the feedback is negative. The linear model is the"
    " plant's own equation at the operating point, on its integrator's grid, and the sampled laws"
    " that the FMUs carry: no rounding, no limits. Dots are the running FMUs, excited by a"
    " multisine while the loop is closed, so small that no limit is reached. The disk"
    " margin is the balanced one, 1/max|S &minus; 1/2|."
    ' Every number is in <a href="result.json">result.json</a>.'
)


def page_text(axis: AxisModel, studies: Sequence[LoopStudy], about: str = "") -> str:
    """The whole HTML page; `about` is what the operating point is and whence."""
    page = Page()
    if told := worst(axis):
        note = "The model is the worst that the FMUs can become; they are not run."
        rows = [[escape(text)] for text in told]
        page.section("Worst case", note, table(["taken"], rows, 1))
    if axis.set:
        given = overrides(f"{n} = {v}" for n, v in axis.set.items())
        page.section("What was looked at", "", given)
    for k, study in enumerate(studies):
        _add(page, study, f"loop{k}", _gains(axis, study))
    page.section("Operating point", _point_note(axis), _points(axis))
    name = f"{axis.scenario.name}, axis {axis.axis}"
    head = f"{axis.scenario.document.about} {about}".strip()
    frame = PageFrame(name, head, "margins report", [], FOOTER)
    return page.text(frame)


def _gains(axis: AxisModel, study: LoopStudy) -> list[LoopGain]:
    """Position gains that the loop has."""
    found = gain_of(axis.scenario, axis.set, axis.axis, axis.at)
    return [g for g in found if g.loop == study.at]


def numbers(axis: AxisModel, studies: Sequence[LoopStudy]) -> dict[str, Any]:
    """The result for JSON; what is infinite or not a number is null."""
    loops = []
    for s in studies:
        row: dict[str, Any] = {
            "at": s.at,
            "cut": list(s.cut),
            "period": s.loop.dt,
            "states": list(s.loop.state_labels),
            "margins": {
                k: v for k, v in asdict(replace(s.margins, loop=None)).items() if k != "loop"
            },
            "gain": s.gain or f"factor on the wire to {s.at}",
            "position_gains": [asdict(g) for g in _gains(axis, s)],
            "largest_gain": asdict(s.linear),
            "largest_gain_simulated": asdict(s.simulated) if s.simulated else None,
            "kick": s.kick,
            "notes": list(s.notes),
        }
        if s.difference is not None:
            row["difference"] = dict(zip(("percent", "degrees"), s.difference, strict=True))
        if s.measured is not None:
            row["measured"] = {
                "omega": s.measured.omega.tolist(),
                "real": s.measured.values[:, 0].real.tolist(),
                "imaginary": s.measured.values[:, 0].imag.tolist(),
            }
        loops.append(row)
    points = {
        c: {"stated": p.stated, "held": p.held, "values": p.values} for c, p in axis.points.items()
    }
    told = {
        "scenario": axis.scenario.name,
        "about": axis.scenario.document.about,
        "axis": axis.axis,
        "set": dict(axis.set),
        "operating_point": points,
        "left_out": list(axis.left_out),
        "worst": worst(axis),
        "loops": loops,
    }
    found: dict[str, Any] = _plain(told)
    return found


def _plain(value: Any) -> Any:
    if isinstance(value, dict):
        return {k: _plain(v) for k, v in value.items()}
    if isinstance(value, list | tuple):
        return [_plain(v) for v in value]
    if isinstance(value, float | np.floating):
        return float(value) if math.isfinite(value) else None
    return value.item() if hasattr(value, "item") else value


def _hertz(omega: float) -> str:
    return f"at {figure(omega / (2.0 * math.pi))} Hz" if math.isfinite(omega) else ""


def _unlimited(value: float, text: str) -> str:
    return text if math.isfinite(value) else "unlimited"


def margin_rows(m: Margins) -> list[tuple[str, str, str]]:
    """What each margin is, its value, and where it is or what it comes to; as HTML."""
    decibel = 20.0 * math.log10(m.gain) if 0.0 < m.gain < math.inf else math.inf
    period, periods = m.loop.dt if m.loop.isdtime(strict=True) else 0.0, ""
    if period and math.isfinite(m.delay):
        periods = f"{figure(m.delay / period)} periods of {figure(period * 1e6)} µs"
    disk = f"gain by {figure(m.disk_gain)} either way and phase ±{figure(m.disk_phase)}°"
    return [
        ("Gain margin", _unlimited(m.gain, f"{figure(decibel)} dB"), _hertz(m.omega_gain)),
        ("Phase margin", _unlimited(m.phase, f"{figure(m.phase)}°"), _hertz(m.omega_phase)),
        ("Delay margin", _unlimited(m.delay, f"{figure(m.delay * 1e3)} ms"), periods),
        ("Disk margin", figure(m.disk), disk),
        ("Sensitivity peak", figure(m.sensitivity), _hertz(m.omega_sensitivity)),
        ("Bandwidth", f"{figure(m.bandwidth / (2.0 * math.pi))} Hz", f"closed loop, {MINUS}3 dB"),
    ]


def _add(page: Page, study: LoopStudy, name: str, gains: Sequence[LoopGain]) -> None:
    m, rows = study.margins, margin_rows(study.margins)
    for gain in gains:
        told = in_lines([gain])[0].partition(" (")[0]
        rows.append(("Position gain Kp", in_words(gain.kp), escape(told)))
    boxes = cards(rows, "repeat(auto-fit,minmax(min(140px,45%),1fr))")
    if not m.stable:
        wrong = '<span class="mark fail">✗ This loop is unstable as it is;</span>'
        boxes = f'<p class="note">{wrong} margins are distances to &minus;1.</p>{boxes}'
    note = f"Opened at <b>{escape(study.at)}</b>"
    if study.cut:
        note += f", with {escape(', '.join(study.cut))} cut"
    states = ", ".join(study.loop.state_labels)
    note += f". {study.loop.nstates} states: {escape(states)}."
    page.section(f"Loop at {escape(study.at)}", note, boxes + _limits(study, gains))
    left = page.place(f"{name}_bode", bode(study.margins, study.measured))
    note = "Green: where |L| crosses 1; red: where the phase crosses &minus;180°."
    page.section("Bode diagram", note + _deviation(study), left)
    two = (
        page.place(f"{name}_nyquist", nyquist(study.margins)),
        page.place(f"{name}_locus", locus(study.margins)),
    )
    titles = "Nyquist diagram, and the disk that L keeps out of", "Poles over a factor on the loop"
    cells = "".join(f"<div><h3>{t}</h3>{p}</div>" for t, p in zip(titles, two, strict=True))
    page.sections.append(f'<section><div class="two">{cells}</div></section>')
    two = (
        page.place(f"{name}_step", step(study.margins), cursors=f"{name}_step"),
        page.place(f"{name}_s", sensitivity(study.margins)),
    )
    titles = "Step response of the closed loop", "Sensitivity"
    cells = "".join(f"<div><h3>{t}</h3>{p}</div>" for t, p in zip(titles, two, strict=True))
    page.sections.append(f'<section><div class="two">{cells}</div></section>')


def _deviation(study: LoopStudy) -> str:
    """How far the measured dots are from the line, and what is to be said about them."""
    told = [f" {escape(note)}." for note in study.notes]
    if study.difference is not None:
        size, angle = (figure(value) for value in study.difference)
        text = f"the running FMUs differ by at most {size} % and {angle}°."
        told.insert(0, f" Where |L| is above &minus;20 dB, {text}")
    return "".join(told)


def _limits(study: LoopStudy, gains: Sequence[LoopGain]) -> str:
    what = escape(study.gain) if study.gain else f"factor on the wire to {escape(study.at)}"
    rows = [(f"{what}: by the poles of the linear model", *_limit(study.linear, study, gains), "")]
    if study.simulated is not None:
        share = study.simulated.gain / study.linear.gain - 1.0 if study.linear.gain else math.nan
        told = f"{figure(100.0 * share, sign=True)} %" if math.isfinite(share) else ""
        name = f"{what}: by running the FMUs until they ring after a step of {study.kick:.3g}"
        rows.append((name, *_limit(study.simulated, study, gains), told))
    elif study.silent:
        rows.append((f"FMUs not run: {escape(study.silent)}", "", "", ""))
    heads = ("Largest stable gain", "value", "rings at", "difference")
    return table(heads, rows)


def _limit(limit: Limit, study: LoopStudy, gains: Sequence[LoopGain]) -> tuple[str, str]:
    if not math.isfinite(limit.gain):
        return "none found", ""
    ring = limit.omega / (2.0 * math.pi)
    told = "".join(f" (Kp {in_words(kp)})" for kp in kp_at(limit, study, gains))
    return f"{limit.gain:.4g}{told}", f"{figure(ring)} Hz" if math.isfinite(ring) else ""


def kp_at(limit: Limit, study: LoopStudy, gains: Sequence[LoopGain]) -> list[float]:
    """Position gain [1/s] at a limit, if it is one of a position gain or a factor on its loop."""
    if study.gain is None:
        return [g.kp * limit.gain for g in gains]
    return [g.at(limit.gain).kp for g in gains if g.name == study.gain]


def point_line(axis: AxisModel, whence: str) -> str:
    """One line that names the operating point at which the model is linearised."""
    if axis.at:
        end = axis.scenario.resolver.end
        units = {name: end(name, "at", name).port.unit or "" for name in axis.at}
        shown = (f"{name} = {value:.6g} {units[name]}".strip() for name, value in axis.at.items())
        point = ", ".join(shown)
        other = "; --at states another" if whence != "stated" else ""
        return f"Operating point: {point} ({whence}){other}"
    friction = "friction is the steep slope of a part that sticks"
    return f"Operating point: at rest ({whence}), where {friction}; --at states another"


def _point_note(axis: AxisModel) -> str:
    told = [f"{escape(n)} = {v:g}" for n, v in axis.at.items()]
    if axis.others:
        joints = ", ".join(map(str, axis.others))
        stated = f"At {', '.join(told)}. " if told else ""
        return (
            f"{stated}At rest where it starts, held by the"
            f" drives' integrals. Axes {joints} are coupled with it, and held by their own loops."
            " Friction is the steep slope of a part that sticks; a gap is as the load has it."
        )
    if told:
        kept = f" {escape(text)}." if (text := held(axis)) else ""
        return f"At {', '.join(told)}.{kept} The rest follows: a uniform motion.{_over(axis)}"
    return (
        "The state at the start, at rest. Friction there is the steep slope of"
        " a part that sticks; state a speed to linearise about a motion."
    )


def _over(axis: AxisModel) -> str:
    """Say after which time the motion cannot go on."""
    ends = [p.lasts for p in axis.points.values() if math.isfinite(p.lasts)]
    if not ends:
        return ""
    return f" It goes on for {figure(min(ends))} s, to where parts meet or part."


def _named(axis: AxisModel, name: str) -> str:
    """A quantity of a plant, and what it is in words."""
    words, unit = words_of(axis.scenario.resolver, name)
    told = ", ".join(text for text in (words, unit) if text)
    return f'{escape(name)}<div class="sub">{escape(told)}</div>' if told else escape(name)


def _points(axis: AxisModel) -> str:
    rows = [
        (_named(axis, f"{c}.{name}"), f"{value:.6g}")
        for c, p in axis.points.items()
        for name, value in p.values.items()
    ]
    half = (len(rows) + 1) // 2
    heads = ("quantity", "value")
    return f'<div class="two">{table(heads, rows[:half])}{table(heads, rows[half:])}</div>'
