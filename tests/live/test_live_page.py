"""The page of a live machine in a browser: what an operator does, and what it shows."""

import io
import re
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from browser import PHONE
from browser import tab as browser_tab
from conftest import ROOT
from few_cases import few
from live_pages import DESK, MOVED, position, ready, rests, serving, until
from page_rules import RULES
from page_words import WORDS

import motionfmu

# The program waits for cycle start, so that the axes can be moved by hand.
WAITS = {"mcc.auto_start": False}


@pytest.fixture(scope="module")
def address() -> Iterator[str]:
    with serving(ROOT / "scenarios/circle", set=WAITS) as found:
        yield found


@pytest.fixture
def tab(browser: Any, address: str) -> Iterator[Any]:
    with browser_tab(browser, address, DESK) as page:
        ready(page)
        yield page


@pytest.mark.more
def test_a_key_of_the_keyboard_jogs_while_it_is_down(tab: Any) -> None:
    before = position(tab, 1)
    tab.keyboard.down("ArrowRight")  # the pad has not the focus: nothing may move
    tab.keyboard.up("ArrowRight")
    tab.locator(".jog-pad").focus()
    tab.keyboard.down("ArrowRight")
    until(tab, MOVED, [1, before, 1])
    tab.keyboard.up("ArrowRight")
    rests(tab, 1)
    there = position(tab, 1)
    assert there > before + 0.05
    tab.keyboard.down("ArrowLeft")
    until(tab, MOVED, [1, there, -1])
    tab.keyboard.up("ArrowLeft")
    rests(tab, 1)
    assert position(tab, 1) < there - 0.05


@pytest.mark.more
def test_the_keys_jog_everywhere_only_if_that_is_switched_on(tab: Any) -> None:
    tab.locator("#tab-operate").focus()
    before = position(tab, 2)
    tab.locator("#h-readout").click()
    tab.keyboard.down("ArrowUp")
    tab.keyboard.up("ArrowUp")
    rests(tab, 2)
    assert position(tab, 2) == before
    tab.get_by_role("button", name="Keys jog").click()
    tab.keyboard.down("ArrowUp")
    until(tab, MOVED, [2, before, 1])
    tab.keyboard.up("ArrowUp")
    rests(tab, 2)


@pytest.mark.more
def test_a_finger_jogs_and_a_page_that_loses_the_focus_lets_go(browser: Any, address: str) -> None:
    with browser_tab(browser, address, PHONE) as tab:
        ready(tab)
        for gone in ("pointerup", "pointercancel", "blur"):
            before = position(tab, 1)
            button = tab.get_by_role("button", name="Jog X minus")
            touch = {"pointerId": 7, "pointerType": "touch", "isPrimary": True, "button": 0}
            button.evaluate("b => { b.setPointerCapture = () => {}; }")
            button.dispatch_event("pointerdown", touch)
            until(tab, MOVED, [1, before, -1])
            if gone == "blur":
                tab.evaluate("() => dispatchEvent(new Event('blur'))")
            else:
                button.dispatch_event(gone, touch)
            rests(tab, 1)
            assert "down" not in (button.get_attribute("class") or "")


# A gamepad in the page: its axes and buttons are set by the test, and it can be pulled out.
LOSSES = ("pulled out", "no longer listed", "shoulder", "middle")
GAMEPAD = """() => {
  window.pad = { connected: true, axes: [0, 0, 0, 0], buttons: Array.from({ length: 17 },
    () => ({ pressed: false, value: 0 })) };
  navigator.getGamepads = () => [null, window.pad];
}"""


