"""Limits of what is read and run: hostile or absurd input gets one message before anything runs."""

import os
from pathlib import Path

import pytest
from conftest import ROOT
from test_bad_input import message, scenario

import motionfmu
from motionfmu import sweep
from motionfmu.base import toml_lines
from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import SIZE_MAX, tables_of, text_of, word
from motionfmu.run.session import Session
from motionfmu.scenarios import recording
from motionfmu.study import tune

TRACE = '[component]\ntrace = "scope"\n'
OPEN = 'leave = ["trace.*", '


@pytest.mark.parametrize(
    ("text", "what"),
    [
        ("x = " + "[" * 5000, "f:1: brackets more than 16 deep"),
        ("a = 1\nx = " + "{a=" * 17, "f:2: brackets more than 16 deep"),
        (".".join("a" * 20_000) + " = 1", "f:1: a key of more than 16 parts"),
        ("\n\n[" + ".".join("a" * 17) + "]", "f:3: a key of more than 16 parts"),
        ("x = " + "9" * 5000, "f: a whole number has too many digits"),
        (f"y = 1\nx = {2**63}", "f:2: 9223372036854775808: a whole number has 64 bits"),
        ('y = 1\nx = "a\\u0000b"', "f:2: 'a\\x00b': a text has no NUL"),
        ('"a\\nb" = 1', "f:1: 'a\\nb': a key has only characters that can be printed"),
        ("b" * 201 + " = 1", "a key has no more than 200 characters"),
        ("#" * (SIZE_MAX + 1), "f: more than 1048576 characters"),
        ("x = 1979-13-45", "f:1: "),
        ("x =", "f:1: "),
    ],
)
def test_what_no_person_writes_is_one_message(text: str, what: str) -> None:
    with pytest.raises(InputError) as caught:
        tables_of(text, "f")
    assert what in str(caught.value) and "\n" not in str(caught.value)
    assert len(str(caught.value)) < 500


@pytest.mark.parametrize(
    "text",
    [
        "x = " + "[" * 16 + "]" * 16,
        ".".join("a" * 16) + " = 1",
        f"x = {2**63 - 1}\ny = -{2**63}",
        "x = '''\n[[[[[[[[[[[[[[[[[[[[[ a.b.c.d.e.f.g.h.i.j.k.l.m.n.o.p.q.r\n'''",
        'x = "\\"[[[[[[[[[[[[[[[[[[[[[[[" # [[[[[[[[[[[[[[[[[[[[[[[[[[[[[[[',
        'x = """a""""" # five quotes end it\ny = [1.5, 2.5, 3.5]',
        "x = [" + "1.5, " * 1000 + "]",
    ],
)
def test_what_is_within_the_limits_is_read(text: str) -> None:
    assert tables_of(text, "f")


