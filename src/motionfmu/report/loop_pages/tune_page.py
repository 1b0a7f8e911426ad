"""The report of a tuning: gains, limits, contour error before and after."""

from collections.abc import Sequence
from html import escape

import numpy as np

from motionfmu.analysis.linear import LoopGain
from motionfmu.analysis.linear.gains import in_words
from motionfmu.base.units import spelled
from motionfmu.report.diagram import DOT, SOLID, Diagram, SamplesMark, Scale, ends_of, one
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import RMS, cards, overrides, table
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, RAPID
from motionfmu.study.tune.problem import ON_PATH
from motionfmu.study.tune.trial import Trial
from motionfmu.study.tune.tuning_result import RegionCheck, Tuned, TuningRun, kept_of, room_text
from motionfmu.study.tune.tuning_words import assumptions, units_of

BEFORE, AFTER = RAPID, AXES[0]
_STEPS = 600
_WIDTH, _HEIGHT = 1.6, 230  # [pixel] of a curve, of a plot
FOOTER = (
    "Model: the plant's own equation about the operating point with its friction as a disturbance,"
    " the sampled laws that the FMUs carry, all their delays. FMUs: the scenario run with the gains"
    " of gains.toml, rounded to the registers. The contour error is the distance from the nearest"
    ' point of the exact programmed geometry. Every number is in <a href="result.json">'
    "result.json</a>; use the gains with"
    " <code>motionfmu run SCENARIO --set gains.toml</code>."
)


def page_text(tuned: Tuned) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(tuned))
    if told := tuned.before[0].result.overrides:
        page.section("What was run", "", overrides(told))
    page.section("Gains", "", _gains(tuned))
    if tuned.region is not None:
        page.section(
            "Plants that the record leaves possible", tuned.region.text + ".", _region(tuned.region)
        )
    if tuned.trial is not None:
        note = f"{tuned.trial.stopped_by}. Runs of the FMUs with the gains above."
        page.section(f"Trial of {tuned.trial.name}", note, _trial(tuned.trial))
    note = f"The same program, run by the FMUs before and after. RMS {_over(tuned)}."
    page.section(
        tuned.study.path.what.capitalize(),
        note,
        _runs(tuned) + page.place("error", errors(tuned), True),
    )
    page.section("Margins and limits", _limits_note(tuned), _limits(tuned))
    note = "Position after a small step of the command, linear model, nominal plant."
    page.section("Step", note, page.place("step", _step(tuned), cursors="step"))
    page.section("How it was found", _search(tuned), _assumed(tuned))
    scenario = tuned.study.scenario
    frame = PageFrame(scenario.name, scenario.document.about, "tuning report", [], FOOTER)
    return page.text(frame)


def _cards(tuned: Tuned) -> str:
    before, after = tuned.before[0].fmus, tuned.after[0].fmus
    what = tuned.study.path.what
    least = tuned.margins(tuned.z)
    tight = max(least, key=lambda m: m.sensitivity)
    rows = [
        (f"RMS {what}", length(after.rms), f"{_over(tuned)}; before {length(before.rms)}"),
        (f"Largest {what}", length(after.max), f"before {length(before.max)}"),
        ("Largest |1/(1 + L)|", figure(tight.sensitivity), f"axis {tight.axis}, {tight.loop}"),
        ("Stopped by", _short(tuned), ""),
    ]
    return cards(rows)


def _over(tuned: Tuned) -> str:
    """The words that say over which time the RMS is taken."""
    return RMS if tuned.study.problem.command is None else "over the whole run"


def _short(tuned: Tuned) -> str:
    words = list(dict.fromkeys(x.what for x in tuned.found.stopped_by))
    return escape("; ".join(words) or tuned.stopped_by[0])