@pytest.mark.more
@pytest.mark.parametrize("gone", few(LOSSES, 1, pytest.mark.long))
def test_a_gamepad_jogs_while_its_shoulder_is_down_and_its_loss_stops(tab: Any, gone: str) -> None:
    tab.evaluate(GAMEPAD)
    before = position(tab, 2)
    tab.evaluate("() => { pad.axes[1] = -1; }")  # without the shoulder nothing moves
    rests(tab, 2)
    assert position(tab, 2) == before
    tab.evaluate("() => { pad.buttons[4].pressed = true; }")
    until(tab, MOVED, [2, before, 1])
    tab.evaluate(
        {
            "pulled out": "() => { pad.connected = false; }",
            "no longer listed": "() => { pad = null; }",
            "shoulder": "() => { pad.buttons[4].pressed = false; }",
            "middle": "() => { pad.axes[1] = 0.2; }",
        }[gone]
    )
    rests(tab, 2)
    assert position(tab, 2) > before
    assert tab.locator(".jog-pad .down").count() == 0


@pytest.mark.more
def test_a_refused_gamepad_asks_once_and_not_at_every_picture(
    browser: Any, tab: Any, address: str
) -> None:
    from playwright.sync_api import expect

    with browser_tab(browser, address, DESK) as other:
        expect(other.locator("body")).to_have_class("watching")
        sent: list[Any] = []
        other.evaluate(
            """() => { window.asked = 0; const send = WebSocket.prototype.send;
              WebSocket.prototype.send = function (text) {
                asked += text.includes('"do":"jog"') && text.includes('"direction":1');
                send.call(this, text); }; }"""
        )
        other.evaluate(GAMEPAD)
        other.evaluate("() => { pad.buttons[4].pressed = true; pad.axes[0] = 1; }")
        expect(other.locator("#told")).to_contain_text("take it first")
        sent.append(other.evaluate("() => asked"))
        rests(other, 1)
        sent.append(other.evaluate("() => asked"))
        assert 1 <= sent[0] == sent[1]
        other.evaluate("() => { pad.axes[0] = 0; }")


TOOLS = "T1 P1 D6.0 Z50.2\nT3 P2 D10.0 Z-12.5 X1.5\n" + "".join(
    f"T{n} P{n} Z{n}.0\n" for n in range(10, 22)
)


@pytest.mark.more
def test_tools_are_shown_changed_and_turned_over(browser: Any, tmp_path: Path) -> None:
    from playwright.sync_api import expect

    file = tmp_path / "tools.tbl"
    file.write_text(TOOLS)
    given = {**WAITS, "mcc.tool_table": str(file), "mcc.tool_change": "immediate"}
    with (
        serving(ROOT / "scenarios/circle", set=given) as place,
        browser_tab(browser, place, DESK) as tab,
    ):
        ready(tab)
        rows = tab.locator("#tools tbody tr")
        expect(rows).to_have_count(10)
        expect(tab.get_by_label("Diameter of tool 1", exact=True)).to_have_value("6.000")
        expect(tab.get_by_label("X of tool 3", exact=True)).to_have_value("1.500")
        expect(tab.locator("#tools [aria-current]")).to_have_count(0)
        line = tab.get_by_label("Line to run")
        line.fill("T3 M6")
        line.press("Enter")
        expect(tab.locator("#tools [aria-current]")).to_contain_text("T3")
        expect(tab.locator("#tools [aria-current]")).to_contain_text("in the spindle")
        # What is given there counts in the units of the page, whatever the program's are.
        line.fill("G20")
        line.press("Enter")
        expect(tab.locator("#readout")).to_contain_text("G20")
        diameter = tab.get_by_label("Diameter of tool 3", exact=True)
        diameter.fill("8.5")
        diameter.press("Enter")
        tab.get_by_label("X of tool 3", exact=True).fill("-2.54")
        tab.get_by_label("X of tool 3", exact=True).press("Enter")
        tab.locator("#tools h3, #h-tools").first.click()
        expect(tab.locator(".typed li").first).to_contain_text("taken")
        until(tab, SHOWN_TOOL, ["T3", [-2.54, 8.5]])
        touched = tab.get_by_label("Value of a touch-off")
        touched.fill("25.4")
        tab.get_by_role("button", name="Touch off X").click()
        expect(tab.locator("#readout tbody td").first).to_have_text("25.400")
        line.fill("G21")
        line.press("Enter")
        # More of them, and one that the file does not have.
        tab.get_by_role("button", name="Tools behind").click()
        expect(rows).to_have_count(4)
        expect(rows.last).to_contain_text("T21")
        tab.get_by_role("button", name="Tools before").click()
        expect(rows).to_have_count(10)
        tab.get_by_label("Number of a tool").fill("77")
        tab.get_by_role("button", name="Set tool").click()
        expect(tab.locator("#mdi [role=status]")).to_contain_text("Refused")


