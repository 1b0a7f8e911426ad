"""The page of an arm that was identified from a record."""

from html import escape

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.arm_dynamics.arm_files import law_names, with_deviation
from motionfmu.identify.arm_dynamics.arm_identification import ArmQuantity, IdentifiedArm
from motionfmu.identify.arm_dynamics.arm_run import HeldArm
from motionfmu.identify.arm_dynamics.gear_windup import GearFound
from motionfmu.identify.arm_dynamics.torque_laws import BASE, LAWS, JointState
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
from motionfmu.report.html_tables import cards, table
from motionfmu.report.numbers import figure
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, RAPID

Array = NDArray[np.float64]
RECORD, FOUND = RAPID, AXES[0]
_WIDTH, _HEIGHT = 1.4, 200  # [pixel]
_SEGMENTS = 8  # of the record whose spectra are averaged
_BINS, _FEWEST = 24, 5  # of speeds, and rows of one
FOOTER = (
    "Torque = regressor of the links, inertia of the motors and friction, times what is looked for:"
    " weighted least squares after one low pass on both sides, base parameters by QR. Standard"
    " deviations count that residuals are not white. Every number is in"
    ' <a href="result.json">result.json</a>; use the values with'
    " <code>motionfmu run SCENARIO --set found.toml</code>."
)


def arm_page(found: IdentifiedArm, run: HeldArm | None) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(found, run))
    page.section("Torques", _torque_note(found), _torques(page, found))
    if run is not None:
        note = (
            "The arm's FMU with what was found, driven by the torques of the part kept back and"
            " held to its motion by a loop of 2 Hz at each motor: what it adds, the model lacks."
        )
        page.section("The FMU along the record", note, _held(page, found, run))
    page.section("Base parameters", _base_note(found), _base(found))
    page.section("Friction", _friction_note(found), _friction(page, found))
    if found.gears:
        note = (
            "Wind-up, less what the errors of the gear and the friction of the link make, over the"
            " torque that the links ask of the gear."
        )
        page.section("Gears", note, _gears(page, found))
    if len(found.tried) > 1:
        page.section("Laws tried", _tried_note(found), _tried(found))
    page.section("Spectra of the residuals", "", _spectra(page, found))
    if found.notes:
        page.section("To be known", "", "".join(f"<p>{escape(n)}</p>" for n in found.notes))
    scenario = found.plant.scenario
    frame = PageFrame(scenario.name, scenario.document.about, "identification report", [], FOOTER)
    return page.text(frame)


def _cards(found: IdentifiedArm, run: HeldArm | None) -> str:
    told = sum(q.told for q in found.base)
    kept = found.kept[np.isfinite(found.kept)]
    rows = [
        ("Base parameters", f"{told} of {len(found.base)}", "known to 30 % of themselves"),
        (
            "Torque left unexplained",
            f"{100 * float(kept.mean()):.3g} %",
            f"of the part kept back; {100 * float(kept.max()):.3g} % at most",
        ),
        ("Condition", f"{found.fit.condition:.3g}", "of the columns, each scaled to 1"),
    ]
    if found.gears:
        joints = ", ".join(str(k + 1) for k in found.gears)
        rows.append(("Gears told", str(len(found.gears)), f"joints {joints}"))
    if run is not None:
        added = run.shares[np.isfinite(run.shares)]
        rows.append(("The loops add", f"{100 * float(added.mean()):.3g} %", "of the torque"))
    return cards(rows)


def _torque_note(found: IdentifiedArm) -> str:
    e, record = found.equation, found.record
    return (
        f"{escape(record.name)}: {len(record.time)} samples at {record.rate:.4g} Hz,"
        f" {record.time[-1]:.4g} s. Angles pass below {e.corner:.3g} Hz, both sides of the equation"
        f" below {e.stretch:.3g} Hz; {int(e.moving.sum())} rows. Unexplained: RMS of the residual"
        " over that of the torque about its mean, on the part kept back, by what the rest tells."
    )


