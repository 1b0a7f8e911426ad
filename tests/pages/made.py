"""A page of each kind, made as the command makes it, of the shortest runs that fill it."""

import re
import shutil
import time
from collections.abc import Callable
from functools import cache
from pathlib import Path
from typing import TYPE_CHECKING, Any

from conftest import ROOT

import motionfmu
from motionfmu.compare import Comparison, compare
from motionfmu.report.run_page import page_text
from motionfmu.report.run_summary import summary_of
from motionfmu.report.signal_page import plain_text
from motionfmu.scenarios import document
from motionfmu.scenarios.table_sources import ARRAYS, ORIGINS
from motionfmu.scenarios.toml_text import pair_lines, table_lines

if TYPE_CHECKING:
    from motionfmu.analysis.linear import Margins
    from motionfmu.study.tune import Tuned
    from motionfmu.sweep import Outcome

KINDS = (
    "contour",
    "robot",
    "iso9283",
    "signals",
    "compare",
    "margins",
    "tune",
    "causes",
    "path",
    "sweep",
    "gcode",
    "machine",
    "plan",
)
BARE = ("documentation", "notebook")  # without plots of a script
CIRCLE = ROOT / "scenarios/circle"
LONG = 40  # letters of a name


def long_name(name: str) -> str:
    """A name of forty letters."""
    return f"{name}_with_a_name_of_forty_letters_altogether"[:LONG]


def renamed(name: str, folder: Path, *components: str) -> Path:
    """A scenario's copy with a name of forty letters, and such names of its components."""
    place = folder / long_name(name)
    if place.is_dir():
        return place
    shutil.copytree(ROOT / "scenarios" / name, place)
    if components:
        file = place / "scenario.toml"
        text = whole_text(file)
        for one in components:
            text = re.sub(rf'(?m)(^|")({one})(?=\s*=\s*"|\.)', rf"\g<1>{long_name(one)}", text)
            assert f"\n{long_name(one)} " in text
        file.write_text(text)
    return place


def whole_text(file: Path) -> str:
    """A scenario that stands alone: with its machine, and with names in the place of patterns."""
    found = document.read(file)
    tables = {k: v for k, v in found.tables.items() if k not in ("machine", *ORIGINS)}
    inner = {k: v for k, v in tables.items() if k in ARRAYS or isinstance(v, dict)}
    lines = [f"# {found.about}"]
    for key, value in tables.items():
        lines += [] if key in inner else pair_lines(key, value)
    for key, table in inner.items():
        lines += table_lines(key, table)
    return "\n".join(lines) + "\n"


def contour_run(folder: Path) -> motionfmu.Result:
    """A circle: contour, FIFO, interrupts, traces."""
    return motionfmu.load(renamed("fifo_latency", folder)).run(stop=0.8)


def contour(result: motionfmu.Result) -> str:
    from motionfmu.report.error_path import draw

    found = result.contour()
    return page_text((result, summary_of(result, found)), found, draw(found), result.figures())


def plain(place: Path, stop: float) -> str:
    result = motionfmu.load(place).run(stop=stop)
    return plain_text(result, result.figures(), summary_of(result, None))


def comparison(result: motionfmu.Result, folder: Path) -> Comparison:
    """The circle over itself at a higher gain."""
    other = motionfmu.load(renamed("fifo_latency", folder)).run(stop=0.8, set={"mcc.p_gain": 250})
    return compare(result, other)


def margins(folder: Path) -> "tuple[str, Margins]":
    from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
    from motionfmu.analysis.linear import model
    from motionfmu.report.loop_pages import margin_page

    linear = model(renamed("circle", folder), 1, {"machine.motor_speed": 30.0}, {})
    found = study(linear, LoopStudyOptions(None, {}, False, None))
    return margin_page.page_text(linear, found), found[0].margins


def tuned(folder: Path) -> "Tuned":
    from motionfmu.run import load
    from motionfmu.study.tune import problem, tune

    return tune(load(renamed("mismatch_line", folder)), problem({}), {})


def causes(folder: Path) -> str:
    from motionfmu.analysis.explain import explain
    from motionfmu.report.cause_pages import explain_page

    return explain_page.page_text(explain(renamed("mismatch_line", folder), {}))


def program() -> str:
    """A program on a machine: where its time goes, too, and what each limit costs."""
    from motionfmu.analysis.cycle_time import planned, what_if
    from motionfmu.analysis.gcode import read, summarise
    from motionfmu.report.jobs import gcode_page
    from motionfmu.report.jobs.drawn_strokes import DrawnStrokes
    from motionfmu.run import machine
    from motionfmu.run.program_reading import reading_on

    file = CIRCLE / "circle.ngc"
    read_as, tools = reading_on("mill3", {})
    found = read(file, tools, **read_as)
    assert not found.faults
    scenario = machine("mill3").scenario(file)
    way = planned(scenario)
    figures = summarise(found)
    drawn, both = DrawnStrokes(found, figures), (way, what_if(scenario, way))
    return gcode_page.page_text(long_name("circle"), found, figures, drawn, both)