# Whether the row of a tool has this X and this diameter.
SHOWN_TOOL = """([name, wanted]) => {
  const row = [...document.querySelectorAll("#tools tbody tr")]
    .find((r) => r.textContent.startsWith(name));
  const found = [...row.querySelectorAll("input")].map((i) => Number(i.value));
  return found[0] === wanted[0] && found.at(-1) === wanted[1];
}"""


@pytest.mark.more
@pytest.mark.parametrize("kind", few(["csv", "npz"], 1, pytest.mark.long))
def test_a_record_has_every_step_until_its_end(tab: Any, tmp_path: Path, kind: str) -> None:
    from playwright.sync_api import expect

    file = tmp_path / f"trace.{kind}"
    tab.locator("#tab-scope").click()
    expect(tab.locator("#scope-channels li")).not_to_have_count(0)
    names = tab.locator("#scope-channels b").all_inner_texts()
    tab.locator("#record summary").click()
    end = tab.locator("#record").get_by_role("button", name="End", exact=True)
    expect(end).to_be_disabled()
    tab.get_by_label("File", exact=True).fill(str(file))
    tab.get_by_role("button", name="Record", exact=True).click()
    expect(tab.locator("#record-state")).to_contain_text(f"trace.{kind}")
    until(
        tab,
        """() => / 0\\.[3-9]|, [1-9]/.test(document.querySelector("#record-state").textContent)""",
    )
    end.click()
    expect(tab.locator("#told")).to_contain_text(f"trace.{kind}")
    expect(tab.locator("#record-state")).to_have_text("off")
    if kind == "npz":
        with np.load(file) as record:
            found = {name: record[name] for name in record.files}
    else:
        heads = [head.split(" [")[0] for head in file.read_text().splitlines()[0].split(",")]
        columns = np.loadtxt(file, delimiter=",", skiprows=1, unpack=True)
        found = dict(zip(heads, columns, strict=True))
    assert list(found) == ["time", *names]
    assert len(found["time"]) > 2000
    assert np.allclose(np.diff(found["time"]), 1e-4)
    tab.get_by_role("button", name="Record", exact=True).click()  # it is there
    expect(tab.locator("#told")).to_have_class("told bad")


@pytest.mark.more
def test_lines_by_hand_run_and_wrong_ones_are_refused_in_words(tab: Any) -> None:
    from playwright.sync_api import expect

    line = tab.get_by_label("Line to run")
    line.fill("G90 G1 X3.5 F3000")
    line.press("Enter")
    expect(tab.locator("#readout tbody td").first).to_have_text("3.500")
    line.fill("G1 X4 Q")
    line.press("Enter")
    said = tab.locator("#mdi [role=status]")
    expect(said).to_contain_text("Refused: Number expected after")
    assert position(tab, 1) == 3.5
    line.press("ArrowUp")
    assert line.input_value() == "G1 X4 Q"
    line.press("ArrowUp")
    assert line.input_value() == "G90 G1 X3.5 F3000"
    line.press("ArrowDown")
    line.press("ArrowDown")
    assert line.input_value() == ""