def _torques(page: Page, found: IdentifiedArm) -> str:
    rows, parts = [], []
    e, model = found.equation, found.modelled
    ratio = found.plant.ratio
    for k in range(found.plant.count):
        left, size = found.kept[k], float(found.fit.sizes[k])
        cells = [f"{100 * left:.3g} %", figure(size), f"{size / ratio[k]:.2g}"]
        rows.append([f"joint {k + 1}", *cells])
        curves = [
            SamplesMark(Samples(e.time, x[:, k]), label, color, _WIDTH)
            for x, label, color in (
                (e.torque, "record", RECORD),
                (model, "model", FOUND),
                (e.torque - model, "residual", AXES[1]),
            )
        ]
        ends = ends_of([c.samples.values for c in curves])
        diagram = one(Scale("Time", "s"), Scale(f"Joint {k + 1}", "N·m", ends), curves, _HEIGHT)
        parts.append(page.place(f"torque{k}", diagram, True))
    heads = ["", "unexplained", "RMS left [N·m]", "at the motor [N·m]"]
    return table(heads, rows, 1) + "".join(parts)


def _held(page: Page, found: IdentifiedArm, run: HeldArm) -> str:
    rows, parts = [], []
    there = run.time >= run.settled
    for k in range(found.plant.count):
        windup = run.windup_shares[k]
        shown = f"{100 * windup:.3g} %" if np.isfinite(windup) else ""
        rows.append([f"joint {k + 1}", f"{100 * run.shares[k]:.3g} %", shown])
        curves = [
            SamplesMark(Samples(run.time[there], x[there, k]), label, color, _WIDTH)
            for x, label, color in (
                (run.recorded, "record", RECORD),
                (run.added, "added by the loop", AXES[1]),
            )
        ]
        scale = Scale(f"Motor {k + 1}", "N·m", ends_of([c.samples.values for c in curves]))
        parts.append(page.place(f"held{k}", one(Scale("Time", "s"), scale, curves, 150), True))
    heads = ["", "added over torque (RMS)", "difference of the wind-up over it (RMS)"]
    return table(heads, rows, 1) + "".join(parts)


def _base_note(found: IdentifiedArm) -> str:
    none = ", ".join(found.equation.base.none)
    left = f" No torque depends on {escape(none)}." if none else ""
    return (
        "What torques tell are sums of masses m, first moments mx, my, mz, moments of inertia Ixx"
        " to Izz about the joint and inertias J of the motors at the joint. Frames are parallel to"
        f" the base with the arm straight up.{left} What is known worse than to 30 % is grey."
    )


def _base(found: IdentifiedArm) -> str:
    return table(
        ["base parameter", "unit", "before", "found", "deviation"],
        [_row(q, escape(q.text)) for q in found.base],
        2,
    )


def _row(q: ArmQuantity, title: str) -> list[str]:
    value = with_deviation(q.value, q.deviation)
    share = f"{100 * q.deviation / abs(q.value):.2g} %" if q.value else ""
    before = figure(q.before) if np.isfinite(q.before) else ""
    cells = [title, q.unit, before, value, share if q.told else "not told"]
    return cells if q.told else [f'<span class="sub">{c}</span>' for c in cells]


def _friction_note(found: IdentifiedArm) -> str:
    own = [
        f"{LAWS[law].title}: {'joint' if len(on) == 1 else 'joints'} {', '.join(map(str, on))}"
        for law, on in law_names(found).items()
    ]
    more = "; ".join(own)
    return f"At the joint: motor and link together. {BASE.title}{'; ' if more else ''}{more}."


def _friction(page: Page, found: IdentifiedArm) -> str:
    rows = [_row(q, escape(q.name)) for q in found.joints]
    parts = [table(["of the joint", "unit", "before", "found", "deviation"], rows, 2)]
    for k in range(found.plant.count):
        diagram = _curve(found, k)
        if diagram is not None:
            parts.append(page.place(f"friction{k}", diagram))
    return "".join(parts)


def _laws_of(found: IdentifiedArm, joint: int) -> list[tuple[int, str, int, float]]:
    """Column in the equation, law, place in the law and value of what a joint has."""
    e = found.equation
    n = len(e.base.kept)
    rows = []
    for place, value in zip(found.fit.places, found.fit.values, strict=True):
        if place >= n and (c := e.columns[int(place) - n]).joint == joint:
            law = BASE if not c.law else LAWS[c.law]
            rows.append((int(place), c.law, [t for t, _ in law.terms].index(c.term), float(value)))
    return rows


