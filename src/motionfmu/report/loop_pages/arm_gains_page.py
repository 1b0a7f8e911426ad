"""The page of the gains of an arm's drives: worst poses, margins, the tool before and after."""

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.linear import Margins
from motionfmu.report.diagram import (
    DOT,
    SOLID,
    Diagram,
    LevelMark,
    LineMark,
    SamplesMark,
    Scale,
    Subplot,
    ends_of,
    one,
)
from motionfmu.report.html_page import Page, PageFrame
from motionfmu.report.html_tables import cards, table
from motionfmu.report.numbers import figure, length, unit
from motionfmu.report.samples import Samples
from motionfmu.report.style import AXES, RAPID
from motionfmu.study.arm_gains import ArmTuned, ArmVerdict

Array = NDArray[np.float64]
BEFORE, AFTER = RAPID, AXES[0]
_WIDTH, _HEIGHT = 1.4, 200  # [pixel]
FOOTER = (
    "Model: the arm's own equation at rest in a pose, its joints moving slowly under load (no"
    " friction that holds, gears on one side of their lost motion), the sampled laws of all six"
    " drives. Each loop is opened with the five others closed. Every number is in"
    ' <a href="result.json">result.json</a>; use the gains with'
    " <code>motionfmu run SCENARIO --set gains.toml</code>."
)
ROWS = (
    ("position_gain", "position gain [1/s]"),
    ("velocity_gain", "velocity gain [N·m·s/rad]"),
    ("velocity_time", "integral time [s]"),
)


def page_text(tuned: ArmTuned) -> str:
    """The whole HTML page."""
    page = Page()
    page.sections.append(_cards(tuned))
    page.section("Gains", _gains_note(tuned), _gains(tuned))
    page.section("Worst poses", _poses_note(tuned), _poses(tuned))
    note = (
        "Largest of each joint's loop at every frequency in its worst pose: how much it raises a"
        " disturbance, and how far its link swings beyond the command. Lines: found; dots: before."
    )
    page.section("Loops in the worst poses", note, page.place("loops", _loops(tuned)))
    if tuned.runs:
        note = (
            "Distance of the tool from the path that it would take at infinitely low speed, with"
            " sag and errors of the geometry. The FMUs ran without lost motion and transmission"
            " errors, which no gain changes. Figures count from 1 s on, when the arm has stopped"
            " sinking."
        )
        shown = page.place("tool", _tool(tuned), True) + _runs(tuned)
        page.section("Tool beside its way", note, shown)
        note = (
            "Share of the command speed fed forward and its filter, on the program with the gains"
            " found: what brings the tool nearest to its way and no motor to its torque limit."
        )
        page.section("Feed-forward", note, _forward(tuned))
    scenario = tuned.loops.scenario
    frame = PageFrame(scenario.name, scenario.document.about, "tuning report", [], FOOTER)
    return page.text(frame)


def _cards(tuned: ArmTuned) -> str:
    before, after = tuned.before, tuned.after
    rows = [
        (
            "Largest |1/(1 + L)|",
            figure(_most(after, "sensitivity")),
            f"before {figure(_most(before, 'sensitivity'))}; asked {tuned.limits.sensitivity:g}",
        ),
        (
            "Largest |link/command|",
            figure(_most(after, "swing")),
            f"before {figure(_most(before, 'swing'))}; asked {tuned.limits.swing:g}",
        ),
        ("Slowest joint", f"J{tuned.slowest}", f"of {len(tuned.found.arm)} poses"),
    ]
    if tuned.runs:
        had, has = (r.rms for r in tuned.runs)
        rows.append(("RMS of the tool", length(has), f"beside its way; before {length(had)}"))
    return cards(rows)


def _most(verdict: ArmVerdict, name: str) -> float:
    return max(float(getattr(j, name)) for j in verdict.joints)


def _gains_note(tuned: ArmTuned) -> str:
    bears = ", ".join(f"J{k + 1} {x:.3g}" for k, x in enumerate(tuned.found.own))
    return (
        f"All joints lag alike, as long as J{tuned.slowest} must, so that the tool keeps its path;"
        f" by itself each would bear [1/s]: {bears}."
    )


def _gains(tuned: ArmTuned) -> str:
    rows = []
    present, found = tuned.loops.present, tuned.found.gains
    for k, (_, title) in enumerate(ROWS):
        rows.append([title, "before", *(f"{x:.4g}" for x in present[k])])
        rows.append(["", "found", *(f"{x:.4g}" for x in found[k])])
    if tuned.share is not None:
        share, time = tuned.share
        rows.append(["feed-forward", "found", *6 * [f"{share:g}"]])
        rows.append(["its filter [s]", "found", *6 * [f"{time:g}"]])
    low, high = tuned.inertia * 1e4
    spans = (f"{a:.3g} to {b:.3g}" for a, b in zip(low, high, strict=True))
    rows.append(["inertia at the motor [kg·cm²]", "poses", *spans])
    return table(["", "", *(f"J{k}" for k in range(1, 7))], rows, 2)