def _gains(tuned: Tuned) -> str:
    study, rows = tuned.study, []
    kps = [{(g.name, g.axis): g for g in tuned.position_gains(z)} for z in (study.present, tuned.z)]
    for k, (variable, share) in enumerate(zip(study.variables, tuned.z, strict=True)):
        port = study.scenario.resolver.end(variable.name, "set", variable.name).port
        found = tuned.found.z[k]
        cells = [variable.start, variable.value(float(found)), variable.value(float(share))]
        bounds = f"{variable.low:.4g} to {variable.high:.4g}"
        doc = f'{escape(variable.title)}<div class="sub">{escape(port.doc)}</div>'
        # of the first of its axes: they have the same value
        whose = variable.name, variable.axes[0] if port.shape else 0
        known = [kps[0].get(whose), *2 * [kps[1].get(whose)]]
        said = [_kp(g and g.at(c)) for g, c in zip(known, cells, strict=True)]
        values = (f"{c:.6g}{kp}" for c, kp in zip(cells, said, strict=True))
        rows.append([doc, spelled(port.unit), *values, bounds])
    exact, rounded = tuned.lags(tuned.found.z), tuned.lags(tuned.z)
    for k, before in tuned.lags(study.present).items():
        name = f'lag of axis {k}<div class="sub">Following error over speed in slow motion</div>'
        lags = (f"{1e3 * v:.4g}" for v in (before, exact[k], rounded[k]))
        rows.append([name, "ms", *lags, ""])
    heads = ["gain", "unit", "before", "found", "rounded", "searched"]
    return table(heads, rows, 2)


def _kp(gain: LoopGain | None) -> str:
    return "" if gain is None else f'<div class="sub">Kp {in_words(gain.kp)}</div>'


def _region(region: RegionCheck) -> str:
    """How much room plants leave, and which of them were held to."""
    sides = region.before, region.room
    rows = [
        ["plants that keep all limits", *(f"{kept_of(r)} of {len(r)}" for r in sides)],
        ["least room", *(room_text(r) for r in sides)],
    ]
    heads = ["", "gains for the nominal plant", "gains found"]
    found = table(heads, rows, 1)
    names = list(dict.fromkeys(n for plant in region.added for n in plant))
    held = [[n, *(f"{plant[n]:.5g}" for plant in region.added)] for n in names]
    heads = ["added to the search", *(f"possible plant {k + 1}" for k in range(len(region.added)))]
    return found + (table(heads, held, 1) if held else "")


def _trial(trial: Trial) -> str:
    rows = []
    for value, look in trial.tried.items():
        mark = ' <span class="mark">taken</span>' if value == trial.value else ""
        rows.append([f"{value:g}{mark}", length(look.cost), length(look.beyond)])
    return table([escape(trial.name), "RMS error at rest", "beyond the target"], rows, 1)


def _runs(tuned: Tuned) -> str:
    rows = []
    for before, after in zip(tuned.before, tuned.after, strict=True):
        name = escape(tuned.plant_name(before.plant))
        for side, run in (("before", before), ("after", after)):
            error = run.fmus
            lengths = (error.rms, run.model.rms, error.max, run.model.max)
            rows.append([name, side, *(length(x) for x in lengths)])
    heads = ["plant", "gains", "RMS", "by the model", "largest", "by the model"]
    return table(heads, rows, 2)


def errors(tuned: Tuned) -> Diagram:
    """The error of the runs before and after over time."""
    runs: Sequence[tuple[str, TuningRun, str]] = (
        ("before", tuned.before[0], BEFORE),
        ("after", tuned.after[0], AFTER),
    )
    factor, name = unit(max(r.fmus.max for _, r, _ in runs))
    curves = [
        SamplesMark(Samples(run.fmus.time, run.fmus.values * factor), title, color, _WIDTH)
        for title, run, color in runs
    ]
    ends = ends_of([c.samples.values for c in curves])
    what = tuned.study.path.what.capitalize()
    return one(Scale("Time", "s"), Scale(what, name, ends), curves, _HEIGHT)