@pytest.mark.parametrize(
    "unit", ['"""\n', "'''\n'", '"\\\\"', "[[a]]\n", "[a.b]\n", "x=", " ", "#", "]", '"', "\\"]
)
def test_the_look_at_brackets_takes_a_pass_over_the_text(unit: str) -> None:
    """No quote is passed over: one that is would be searched for its end again and again."""
    text = '"""' + unit * (20_000 // len(unit))
    assert not set("\"'#[]{}.=,\n") & set(toml_lines._TOKEN.sub("", text))


def test_only_regular_files_are_read(tmp_path: Path) -> None:
    os.mkfifo(tmp_path / "pipe.toml")
    for file in (tmp_path / "pipe.toml", Path("/dev/zero"), tmp_path):
        for reader in (text_of, tune.read, sweep.study):
            if file == tmp_path and reader is sweep.study:
                continue
            with pytest.raises(InputError, match=r"not a regular file|no such scenario"):
                reader(file)
    (tmp_path / "large.toml").write_bytes(b"#" * (SIZE_MAX + 1))
    with pytest.raises(InputError, match=r"large.toml: more than 1048576 bytes"):
        text_of(tmp_path / "large.toml")


@pytest.mark.parametrize(
    ("given", "what"),
    [
        (
            {"sampling": "random", "runs": 20_000_000},
            "20000000 runs of 1 axes; 10000000 are the most",
        ),
        (
            {
                "axis": {f"mcc.p_gain[{i}]": [1, 2, 3] for i in range(1, 7)}
                | {"mcc.irq_latency": {"from": 1e-4, "to": 1e-3, "n": 20_000}}
            },
            "14580000 runs of 7 axes; 7142857 are the most",
        ),
        (
            {
                "sampling": "latin",
                "runs": 4_500_000,
                "axis": {
                    f"{n}[{i}]": [1, 2] for i in range(1, 7) for n in ("mcc.p_gain", "mcc.ppr")
                },
            },
            "4500000 runs of 12 axes; 4166666 are the most",
        ),
    ],
)
def test_a_study_has_no_more_points_than_memory_holds(given: dict, what: str) -> None:
    axis = {"axis": {"mcc.p_gain": [100, 200]}, "results": ["mcc.error.absmax"]}
    with pytest.raises(InputError, match=what):
        sweep.study(ROOT / "scenarios/circle_theory/scenario.toml", axis | given)


def test_a_word_of_the_command_line_is_one_value() -> None:
    assert word("1\ny = 2") == "1\ny = 2" and word("[1, 2]") == [1, 2]
    assert word("[" * 5000) == "[" * 5000


@pytest.mark.parametrize(
    ("old", "new", "what"),
    [
        ("stop = 0.1", "stop = 1e12", "stop = 1000000000000.0 s: 100000 s are the most"),
        ("step = 1e-4", "step = 1e-9", "step = 1e-09 s is no whole number of 25 ns"),
        ("stop = 0.1\nstep = 1e-4", "stop = 1e5\nstep = 1e-4", "1000000000 steps; 100000000 are"),
        ("stop = 0.1", "stop = 1" + "0" * 400, "whole number has 64 bits"),
        ("[component]", "[component]\n" + "".join(f'c{i} = "mcc"\n' for i in range(100)), "64"),
        ("[component]", '[component]\n"a/../b" = "mcc"', "a/../b"),
        ("[component]", '[component]\n_scope1 = "mcc"', "_scope1"),
        ("[component]", '[component]\na = "../fmus/mcc"', "no FMU '../fmus/mcc'"),
        ("[component]", f'[component]\na = "{"m" * 200}"', "no FMU 'mmm"),
        ("[component]", '[component]\na = "mmc"', "(there are: axes_arm, ball_screw_axes, "),
        ("[component]", f'[component]\na = "{"m" * 300}"', "at most 200 characters"),
        ('"circle.ngc"', f'"{"m" * 1024}"', "less than 1024 bytes wanted"),
        ('"circle.ngc"', f'"{"m" * 500}"', "File name too long"),
        ('"circle.ngc"', '"a\\u0000b"', "a text has no NUL"),
        (
            "[record]",
            '[[drive]]\ninput = "mcc.hold"\nat = [1e300]\nvalue = [true]\n[record]',
            "at =",
        ),
    ],
)
def test_a_scenario_beyond_a_limit(tmp_path: Path, old: str, new: str, what: str) -> None:
    folder = scenario(tmp_path)
    file = folder / "scenario.toml"
    text = file.read_text()
    assert old in text
    file.write_text(text.replace(old, new, 1))
    told = message(folder)
    assert told.startswith(f"{file}:") and what in told and len(told) < 2000


def traced(folder: Path, more: str, stop: str = "") -> Path:
    """A scenario with a scope of its own."""
    made = scenario(folder, "[component]\n", TRACE)
    file = made / "scenario.toml"
    text = file.read_text().replace("leave = [", OPEN).replace("[set]\n", f"[set]\n{more}\n")
    file.write_text(text.replace("stop = 0.1", stop or "stop = 0.1"))
    return made


def test_a_recording_is_bounded_before_the_run(tmp_path: Path) -> None:
    """25 ns for 1 s with all channels: 4e7 rows of 64 times 8 and 64 times 4 bytes, 30.7 GB."""
    more = f'"trace.file" = "{tmp_path}/t"\n"trace.period" = 25e-9'
    text = message(traced(tmp_path, more, "stop = 1.0"))
    line = next(
        i
        for i, row in enumerate((tmp_path / "mine/scenario.toml").read_text().split("\n"), 1)
        if row.startswith('"trace.period"')
    )
    told = "40000000 rows of trace make a recording of 30.7 GB; 2 are the most"
    assert text == f"{tmp_path}/mine/scenario.toml:{line}: {told}"


def test_too_many_rows_are_refused_however_narrow(tmp_path: Path) -> None:
    columns = "".join(f'"trace.{n}_used" = 0\n' for n in ("axes_real", "axes_int", "real", "int"))
    more = f'"trace.file" = "{tmp_path}/t"\n"trace.period" = 25e-9\n{columns}'
    text = message(traced(tmp_path, more, "stop = 3.0"))
    assert "trace would record 120000000 rows; 100000000 are the most" in text


def test_what_scopes_hold_in_memory_is_bounded(tmp_path: Path) -> None:
    folder = scenario(tmp_path)
    text = message(folder, "--stop", "100", "--step", "1e-5", "--engine", "native")
    assert "rows of _scope1 make a recording of" in text and "2 are the most" in text


def test_a_study_that_varies_the_period_keeps_the_bound(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    """1000 rows of 768 bytes are within 2 MB, 4000 are not; a bound that is lost costs no more."""
    monkeypatch.setattr(recording, "BYTES_MAX", 2_000_000)
    folder = traced(tmp_path, f'"trace.file" = "{tmp_path}/t"')
    with Session(motionfmu.load(folder), ["trace.period"]) as session:
        session.run({"trace.period": 1e-4})
        with pytest.raises(InputError, match=r"set trace.period: 4000 rows of trace make"):
            session.run({"trace.period": 25e-6})


def test_two_scopes_on_one_file_are_refused(tmp_path: Path) -> None:
    (tmp_path / "b").mkdir()
    more = f'"trace.file" = "{tmp_path}/b/../t"\n"other.file" = "{tmp_path}/t"'
    folder = traced(tmp_path, more)
    file = folder / "scenario.toml"
    text = file.read_text().replace(TRACE, TRACE + 'other = "scope"\n')
    file.write_text(text.replace(OPEN, 'leave = ["trace.*", "other.*", '))
    told = message(folder)
    assert "trace and other would both write" in told or "other and trace would both write" in told
    assert f"{tmp_path}/t" in told and "scenario.toml:" in told


def test_a_component_of_the_demo_may_have_a_scope(tmp_path: Path) -> None:
    folder = traced(tmp_path, f'"trace.file" = "{tmp_path}/t"')
    motionfmu.load(folder).run(stop=0.01)
    assert (tmp_path / "t.real.npy").is_file() and (tmp_path / "t.int.npy").is_file()


def test_the_limits_are_above_what_is_used() -> None:
    for file in ROOT.glob("scenarios/*/*.toml"):
        assert file.stat().st_size < SIZE_MAX / 50
