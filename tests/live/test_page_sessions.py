"""A whole session at each machine's page, in one piece; what it leaves has the same bits.

Home, jog by key and by finger, lines by hand, a program with hold and override, a limit switch
and the way out of it by the page's own words, an encoder unplugged with the oscilloscope's trigger
on it, the journal saved with a check.
"""

from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from live_pages import MOVED, position, rests, until
from page_session import COLOURS, Session, session

MACHINES = ROOT / "src/motionfmu/machines"
FASTEST = "as fast as it goes"
SLOW = "0.1 \N{MULTIPLICATION SIGN}"  # what lasts seconds lasts until a slow hand is there
LINE = "#program-lines [aria-current=step]"


@pytest.mark.long
def test_a_session_at_the_mill(browser: Any, tmp_path: Path) -> None:
    """It has all of it; its library believes X to be 150 mm from where it stands."""
    from playwright.sync_api import expect

    channels = [
        *(f"machine.table_position[{k}]" for k in (1, 2, 3)),
        *(f"mcc.position[{k}]" for k in (1, 2, 3)),
        *(f"drives.torque[{k}]" for k in (1, 2, 3)),
        *("drives.alarm[1]", "card.err_count[1]", "card.over_travel", "card.dac[1]"),
        *("mcc.status", "mcc.error", "mcc.path_feed"),
    ]
    more = {
        "program": str(MACHINES / "mill3/example.ngc"),
        "set": {
            "mcc.auto_start": False,
            "machine.start_position": [0.15, 0.02, -0.05, 0.0, 0.0, 0.0],
        },
    }
    with session(browser, tmp_path, "mill3", channels, **more) as at:
        page = at.page
        # By key into the limit switch: nobody has homed, so no software limit is in its way.
        page.get_by_label("Speed of jog").fill("0.2")
        page.locator(".jog-pad").focus()
        page.keyboard.down("ArrowRight")
        at.alarm("X at a limit", "Reset, then jog away from the switch.")
        page.keyboard.up("ArrowRight")
        rests(page, 1)
        # What the words say: reset, and away from it by finger.
        at.click("Reset")
        at.no_alarm()
        there = position(page, 1)
        with at.finger("Jog X minus"):
            until(page, MOVED, [1, there, -1, 25])
        rests(page, 1)
        at.pace(FASTEST)
        at.click("Home")
        at.lamp("Homed")
        at.pace("1 \N{MULTIPLICATION SIGN}")
        at.key("ArrowUp", 2, 1.0)
        rests(page, 2)
        at.mdi("G0 X12.5 Y-3")
        expect(page.locator("#readout tbody td").first).to_have_text("12.500")
        # The program.
        at.pace(SLOW)
        at.click("Cycle start")
        expect(page.locator(LINE)).to_contain_text("G2 I-20 F3000")
        readout = expect(page.locator("#readout"))
        at.hold_and_slow("Feed", lambda: readout.to_contain_text("Feed1500 mm/min"))
        page.get_by_role("button", name="Feed back to where it began").click()
        at.pace(FASTEST)
        at.lamp("Program ended")
        at.pace("1 \N{MULTIPLICATION SIGN}")
        # The encoder.
        at.arm("drives.alarm[1]", "changes")
        at.view("operate")
        at.mdi("G91 G1 X-240 F600")
        until(page, MOVED, [1, 0.0, -1, 1.0])
        box, plug = at.fault("unplugged", "Encoder of the drive unplugged")
        plug.check()
        at.alarm("Servo drives, X: encoder unplugged", "Plug the encoder in again", "home.")
        at.alarm("Following error of X")
        record = at.triggered()
        alarm = record["drives.alarm[1]"]
        assert (alarm[:500] == 0).all() and (alarm[500:] == 4).all()  # a quarter is before it
        assert np.ptp(record["machine.table_position[1]"]) > 1e-4  # it ran out
        at.fault("unplugged", "Encoder of the drive unplugged")
        at.undo(box)
        at.view("operate")
        at.clear_drives()
        at.click("Reset")
        at.no_alarm()
        rests(page, 1)
        at.pace(FASTEST)
        at.click("Home")
        until(page, "() => document.querySelector('#readout tbody td').textContent === '0.000'")
        at.lamp("Homed")
        at.pace("1 \N{MULTIPLICATION SIGN}")
        at.saved("mcc.position[2]")


