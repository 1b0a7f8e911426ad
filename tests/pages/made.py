"""A page of each kind, made as the command makes it, of the shortest runs that fill it."""

import time
from collections.abc import Callable
from pathlib import Path

from conftest import ROOT

import motionfmu
from motionfmu.report.run_page import page_text
from motionfmu.report.run_summary import summary_of
from motionfmu.report.signal_page import plain_text

CIRCLE = ROOT / "scenarios/circle"


def contour_run() -> motionfmu.Result:
    """A circle: contour, FIFO, interrupts, traces."""
    return motionfmu.load(ROOT / "scenarios/fifo_latency").run(stop=0.8)


def contour(result: motionfmu.Result) -> str:
    from motionfmu.report.error_path import draw

    found = result.contour()
    return page_text((result, summary_of(result, found)), found, draw(found), result.figures())


def plain(name: str, stop: float) -> str:
    result = motionfmu.load(ROOT / "scenarios" / name).run(stop=stop)
    return plain_text(result, result.figures(), summary_of(result, None))


def compared(result: motionfmu.Result) -> str:
    """The circle over itself at a higher gain."""
    from motionfmu.compare import compare
    from motionfmu.compare.comparison_page import page_text as compare_page

    other = motionfmu.load(ROOT / "scenarios/fifo_latency").run(stop=0.8, set={"mcc.p_gain": 250})
    return compare_page(compare(result, other))


def margins() -> str:
    from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
    from motionfmu.analysis.linear import model
    from motionfmu.report.loop_pages import margin_page

    linear = model(CIRCLE, 1, {"machine.motor_speed": 30.0}, {})
    return margin_page.page_text(linear, study(linear, LoopStudyOptions(None, {}, False, None)))


def tuned() -> str:
    from motionfmu.report.loop_pages import tune_page
    from motionfmu.run import load
    from motionfmu.study.tune import problem, tune

    return tune_page.page_text(tune(load(ROOT / "scenarios/mismatch_line"), problem({}), {}))


def causes() -> str:
    from motionfmu.analysis.explain import explain
    from motionfmu.report.cause_pages import explain_page

    return explain_page.page_text(explain(ROOT / "scenarios/mismatch_line", {}))


def program() -> str:
    from motionfmu.analysis.gcode import read, strokes, summarise
    from motionfmu.report.jobs import gcode_page

    found = read((CIRCLE / "circle.ngc").read_text())
    return gcode_page.page_text("circle", found, summarise(found), list(strokes(found)))


def plan() -> str:
    from motionfmu.cards import load, plt
    from motionfmu.cards.plan import plan as planned
    from motionfmu.cards.plan_figures import figures
    from motionfmu.report.jobs import card_page

    folder = ROOT / "scenarios/plt_plate"
    drawing = plt.read(folder / "plate.plt")
    config = load(folder / "card.toml")
    found = planned(drawing, config)
    return card_page.plan_page("plate", found, drawing, figures(found, config).numbers())


def swept(folder: Path) -> str:
    """A study whose rows are made by hand: a bowl over two gains."""
    from motionfmu.report.studies.sweep_page import page_text as sweep_text
    from motionfmu.study import worker
    from motionfmu.sweep import Outcome, study

    gains = {f"mcc.p_gain[{k}]": {"from": 100, "to": 300, "n": 5} for k in (1, 2)}
    cost = "contour.error.max"
    given = {"axis": gains, "results": [cost], "cost": cost, "sampling": "grid", "stop": 0.5}
    chosen = study(CIRCLE, given)
    rows = [
        worker.Row(i, "ok", "", True, (0.01 + sum((x / 200.0 - 1.0) ** 2 for x in point),))
        for i, point in enumerate(chosen.points)
    ]
    return sweep_text(Outcome(chosen, rows, folder, 0))


def path_causes(folder: Path) -> str:
    from motionfmu.analysis.explain import explain_path
    from motionfmu.report.cause_pages.path_causes_page import write_path_explanation

    found = explain_path(ROOT / "scenarios/plt_plate", {})
    return write_path_explanation(found, folder).read_text()


def made(folder: Path) -> tuple[dict[str, Path], motionfmu.Result]:
    """Pages by kind, and the run that is on the page `contour`."""
    result = contour_run()
    kinds: dict[str, Callable[[], str]] = {
        "contour": lambda: contour(result),
        "iso9283": lambda: plain("plt_plate", 2.5),
        "robot": lambda: plain("robot_pick", 0.2),
        "compare": lambda: compared(result),
        "margins": margins,
        "tune": tuned,
        "causes": causes,
        "path": lambda: path_causes(folder),
        "sweep": lambda: swept(folder),
        "gcode": program,
        "plan": plan,
    }
    pages: dict[str, Path] = {}
    for kind, make in kinds.items():
        start = time.process_time()
        pages[kind] = folder / f"{kind}.html"
        pages[kind].write_text(make(), encoding="utf-8")
        print(f"{kind}: {time.process_time() - start:.2f} s")
    return pages, result
