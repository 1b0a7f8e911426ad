"""Wrong input gets one message with file, line and value, status 2, and leaves nothing behind."""

from pathlib import Path

import pytest
from conftest import ROOT
from console import within
from written_out import WHOLE_TEXT

import motionfmu
from motionfmu.run.engines import ENGINES

PROGRAM = "G21 G17 G90\nG1 X5 F3000\nM30\n"


def scenario(folder: Path, old: str = "", new: str = "", program: str = PROGRAM) -> Path:
    """A scenario folder in which `old` stands as `new`."""
    assert old in WHOLE_TEXT
    folder = folder / "mine"
    folder.mkdir()
    text = WHOLE_TEXT.replace(old, new, 1) if old else WHOLE_TEXT
    (folder / "scenario.toml").write_text(text.replace("stop = 3.0", "stop = 0.1"))
    (folder / "circle.ngc").write_text(program)
    return folder


def message(folder: Path, *arguments: str, lines: int = 1) -> str:
    """The one message of the command, which must end with status 2 and write nothing."""
    out = folder.parent / "out" / "result"
    run = within("run", folder, "--out", out, *arguments)
    assert run.returncode == 2, run.stdout + run.stderr
    assert run.stdout == ""
    assert "Traceback" not in run.stderr
    assert run.stderr.startswith("motionfmu: ") and run.stderr.count("\n") == lines, run.stderr
    assert not out.exists() and not list(folder.parent.glob("out/.*"))
    return run.stderr.removeprefix("motionfmu: ").rstrip("\n")


@pytest.mark.parametrize("name", ["part.ngc", "part.NC", "plate.plt", "pick.JBI", "part"])
def test_a_program_in_place_of_a_scenario(tmp_path: Path, name: str) -> None:
    (tmp_path / name).write_text("G21\nG1 X5 F100\nM30\n")
    text = message(tmp_path / name)
    assert text.startswith(f"{tmp_path / name}:")
    assert ("on a machine: --machine NAME" in text) == ("." in name)


def test_files_for_other_commands(tmp_path: Path) -> None:
    for name, words in (
        ("pick.JBI", ("gcode", ": a robot's job: motionfmu job ")),
        ("plate.dxf", ("import", ": an SSP (.ssp) or an arm (.urdf, .xml, .xacro, .toml) wanted")),
    ):
        (tmp_path / name).write_text("NOP\nEND\n")
        done = within(words[0], tmp_path / name, folder=tmp_path)
        assert done.returncode == 2 and done.stdout == ""
        assert done.stderr.startswith(f"motionfmu: {tmp_path / name}{words[1]}")
        assert [f.name for f in tmp_path.iterdir()] == [name]
        (tmp_path / name).unlink()


def test_a_program_that_is_not_there_is_no_scenario(tmp_path: Path) -> None:
    assert message(Path("part.ngc")) == "part.ngc: no such scenario"


@pytest.mark.parametrize(
    ("line", "program", "what"),
    [
        (2, "G21\nG1 X5 Q3 F100\nM30\n", 'word has no use in this line "Q3"'),
        (3, "G21\nG1 X5 F100\nG3 X9 Y9 R1\n", "arc radius is smaller than half the distance"),
        (2, "G21\nG3 X10 Y0 I4 J0 F100\n", "does not lie on the circle"),
        (2, "G21\nG1 G2 X5 F100\n", "second word of one modal group"),
        (2, "G21\nG1 Xabc F100\n", "X"),
        (2, "G21\nG1 X1 X2 F100\n", "X"),
        (1, "G21 G1 X5 F-100\n", "F"),
    ],
)
def test_a_wrong_part_program(tmp_path: Path, line: int, program: str, what: str) -> None:
    folder = scenario(tmp_path, program=program)
    text = message(folder)
    assert f"{folder}/circle.ngc: line {line}: " in text
    assert what in text