def test_the_program_is_started_held_and_overridden(tab: Any) -> None:
    from playwright.sync_api import expect

    dial = tab.get_by_label("Feed", exact=True)
    dial.fill("0.5")
    tab.get_by_role("button", name="Cycle start").click()
    current = tab.locator("#program-lines [aria-current=step]")
    expect(current).to_contain_text("N40 G3")
    expect(tab.locator("#readout")).to_contain_text("3000 mm/min")
    hold = tab.get_by_role("button", name="Hold")
    hold.click()
    expect(hold).to_have_attribute("aria-pressed", "true")
    expect(tab.locator("#state")).to_have_text("Hold")
    expect(tab.locator("#readout")).to_contain_text("Feed0 mm/min")
    hold.click()
    tab.get_by_role("button", name="Feed back to where it began").click()
    expect(tab.locator("#readout")).to_contain_text("6000 mm/min")
    expect(tab.locator(".facts")).to_contain_text("Feed")
    tab.get_by_role("button", name="Abort").click()
    expect(tab.locator("#readout")).to_contain_text("Feed0 mm/min")


@pytest.mark.more
def test_an_alarm_says_what_to_do_and_the_emergency_stop_is_released(tab: Any) -> None:
    from playwright.sync_api import expect

    tab.locator("#stop").click()
    alarm = tab.get_by_role("alert")
    expect(alarm).to_contain_text("Emergency stop")
    expect(alarm).to_contain_text("Release the emergency stop, then reset.")
    expect(tab.locator("#state")).to_have_attribute("data-kind", "alarm")
    tab.get_by_role("button", name="Release the stop").click()
    expect(tab.locator("#stop")).to_have_text("Emergency stop")
    tab.get_by_role("button", name="Reset", exact=True).click()
    expect(alarm).to_be_hidden()


@pytest.mark.more
def test_a_fault_is_set_shown_as_changed_and_undone(tab: Any) -> None:
    from playwright.sync_api import expect

    tab.locator("#tab-values").click()
    first = tab.locator("#values section").first
    expect(first.locator("h2")).to_have_text("Faults")
    tab.locator("#values-search").fill("unplugged")
    box = tab.locator(".value", has_text="Encoder unplugged")
    plug = box.get_by_role("switch").first
    plug.check()
    expect(box).to_have_class(re.compile("changed"))
    expect(box.locator(".was")).to_have_text("began as off")
    box.get_by_role("button", name="Undo").click()
    expect(box).not_to_have_class(re.compile("changed"))
    expect(plug).not_to_be_checked()
    tab.locator("#values-search").fill("force")
    force = tab.locator(".value", has_text="Force on the tables").get_by_role("spinbutton").first
    force.fill("12.5")
    force.press("Enter")
    undo = tab.get_by_role("button", name="Undo Force on the tables")
    undo.click()
    expect(undo).to_be_hidden()
    expect(force).to_have_value("0")


@pytest.mark.more
def test_a_trigger_catches_the_edge_and_its_record_is_a_file(tab: Any) -> None:
    from playwright.sync_api import expect

    tab.locator("#tab-scope").click()
    expect(tab.locator("#scope-channels li")).to_have_count(4)
    search = tab.get_by_role("combobox", name="Add a signal")
    search.fill("mcc path_feed")
    search.press("Enter")
    expect(tab.locator("#scope-channels li")).to_have_count(5)
    tab.locator("#trigger summary").click()
    tab.locator("#trigger-channel").select_option("mcc.path_feed")
    tab.locator("#trigger-level").fill("1")
    tab.locator("#trigger-length").select_option("0.2")
    tab.get_by_role("button", name="Arm").click()
    expect(tab.locator("#trigger-state")).to_contain_text(
        "waits until mcc.path_feed rises through 1"
    )
    tab.locator("#tab-operate").click()
    line = tab.get_by_label("Line to run")
    line.fill("G91 G1 X1 F3000")
    line.press("Enter")
    tab.locator("#tab-scope").click()
    expect(tab.locator("#trigger-state")).to_contain_text("triggered at")
    expect(tab.locator("#scope-run")).to_have_text("Run")
    with tab.expect_download() as got:
        tab.get_by_role("button", name="NumPy").click()
    record = np.load(io.BytesIO(Path(got.value.path()).read_bytes()))
    feed = record["mcc.path_feed"]
    assert len(feed) == len(record["time"]) == 2000
    assert feed[499] < 1 <= feed[500]  # a quarter is before it
    assert np.allclose(np.diff(record["time"]), 1e-4)
    with tab.expect_download() as got:
        tab.get_by_role("button", name="CSV").click()
    head, *rows = Path(got.value.path()).read_text().splitlines()
    assert head.split(",") == list(record.files)
    assert [float(r.split(",")[5]) for r in rows] == feed.tolist()
    tab.get_by_role("button", name="Run", exact=True).click()
    tab.get_by_role("button", name="Remove mcc.path_feed").click()
    expect(tab.locator("#scope-channels li")).to_have_count(4)


