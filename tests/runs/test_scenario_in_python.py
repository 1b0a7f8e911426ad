"""Scenarios made in Python, of tables or by a change of another; scenarios that extend others."""

import inspect
import shutil
from pathlib import Path

import numpy as np
import pytest
from conftest import ROOT
from refusals import refusal
from written_out import WHOLE_CIRCLE, WHOLE_TEXT

import motionfmu
from motionfmu.base.toml_lines import tables_of
from motionfmu.run.session import Session

TABLES = tables_of(WHOLE_TEXT, "")


@pytest.fixture(scope="module")
def base() -> motionfmu.Scenario:
    return motionfmu.load(WHOLE_CIRCLE)


def same(a: motionfmu.Result, b: motionfmu.Result) -> bool:
    return set(a.signals) == set(b.signals) and all(
        x.tobytes() == b.signals[name].tobytes() for name, x in a.signals.items()
    )


def test_tables_run_as_their_file(base: motionfmu.Scenario) -> None:
    made = motionfmu.scenario(TABLES, name="mine", folder=WHOLE_CIRCLE, about="A circle.")
    assert (made.name, made.document.about) == ("mine", "A circle.")
    assert made.document.body == base.document.body
    assert same(made.run(stop=0.2), base.run(stop=0.2))
    assert motionfmu.scenario(WHOLE_CIRCLE).name == "whole_circle"


def test_a_change_is_a_scenario_of_its_own(base: motionfmu.Scenario) -> None:
    before = base.document.tables
    changed = base.changed(
        set={"mcc.p_gain": np.int64(300), "machine.tau": np.full(6, 2e-3)}, name="stiff"
    )
    run = changed.run(stop=0.2)
    assert run.name == "stiff" and run.overrides == ["stop = 0.2 s (scenario: 3 s)"]
    assert run.parameters["mcc.p_gain"] == (300,) * 6
    assert same(run, base.run(stop=0.2, set={"mcc.p_gain": 300, "machine.tau": 2e-3}))
    assert not same(run, base.run(stop=0.2))
    assert base.document.tables == before and base.document.body.set["mcc.p_gain"] == 200


def test_tables_merge_key_by_key(base: motionfmu.Scenario) -> None:
    drive = [{"input": "mcc.hold", "at": [0.05], "value": [True]}]
    changed = base.changed(
        leave=["mcc.hold"], drive=drive, record=["mcc.services"], check={"card.stock": {"max": 9}}
    )
    body, old = changed.document.body, base.document.body
    assert body.leave == old.leave and "mcc.hold" in old.leave  # once
    assert body.record.signals == [*old.record.signals, "mcc.services"]
    assert list(body.check) == [*old.check, "card.stock"]
    assert changed.changed(drive=[]).document.body.drive == []
    held = changed.run(stop=0.2)
    plain = base.run(stop=0.2)
    assert held["mcc.path_feed"][-1] < 0.3 * plain["mcc.path_feed"][-1]
    assert "mcc.services" not in plain.signals and np.ptp(held["mcc.services"]) > 0
    wires = base.changed(connect={"card.enc_phase": None}, leave=["card.enc_phase"])
    assert "card.enc_phase" not in wires.document.body.connect
    faster = base.changed(record={"every": 5}).run(stop=0.2)
    assert same(faster, base.run(stop=0.2, every=5)) and len(faster.time) == 400


def test_what_is_checked_is_recorded(base: motionfmu.Scenario) -> None:
    run = base.changed(check={"mcc.services": {"max": 99}}).run(stop=0.01)
    assert "mcc.services" in run.signals and "mcc.services" not in base.run(stop=0.01).signals


def test_one_element_leaves_the_others(base: motionfmu.Scenario) -> None:
    name = "mcc.p_gain[2]"
    changed = base.changed(set={name: 300})
    assert changed.run(stop=1e-3).parameters["mcc.p_gain"] == (200, 300, *(200,) * 4)
    run = changed.run(stop=1e-3, set={"mcc.p_gain[1]": 100})
    assert run.parameters["mcc.p_gain"] == (100, 300, *(200,) * 4)
    assert changed.run(stop=1e-3, set={"mcc.p_gain": 50}).parameters["mcc.p_gain"] == (50,) * 6
    with Session(base, [name], stop=1e-3, set={"mcc.p_gain[1]": 100}) as session:
        found = session.run({name: 300}).parameters["mcc.p_gain"]
        assert found == (100, 300, *(200,) * 4)
        assert session.run({}).parameters["mcc.p_gain"] == (100, *(200,) * 5)
    assert refusal(base.run, set={"mcc.p_gain[7]": 1}) == [
        "set mcc.p_gain[7]: mcc.p_gain has elements 1 to 6"
    ]


def test_places_of_what_is_wrong(base: motionfmu.Scenario) -> None:
    told = refusal(
        base.changed, set={"mcc.p_gain": -1, "mcc.p_gian": 1}, leave=["mcc.hodl"], name="mine"
    )
    assert [t.partition(": ")[0] for t in told] == [
        "<mine>:[set] mcc.p_gain",
        "<mine>:[set] mcc.p_gian",
    ]
    assert told[1].endswith("did you mean 'p_gain'?")
    assert refusal(base.changed, name="b", leave=["mcc.hodl"]) == [
        "<b>: leave: leave: 'mcc.hodl' matches no input; did you mean 'mcc.hold'?"
    ]
    drive = [{"input": "mcc.hold", "at": [0.1], "valu": [True]}]
    assert refusal(base.changed, drive=drive) == [
        "<whole_circle>:[[drive]] 1 valu: unknown key 'valu'; did you mean 'value'?"
    ]
    # what a change makes wrong in the file is told at its line there
    told = refusal(base.changed, component={"machine": "stepper_axes"}, name="other")
    assert len(told) == 3 and all(t.startswith(f"{WHOLE_CIRCLE}/scenario.toml:") for t in told), (
        told
    )
    lines = [int(t.split(":")[1]) for t in told]
    assert lines == sorted(lines)


