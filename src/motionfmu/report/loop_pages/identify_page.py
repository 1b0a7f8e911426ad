"""The report of an identification: what was found, how sure it is, and what it explains."""

from html import escape

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.units import spelled
from motionfmu.identify.found_values import value_text
from motionfmu.identify.identification import Identified
from motionfmu.identify.record_run import RecordRun
from motionfmu.report.diagram import (
    Diagram,
    LineMark,
    Mark,
    PointMark,
    SamplesMark,
    Scale,
    ends_of,
    one,
)
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, facts, table
from motionfmu.report.numbers import figure, unit
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, RAPID

Array = NDArray[np.float64]
RECORD, FOUND = RAPID, AXES[0]
_WIDTH, _HEIGHT = 1.4, 230  # [pixel] of a curve, of a plot
_SEGMENTS = 8  # of the record whose spectra are averaged
FOOTER = (
    "Start values by inverse dynamics and least squares; then the plant's own equation with the"
    " sampled laws of the scenario around it, fitted to the record by multiple shooting and"
    " Gauss-Newton. Standard deviations count that residuals are not white. Every number is in"
    ' <a href="result.json">result.json</a>; use the values with'
    " <code>motionfmu run SCENARIO --set found.toml</code>."
)


def identify_page(found: Identified, run: RecordRun | None) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(found, run))
    page.section("What was found", _note(found), _values(found))
    if found.notes:
        page.section("To be known", "", "".join(f"<p>{escape(n)}</p>" for n in found.notes))
    if run is not None:
        note = (
            f"Both from the beginning; figures from {run.settled:g} s on, because FMUs begin at"
            " rest and where the command is."
        )
        page.section("The FMUs laid over the record", note, _laid_over(page, found, run))
    if len(found.curve.speed):
        note = (
            "Drive at uniform motion, by inverse dynamics: means of the record over ranges of"
            " speed, and the law found."
        )
        page.section("Friction", note, page.place("friction", _friction(found)))
    if found.tried:
        page.section("Laws tried", _tried_note(found), _tried(found))
    page.section("Residuals", _residual_note(found), _residuals(page, found))
    if found.spread is not None and len(found.free) > 1:
        note = f"Condition number of the information matrix: {found.spread.condition:.3g}."
        page.section("Correlations", note, _correlations(found))
    if found.check is not None:
        note = "The laws of the scenario fed with what they saw by the record."
        page.section("Controller", note, _controller(found))
    scenario = found.scenario
    frame = PageFrame(scenario.name, scenario.document.about, "identification report", [], FOOTER)
    return page.text(frame)


def _cards(found: Identified, run: RecordRun | None) -> str:
    rows = []
    for p in found.parameters[:3]:
        shown = figure(p.value) if p.told else "not told"
        where = f"± {p.deviation:.2g}, before {figure(p.before)}" if p.told else escape(p.why)
        rows.append((p.title, f"{shown} {spelled(p.unit) if p.told else ''}", where))
    if run is not None:
        name = "following error" if "following error" in run.differences else found.signals[0]
        rows.append((f"FMUs beside the record: {name}", f"{100 * run.differences[name]:.3g} %", ""))
    return cards(rows)


def _note(found: Identified) -> str:
    words = [found.ground.known.law[n].title for n in found.laws]
    law = "Coulomb and viscous friction" + "".join(f", {w}" for w in words)
    n, span = len(found.time), float(found.time[-1] - found.time[0]) if len(found.time) else 0.0
    return f"{escape(found.record.name)}: {n} samples, {span:.4g} s. {law}."


def _values(found: Identified) -> str:
    rows = []
    for p in found.parameters:
        title = f'{escape(p.title)}<div class="sub">{escape(p.name)}</div>'
        value = value_text(p) if p.told else f"left alone: {escape(p.why)}"
        share = abs(p.deviation / p.value) if p.told and p.value else np.nan
        shown = f"{100 * share:.2g} %" if np.isfinite(share) else ""
        rows.append([title, spelled(p.unit), figure(p.before), value, shown])
    return table(["quantity", "unit", "before", "found", "deviation"], rows, 2)


def _pair(title: str, of: str, time: Array, pair: tuple[Array, Array]) -> Diagram:
    factor, name = unit(1e3 * float(np.abs(pair[0]).max())) if of == "m" else (1.0, spelled(of))
    factor = 1e3 * factor if of == "m" else factor
    curves = [
        SamplesMark(Samples(time, values * factor), label, color, _WIDTH)
        for values, label, color in zip(pair, ("record", "FMUs"), (RECORD, FOUND), strict=True)
    ]
    ends = ends_of([c.samples.values for c in curves])
    return one(Scale("Time", "s"), Scale(title, name, ends), curves, _HEIGHT)


