"""The report of a measured frequency response: what it shows, and what explains it."""

import math
from collections.abc import Mapping
from html import escape
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear.stability import grid, margins, response
from motionfmu.analysis.measured_response import FoundResponse
from motionfmu.analysis.measured_response.plant_response import FoundLoop
from motionfmu.analysis.measured_response.two_masses import apart
from motionfmu.base.units import spelled
from motionfmu.report.diagram import (
    DASH,
    BandMark,
    Diagram,
    LevelMark,
    LineMark,
    Mark,
    PointMark,
    Scale,
    Subplot,
    ends_of,
    one,
)
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, facts, overrides, table
from motionfmu.report.numbers import figure
from motionfmu.report.style import AXES, MUTED

Array = NDArray[np.float64]
MEASURED, FOUND, BEFORE = AXES[1], AXES[0], MUTED
_WIDTH, _DOT = 1.8, 4.0  # [pixel]
_HIGH, _LOW = 240, 130  # [pixel] of a plot
_POINTS = 600
# Half width of the band, in standard deviations.
BAND = 2.0
FOOTER = (
    "The response is the mean output over the mean input, both taken by the reference, so that no"
    " noise in the loop biases it; the band is two standard deviations. Models are the"
    " scenario's own linear one, with the sampling, holds and lags of its FMUs, with the values"
    " before and with those found. Every number is in"
    ' <a href="result.json">result.json</a>; use the values with'
    " <code>motionfmu run SCENARIO --set found.toml</code>."
)


def response_page(found: FoundResponse) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(found))
    page.section("What was found", escape(" ".join(words(found))), _values(found))
    if found.notes:
        page.section("To be known", "", "".join(f"<p>{escape(n)}</p>" for n in found.notes))
    source, output = found.signals
    note = f"{escape(output)} per {escape(source)}: {escape(found.measured.way)}."
    page.section("Frequency response", note, page.place("bode", _bode(found)))
    note = (
        "Difference of the response and the model with the values found, over the larger of them:"
        f" {100 * _rms(found):.3g} % (RMS)."
        " What has a shape here is not in two masses."
    )
    page.section("Residuals", note, page.place("rest", _residual(found)))
    for k, loop in enumerate(found.loops):
        note = (
            "The loop as <code>motionfmu margins</code> has it, with the values before and those"
            " found; dots are the measured plant with the scenario's controller."
        )
        place = page.place(f"loop{k}", _loop(loop))
        page.section(f"Loop at {escape(loop.at)}", note, _margins(loop) + place)
    rows = [
        ("Record", escape(found.measured.name)),
        ("Estimate", escape(found.measured.way)),
        ("Band", f"{_hertz(found)[0]:.4g} to {_hertz(found)[-1]:.4g} Hz"),
        ("Frequencies", str(len(found.measured.omega))),
    ]
    if math.isfinite(found.speed):
        rows.append(("Mean speed of the motor", f"{found.speed:.4g} rad/s"))
    page.section("What was measured", "", facts(rows))
    if found.given:
        given = overrides(f"{n} = {v}" for n, v in found.given.items())
        page.section("Set beside the scenario", "", given)
    scenario = found.scenario
    frame = PageFrame(
        scenario.name, scenario.document.about, "frequency response report", [], FOOTER
    )
    return page.text(frame)


def words(found: FoundResponse) -> list[str]:
    """What the response shows, in sentences."""
    fit, m = found.fit, found.fit.model
    if not fit.two:
        sure = fit.deviations["motor"]
        return [
            f"One mass explains the response within {100 * fit.alone:.2g} %: {m.motor:.4g} ±"
            f" {sure:.2g} on the side of the motor, where the scenario has"
            f" {found.old.motor + found.old.load:.4g}."
        ]
    hertz = [w / (2.0 * math.pi) for w in (m.antiresonance, m.resonance)]
    parts = [
        f"Two masses explain the response within {100 * fit.left:.2g} %, one alone within"
        f" {100 * fit.alone:.2g} %.",
        f"The motor stands at {_sure(hertz[0], fit.deviations['antiresonance'] / 2 / math.pi)} Hz"
        " while the load swings"
        + (
            f"; both swing at {_sure(hertz[1], fit.deviations['resonance'] / 2 / math.pi)} Hz."
            if fit.told("resonance")
            else f"; the resonance is not told: {fit.why['resonance']}."
        ),
    ]
    if fit.told("ratio"):
        parts.append(
            f"The load has {_sure(fit.ratio, fit.deviations['ratio'])} times the inertia of the"
            " motor."
        )
    untold = [p for p in found.parameters if not p.told]
    parts += [f"{p.name} is not told: {p.why}." for p in untold]
    return parts