def test_options_have_names(base: motionfmu.Scenario) -> None:
    names = list(inspect.signature(base.run).parameters)
    assert names[:6] == ["engine", "fmi", "set", "stop", "step", "every"]
    assert refusal(base.run, stpo=1) == ["run: no option 'stpo'; did you mean 'stop'?"]
    assert refusal(base.run, engine="nativ", fmi=4, stop="1", every=0) == [
        "no engine 'nativ' (there are: fused, native, python, fmpy); did you mean 'native'?",
        "FMI 4: 2 or 3",
        "stop = '1': seconds wanted",
        "every = 0: a whole number from 1 wanted",
    ]


def folder_of(place: Path, name: str, text: str) -> Path:
    folder = place / name
    folder.mkdir()
    (folder / "scenario.toml").write_text(text)
    return folder


def test_a_file_extends_another(tmp_path: Path, base: motionfmu.Scenario) -> None:
    shutil.copytree(WHOLE_CIRCLE, tmp_path / "circle")
    own = (
        '# Stiffer.\nextends = "../circle"\nleave = ["card.io_ldi"]\n\n[set]\n"mcc.p_gain" = 300\n'
    )
    folder = folder_of(tmp_path, "stiff", own)
    stiff = motionfmu.load(folder)
    assert (stiff.name, stiff.document.about) == ("stiff", "Stiffer.")
    assert [f.parent.name for f in stiff.document.files] == ["stiff", "circle"]
    assert set(stiff.document.body.leave) == {*base.document.body.leave, "card.io_ldi"}
    assert same(stiff.run(stop=0.2), base.run(stop=0.2, set={"mcc.p_gain": 300}))
    # a program beside the scenario comes before the one beside what it extends
    (folder / "circle.ngc").write_text("G21 G17 G90\nG1 X1 F600\nM2\n")
    assert stiff.run(stop=0.2)["mcc.path_feed"].max() <= 10.001
    # lines of the file in which a key stands
    (folder / "scenario.toml").write_text(own.replace("p_gain", "p_gian"))
    text = (tmp_path / "circle/scenario.toml").read_text()
    (tmp_path / "circle/scenario.toml").write_text(text.replace('"card.dac"', '"card.dca"', 1))
    number = 1 + next(i for i, x in enumerate(text.splitlines()) if '"card.dac"' in x)
    told = refusal(motionfmu.load, folder)
    assert [t.partition(": ")[0] for t in told] == [
        f"{folder}/scenario.toml:6",
        f"{tmp_path}/circle/scenario.toml:{number}",
    ]


@pytest.mark.parametrize(
    ("files", "what"),
    [
        ({"a": "b", "b": "a"}, "extends goes in a circle: a -> b -> a"),
        ({"a": "a"}, "extends goes in a circle: a -> a"),
        ({"a": "none"}, "extends = '../none': no such scenario"),
        ({chr(97 + i): chr(98 + i) for i in range(9)}, "a scenario extends 7 others at most"),
    ],
)
def test_a_wrong_chain(tmp_path: Path, files: dict[str, str], what: str) -> None:
    for name, wanted in files.items():
        folder_of(tmp_path, name, f'# About.\nextends = "../{wanted}"\n')
    (told,) = refusal(motionfmu.load, tmp_path / "a")
    assert told.endswith(what) and "scenario.toml:2: " in told


def test_a_time_takes_the_place_of_a_signal(base: motionfmu.Scenario) -> None:
    by_signal = base.changed(stop="done", limit=2.5, settle=0.1)
    assert (by_signal.stop_limit, by_signal.document.body.settle) == (2.5, 0.1)
    assert by_signal.changed(stop=1.7).document.body.limit is None
    assert by_signal.changed(settle=None).document.body.limit == 2.5


def test_a_value_of_one_element_is_stronger_than_one_of_all() -> None:
    """In whatever order they are given, and in the scenario's own table, too."""
    scenario = motionfmu.load(ROOT / "scenarios/circle")
    one, whole = {"mcc.p_gain[2]": 300}, {"mcc.p_gain": 250}
    wanted = (250, 300, 250, 250, 250, 250)
    for given in (one | whole, whole | one):
        assert scenario.run(stop=0.01, set=given).parameters["mcc.p_gain"] == wanted
        changed = scenario.changed(set={"mcc.p_gain": None}).changed(set=given)
        assert changed.run(stop=0.01).parameters["mcc.p_gain"] == wanted


def test_a_machine_and_its_tables_written_out_are_the_same_run() -> None:
    """A scenario on a machine is to the bit what it is with every line in its own file."""
    short = motionfmu.load(ROOT / "scenarios/circle_theory").run(stop=0.3)
    whole = motionfmu.load(WHOLE_CIRCLE).run(stop=0.3)
    assert set(short.signals) - set(whole.signals) == {"machine.motor_speed"}  # of its limits
    assert all(x.tobytes() == short[name].tobytes() for name, x in whole.items())
    assert short.parameters["mcc.active"] == whole.parameters["mcc.active"]