@pytest.mark.more
@pytest.mark.parametrize("show", few(["field", "fft", "xy"], 1, pytest.mark.long))
def test_every_picture_of_the_oscilloscope_has_ink_of_its_channels(tab: Any, show: str) -> None:
    tab.locator("#tab-scope").click()
    tab.locator("#scope-show").select_option(show)
    ink = """() => {
      const c = document.querySelector("#scope");
      const { data } = c.getContext("2d").getImageData(0, 0, c.width, c.height);
      const colours = [...document.querySelectorAll(".swatch")]
        .map((b) => b.style.getPropertyValue("--c").match(/\\w\\w/g).map((h) => parseInt(h, 16)));
      return colours.filter(([r, g, b]) => { for (let k = 0; k < data.length; k += 4) {
        if (Math.abs(data[k] - r) + Math.abs(data[k + 1] - g) + Math.abs(data[k + 2] - b) < 12
          && data[k + 3] > 120) return true; } return false; }).length >= 2;
    }"""
    line_of(tab, "G91 G1 X20 Y10 F150")  # for as long as a slow page needs
    until(tab, ink)


def line_of(tab: Any, line: str) -> None:
    """Type a line, whatever view is open."""
    view = tab.locator("[role=tab][aria-selected=true]")
    own = view.get_attribute("id")
    tab.locator("#tab-operate").click()
    field = tab.get_by_label("Line to run")
    field.fill(line)
    field.press("Enter")
    tab.locator(f"#{own}").click()


@pytest.mark.more
def test_what_was_done_is_saved_and_its_run_has_the_same_end(browser: Any, tmp_path: Path) -> None:
    from playwright.sync_api import expect

    with (
        serving(ROOT / "scenarios/circle", set=WAITS) as place,
        browser_tab(browser, place, DESK) as tab,
    ):
        ready(tab)
        line_of(tab, "G1 X2 F3000")
        expect(tab.locator("#readout tbody td").first).to_have_text("2.000")
        tab.locator("#tab-journal").click()
        expect(tab.locator("#journal")).to_contain_text("mcc.mdi_seq")
        tab.get_by_role("button", name="Pause").click()
        expect(tab.locator("#run")).to_have_text("Run")
        tab.locator("#checks-search").fill("table_position[1]")
        row = tab.locator("#checks .check", has_text="machine.table_position[1]")
        row.get_by_role("checkbox").check()
        row.get_by_role("spinbutton").fill("5e-6")
        tab.get_by_label("Folder").fill(str(tmp_path / "by_hand"))
        tab.get_by_role("button", name="Save", exact=True).click()
        expect(tab.locator("#told")).to_contain_text("Saved")
        tab.get_by_label("Folder").press("Enter")  # once more: it is there
        expect(tab.locator("#told")).to_have_class("told bad")
    result = motionfmu.load(tmp_path / "by_hand").run()
    assert result.ok
    names = {v.name for v in result.checks}
    assert any("machine.table_position[1]" in n for n in names) and len(result.checks) >= 3