@pytest.mark.parametrize(
    ("old", "new", "key", "what"),
    [
        ("stop = 3.0", "stop = 0.0", "stop", "greater than 0"),
        ("stop = 3.0", "stop = 3.00005", "stop", "no whole number of steps"),
        ("step = 1e-4", "step = 1.5e-10", "step", "not a whole number of ns"),
        ("step = 1e-4", 'step = "fast"', "step", "'fast'"),
        ("step = 1e-4", "step = 1e-4\nspeed = 3", "speed", "unknown key 'speed'"),
        ("step = 1e-4", "stpe = 1e-4", "stpe", "unknown key 'stpe'; did you mean 'step'?"),
        ("[record]", "[recrod]", "[recrod]", "unknown table [recrod]; did you mean 'record'?"),
        ("signals = [", "signal = [", "signal", "'signal'; did you mean 'signals'?"),
        ("step = 1e-4", "limit = 2.0\nstep = 1e-4", "limit", "goes with a stop that is a signal"),
        ("stop = 3.0", 'stop = "mcc.done"', "stop", "the longest run, is missing"),
        ("stop = 3.0", 'stop = "dnoe"\nlimit = 1', "stop", "such an output; did you mean 'done'?"),
        ("stop = 3.0", 'stop = "mcc.path_feed"\nlimit = 1', "stop", "Boolean or a whole number"),
        ("stop = 3.0", 'stop = "card.stock"\nlimit = 1', "stop", "which element, card.stock[1]?"),
        ("stop = 3.0", 'stop = "mcc.hold"\nlimit = 1', "stop", "mcc.hold is no output"),
        ("stop = 3.0", 'stop = "done"\nlimit = 1\nfault = "dun"', "fault", "no component has"),
        ("stop = 3.0", 'stop = "done"\nlimit = 1\nfault = "mcc.feed"', "fault", "is no output"),
        ("stop = 3.0", 'stop = 3.0\nfault = "mcc.error"', "fault", "goes with a stop that is a"),
        (
            "stop = 3.0",
            'stop = "done"\nlimit = 1\nsettle = 1e-5',
            "settle",
            "no whole number of steps",
        ),
        ('= "epcio"', '= "epcoi"', "card ", "did you mean 'epcio'?"),
        ('"mcc.p_gain"     = 200', "mcc.p_gain = 200", "mcc.p_gain", 'quotes: "mcc.p_gain"'),
        ('"mcc.p_gain"     = 200', '"mcc.p_gain[7]" = 2', '"mcc.p_gain[7]"', "elements 1 to 6"),
        ('"card.dac"', '"card.dca"', '"machine.voltage"', "did you mean 'dac'?"),
        ('"card.dac"', '"cart.dac"', '"machine.voltage"', "did you mean 'card'?"),
        ('"card.dac"', '"card.dac[1]"', '"machine.voltage"', "Float64[6], card.dac[1] is Float64"),
        ('"card.dac"', '"machine.table_position"', '"machine.voltage"', "units differ"),
        ('"card.dac"', '"card.stock"', '"machine.voltage"', "Int32[6]"),
        ('"card.dac"', '"mcc.p_gain"', '"machine.voltage"', "mcc.p_gain is no output"),
        ('"machine.voltage" =', '"machine.tau" =', '"machine.tau"', "is no input"),
        ('"card.host_*" ', '"card.nothing_*" ', '"card.nothing_*"', "joins nothing"),
        ('= "mcc.card_*"', '= "mcc.card"', '"card.host_*"', "* on both sides"),
        ('"mcc.p_gain"     = 200', '"mcc.p_gain" = nan', '"mcc.p_gain"', "nan"),
        (
            '"mcc.p_gain"     = 200',
            '"mcc.p_gain" = 70000',
            '"mcc.p_gain"',
            "70000: outside 0 .. 65535",
        ),
        ('"mcc.p_gain"     = 200', '"mcc.p_gain" = 2.5', '"mcc.p_gain"', "2.5: Int32 wanted"),
        ('"mcc.p_gain"     = 200', '"mcc.p_gain" = true', '"mcc.p_gain"', "True: Int32 wanted"),
        ('"mcc.p_gain"     = 200', '"mcc.p_gain" = [1, 2]', '"mcc.p_gain"', "6 elements, not 2"),
        ('"mcc.p_gain"     = 200', '"mcc.lead" = "wide"', '"mcc.lead"', "'wide': Float64 wanted"),
        ('"mcc.p_gain"     = 200', '"card.dac" = 1.0', '"card.dac"', "cannot be set"),
        ('"circle.ngc"', '"square.ngc"', '"mcc.program"', "square.ngc"),
        ('"circle.ngc"', '"/"', '"mcc.program"', "'/'"),
        ('"card.dac",', '"card.irq_clock*x",', "signals", "matches no output"),
        ('"card.dac",', '"card.enc_phase",', "signals", "card.enc_phase is no output"),
        ('"mcc.done"    = {', '"mcc.servics" = {', '"mcc.servics"', "did you mean 'services'?"),
        ("{ final = true }", "{ last = true }", '"mcc.done"', "unknown key 'last'"),
        ("radius_change", "radius_chance", '"contour.circles', "did you mean 'radius_change'?"),
    ],
)
def test_a_wrong_scenario(tmp_path: Path, old: str, new: str, key: str, what: str) -> None:
    program = (ROOT / "scenarios/circle_theory/circle.ngc").read_text()
    folder = scenario(tmp_path, old, new, program)
    file = folder / "scenario.toml"
    if "circles" in key:
        file.write_text(file.read_text().replace("stop = 0.1", "stop = 2.0"))
    lines = file.read_text().splitlines()
    number = 1 + next(i for i, row in enumerate(lines) if row.lstrip().startswith(key))
    text = message(folder)
    assert text.startswith(f"{file}:{number}: "), text
    assert what in text


