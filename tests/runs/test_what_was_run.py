"""The report says what was run: overrides, times, ways, feeds, gains; so does result.json."""

import json
import math
import re
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from page_curves import curve, page_data

import motionfmu
from motionfmu.report import result_folder
from motionfmu.report.signal_words import of_check, sentence, titled
from motionfmu.run.checks import Verdict


@pytest.fixture(scope="module")
def circle(tmp_path_factory: pytest.TempPathFactory):
    folder = tmp_path_factory.mktemp("ran") / "circle"
    result = motionfmu.load(ROOT / "scenarios/circle").run(set={"mcc.p_gain": 300})
    page = result_folder.save(result, folder)
    return (
        result,
        page.read_text(),
        page_data(page),
        json.loads((folder / "result.json").read_text()),
    )


def words(page: str, name: str) -> str:
    found = re.search(rf"<th>{name}</th><td>(.*?)</td>", page)
    assert found, name
    return found[1]


def speeds(data) -> list[tuple[np.ndarray, np.ndarray]]:
    figure = next(f for f in data["figures"] if f["id"] == "speed")
    return [curve(data, trace) for trace in figure["data"]]


def test_the_page_says_what_was_run(circle) -> None:
    result, page, _, numbers = circle
    assert words(page, "Overrides") == "mcc.p_gain = 300 (scenario: 200)"
    assert words(page, "Engine") == "fused, FMI 3, communication step 0.1 ms"
    assert words(page, "Ended by") == "stop = 8 s" == numbers["stopped"]
    assert words(page, "Position gains") == "mcc.p_gain[1,2] = 300 (Kp 71.5 1/s)"
    assert numbers["position_gains"][1]["kp"] == pytest.approx(300 / 200 * 47.683716)
    assert numbers["overrides"] == ["mcc.p_gain = 300 (scenario: 200)"]
    assert words(page, "Program done") == f"at {result.done_at:.3f} s"
    # two turns of R 50 and a rapid of 50 mm there and back; the tool cuts 19 um off the radius
    assert "programmed 628.3 mm of cutting, 100 mm of rapids" in words(page, "Way of the tool")
    assert numbers["distance"] == pytest.approx(200.0 * np.pi + 100.0, abs=0.4)
    # 0.1 s to the feed and from it: a move takes way/feed + 0.1 s, or 2 sqrt(way 0.1 s/feed)
    moves = 2.0 * (100.0 * np.pi / 100.0 + 0.1) + 2.0 * 2.0 * np.sqrt(50.0 * 0.1 / 500.0)
    dwell = numbers["cycle_time"] - moves
    assert words(page, "Cycle time").startswith(f"{numbers['cycle_time']:.3f} s")
    assert 0.59 < dwell < 0.62  # G4 P0.2 thrice, and what the card's stock takes


def test_the_feed_stands_beside_the_programmed(circle) -> None:
    result, _, data, _ = circle
    (time, programmed), (_, planned), (_, tool) = speeds(data)
    within = (time > 1.0) & (time < 3.0)
    assert (programmed[within] == 6000.0).all()
    assert planned[within] == pytest.approx(6000.0, abs=1e-6 * 6000.0)
    # V |H|: as much slower as the radius is smaller
    change = result.contour().circles[0].ccw.reading.radius_change
    assert tool[within].mean() == pytest.approx(6000.0 * (1.0 + change / 50.0), rel=1e-4)
    assert abs(tool[within].mean() - 6000.0) > 0.5
    assert set(programmed[np.isfinite(programmed)]) == {6000.0, 30000.0}
    assert np.isnan(programmed[time > result.done_at]).all() and (time > result.done_at).any()
    way = float(np.sum(planned[:-1] * np.diff(time)) / 60.0)
    assert way == pytest.approx(200.0 * np.pi + 100.0, rel=2e-3)


def test_the_circle_the_other_way_round_is_no_corner(circle) -> None:
    result, page, _, _ = circle
    assert result.contour().corners == () and "<h2>Corners" not in page
    assert "<h3>Worst lines</h3>" in page
    assert 'class="two"><div><h2>' not in page  # nor half a page left empty
    # in words beside the name, with its unit
    cells = r'<div class="sub">(.*?)</div>.*?<td class="n">.*?<td class="n">(.*?)<'
    row = re.search(rf"contour\.error\.max{cells}", page)
    assert row and row[1] == "Contour error, largest" and row[2].endswith(" µm")
    assert "<h2>Torque command to the current loop (drives.torque)</h2>" in page


def test_notes_of_figures_are_the_scenarios_where_something_is_overridden(tmp_path: Path) -> None:
    scenario = motionfmu.load(ROOT / "scenarios/fifo_one")
    mark = "Note of the scenario as written: The PC answers one clock"
    result = scenario.run(set={"mcc.irq_latency": 5e-4}, stop=0.3008)
    page = result_folder.save(result, tmp_path / "changed").read_text()
    assert mark in page
    assert words(page, "Overrides").count("<br>") == 1
    assert "stop = 0.3008 s (scenario: 0.6 s)" in words(page, "Overrides")
    assert words(page, "Program done") == "not within the run"
    assert "Cycle time" not in page and "Position gains" not in page
    # 50 mm/s by the pulses alone
    time, tool = speeds(page_data(tmp_path / "changed/report.html"))[-1]
    assert tool[(time > 0.15) & (time < 0.29)] == pytest.approx(50.0, rel=5e-3)
    written = result_folder.save(scenario.run(), tmp_path / "written").read_text()
    assert mark not in written and "The PC answers one clock" in written
    assert words(written, "Overrides") == "none: as written"


def test_a_list_of_values_is_no_title_but_stands_beside_its_check() -> None:
    doc = "0 none, 1 following error, 2 overspeed; held until alarm_reset"
    assert titled("drives.alarm", doc) == "drives.alarm"
    assert (
        titled("card.dac", "DAC voltage of the axes, held") == "DAC voltage of the axes (card.dac)"
    )
    assert sentence(doc) == "0 none, 1 following error, 2 overspeed"


@pytest.mark.parametrize(
    ("name", "bounds", "value", "told"),
    [
        ("mcc.error", "|.| <= 0", 62209.0, "Run-time error: axis 1 at a limit"),
        ("drives.alarm[2]", "final = 0", 4.0, "Alarm of the drive: encoder unplugged"),
        ("mcc.status", "max in 0 .. 1", 1.0, "What the library does: stopped (no stock)"),
        ("mcc.error", "|.| <= 0", 7.0, "Run-time error"),
        ("mcc.error", "<= 0", math.nan, "Run-time error"),
        ("mcc.error", "changes = 0", 0.0, "Run-time error"),
        ("mcc.status", "order 2, 0, 1 to 3 s", 2.0, "What the library does: hold, running"),
    ],
)
def test_a_number_that_is_checked_has_its_meaning_beside_it(
    name: str, bounds: str, value: float, told: str
) -> None:
    plan = motionfmu.machine("mill3").plan()
    assert of_check(plan.resolver, Verdict(name, bounds, value, True)) == (told, "")
