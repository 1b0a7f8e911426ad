"""What Grbl 1.1's documentation says of its commands, answers and reports, as dialogues."""

from dataclasses import replace

import pytest
from grbl_fake import HOMES, GrblDialogue

from motionfmu.live.grbl.grbl_faults import ERRORS, TRAVEL, fault_text

GREETING = ["", "Grbl 1.1h ['$' for help]"]
LOCKED = [*GREETING, "[MSG:'$H'|'$X' to unlock]"]
ORIGIN = "0.000,0.000,0.000"
FAULTS = {fault_text(k): k for k in range(1, 200) if fault_text(k)}


def begun(**more: object) -> GrblDialogue:
    """A session behind its greeting."""
    return GrblDialogue(**more).begun()  # type: ignore[arg-type]


def test_a_sender_is_greeted_and_finds_it_idle() -> None:
    dialogue = GrblDialogue()
    assert dialogue.look(40).split("\r\n")[:-1] == GREETING
    assert dialogue.say("?") == [f"<Idle|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]
    assert dialogue.say("?") == [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:100,100,100>"]
    assert dialogue.say("?") == [f"<Idle|MPos:{ORIGIN}|FS:0,0>"]


def test_a_machine_that_homes_is_locked_until_it_has() -> None:
    dialogue = GrblDialogue(HOMES)
    assert dialogue.look(40).split("\r\n")[:-1] == LOCKED
    assert dialogue.say("G0X1\n") == ["error:9"]
    assert dialogue.say("$X\n") == ["[MSG:Caution: Unlocked]", "ok"]
    assert dialogue.say("G0X1\n") == ["ok"]


# What is said, and what comes, in one session each.
DIALOGUES: list[list[tuple[str, list[str]]]] = [
    [("$\n", ["[HLP:$$ $# $G $I $N $x=val $Nx=line $J=line $SLP $C $X $H ~ ! ? ctrl-x]", "ok"])],
    [("\n", ["ok"]), ("\r\n", ["ok", "ok"]), ("(a comment)\n", ["ok"]), ("; another\n", ["ok"])],
    [("$G\n", ["[GC:G0 G54 G17 G21 G90 G94 M5 M9 T0 F0 S0]", "ok"])],
    [
        ("g20 g91 g55 f10 s500 m3 m8 t4\n", ["ok"]),
        ("$G\n", ["[GC:G0 G55 G17 G20 G91 G94 M3 M8 T4 F254 S500]", "ok"]),
        ("$13=1\n", ["ok"]),
        ("$G\n", ["[GC:G0 G55 G17 G20 G91 G94 M3 M8 T4 F10.0 S500]", "ok"]),
    ],
    [("$I\n", ["[VER:1.1h.20190825:]", "[OPT:VNM,255,128]", "ok"])],
    [
        ("$I=Mill 3\n", ["ok"]),
        ("$I\n", ["[VER:1.1h.20190825:MILL3]", "[OPT:VNM,255,128]", "ok"]),
    ],
    [
        ("$N\n", ["$N0=", "$N1=", "ok"]),
        ("$N0=G20\n", ["ok"]),
        ("$N1=G55 X\n", ["error:2"]),
        ("$N2=G55\n", ["error:3"]),
        ("$N\n", ["$N0=G20", "$N1=", "ok"]),
        ("\x18", [*GREETING, ">G20:ok"]),
        ("$G\n", ["[GC:G0 G54 G17 G20 G90 G94 M5 M9 T0 F0 S0]", "ok"]),
    ],
    [
        ("$C\n", ["[MSG:Enabled]", "ok"]),
        ("?", [f"<Check|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("G1X10\nG1X10F100\nM30\n", ["error:22", "ok", "[MSG:Pgm End]", "ok"]),
        ("$H\n", ["error:8"]),
        ("$J=X1F1\n", ["error:8"]),
        ("$C\n", ["[MSG:Disabled]", "ok", *GREETING]),
    ],
    [
        ("$SLP\n", ["ok", "[MSG:Sleeping]"]),
        ("?", [f"<Sleep|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("G0X1\n", []),
        ("\x18", LOCKED),
        ("?", [f"<Alarm|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
    ],
    [
        ("G10L2P1X1Y2Z3\n", ["ok"]),
        ("G92X10\n", ["ok"]),
        ("G43.1Z5\n", ["ok"]),
        (
            "$#\n",
            [
                "[G54:1.000,2.000,3.000]",
                *(f"[G{k}:{ORIGIN}]" for k in (55, 56, 57, 58, 59, 28, 30)),
                "[G92:-11.000,0.000,0.000]",
                "[TLO:5.000]",
                f"[PRB:{ORIGIN}:0]",
                "ok",
            ],
        ),
        ("$RST=#\n", ["[MSG:Restoring defaults]", "ok", *GREETING]),
        ("$RST=+\n", ["error:3"]),
    ],
    [
        ("\x84", ["[MSG:Check Door]"]),
        ("?", [f"<Door:0|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("G0X1\n", []),
        ("~", ["ok"]),
    ],
    [
        ("!", []),
        ("?", [f"<Hold:0|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("$$\n", []),
        ("\x18", GREETING),
    ],
    [
        ("\x91\x91\x94?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:119,100,100>"]),
        ("\x96\x9a\x9d?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:119,50,109>"]),
        ("\x90\x97\x99?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:100,25,100>"]),
        ("\x95" + "\x92" * 20 + "\x9b" * 20 + "?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:10,100,10>"]),
        ("\x91" * 30 + "\x9a" * 30 + "?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:200,100,200>"]),
        ("M2\n", ["[MSG:Pgm End]", "ok"]),
        ("?", [f"<Idle|MPos:{ORIGIN}|FS:0,0|Ov:100,100,100>"]),
    ],
    [
        ("$10=3\n", ["ok"]),
        ("?", [f"<Idle|MPos:{ORIGIN}|Bf:255,128|FS:0,0|WCO:{ORIGIN}>"]),
        ("$10=2\n", ["ok"]),
        ("?", [f"<Idle|WPos:{ORIGIN}|Bf:255,128|FS:0,0|WCO:{ORIGIN}>"]),
    ],
    [("G0X1M0\n", []), ("G0X2\n", []), ("~", ["ok", "ok"])],
    [
        ("$N0=M0\n", ["ok"]),
        ("~", []),
        ("\x18", [*GREETING, ">M0:ok"]),
        ("?", [f"<Hold:0|MPos:{ORIGIN}|FS:0,0|WCO:{ORIGIN}>"]),
        ("~G0X1\n", ["ok"]),
    ],
    [("M1\n", ["ok"]), ("N7G0X1\n", ["ok"]), ("/G0X2\n", ["ok"]), ("M7M3\n", ["ok"])],
]


@pytest.mark.parametrize("talk", DIALOGUES, ids=[repr(d[0][0]) for d in DIALOGUES])
def test_dialogue(talk: list[tuple[str, list[str]]]) -> None:
    dialogue = begun()
    for said, answer in talk:
        assert dialogue.say(said) == answer, said


# A line, what came before it, and the number of its error.
WRONG: list[tuple[str, str, int]] = [
    ("10", "", 1),
    ("G1=10", "", 1),
    ("*", "", 1),
    ("G", "", 2),
    ("GX", "", 2),
    ("X-", "", 2),
    ("X.", "", 2),
    ("G1X--5", "", 2),
    ("$Q", "", 2),
    ("$100=", "", 2),
    ("$=1", "", 2),
    ("$5", "", 3),
    ("$G1", "", 3),
    ("$XX", "", 3),
    ("$JX1F1", "", 3),
    ("$SLEEP", "", 3),
    ("$#1", "", 3),
    ("$256=1", "", 3),
    ("$14=1", "", 3),
    ("$100=1001", "", 3),
    ("G1X1F-1", "", 4),
    ("M3S-1", "", 4),
    ("G4P-1", "", 4),
    ("N-1G0X1", "", 4),
    ("$0=-3", "", 4),
    ("$H", "", 5),
    ("$0=2", "", 6),
    ("$20=1", "", 10),
    ("G0" + "X" * 80, "", 11),
    ("$J=G90X251F100", "", 15),
    ("$J=X1F1M3", "", 16),
    ("$J=G2X1F1", "", 35),
    ("$32=1", "", 17),
    ("G5X1", "", 20),
    ("G64", "", 20),
    ("G43H1", "", 20),
    ("G90.1", "", 20),
    ("M6T1", "", 20),
    ("A10", "", 20),
    ("G0G1X1", "", 24),
    ("G17G18", "", 21),
    ("M3M4", "", 21),
    ("G1X1", "", 22),
    ("G1X1", "G93", 22),
    ("$J=X1", "", 22),
    ("G59.1", "", 23),
    ("M3.1", "", 23),
    ("G1G92X0", "", 24),
    ("G1X1X2F1", "", 25),
    ("G2F100", "", 26),
    ("G92", "", 26),
    ("N10000001G0X1", "", 27),
    ("G4", "", 28),
    ("G10X1", "", 28),
    ("G10L2P7X1", "", 29),
    ("G53G2X1Y1I1F1", "", 30),
    ("X1", "G80", 31),
    ("G2Z1I1F100", "", 32),
    ("G38.2X0F100", "", 33),
    ("G2X1Y0I5F100", "", 33),
    ("G2X10Y0R4F100", "", 34),
    ("G2X10Y0F100", "", 35),
    ("G0X1P3", "", 36),
    ("G43.1X1", "", 37),
    ("T256", "", 38),
]


@pytest.mark.parametrize(("line", "before", "number"), WRONG)
def test_a_wrong_line_has_its_number(line: str, before: str, number: int) -> None:
    dialogue = begun()
    if before:
        assert dialogue.say(before + "\n") == ["ok"]
    given = list(dialogue.machine.lines)
    modes = dialogue.say("$G\n")
    assert dialogue.say(line + "\n") == [f"error:{number}"]
    assert dialogue.machine.lines == given
    assert dialogue.say("$G\n") == modes
    assert dialogue.say("G0X1\n") == ["ok"]


@pytest.mark.parametrize("text", sorted({*ERRORS, TRAVEL}))
def test_faults_of_the_library_are_known_by_their_texts(text: str) -> None:
    assert text in FAULTS


def test_what_the_library_refuses_is_an_error_of_its_line() -> None:
    dialogue = begun()
    dialogue.machine.refusals = {
        "G1X2": FAULTS["arc of radius zero"],
        "G1X4": FAULTS["a comment that does nothing here"],
    }
    dialogue.controller.receive(b"G1X0F100G4P0\n" + b"".join(b"G1X%d\n" % k for k in range(1, 6)))
    answers = dialogue.look(60).split("\r\n")[:-1]
    assert answers == ["ok", "ok", "error:34", "ok", "error:20", "ok"]
    assert dialogue.controller.input.lost == 0


def test_modes_of_a_line_that_the_library_refuses_are_given_again() -> None:
    dialogue = begun()
    dialogue.say("G1X0F100\n")
    dialogue.machine.refusals = {"G20G55G1X2": FAULTS["arc of radius zero"]}
    dialogue.controller.receive(b"G4P0\nG20G55G1X2\n")
    assert dialogue.look(60).split("\r\n")[:-1] == ["ok", "error:34"]
    count = len(dialogue.machine.lines)
    assert dialogue.say("X3\n") == ["ok"]
    assert dialogue.machine.lines[count:] == ["G17G20G90G94G55F3.937008", "G1X3"]


def test_a_line_that_leaves_the_limits_is_the_soft_limit_alarm() -> None:
    dialogue = begun()
    dialogue.machine.refusals = {"G1X900F10": FAULTS[TRAVEL]}
    answers = dialogue.say("G1X900F10\nG1X1\n")
    assert answers[-2:] == ["ALARM:2", "[MSG:Reset to continue]"]
    assert dialogue.say("?G0X1\n$X\n") == []
    assert dialogue.say("\x18") == LOCKED
    assert dialogue.say("$X\n") == ["[MSG:Caution: Unlocked]", "ok"]
    assert dialogue.say("G0X1\n") == ["ok"]


@pytest.mark.parametrize(
    ("error", "alarm"), [(62209, 1), (62214, 1), (61698, 3), (61955, 3), (63489, 3)]
)
def test_a_run_time_error_is_an_alarm(error: int, alarm: int) -> None:
    dialogue = begun()
    dialogue.machine.view = replace(dialogue.machine.view, error=error)
    assert dialogue.look(1).split("\r\n")[:2] == [f"ALARM:{alarm}", "[MSG:Reset to continue]"]
    assert dialogue.say("\x18") == LOCKED
    assert dialogue.machine.view.error == 0


def test_a_reset_in_motion_is_an_alarm_and_drops_what_is_not_answered() -> None:
    dialogue = begun(looks=100)
    dialogue.controller.receive(b"G1X10F100\nG4P1\nG1X20\n")
    assert dialogue.look(10) == "ok\r\n"
    assert dialogue.say("?")[0].startswith("<Run|")
    assert dialogue.say("\x18") == ["ALARM:3", *LOCKED]
    assert "abort" in dialogue.machine.pressed
    assert dialogue.say("$X\n") == ["[MSG:Caution: Unlocked]", "ok"]


def test_a_hold_comes_to_rest_and_goes_on() -> None:
    dialogue = begun(looks=20)
    dialogue.controller.receive(b"G1X10F100\nG4P1\n")
    dialogue.look(8)
    dialogue.controller.receive(b"!?")
    first = dialogue.look(1)
    assert "Hold:1" in first, first
    dialogue.look(1)
    assert "Hold:0" in "".join(dialogue.say("?", 1))
    assert dialogue.machine.values["hold"] is True
    assert dialogue.say("~", 60) == ["ok"]
    assert dialogue.say("?")[0].startswith("<Idle|")


def test_jogs_follow_each_other_and_leave_no_trace() -> None:
    dialogue = begun(looks=20)
    assert dialogue.say("G20G91\n") == ["ok"]
    dialogue.controller.receive(b"$J=G21G90X10F600\n$J=X1F100\n?")
    assert "<Jog|" in dialogue.look(2)
    assert dialogue.say("G0X1\n", 4) == ["error:9"]
    jogs = [line for line in dialogue.machine.lines if line.startswith("G53G1G90G21G94X")]
    assert jogs == [
        "G53G1G90G21G94X10.000000F600.000000",
        "G53G1G90G21G94X35.400000F2540.000000",
    ]
    dialogue.look(80)
    assert dialogue.machine.lines[-1] == "G17G20G91G94G54"
    assert "G20 G91" in dialogue.say("$G\n")[0]


@pytest.mark.parametrize("key", ["\x85", "!", "\x84"])
def test_a_jog_is_cancelled(key: str) -> None:
    dialogue = begun(looks=1000)
    dialogue.controller.receive(b"$J=X10F600\n")
    dialogue.look(5)
    dialogue.controller.receive(key.encode("latin-1"))
    dialogue.look(40)
    assert dialogue.machine.pressed[-1] == "abort"
    state = dialogue.say("?")[0]
    assert state.startswith("<Door:0|" if key == "\x84" else "<Idle|")


def test_homing_that_ends_well_unlocks() -> None:
    dialogue = GrblDialogue(HOMES).begun()
    dialogue.machine.homing = lambda view: view
    assert dialogue.say("$H\n") == []
    assert dialogue.say("?")[0].startswith("<Home|")
    dialogue.machine.view = replace(dialogue.machine.view, homed=True, position=(1.0, 2.0, 3.0))
    assert dialogue.look(1) == "ok\r\n"
    assert dialogue.say("?")[0].startswith("<Idle|MPos:1.000,2.000,3.000|")


@pytest.mark.parametrize(("fault", "alarm"), [(1, 9), (2, 8), (3, 9), (4, 9)])
def test_homing_that_fails_is_an_alarm(fault: int, alarm: int) -> None:
    dialogue = GrblDialogue(HOMES).begun()
    dialogue.machine.homing = lambda view: replace(view, error=63232 + 16 * fault + 1)
    assert dialogue.say("$H\n") == [f"ALARM:{alarm}", "ok", *LOCKED]


@pytest.mark.parametrize(("key", "alarm"), [("\x18", 6), ("\x84", 7)])
def test_homing_that_is_stopped_is_an_alarm(key: str, alarm: int) -> None:
    dialogue = GrblDialogue(HOMES).begun()
    dialogue.machine.homing = lambda view: view
    dialogue.say("$H\n")
    told = [t for t in dialogue.say(key) if t != "[MSG:Check Door]"]
    assert told == [f"ALARM:{alarm}", *LOCKED]


def test_a_probe_tells_where_it_has_touched() -> None:
    dialogue = begun()
    dialogue.machine.view = replace(dialogue.machine.view, probed=(0.0, 0.0, -7.25), found=True)
    assert dialogue.say("G38.2Z-10F50\nG0Z0\n") == ["[PRB:0.000,0.000,-7.250:1]", "ok", "ok"]
    assert "[PRB:0.000,0.000,-7.250:1]" in dialogue.say("$#\n")


@pytest.mark.parametrize(("error", "alarm"), [(63361, 4), (63362, 5)])
def test_a_probe_that_fails_is_an_alarm(error: int, alarm: int) -> None:
    dialogue = begun()
    dialogue.controller.receive(b"G38.2Z-10F50\nG0Z0\n")
    dialogue.look(2)
    dialogue.machine.view = replace(dialogue.machine.view, error=error)
    place = [f"[PRB:{ORIGIN}:0]"] if alarm == 5 else []
    assert dialogue.say("") == [f"ALARM:{alarm}", *place, "ok", "error:9"]


def test_lines_of_a_sender_that_does_not_pause_begin_together() -> None:
    dialogue = begun()
    for k in range(5):
        assert dialogue.say(f"G1X{k}F100\n", 2) == ["ok"], "answered, and held back"
    assert "G1X0F100" not in dialogue.machine.lines
    dialogue.look(6)
    assert dialogue.machine.lines[-5:] == [f"G1X{k}F100" for k in range(5)]


def test_a_setting_of_corners_is_the_library_s_tolerance() -> None:
    dialogue = begun()
    assert dialogue.say("$11=0.02\n") == ["ok"]
    assert dialogue.machine.lines[-1] == "G64P0.020000"
    assert "$11=0.020" in dialogue.say("$$\n")
    assert dialogue.say("$RST=$\n")[:2] == ["[MSG:Restoring defaults]", "ok"]
    assert dialogue.machine.lines[-1] == "G61"
    assert "$11=0.000" in dialogue.say("$$\n")


def test_settings_are_the_machine_s() -> None:
    shown = begun().say("$$\n")
    numbers = [*range(7), 10, 11, 12, 13, *range(20, 28), 30, 31, 32]
    numbers += [k + axis for k in (100, 110, 120, 130) for axis in range(3)]
    assert [line.partition("=")[0] for line in shown[:-1]] == [f"${n}" for n in numbers]
    assert {"$100=1000.000", "$110=30000.000", "$120=5000.000", "$130=500.000"} <= set(shown)


def test_the_buffer_has_what_is_behind_the_line_that_is_done() -> None:
    dialogue = begun(looks=100)
    assert dialogue.say("$10=3\n") == ["ok"]
    dialogue.controller.receive(b"G1X9F100\nG4P1\nG0X1\nG0\n(five)\nG1")
    assert dialogue.look(10) == "ok\r\n"
    dialogue.controller.receive(b"?")
    assert f"|Bf:251,{128 - len('G0X1nG0n(five)nG1')}|" in dialogue.look()
    assert dialogue.say("X2\n", 500) == ["ok", "ok", "ok", "ok", "ok"]
    assert "|Bf:255,128|" in dialogue.say("?")[0]


def test_commands_come_behind_the_lines_before_them() -> None:
    dialogue = begun(looks=20)
    modes = "[GC:G0 G54 G17 G20 G90 G94 M5 M9 T0 F0 S0]"
    assert dialogue.say("G20\nG4P1\n$G\n") == ["ok", "ok", modes, "ok"]
    assert dialogue.say("G21M3\n$J=G91X1F100\n") == ["ok", "ok"]


def test_another_hand_bars_all_but_looking() -> None:
    dialogue = begun()
    dialogue.controller.receive(b"G20\nG1X1F100\n")
    dialogue.controller.bar("Ann")
    assert dialogue.look(40).split("\r\n")[:-1] == ["ok", "ok", "[MSG:Ann has the machine in hand]"]
    assert dialogue.machine.lines[-1] == "G1X1F100", "what was answered is done"
    done, count = len(dialogue.machine.lines), dialogue.machine.count
    assert dialogue.say("G1X2\n$J=X1F1\n$X\n$11=1\n$H\n\n") == ["error:9"] * 5 + ["ok"]
    assert dialogue.say("!~\x85\x84\x91\x9e\xa0") == []
    assert dialogue.say("$I\n$G\n")[-1] == "ok"
    assert dialogue.say("?")[0].startswith("<Idle|")
    assert dialogue.say("G1X3\x18") == [*GREETING, "[MSG:Ann has the machine in hand]"]
    assert (len(dialogue.machine.lines), dialogue.machine.count) == (done, count)
    dialogue.machine.mdi("G18")
    dialogue.look(9)
    dialogue.controller.bar("")
    assert dialogue.say("G1X4\n") == ["ok"]
    assert dialogue.machine.lines[-2:] == ["G17G20G90G94G54F100.000000", "G1X4"]
    assert dialogue.say("?")[0].startswith("<Idle|")


def test_a_jog_ends_when_another_takes_the_machine() -> None:
    dialogue = begun(looks=10**6)
    dialogue.say("$J=X100F1000\n")
    dialogue.machine.pressed.clear()
    dialogue.controller.bar("Ann")
    assert dialogue.machine.pressed == ["abort"]
    dialogue.controller.bar("Bob")
    assert dialogue.look(40).split("\r\n")[:-1] == [
        "[MSG:Ann has the machine in hand]",
        "[MSG:Bob has the machine in hand]",
    ]
    assert dialogue.machine.pressed == ["abort"]


def test_who_connects_while_another_has_the_machine_disturbs_nothing() -> None:
    dialogue = GrblDialogue(HOMES, other="Ann")
    told = "[MSG:Ann has the machine in hand]"
    assert dialogue.look(4).split("\r\n")[:-1] == [told, *GREETING, told]
    assert dialogue.machine.count == 0
    dialogue.controller.bar("")
    assert dialogue.say("G0X1\n") == ["error:9"]
    assert dialogue.say("$X\nG0X1\n")[-1] == "ok"