def _short(value: float) -> str:
    """A number that may be very small or very large."""
    return figure(value) if 1e-2 <= abs(value) < 1e6 or value == 0.0 else f"{value:.4g}"


def _sure(value: float, deviation: float) -> str:
    if not math.isfinite(deviation) or deviation <= 0.0:
        return figure(value)
    digits = max(0, 1 - math.floor(math.log10(deviation)))
    return f"{value:.{digits}f} ± {deviation:.2g}" if digits < 8 else f"{value:.6g}"


def _rms(found: FoundResponse) -> float:
    return float(np.sqrt(np.mean(apart(found.measured.values, found.found) ** 2)))


def _hertz(found: FoundResponse) -> Array:
    return np.asarray(found.measured.omega / (2.0 * math.pi))


def _cards(found: FoundResponse) -> str:
    fit, m, old = found.fit, found.fit.model, found.old
    if not fit.two:
        whole = m.motor + m.load
        before = old.motor + old.load
        return cards([("Inertia at the motor", f"{whole:.4g}", f"before {before:.4g}")])
    rows = []
    for title, key, value, before in (
        ("Antiresonance", "antiresonance", m.antiresonance, old.antiresonance),
        ("Resonance", "resonance", m.resonance, old.resonance),
    ):
        a, b = value / (2.0 * math.pi), before / (2.0 * math.pi)
        sure = fit.deviations[key] / (2.0 * math.pi)
        shown = f"{figure(a)} Hz" if fit.told(key) else "not told"
        rows.append((title, shown, f"± {sure:.2g} Hz, before {figure(b)} Hz"))
    sure, before = fit.deviations["ratio"], old.load / old.motor
    shown = figure(fit.ratio) if fit.told("ratio") else "not told"
    rows.append(("Load over motor inertia", shown, f"± {sure:.2g}, before {figure(before)}"))
    rows.append(("Left by the model", f"{100 * fit.left:.3g} %", "RMS over the band"))
    return cards(rows)


def _values(found: FoundResponse) -> str:
    rows = []
    for p in found.parameters:
        title = f'{escape(p.title)}<div class="sub">{escape(p.name)}</div>'
        value = _sure(p.value, p.deviation) if p.told else f"left alone: {escape(p.why)}"
        if p.told and abs(p.value) >= 1e6:
            value = f"{p.value:.5g} ± {p.deviation:.2g}"
        if p.told and abs(p.value) < 1e-2:
            value = f"{p.value:.5g} ± {p.deviation:.2g}"
        share = f"{100 * abs(p.deviation / p.value):.2g} %" if p.told and p.value else ""
        rows.append([title, spelled(p.unit), _short(p.before), value, share])
    return table(["quantity", "unit", "before", "found", "deviation"], rows, 2)


def _decibel(values: Any) -> Array:
    return np.asarray(20.0 * np.log10(np.maximum(np.abs(values), 1e-300)))