def on_a_machine(stop: float) -> str:
    """A program on a mill, whose axes have every kind of limit."""
    from motionfmu.run import machine

    return contour(machine("mill3").scenario(CIRCLE / "circle.ngc").run(stop=stop))


def plan() -> str:
    from motionfmu.cards import load
    from motionfmu.cards.plan import plan as planned
    from motionfmu.cards.plan_figures import figures
    from motionfmu.drawings import plt
    from motionfmu.report.jobs import card_page

    folder = ROOT / "scenarios/plt_plate"
    drawing = plt.read(folder / "plate.plt")
    config = load(folder / "card.toml")
    found = planned(drawing, config)
    return card_page.plan_page(long_name("plate"), found, drawing, figures(found, config).numbers())


def swept(folder: Path) -> "Outcome":
    """A study whose rows are made by hand: a bowl over two gains."""
    from motionfmu.study import worker
    from motionfmu.sweep import Outcome, study

    gains = {f"mcc.p_gain[{k}]": {"from": 100, "to": 300, "n": 5} for k in (1, 2)}
    cost = "contour.error.max"
    given = {"axis": gains, "results": [cost], "cost": cost, "sampling": "grid", "stop": 0.5}
    chosen = study(renamed("circle", folder), given)
    rows = [
        worker.Row(i, "ok", "", True, (0.01 + sum((x / 200.0 - 1.0) ** 2 for x in point),))
        for i, point in enumerate(chosen.points)
    ]
    return Outcome(chosen, rows, folder, 0)


def path_causes(folder: Path) -> str:
    from motionfmu.analysis.explain import explain_path
    from motionfmu.report.cause_pages.path_causes_page import write_path_explanation

    found = explain_path(renamed("plt_plate", folder, "card", "drives", "machine"), {})
    return write_path_explanation(found, folder).read_text()


def documentation() -> str:
    """The page of documentation in an FMU."""
    from motionfmu.fmu import documentation, fmu_toml

    folder = ROOT / "fmus/mcc"
    described = fmu_toml.load(folder / "fmu.toml")
    readme, icon = (folder / "README.md").read_text(), documentation.icon_of(folder)
    fragment = documentation.variables(described)
    return documentation.page(described.name, described.description, readme, fragment, icon)


def notebook(*shown: Any) -> str:
    """What a notebook shows of a run, a loop and so on, on a page of nothing else."""
    head = '<!DOCTYPE html><meta charset="utf-8"><meta name="color-scheme" content="light dark">'
    head += '<meta name="viewport" content="width=device-width">'
    return f"{head}<body>{''.join(x._repr_html_() for x in shown)}</body>"


@cache
def made(folder: Path) -> tuple[dict[str, Path], motionfmu.Result]:
    """Pages by kind, and the run that is on the page `contour`; made once in a new folder."""
    from motionfmu.compare.comparison_page import page_text as compare_page
    from motionfmu.report.loop_pages import tune_page
    from motionfmu.report.studies.sweep_page import page_text as sweep_text

    folder.mkdir()
    result = contour_run(folder)
    compared, gains, study = comparison(result, folder), tuned(folder), swept(folder)
    margin_text, loop = margins(folder)
    kinds: dict[str, Callable[[], str]] = {
        "contour": lambda: contour(result),
        "iso9283": lambda: plain(renamed("plt_plate", folder, "card", "drives", "machine"), 2.5),
        "robot": lambda: plain(renamed("robot_pick", folder, "soft", "card"), 0.2),
        "signals": lambda: plain(
            renamed("hydraulic_quadrature", folder, "written", "repaired", "axis"), 0.12
        ),
        "compare": lambda: compare_page(compared),
        "margins": lambda: margin_text,
        "tune": lambda: tune_page.page_text(gains),
        "causes": lambda: causes(folder),
        "path": lambda: path_causes(folder),
        "sweep": lambda: sweep_text(study),
        "gcode": program,
        "machine": lambda: on_a_machine(1.5),
        "plan": plan,
        "documentation": documentation,
        "notebook": lambda: notebook(result, loop, gains, compared, study),
    }
    pages: dict[str, Path] = {}
    for kind, make in kinds.items():
        start = time.process_time()
        pages[kind] = folder / f"{kind}.html"
        pages[kind].write_text(make(), encoding="utf-8")
        print(f"{kind}: {time.process_time() - start:.2f} s")
    return pages, result
