"""What is wrong with a study is told at once, each with its line; the command has status 2."""

import re
import sys
from pathlib import Path

import pytest
from conftest import ROOT

import motionfmu
from motionfmu.study import study_axes
from motionfmu.sweep import study

CIRCLE = ROOT / "scenarios/circle_theory"
GAIN = "mcc.p_gain"

TEXT = """# A study.
scenario = "%s"
stop = 0.03
results = ["card.err_count.absmax"]
[axis]
"mcc.p_gain" = { from = 100, to = 200, n = 2 }
"""


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("# A study.", "", r":1: the first line is a comment"),
        ("stop = 0.03", "stop = ", r":3: "),
        ("stop = 0.03", "stopp = 0.03", r":3: unknown key 'stopp'"),
        ("stop = 0.03", "stop = 'x'", r":3: stop = 'x'"),
        ("stop = 0.03", 'sampling = "dice"', r":3: sampling = 'dice'"),
        ("stop = 0.03", 'sampling = "latin"\nruns = 3', r":7: .*n = 2 belongs to a grid"),
        ("stop = 0.03", "runs = 5", r":3: runs: the number of runs of a grid follows"),
        ("stop = 0.03", 'cost = "card.stock.min"', r":3: cost = 'card.stock.min' is none of"),
        ("stop = 0.03", 'tuned = "study.toml"', r"no value \"mcc.p_gain\" = ... for the tuned"),
        ("stop = 0.03", 'tuned = "none.toml"', r":3: tuned = 'none.toml': No such file"),
        ("err_count.absmax", "err_count.absmx", r":4: card.*: SIGNAL.STATISTIC.*mean 'absmax'\?"),
        (
            "card.err_count.absmax",
            "contuor.error.max",
            r":4: .*'contuor'; .*mean 'contour'\?",
        ),
        ("stop = 0.03", "cost = 'card.er_count.absmax'", r":3: .*mean 'card.err_count.absmax'\?"),
        ("err_count.absmax", "err_cont.max", r":4: card.err_cont: .*did you mean 'err_count'"),
        ("err_count.absmax", "err_count.final", r":4: .*final value of which element"),
        ("err_count.absmax", "err_count[7].max", r":4: .*no element 7"),
        ("mcc.p_gain", "mcc.p_gian", r":6: mcc.p_gian: mcc has no variable .*p_gain"),
        ("mcc.p_gain", "card.err_count", r":6: card.err_count is an output and cannot be set"),
        ("mcc.p_gain", "machine.voltage", r":6: machine.voltage is connected"),
        ("mcc.p_gain", "mcc.p_gain[9]", r":6: mcc.p_gain\[9\]: mcc.p_gain has no element 9"),
        ("{ from = 100, to = 200, n = 2 }", "3", r":6: mcc.p_gain = 3: a list"),
        ("to = 200,", "", r":6: mcc.p_gain: to is missing"),
        ("n = 2", "m = 2, n = 2", r":6: mcc.p_gain: unknown key 'm'"),
        ("from =", "form =", r":6: mcc.p_gain: unknown key 'form'; did you mean 'from'\?"),
        ("[axis]", "[axes]", r":5: unknown table \[axes\]; did you mean 'axis'\?"),
        ("stop = 0.03", "set = {'mcc.p_gian' = 3}", r":3: set mcc.p_gian: .*mean 'p_gain'\?"),
        ("stop = 0.03", "set = {'mcc.p_gain' = {a = 3}}", r":3: set.mcc.p_gain = .*: a number, a"),
        ("stop = 0.03", "stop = 0.00015", r":3: stop = 0.00015 s is no whole number of steps"),
        ("stop = 0.03", "step = 0.3e-9", r":3: step = 3e-10 s is not a whole number of ns"),
        (", n = 2", "", r":6: mcc.p_gain = 100 .. 200: a grid wants n"),
        ("to = 200", "to = 50", r":6: mcc.p_gain = 100 .. 50: from is not below to"),
        ("to = 200, n = 2", "to = 101, n = 9", r":6: .*fewer whole numbers than n = 9"),
        ("{ from = 100, to = 200, n = 2 }", "[1.5]", r":6: mcc.p_gain = 1.5: Int32 wanted"),
        ("{ from = 100, to = 200, n = 2 }", "[]", r":6: mcc.p_gain: values = \[\]"),
        ("[axis]", "[other]", r":5: unknown table \[other\]"),
    ],
)
def test_a_wrong_study_is_one_message_with_its_line(
    tmp_path: Path, old: str, new: str, message: str
) -> None:
    file = tmp_path / "study.toml"
    file.write_text((TEXT % CIRCLE).replace(old, new))
    with pytest.raises(motionfmu.InputError, match=message) as caught:
        study(file)
    assert str(file) in str(caught.value) and "\n" not in str(caught.value)