def _bode(found: FoundResponse) -> Diagram:
    """Magnitude and phase with their bands and both models, coherence below."""
    hertz, m = _hertz(found), found.measured
    size = np.abs(m.values)
    known = np.where(np.isfinite(m.deviation), m.deviation, 0.0)
    share = np.minimum(BAND * known / size, 0.95)
    curves = {"before": found.before, "found": found.found}
    near = np.degrees(np.unwrap(np.angle(found.found)))
    near -= 360.0 * round(float(near[0] + 90.0) / 360.0)

    def angle(values: Any) -> Array:
        a = np.degrees(np.angle(values))
        return np.asarray(a + 360.0 * np.round((near - a) / 360.0))

    lag = angle(m.values)
    turn = np.degrees(np.arcsin(share))
    level = _decibel(m.values)
    sizes: list[Mark] = []
    angles: list[Mark] = []
    if known.any():
        name = "± 2 standard deviations"
        sizes.append(
            BandMark(
                hertz, level + _decibel(1 - share), level + _decibel(1 + share), name, MEASURED
            )
        )
        angles.append(BandMark(hertz, lag - turn, lag + turn, name, MEASURED))
    for name, color, dash in (("before", BEFORE, DASH), ("found", FOUND, "solid")):
        label = f"model, values {name}"
        sizes.append(LineMark(hertz, _decibel(curves[name]), label, color, _WIDTH, dash))
        angles.append(LineMark(hertz, angle(curves[name]), label, color, _WIDTH, dash))
    sizes.append(PointMark(hertz, level, "measured", MEASURED, size=_DOT))
    angles.append(PointMark(hertz, lag, "measured", MEASURED, size=_DOT))
    fit = found.fit
    if fit.two:
        for omega, text in (
            (fit.model.antiresonance, "antiresonance"),
            (fit.model.resonance, "resonance"),
        ):
            at = omega / (2.0 * math.pi)
            if hertz[0] < at < hertz[-1]:
                side = "left" if text == "antiresonance" else "right"
                sizes.append(LevelMark(at, text, upright=True, side=side))
                angles.append(LevelMark(at, upright=True))
    title, unit = _unit(found)
    ends = ends_of([level, _decibel(found.found)])
    turned = ends_of([lag, angle(found.found)])
    rows = [
        Subplot(Scale(title, unit, ends), sizes, _HIGH),
        Subplot(Scale("Phase", "°", turned, spacing=90.0), angles, _LOW + 40, legend=False),
    ]
    if np.isfinite(m.coherence).any():
        marks: list[Mark] = [PointMark(hertz, m.coherence, "coherence", MEASURED, size=_DOT)]
        low = float(np.nanmin(m.coherence))
        rows.append(Subplot(Scale("Coherence", "", (min(0.9, low) - 0.02, 1.02)), marks, _LOW))
    reach = float(hertz[0]), float(hertz[-1])
    return Diagram((Scale("Frequency", "Hz", reach, log=True),), tuple(rows))


def _unit(found: FoundResponse) -> tuple[str, str]:
    ports = found.scenario.resolver.ports

    def of(signal: str) -> str:
        component, _, name = signal.partition(".")
        unit = ports[component][name.partition("[")[0]].unit
        return spelled(unit) if unit and unit != "1" else "1"

    source, output = found.signals
    return "|G|", f"dB of ({of(output)})/({of(source)})"


def _residual(found: FoundResponse) -> Diagram:
    hertz, m = _hertz(found), found.measured
    rest = apart(m.values, found.found)
    marks: list[Mark] = [PointMark(hertz, rest, "difference", MEASURED, size=_DOT)]
    known = m.deviation / np.abs(m.values)
    if np.isfinite(known).any() and (known > 0.0).any():
        marks.append(LineMark(hertz, known, "standard deviation measured", FOUND, _WIDTH))
    reach = float(hertz[0]), float(hertz[-1])
    return one(
        Scale("Frequency", "Hz", reach, log=True),
        Scale("Residual", "", log=True),
        marks,
        _HIGH - 60,
    )


def _loop(loop: FoundLoop) -> Diagram:
    """The Bode diagram of an open loop with both plants, and with the measured one."""
    sizes: list[Mark] = []
    angles: list[Mark] = []
    omega = grid(loop.after, _POINTS)
    near = np.degrees(np.unwrap(np.angle(response(loop.after, omega))))
    middle = int(np.argmin(np.abs(_decibel(response(loop.after, omega)))))
    near -= 360.0 * round((near[middle] + 180.0) / 360.0)
    for system, name, color, dash in (
        (loop.before, "values before", BEFORE, DASH),
        (loop.after, "values found", FOUND, "solid"),
    ):
        values = response(system, omega)
        a = np.degrees(np.angle(values))
        a += 360.0 * np.round((near - a) / 360.0)
        hertz = omega / (2.0 * math.pi)
        sizes.append(LineMark(hertz, _decibel(values), name, color, _WIDTH, dash))
        angles.append(LineMark(hertz, a, name, color, _WIDTH, dash))
    lag = np.degrees(np.angle(loop.measured))
    lag += 360.0 * np.round((np.interp(loop.omega, omega, near) - lag) / 360.0)
    hertz = loop.omega / (2.0 * math.pi)
    sizes.append(PointMark(hertz, _decibel(loop.measured), "measured plant", MEASURED, size=_DOT))
    angles.append(PointMark(hertz, lag, "measured plant", MEASURED, size=_DOT))
    sizes.append(LevelMark(0.0, dash=DASH))
    angles.append(LevelMark(-180.0, dash=DASH))
    level = _decibel(loop.measured)
    low, high = float(level.min()) - 20.0, float(level.max()) + 20.0
    seen = (omega > 0.3 * loop.omega[0]) & (omega < 3.0 * loop.omega[-1])
    reach = float(omega[seen][0] / 2 / math.pi), float(omega[seen][-1] / 2 / math.pi)
    return Diagram(
        (Scale("Frequency", "Hz", reach, log=True),),
        (
            Subplot(Scale("|L|", "dB", (low, high)), sizes, _HIGH - 30),
            Subplot(
                Scale("Phase", "°", ends_of([lag, near[seen]]), spacing=90.0),
                angles,
                _LOW + 40,
                legend=False,
            ),
        ),
    )