def test_all_that_is_wrong_is_told_at_once(tmp_path: Path) -> None:
    folder = scenario(tmp_path)
    file = folder / "scenario.toml"
    wrong = file.read_text()
    for old, new in (
        ("step = 1e-4", "stpe = 1e-4"),
        ('"card.host_*"', '"cart.host_*"'),
        ('"card.dac"', '"card.dca"'),
        ('"mcc.p_gain" ', '"mcc.p_gian" '),
        ("[record]", '[[drive]]\ninput = "mcc.hold"\nat = [0.01]\nvalue = [1]\n\n[record]'),
        ('"mcc.done", ', '"mcc.doen", '),
        ("{ final = true }", "{ last = true }"),
        ("radius_change", "radius_chance"),
    ):
        assert old in wrong
        wrong = wrong.replace(old, new, 1)
    file.write_text(wrong)
    told = message(folder, lines=8).splitlines()
    words = ("'step'", "joins nothing", "'dac'", "'p_gain'", "Boolean", "'done'", "'last'")
    assert all(w in t for w, t in zip((*words, "'radius_change'"), told, strict=True)), told
    places = [int(t.removeprefix(f"{file}:").partition(":")[0]) for t in told]
    lines = file.read_text().splitlines()
    assert places == sorted(places) and lines[places[0] - 1].startswith("stpe")
    assert "dca" in lines[places[2] - 1] and lines[places[4] - 1].startswith("value")


def test_an_empty_list_is_told_in_words(tmp_path: Path) -> None:
    folder = scenario(tmp_path)
    file = folder / "scenario.toml"
    before, rest = file.read_text().split("signals = [", 1)
    file.write_text(f"{before}signals = []{rest.split(']', 1)[1]}")
    line = 1 + before.count("\n")
    what = 'record.signals = []: the name of an output, or a pattern such as "card.*", wanted'
    assert message(folder) == f"{file}:{line}: {what}"


def test_an_open_input_is_named(tmp_path: Path) -> None:
    text = message(scenario(tmp_path, '"card.enc_phase"  = "machine.motor_phase"\n'))
    assert "input card.enc_phase is open: connect, drive or set it, or name it in leave" in text


@pytest.mark.parametrize(
    ("rows", "what"),
    [
        ('input = "mcc.hold"\nat = [0.05, 0.02]\nvalue = [true, false]', "does not come after"),
        ('input = "mcc.hold"\nat = [0.05]\nvalue = [true, false]', "1 times for 2 values"),
        ('input = "mcc.hold"\nat = [0.00005]\nvalue = [true]', "no whole number of steps"),
        ('input = "mcc.hold"\nat = [0.0]\nvalue = [1]', "Boolean wanted"),
        ('input = "mcc.done"\nat = [0.0]\nvalue = [true]', "is no input"),
        ('input = "card.enc_phase"\nat = [0.0]\nvalue = [1.0]', "is connected and driven"),
    ],
)
def test_a_wrong_stimulus(tmp_path: Path, rows: str, what: str) -> None:
    text = message(scenario(tmp_path, "[record]", f"[[drive]]\n{rows}\n\n[record]"))
    assert "scenario.toml:" in text and what in text


def test_two_sources_for_one_input(tmp_path: Path) -> None:
    more = '"machine.voltage" = "card.dac"\n"machine.*" = "card.*"'
    text = message(scenario(tmp_path, '"machine.voltage" = "card.dac"', more))
    assert "joins nothing" in text or "two sources" in text
    again = '"machine.voltage" = "card.dac"\n"machine.voltage" = "card.dac"'
    (tmp_path / "b").mkdir()
    text = message(scenario(tmp_path / "b", '"machine.voltage" = "card.dac"', again))
    assert "scenario.toml:" in text