@pytest.mark.long
def test_a_session_at_the_robot(browser: Any, tmp_path: Path) -> None:
    """An arm with absolute encoders has no search of origins, a pendant no lines by hand.

    Its pendant jogs joints and the tool, teaches and replays. Joints end at the controller's
    limits, which the page tells; the limit switch is an input of the card.
    """
    from playwright.sync_api import expect

    channels = [
        *(f"soft.joint_command[{k}]" for k in range(1, 7)),
        *(f"arm.tool_position[{k}]" for k in (1, 2, 3)),
        *("drives.alarm[6]", "drives.torque[2]", "card.stopped", "card.pulse_count[1]"),
        *("soft.status", "soft.line", "soft.path_feed"),
    ]
    more = {
        "program": str(MACHINES / "robot6/example.job"),
        "set": {"soft.start_delay": 1e6, "card.stop_mask": 1},  # it waits for the start key
    }
    with session(browser, tmp_path, "robot6", channels, **more) as at:
        page = at.page
        # Joints by key, up to the end of their travel and back.
        page.get_by_label("Speed of jog").fill("1")
        page.locator(".jog-pad").focus()
        page.keyboard.down("ArrowRight")
        expect(page.locator(".ends-told")).to_have_text("J1 is at the end of its travel, 180 °")
        page.keyboard.up("ArrowRight")
        rests(page, 1)
        at.key("ArrowLeft", 1, -100.0)
        rests(page, 1)
        expect(page.locator(".ends-told")).to_have_text("")
        # The tool by finger, in the base's frame.
        page.locator("#jog label", has_text="Frame").locator("select").select_option(
            label="base frame"
        )
        page.get_by_label("Speed of jog").fill("0.2")
        before = tool(page)
        with at.finger("Jog Z minus"):
            until(page, TOOL_BELOW, before[2] - 20.0)
        rests(page, 3)
        there = tool(page)
        assert there[2] < before[2] - 20.0
        assert np.hypot(there[0] - before[0], there[1] - before[1]) < 0.5
        page.locator("#jog label", has_text="Frame").locator("select").select_option(label="joints")
        # Two points taught, and gone through again.
        first = position(page, 2)
        at.click("Teach")
        at.key("ArrowDown", 2, -5.0)
        rests(page, 2)
        second = position(page, 2)
        at.click("Teach")
        at.key("ArrowDown", 2, -5.0)
        rests(page, 2)
        far = position(page, 2)
        at.pace(SLOW)  # it turns there in some 40 ms
        at.click("Replay")
        until(page, MOVED, [2, far, 1, first - far - 0.1])  # it has been at the first one
        at.pace("1 \N{MULTIPLICATION SIGN}")
        rests(page, 2)
        assert position(page, 2) == pytest.approx(second, abs=0.01)
        # The program.
        at.pace(SLOW)
        at.click("Start")
        expect(page.locator(LINE)).to_contain_text("MOV")
        at.hold_and_slow("Speed", lambda: at.state("^Running$"))
        at.pace("1 \N{MULTIPLICATION SIGN}")
        # A switch that the card's stop input sees, and out of it.
        box, field = at.fault("digital", "Digital inputs")
        field.fill("1")
        field.press("Enter")
        at.alarm("The card has stopped", "Once it is gone, reset.")
        at.undo(box)
        at.view("operate")
        at.click("Reset")
        at.no_alarm()
        # The encoder of the last joint, at a run of the program.
        at.arm("drives.alarm[6]", "rises through", "0.5")
        at.view("operate")
        at.click("Start")
        expect(page.locator(LINE)).to_contain_text("MOV")
        box, plug = at.fault("unplugged", "Encoder of the drive unplugged", 5)
        plug.check()
        at.alarm("Servo drives, J6: encoder unplugged", "clear the drive's alarm", "reset")
        record = at.triggered()
        alarm = record["drives.alarm[6]"]
        assert alarm[len(alarm) // 4 - 1] == 0 and alarm[len(alarm) // 4] == 4
        assert record["card.stopped"][-1] == 1
        at.fault("unplugged", "Encoder of the drive unplugged")
        at.undo(box)
        at.view("operate")
        at.clear_drives()
        at.alarm("The card has stopped")
        at.click("Reset")
        at.no_alarm()
        page.get_by_role("button", name="Speed back to where it began").click()
        at.click("Start")
        at.pace(FASTEST)
        at.lamp("Program ended")
        at.saved("soft.joint_command[1]")


# [mm] where the readout has the tool's tip.
TOOL = r"""() => [...document.querySelectorAll("#readout dd")].map((d) => d.textContent)
  .find((t) => t.startsWith("X ")).replaceAll("\u2212", "-").match(/-?[\d.]+/g).map(Number)"""
TOOL_BELOW = f"(far) => ({TOOL})()[2] < far"


def tool(page: Any) -> list[float]:
    """Where the tool is [mm]."""
    return page.evaluate(TOOL)


@pytest.mark.more
def test_a_session_at_the_slide(browser: Any, tmp_path: Path) -> None:
    """Two buttons and a target are all that its box has, as the article describes it.

    So nothing is jogged, typed or overridden, and no switch ends the stroke: a target beyond it is
    refused, a button that is pressed in motion stops it, and a push off the way is an alarm.
    """

    channels = [
        *("controller.state", "controller.code", "controller.counter", "controller.track"),
        *("controller.homed", "controller.voltage", "controller.error", "controller.edges"),
        *("axis.table_position", "axis.table_speed", "axis.pressure_a", "axis.pressure_b"),
    ]
    # As the listing is written, one search in some seventeen loses the edge of the home switch.
    repaired = {"set": {"controller.flag_clear": 1}}
    with session(browser, tmp_path, "hydraulic_slide", channels, **repaired) as at:
        page = at.page
        button, go = "Home, stop, clear", "Go to target"
        target = page.get_by_label("Target [counts]", exact=True)
        rests(page, 1)  # a button that is down at power-up is not pressed
        # A motion before it has been homed is refused, in words, and they lead out of it.
        at.click(go)
        at.alarm("Not homed", "Press Home, stop, clear: it homes the slide.")
        at.click(button)
        at.no_alarm()
        at.state("^Search$")
        at.pace("10 \N{MULTIPLICATION SIGN}")
        at.lamp("Homed")
        at.state("^Ready$")
        # To a target, held on the way, and on: so slowly that a slow hand is in time.
        slow, quick = "0.05 \N{MULTIPLICATION SIGN}", "10 \N{MULTIPLICATION SIGN}"
        at.pace(slow)
        target.fill("20000")
        target.press("Enter")
        at.click(go)
        at.state("^Cruise$")
        at.click(button)
        at.state("^Ready$")
        assert position(page, 1) < 19000
        at.click(go)
        at.state("^Accelerate$|^Cruise$")
        at.pace(quick)
        at.state("^Ready$")
        until(page, NEAR, 20000)
        # The emergency stop of this machine is the same button; at rest it moves nothing.
        page.locator("#stop").click()
        rests(page, 1)
        at.state("^Ready$")
        target.fill("1000")
        target.press("Enter")
        at.pace(slow)
        at.click(go)
        at.state("^Cruise$")
        page.locator("#stop").click()
        at.pace(quick)
        at.state("^Ready$")
        assert position(page, 1) > 2000
        # A target beyond the stroke.
        target.fill("40000")
        target.press("Enter")
        at.click(go)
        at.alarm("Target beyond the limits", "set a target within the travel")
        at.click(button)
        at.no_alarm()
        # The scale.
        target.fill("30000")
        target.press("Enter")
        at.arm("controller.code", "changes")
        at.view("operate")
        at.pace("0.2 \N{MULTIPLICATION SIGN}")
        at.click(go)
        at.state("^Cruise$")
        box, plug = at.fault("unplugged", "Scale unplugged")
        plug.check()
        at.alarm("Scale without edges", "plug it in", "twice, to clear and to home.")
        record = at.triggered()
        code = record["controller.code"]
        assert code[len(code) // 4 - 1] == 0 and code[len(code) // 4] == 4
        before = slice(0, len(code) // 4)
        assert np.ptp(record["controller.counter"][before]) == 0  # it stood, the slide did not
        assert np.ptp(record["axis.table_position"][before]) > 1e-3
        at.fault("unplugged", "Scale unplugged")
        at.undo(box)
        at.view("operate")
        at.pace("1 \N{MULTIPLICATION SIGN}")
        at.click(button)
        at.no_alarm()
        at.state("^Unhomed$")
        at.click(button)
        at.state("^Search$")
        at.pace("10 \N{MULTIPLICATION SIGN}")
        at.lamp("Homed")
        at.state("^Ready$")
        # A push off the way.
        at.pace("0.2 \N{MULTIPLICATION SIGN}")
        at.click(go)
        at.state("^Cruise$")
        box, push = at.fault("force", "Force on the table")
        push.fill("-20000")
        push.press("Enter")
        at.alarm("Following error", "look for a load, the pump or an end stop")
        at.undo(box)
        at.view("operate")
        at.click(button)
        at.no_alarm()
        at.saved("controller.counter")


# Whether the first number of the readout is within a few counts of another.
NEAR = r"""(there) => {
  const cell = document.querySelector("#readout tbody td");
  return Math.abs(there - Number(cell.textContent.replace("\u2212", "-"))) < 40;
}"""


@pytest.mark.more
def test_a_session_at_the_card(browser: Any, tmp_path: Path) -> None:
    """A network card takes five commands, and moves by jobs and searches of origins alone.

    Nothing is jogged, typed or overridden at it by its design, and a stepper has no encoder: what
    tells of a lost axis is the drive's alarm. X stands where the job leads into its limit switch.
    """
    from playwright.sync_api import expect

    channels = [
        *("card.state", "card.error", "card.homed", "card.frame", "card.rate", "card.stock"),
        *(f"card.position[{k}]" for k in (1, 2)),
        *(f"machine.table_position[{k}]" for k in (1, 2)),
        *(f"machine.lost_steps[{k}]" for k in (1, 2)),
        *("machine.upper_limit[1]", "machine.home_switch[1]", "card.enable[1]"),
    ]
    more = {
        "program": str(MACHINES / "engraver/example.plt"),
        "set": {"machine.start_position": [0.15, 0.02, 0.0, 0.0, 0.0, 0.0]},
    }
    with session(browser, tmp_path, "engraver", channels, **more) as at:
        page = at.page
        at.state("^Ready$")
        at.click("Start")
        at.alarm("Limit switch", "Reset, then home: the axes leave the switch")
        at.state("^Fault$")
        at.click("Reset")
        at.no_alarm()
        homed(at)
        at.click("Start")
        at.state("^Running$")
        until(page, MOVED, [1, 0.0, 1, 1000])
        at.click("Pause")
        at.state("^Paused$")
        rests(page, 1)
        at.click("Start")
        at.state("^Running$")
        until(page, f"() => ({COLOURS})('#path') > 12")
        at.click("Stop")
        at.state("^Ready$")
        # The emergency stop, for everybody, and out of it.
        at.click("Start")
        at.state("^Running$")
        page.locator("#stop").click()
        at.alarm("emergency stop", "reset, then home")
        page.get_by_role("button", name="Release the stop").click()
        expect(page.locator("#stop")).to_have_text("Emergency stop")
        at.click("Reset")
        at.no_alarm()
        homed(at)
        # The drive of X tells that it has lost its motor.
        at.arm("card.error", "changes")
        at.view("operate")
        at.click("Start")
        at.state("^Running$")
        box, field = at.fault("alarm", "Alarms of the drives")
        field.fill("1")
        field.press("Enter")
        at.alarm("Alarm of a drive", "reset, then home")
        record = at.triggered()
        error = record["card.error"]
        assert error[len(error) // 4 - 1] == 0 and error[len(error) // 4] == 10
        assert np.ptp(record["card.position[1]"][-100:]) == 0
        at.fault("alarm", "Alarms of the drives")
        at.undo(box)
        at.view("operate")
        at.click("Reset")
        at.no_alarm()
        homed(at)
        at.click("Start")
        at.state("^Running$")
        at.pace(FASTEST)
        at.state("^Ready$")
        at.saved("card.state")


def homed(at: Session) -> None:
    """Have the card search its origins, from wherever; what comes next is slow."""
    at.click("Home")
    at.state("^Homing$")
    at.pace(FASTEST)
    at.state("^Ready$")
    assert [position(at.page, k) for k in (1, 2)] == [0, 0]
    at.pace(SLOW)