def _poses_note(tuned: ArmTuned) -> str:
    text = (
        f"{len(tuned.found.arm)} poses between the ends of the joints, the worst of each climbed"
        " from there; margins by the linear model in that pose. J1 turns about the vertical and"
        " changes nothing."
    )
    for name, verdict in (("before", tuned.before), ("after", tuned.after)):
        if verdict.unstable:
            text += f" Unstable {name} in {verdict.unstable} poses."
    return text


def _poses(tuned: ArmTuned) -> str:
    rows = []
    for before, after in zip(tuned.before.joints, tuned.after.joints, strict=True):
        for side, j in (("before", before), ("after", after)):
            name = f"J{j.joint}" if side == "before" else ""
            pose = ", ".join(f"{x:.0f}" for x in j.pose)
            rows.append([name, side, pose, *margin_cells(j.margins), figure(j.sensitivity),
                         figure(j.swing)])  # fmt: skip
    heads = ["joint", "gains", "worst pose [°]", "gain margin", "phase margin", "bandwidth"]
    return table([*heads, "|1/(1 + L)|", "|link/command|"], rows, 3)


def margin_cells(m: Margins) -> list[str]:
    """Gain margin, phase margin, bandwidth; or that the loop is unstable."""
    if not m.stable:
        return ["unstable", "", ""]
    return [f"x {m.gain:.3g}", f"{m.phase:.3g}°", f"{m.bandwidth / (2.0 * np.pi):.3g} Hz"]


def _loops(tuned: ArmTuned) -> Diagram:
    loops, plots = tuned.loops, []
    hertz = loops.omega / (2.0 * np.pi)
    curves: list[list[LineMark]] = [[], []]
    sides = ((tuned.after, tuned.found.gains, SOLID), (tuned.before, loops.present, DOT))
    for verdict, gains, dash in sides:
        for j in verdict.joints:
            arm = loops.responses(j.pose[None])
            found = loops.curves(loops.alone(arm, gains, j.joint), j.joint, gains[:, j.joint - 1])
            for marks, values in zip(curves, found, strict=True):
                name = f"J{j.joint}" if dash == SOLID and marks is curves[0] else ""
                color = AXES[(j.joint - 1) % len(AXES)]
                marks.append(LineMark(hertz, values[0], name, color, _WIDTH, dash))
    asked = tuned.limits.sensitivity, tuned.limits.swing
    for title, marks, limit in zip(("|1/(1 + L)|", "|link/command|"), curves, asked, strict=True):
        level = LevelMark(limit, f"asked {limit:g}")
        scale = Scale(title, "", (0.1, 20.0), log=True)
        plots.append(Subplot(scale, [*marks, level], _HEIGHT))
    ends = float(hertz[0]), float(hertz[-1])
    return Diagram((Scale("Frequency", "Hz", ends, log=True),), plots)


def _tool(tuned: ArmTuned) -> Diagram:
    factor, name = unit(max(r.max for r in tuned.runs))
    sides = zip(tuned.runs, ("before", "after"), (BEFORE, AFTER), strict=True)
    curves = [
        SamplesMark(Samples(r.time, r.deviation * factor), title, color, _WIDTH)
        for r, title, color in sides
    ]
    ends = ends_of([c.samples.values for c in curves])
    return one(Scale("Time", "s"), Scale("Tool beside its way", name, ends), curves, _HEIGHT)


def _runs(tuned: ArmTuned) -> str:
    rows = []
    for side, run in zip(("before", "after"), tuned.runs, strict=True):
        most = int(run.torque.argmax())
        torque = f"{100.0 * run.torque[most]:.3g} % (J{most + 1})"
        behind = int(run.lag.argmax())
        lag = f"{run.lag[behind]:.3g}° (J{behind + 1})"
        alarm = "alarm" if run.alarm else "none"
        rows.append([side, length(run.rms), length(run.max), lag, torque, alarm])
    heads = ["gains", "RMS", "largest", "most behind its command", "torque of its limit", "alarm"]
    return table(heads, rows)


def _forward(tuned: ArmTuned) -> str:
    rows = []
    for (share, time), (rms, torque) in tuned.forward.items():
        mark = ' <span class="mark">taken</span>' if (share, time) == tuned.share else ""
        rows.append(
            [f"{share:g}{mark}", f"{1e3 * time:g} ms", length(rms), f"{100 * torque:.3g} %"]
        )
    heads = ["share", "filter", "RMS of the tool beside its way", "torque of its limit"]
    return table(heads, rows, 1)