@pytest.mark.parametrize(
    ("option", "what"),
    [
        (("--set", "mcc.p_gian=3"), "did you mean 'p_gain'?"),
        (("--set", "mcc.p_gain=nan"), "set mcc.p_gain = nan"),
        (("--set", "mcc.lead=inf"), "set mcc.lead = inf: not a finite number"),
        (("--set", "mcc.p_gain"), "COMP.VAR=VALUE wanted"),
        (("--set", "mcc.program=none.ngc"), "set mcc.program = 'none.ngc'"),
        (("--set", "card.loop_period=1.2e-7"), "set card.loop_period = 1.2e-07"),
        (("--set", "mcc.p_gain[0]=3"), "mcc.p_gain has elements 1 to 6"),
        (("--engine", "steam"), "no engine 'steam' (there are: fused, native, python, fmpy)"),
        (("--fmi", "4"), "FMI 4: 2 or 3"),
        (("--step", "3e-5"), "no whole number of steps"),
    ],
)
def test_a_wrong_option(tmp_path: Path, option: tuple[str, ...], what: str) -> None:
    assert what in message(scenario(tmp_path), *option)


def test_wrong_options_are_told_together(tmp_path: Path) -> None:
    options = ("--engine", "steam", "--set", "mcc.p_gian=3", "--set", "axis.lead=1")
    told = message(scenario(tmp_path), *options, lines=3)
    for line, what in zip(told.splitlines(), ("'steam'", "p_gian", "axis.lead"), strict=True):
        assert what in line


@pytest.mark.parametrize("ends", ["stop = 3.0", 'stop = "mcc.done"\nlimit = 1.0'])
@pytest.mark.parametrize(
    ("option", "told"),
    [
        (("--stop", "0"), "stop = 0.0 s: more than 0 wanted"),
        (("--stop=-1",), "stop = -1.0 s: more than 0 wanted"),
        (("--stop", "1e-10"), "stop = 1e-10 s is not a whole number of ns"),
        (("--stop", "0.00005"), "stop = 5e-05 s is no whole number of steps"),
        (("--stop", "1e9"), "stop = 1000000000.0 s: 100000 s are the most"),
        (("--step", "0"), "step = 0.0 s: more than 0 wanted"),
    ],
)
def test_a_wrong_time_is_named_as_it_was_given(
    tmp_path: Path, ends: str, option: tuple[str, ...], told: str
) -> None:
    """Whatever the scenario itself ends by."""
    assert message(scenario(tmp_path, "stop = 3.0", ends), *option) == told


@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("engine", ENGINES)
def test_every_engine_tells_the_fmus_own_message(tmp_path: Path, engine: str, fmi: int) -> None:
    folder = scenario(tmp_path, program="G21\nG1 X5 Q3 F100\nX6 $\n")
    with pytest.raises(motionfmu.InputError) as caught:
        motionfmu.load(folder).run(engine=engine, fmi=fmi)
    place = f"{folder}/scenario.toml: mcc: {folder}/circle.ngc: line"
    assert str(caught.value).splitlines() == [
        f'{place} 2: word has no use in this line "Q3", column 7',
        f'{place} 3: unexpected character "$", column 4',
    ]


def test_files_that_are_no_scenario(tmp_path: Path) -> None:
    scenario(tmp_path)
    lines = {"empty": 5, "about": 4, "short": 3}
    for name, content, what in (
        ("mien", None, "mien: no such scenario; did you mean 'mine'?"),
        ("empty", "", "empty/scenario.toml:1: the first line is a comment"),
        ("about", "stop = 1.0\nstpe = 2.0", "unknown key 'stpe'; did you mean 'step'?"),
        ("torn", "# about\nstop = \n", "torn/scenario.toml:2: "),
        ("binary", b"\xff\xfe\x00", "not UTF-8 text"),
        ("short", "# about\nstop = 1.0\n", "step is missing"),
    ):
        if content is not None:
            (tmp_path / name).mkdir()
            raw = content if isinstance(content, bytes) else content.encode()
            (tmp_path / name / "scenario.toml").write_bytes(raw)
        assert what in message(tmp_path / name, lines=lines.get(name, 1))


def test_a_foreign_folder_is_never_replaced(tmp_path: Path) -> None:
    folder = scenario(tmp_path)
    (tmp_path / "precious").mkdir()
    (tmp_path / "precious/thesis.txt").write_text("years of work")
    run = within("run", folder, "--out", tmp_path / "precious")
    assert run.returncode == 2
    assert "holds no earlier result" in run.stderr
    assert (tmp_path / "precious/thesis.txt").read_text() == "years of work"