def _step(tuned: Tuned) -> Diagram:
    study, curves = tuned.study, []
    part_of = study.parts[0]
    for title, z, dash in (("before", study.present, DOT), ("after", tuned.z, SOLID)):
        gains = study.gains(z)
        for k, part in part_of.items():
            periods = max(1, round(8.0 * max(study.lag, 1e-3) / _STEPS / part.period))
            answer = part.step(gains[k], periods, _STEPS, False).value[0]
            time = part.period * periods * 1e3 * np.arange(_STEPS, dtype=np.float64)
            color = AXES[(k - 1) % len(AXES)]
            samples = Samples(time, answer, steps=periods == 1)
            curves.append(SamplesMark(samples, f"axis {k} {title}", color, _WIDTH, dash))
    return one(Scale("Time", "ms"), Scale("Share of the step"), curves, _HEIGHT)


def _limits_note(tuned: Tuned) -> str:
    family = " Least of the family of plants." if len(tuned.study.plants) > 1 else ""
    return (
        "Loops are opened at the input named: the outer one with the inner one closed, the inner"
        f" one alone.{family} What is reached is marked."
    )


def _limits(tuned: Tuned) -> str:
    study = tuned.study
    rows = []
    pairs = zip(tuned.margins(study.present), tuned.margins(tuned.z), strict=True)
    for before, after in pairs:
        asked = study.asked(after.loop)
        values = (
            ("largest |1/(1 + L)|", before.sensitivity, after.sensitivity, asked.sensitivity),
            ("gain margin, factor", before.gain, after.gain, asked.gain),
            ("phase margin [°]", before.phase, after.phase, asked.phase),
        )
        for what, had, has, wanted in values:
            sign = "at most " if what.startswith("largest") else "at least "
            shown = "" if wanted is None else f"{sign}{wanted:g}"
            name = f"axis {after.axis}, {escape(after.loop)}"
            rows.append([name, what, figure(had), figure(has), shown])
    slack = dict(zip(study.limits, tuned.values.slack, strict=True))
    old = dict(zip(study.limits, study.values(study.present, False).slack, strict=True))
    reached = {(x.what, x.axis) for x in tuned.found.stopped_by}
    others = []
    for what, k in dict.fromkeys((x.what, x.axis) for x in study.limits):
        if "of the loop at" in what and (what, k) not in reached:
            continue
        same = [x for x in study.limits if (x.what, x.axis) == (what, k)]
        tight = min(same, key=lambda x: slack[x])
        mark = ' <span class="mark fail">reached</span>' if (what, k) in reached else ""
        name = f"axis {k}: {escape(what)}{mark}"
        if len(study.plants) > 1:
            name += f'<div class="sub">{escape(tuned.plant_name(study.plants[tight.plant]))}</div>'
        before = min(old[x] for x in same)
        others.append([name, f"{100.0 * before:.3g} %", f"{100.0 * slack[tight]:.3g} %"])
    heads = ["loop", "", "before", "after", "asked"]
    first = table(heads, rows, 2)
    second = table(["limit", "room before", "room after"], others, 1)
    return f'<div class="two"><div>{first}</div><div>{second}</div></div>'


def _search(tuned: Tuned) -> str:
    found, study = tuned.found, tuned.study
    factor, name = units_of(study.problem.cost)
    starts = ", ".join(f"{c * factor:.5g}" if np.isfinite(c) else "none" for c in found.starts)
    text = (
        f"{study.problem.cost}, worst of {len(study.plants)} plant(s): NLP (CasADi,"
        f" IPOPT) from {len(found.starts)} start(s) found {starts} {name} with"
        f" {found.evaluations[0]} evaluations in {found.seconds[0]:.2g} s;"
    )
    if np.isfinite(found.check):
        text += (
            f" the global search (DIRECT) {found.check * factor:.5g} {name} with"
            f" {found.evaluations[1]} evaluations in {found.seconds[1]:.2g} s."
        )
    else:
        text += " the global search found nothing within the limits."
    if study.problem.cost in ON_PATH and len(study.plants) > 1:
        text += f" Largest cost of a plant: {tuned.values.worst * factor:.5g} {name}."
    return escape(text)


def _assumed(tuned: Tuned) -> str:
    rows = [[escape(x) for x in text.split(": ", 1)] for text in assumptions(tuned.study)]
    return table(["assumed", ""], rows, 2)