def test_all_that_is_wrong_with_a_study_is_told_at_once(tmp_path: Path) -> None:
    """The lines of what is wrong, in their order; what follows from another error is not told."""
    file = tmp_path / "study.toml"
    file.write_text(
        f"""# A study.
scenario = "{CIRCLE}"
sampling = "dice"
stpo = 0.03
results = ["card.err_cont.max", "mcc.starved.mxa"]
cost = "mcc.starved.mxa"
tuned = "none.toml"
[set]
"machine.tua" = 0.1
[axis]
"mcc.p_gian" = {{ from = 100, to = 200 }}
"machine.tau" = {{ from = 100, to = 50, n = 2 }}
"mcc.irq_latency" = {{ from = 100, ot = 200, nn = 2 }}
"""
    )
    with pytest.raises(motionfmu.InputError) as caught:
        study(file)
    told = [line.removeprefix(f"{file}:") for line in str(caught.value).splitlines()]
    starts = ["3: sampling", "4: unknown key 'stpo'; did you mean 'stop'?", "5: card.err_cont",
              "5: mcc.starved.mxa", "7: tuned", "9: set machine.tua", "11: mcc.p_gian",
              "12: machine.tau = 100 .. 50", "13: mcc.irq_latency: unknown key 'ot'; did you mean",
              "13: mcc.irq_latency: unknown key 'nn'"]  # fmt: skip
    for line, start in zip(told, starts, strict=True):
        assert line.startswith(start), line


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--vary", f"{GAIN}=1:2:x"], r"--vary mcc.p_gain=1:2:x: COMP.VAR=LO:HI:N"),
        (["--vary", f"{GAIN}=1:2"], r"sweep: mcc.p_gain = 1 .. 2: a grid wants n"),
        (["--vary", f"{GAIN}=1,2", "--sampling", "dice"], r"sweep: sampling = 'dice'"),
        (["--vary", f"{GAIN}=1,2", "--set", "mcc.no=1"], r"set mcc.no: mcc has no variable"),
        ([], r"sweep: nothing is varied"),
    ],
)
def test_the_command_refuses_wrong_options_with_status_2(
    arguments: list[str], message: str, tmp_path: Path, monkeypatch, capsys
) -> None:
    from motionfmu import cli

    line = ["motionfmu", "sweep", str(CIRCLE), "--out", str(tmp_path / "o"), *arguments]
    monkeypatch.setattr(sys, "argv", line)
    with pytest.raises(SystemExit) as end:
        cli.main()
    told = capsys.readouterr().err
    assert end.value.code == 2 and re.search(message, told), told
    assert len(told.strip().splitlines()) == 1 and list(tmp_path.iterdir()) == []


@pytest.mark.parametrize(
    ("text", "spec"),
    [
        ("a.b=1:2:3", {"from": 1.0, "to": 2.0, "n": 3, "log": False}),
        ("a.b=1:2", {"from": 1.0, "to": 2.0, "log": False}),
        ("a.b=1e-3:2:log", {"from": 1e-3, "to": 2.0, "log": True}),
        ("a.b=1:2:3:log", {"from": 1.0, "to": 2.0, "n": 3, "log": True}),
        ("a.b=1,2.5,true,x.ngc", [1, 2.5, True, "x.ngc"]),
    ],
)
def test_vary_reads(text: str, spec: object) -> None:
    assert study_axes.option(text) == ("a.b", spec)