@pytest.mark.more
def test_one_goes_back_to_a_state_and_on_from_there(browser: Any) -> None:
    from playwright.sync_api import expect

    with (
        serving(ROOT / "scenarios/circle", set=WAITS, pace=None) as place,
        browser_tab(browser, place, DESK) as tab,
    ):
        ready(tab)
        until(tab, '() => document.querySelector("#time").textContent > "00:03"')
        tab.locator("#tab-journal").click()
        back = tab.get_by_label("Time to go back to")
        back.evaluate("b => { b.value = 1.5; b.dispatchEvent(new Event('input')); }")
        tab.get_by_role("button", name="Go back").click()
        expect(tab.locator("#time")).to_have_text(re.compile(r"00:01\.0"))
        expect(tab.locator("#run")).to_have_text("Run")
        tab.get_by_role("button", name="Step", exact=True).click()
        tab.locator("#run").click()
        until(tab, '() => document.querySelector("#time").textContent > "00:02"')


@pytest.mark.more
def test_a_second_page_watches_and_acts_when_it_has_taken_the_hand(
    browser: Any, tab: Any, address: str
) -> None:
    from playwright.sync_api import expect

    with browser_tab(browser, address, DESK) as other:
        expect(other.locator("#hand")).to_contain_text("in hand")
        expect(other.locator("body")).to_have_class("watching")
        expect(tab.locator("#hand")).to_contain_text("1 more page watches")
        rests(other, 2)  # what was done before has come to an end
        before = position(other, 2)
        other.locator(".jog-pad").focus()
        other.keyboard.down("ArrowUp")
        expect(other.locator("#told")).to_contain_text("take it first")
        other.keyboard.up("ArrowUp")
        rests(other, 2)
        assert position(other, 2) == before
        other.get_by_role("button", name="Take it").click()
        expect(other.locator("#hand")).to_contain_text("in your hand")
        expect(tab.locator("body")).to_have_class("watching")
        other.locator(".jog-pad").focus()
        other.keyboard.down("ArrowUp")
        until(other, MOVED, [2, before, 1])
        other.keyboard.up("ArrowUp")
        rests(other, 2)


@pytest.mark.more
@pytest.mark.parametrize("theme", few(["light", "dark"], 1, pytest.mark.long))
@pytest.mark.parametrize("size", few([DESK, PHONE], 1), ids=["desk", "phone"])
def test_everyone_can_read_and_reach_every_view(
    browser: Any, address: str, size: dict[str, int], theme: Any
) -> None:
    with browser_tab(browser, address, size) as tab:
        tab.emulate_media(color_scheme=theme)
        ready(tab)
        for view in ("operate", "scope", "values", "journal"):
            tab.locator(f"#tab-{view}").click()
            until(tab, f"() => ({RULES})().words > 30")  # it is filled
            assert tab.locator("html").evaluate("e => e.scrollWidth") == size["width"], view
            wrong = [w for w in tab.evaluate(WORDS) if "Emergency stop" not in w]
            assert wrong == [], view
            found = tab.evaluate(RULES)
            assert {rule: bad for rule, bad in found["wrong"].items() if bad} == {}, view
        stop = tab.locator("#stop").bounding_box()
        assert 0 <= stop["y"] and stop["y"] + stop["height"] <= size["height"]


ROWS = {"robot6": 6, "hydraulic_slide": 1, "engraver": 2}


@pytest.mark.parametrize("name", few(list(ROWS), ["engraver"]))
def test_other_machines_have_their_page(browser: Any, name: str) -> None:
    from playwright.sync_api import expect

    with (
        serving(name) as place,
        browser_tab(browser, place, DESK) as tab,
    ):
        expect(tab.locator("#name")).to_have_text(name)
        expect(tab.locator("#readout tbody tr")).to_have_count(ROWS[name])
        expect(tab.locator("#keys button").first).to_be_visible()
        assert tab.evaluate(WORDS) == []