def _curve(found: IdentifiedArm, k: int) -> Diagram | None:
    """Friction over speed in both directions: means of the record, and the law."""
    e = found.equation
    good = e.moving[:, k]
    if not good.any():
        return None
    own = _laws_of(found, k)
    places = [p for p, law, _, _ in own if law != "balancer"]
    values = np.array([v for _, law, _, v in own if law != "balancer"])
    rest = (e.torque - found.modelled)[:, k] + e.matrix[:, k, places] @ values
    speed = e.motion.motors[1][:, k]
    most = float(np.abs(speed[good]).max())
    edges = np.linspace(-most, most, 2 * _BINS + 1)
    into = np.digitize(speed, edges)
    bins = [good & (into == b) for b in range(1, 2 * _BINS + 1)]
    bins = [b for b in bins if b.sum() >= _FEWEST]
    x = np.array([speed[b].mean() for b in bins])
    y = np.array([rest[b].mean() for b in bins])
    line = np.linspace(-most, most, 4 * _BINS)
    slow = float(found.plant.of(found.plant.table.motors.stribeck)[k] / found.plant.ratio[k])
    state = JointState(0.0 * line, line, np.sign(line), slow)
    law = sum(
        v * (BASE if not name else LAWS[name]).columns(state)[j]
        for _, name, j, v in own
        if name != "balancer"
    )
    gap = int(np.searchsorted(line, 0.0))
    marks: list[Mark] = [
        PointMark(x, y, "record", RECORD, size=6.0),
        LineMark(np.insert(line, gap, np.nan), np.insert(law, gap, np.nan), "law", FOUND, 1.8),
    ]
    return one(Scale(f"Speed of joint {k + 1}", "rad/s"), Scale("Friction", "N·m"), marks, _HEIGHT)


def _gears(page: Page, found: IdentifiedArm) -> str:
    rows, parts = [], []
    for k, gear in found.gears.items():
        rows.append([f"joint {k + 1}", *_gear_cells(gear)])
        arc = 180.0 * 60.0 / np.pi
        marks: list[Mark] = [
            PointMark(gear.points[0], arc * gear.points[1], "record", RECORD, size=3.0),
            LineMark(gear.curve[0], arc * gear.curve[1], "found", FOUND, 1.8),
        ]
        diagram = one(
            Scale(f"Torque of joint {k + 1}", "N·m"), Scale("Wind-up", "arcmin"), marks, 240
        )
        parts.append(page.place(f"gear{k}", diagram))
    heads = [
        "",
        "stiffness [N·m/rad]",
        "changes at [N·m]",
        "lost motion [arcmin]",
        "hysteresis [arcmin]",
    ]
    heads += ["link's friction [N·m·s/rad]", "left over [arcmin]"]
    return table(heads, rows, 1) + "".join(parts)


def _gear_cells(gear: GearFound) -> list[str]:
    arc = 180.0 * 60.0 / np.pi

    def shown(name: str, factor: float) -> str:
        value, deviation = gear.values[name]
        if not np.isfinite(deviation):
            return "not told"
        return with_deviation(factor * value, factor * deviation)

    slopes = "<br>".join(
        with_deviation(float(v), float(d))
        for v, d in zip(gear.stiffness, gear.stiffness_deviation, strict=True)
    )
    knees = "<br>".join(f"{x:.4g}" for x in gear.knees)
    own = [slopes, knees, shown("lost", arc), shown("hysteresis", arc), shown("viscous", 1.0)]
    return [*own, f"{arc * gear.left:.3g}"]


def _tried_note(found: IdentifiedArm) -> str:
    share = 100 * found.keep
    return (
        f"Each was fitted to the first {100 - share:.0f} % of the record and had to explain the"
        f" last {share:.0f} %; one is taken that leaves 5 % less of a joint's residual there."
    )


def _tried(found: IdentifiedArm) -> str:
    rows, before = [], set[tuple[str, int]]()
    for t in found.tried:
        now = set(t.laws)
        steps = [f"+ {n}, joint {j + 1}" for n, j in now - before]
        steps += [f"- {n}, joint {j + 1}" for n, j in before - now]
        rows.append([", ".join(steps) or "none", *(f"{100 * x:.3g} %" for x in t.kept)])
        before = now
    return table(["law", *(f"joint {k + 1}" for k in range(found.plant.count))], rows, 1)


def _spectra(page: Page, found: IdentifiedArm) -> str:
    from scipy.signal import welch

    e, lines = found.equation, []
    rest = e.torque - found.modelled
    for k in range(found.plant.count):
        f, density = welch(rest[:, k], e.rate, nperseg=max(16, len(rest) // _SEGMENTS))
        lines.append(LineMark(f[1:], np.sqrt(density[1:]), f"joint {k + 1}", AXES[k % len(AXES)]))
    x, y = Scale("Frequency", "Hz", log=True), Scale("Residual per √Hz", "N·m", log=True)
    return page.place("spectra", one(x, y, lines, 240))