def _laid_over(page: Page, found: Identified, run: RecordRun) -> str:
    ports = found.scenario.resolver.ports
    parts, rows = [], []
    if run.following is not None:
        diagram = _pair("Following error", found.ground.length, run.time, run.following)
        parts.append(page.place("following", diagram, True))
    for k, name in enumerate(run.signals):
        c, _, variable = name.partition(".")
        of = ports[c][variable.partition("[")[0]].unit or ""
        if run.following is None or name in found.ground.loop.shown:
            pair = run.measured[:, k], run.run[:, k]
            parts.append(page.place(f"laid{k}", _pair(name, of, run.time, pair), True))
    for name, share in run.differences.items():
        largest = run.largest[name]
        rows.append([escape(name), f"{100 * share:.3g} %", f"{largest:.3g}"])
    heads = ["signal", "difference over signal (RMS)", "largest difference"]
    return table(heads, rows, 1) + "".join(parts)


def _friction(found: Identified) -> Diagram:
    curve = found.curve
    speed = curve.speed * 1e3 if curve.units[0] == "m/s" else curve.speed
    name = "mm/s" if curve.units[0] == "m/s" else spelled(curve.units[0])
    hover = [
        f"{v:.4g} {name}: {d:.4g} ± {s:.2g}"
        for v, d, s in zip(speed, curve.drive, curve.scatter, strict=True)
    ]
    marks: list[Mark] = [
        PointMark(speed, curve.drive, "record", RECORD, size=7.0, hover=hover),
        LineMark(
            np.insert(speed, np.searchsorted(speed, 0.0), np.nan),
            np.insert(curve.law, np.searchsorted(speed, 0.0), np.nan),
            "law found",
            FOUND,
            1.8,
        ),
    ]
    return one(Scale("Speed", name), Scale("Drive", spelled(curve.units[1])), marks, 300)


def _tried_note(found: Identified) -> str:
    share = 100 * found.kept_share
    return (
        f"Each law was fitted to the first {100 - share:.0f} % of the record and had to explain the"
        f" last {share:.0f} %; the values above are from all of it. Score: what is left of the part"
        " kept back, over that of the first row."
    )


def _tried(found: Identified) -> str:
    rows = []
    for v in found.tried:
        words = [*v.laws, *(f"{n} = {str(x).lower()}" for n, x in v.other.items())]
        mark = ' <span class="mark">taken</span>' if v is found.chosen else ""
        shares = [f"{100 * v.kept[n]:.3g} %" for n in found.signals]
        fits = [f"{100 * v.fitted[n]:.3g} %" for n in found.signals]
        both = [cell for two in zip(fits, shares, strict=True) for cell in two]
        rows.append([escape(", ".join(words) or "none") + mark, *both, f"{v.score:.3f}"])
    heads = ["extension"]
    for n in found.signals:
        heads += [f"{escape(n)}, fitted", "kept back"]
    return table([*heads, "score"], rows, 1)


def _residual_note(found: Identified) -> str:
    words = ", ".join(f"{escape(n)} {100 * x:.0f} %" for n, x in found.residuals.items())
    return (
        "Record less fit, over time, and its spectrum. Autocorrelations beyond those of white noise"
        f" (which has 5 %): {words}."
    )


def _residuals(page: Page, found: Identified) -> str:
    from scipy.signal import welch

    parts = []
    interval = found.recorded.interval
    for k, name in enumerate(found.signals):
        c, _, variable = name.partition(".")
        port = found.scenario.resolver.ports[c][variable.partition("[")[0]]
        of = spelled(port.unit or "")
        rest = found.measured[:, k] - found.simulated[:, k]
        curve = SamplesMark(Samples(found.time, rest), name, AXES[k % len(AXES)], _WIDTH)
        diagram = one(Scale("Time", "s"), Scale(name, of), [curve], 180)
        parts.append(page.place(f"rest{k}", diagram, True))
        f, density = welch(rest, 1.0 / interval, nperseg=max(16, len(rest) // _SEGMENTS))
        line = LineMark(f[1:], np.sqrt(density[1:]), name, AXES[k % len(AXES)])
        spectrum = one(
            Scale("Frequency", "Hz", log=True),
            Scale(f"{name} per √Hz", of, log=True),
            [line],
            180,
        )
        parts.append(page.place(f"spectrum{k}", spectrum))
    return "".join(parts)


def _correlations(found: Identified) -> str:
    assert found.spread is not None
    rows = [
        [escape(name), *(f"{c:.2f}" for c in row)]
        for name, row in zip(found.free, found.spread.correlation, strict=True)
    ]
    return table(["", *map(escape, found.free)], rows, 1)


def _controller(found: Identified) -> str:
    check = found.check
    assert check is not None
    rows = [
        ("Signal", escape(check.signal)),
        ("Unexplained", f"{100 * check.difference:.3g} %"),
        ("Lag", f"{1e3 * check.lag * found.ground.loop.step:.4g} ms"),
    ]
    for name, (before, says) in check.gains.items():
        rows.append((name, f"{before:.6g}; the record says {says:.6g}"))
    rows.append(("Unexplained with these gains", f"{100 * check.fitted:.3g} %"))
    return facts(rows)