def _margins(loop: FoundLoop) -> str:
    rows = []
    for name, system in (("before", loop.before), ("found", loop.after)):
        m = margins(system)
        gain = f"x {m.gain:.4g}" if math.isfinite(m.gain) else "unlimited"
        cells = [gain, f"{m.phase:.4g}°", f"{1e3 * m.delay:.4g} ms", f"{m.sensitivity:.4g}"]
        rows.append([f"values {name}" + ("" if m.stable else " (unstable)"), *cells])
    return table(["model", "gain", "phase", "delay", "peak S"], rows, 1)


def response_numbers(found: FoundResponse) -> Mapping[str, Any]:
    """All numbers, as result.json has them."""

    def plain(values: Any) -> Any:
        return [float(x) if math.isfinite(x) else None for x in np.asarray(values).tolist()]

    def number(x: float) -> float | None:
        return float(x) if math.isfinite(x) else None

    m, fit = found.measured, found.fit
    model = fit.model
    hertz = 2.0 * math.pi
    masses = {
        "motor": model.motor,
        "load": model.load,
        "stiffness": model.stiffness,
        "damping": model.damping,
        "load_viscous": model.load_viscous,
        "delay": model.delay,
    }
    if fit.two:
        masses |= {"ratio": fit.ratio}
    return {
        "scenario": found.scenario.name,
        "axis": found.axis.axis,
        "record": m.name,
        "signals": list(found.signals),
        "estimate": m.way,
        "speed": number(found.speed),
        "two_masses": fit.two,
        "antiresonance": number(model.antiresonance / hertz) if fit.two else None,
        "resonance": number(model.resonance / hertz) if fit.two else None,
        "masses": {
            name: {
                "value": number(value),
                "deviation": number(fit.deviations.get(name, math.inf)),
                "told": fit.told(name),
                "why": fit.why.get(name, ""),
            }
            for name, value in masses.items()
        },
        "parameters": {
            p.name: {
                "value": p.value,
                "deviation": number(p.deviation),
                "before": p.before,
                "unit": p.unit,
                "told": p.told,
                "why": p.why,
            }
            for p in found.parameters
        },
        "settings": dict(found.settings),
        "left": fit.left,
        "left_of_one_mass": fit.alone,
        "response": {
            "frequency": plain(m.omega / hertz),
            "real": plain(m.values.real),
            "imaginary": plain(m.values.imag),
            "deviation": plain(m.deviation),
            "coherence": plain(m.coherence),
        },
        "model": {"real": plain(found.found.real), "imaginary": plain(found.found.imag)},
        "loops": [
            {
                "at": loop.at,
                "frequency": plain(loop.omega / hertz),
                "real": plain(loop.measured.real),
                "imaginary": plain(loop.measured.imag),
            }
            for loop in found.loops
        ],
        "notes": list(found.notes),
    }


def response_toml(found: FoundResponse) -> str:
    """Text of a file for ``--set``, and for the [set] of a machine."""
    lines = [
        f"# Axis {found.axis.axis} of {found.scenario.name}, two masses from the frequency response"
        f" of {found.measured.name}."
    ]
    lines += [f"# {note}" for note in (*words(found), *found.notes)]
    for p in found.parameters:
        if p.told:
            lines.append(f"# {p.name}: {p.value:.6g} ± {p.deviation:.2g} {p.unit}")
    lines += [f'"{name}" = {float(value)!r}' for name, value in found.settings.items()]
    return "\n".join(lines) + "\n"
