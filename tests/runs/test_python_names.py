"""What a user types wrong in Python: one message with what may have been meant; short reprs."""

import re
from collections.abc import Callable
from typing import Any

import pytest
from conftest import ROOT

import motionfmu
from motionfmu import sweep
from motionfmu.analysis import gcode, linear
from motionfmu.base.errors import InputError, suggestion
from motionfmu.run import Scenario, Session
from motionfmu.study import tune
from motionfmu.virtual import mcc, robot

CIRCLE = ROOT / "scenarios/circle/circle.ngc"


@pytest.fixture(scope="module")
def theory() -> Scenario:
    return motionfmu.load(ROOT / "scenarios/circle_theory")


@pytest.fixture(scope="module")
def axis(theory: Scenario) -> Any:
    return linear.model(theory)


@pytest.fixture(scope="module")
def card() -> mcc.VirtualCard:
    return mcc.VirtualCard()


@pytest.fixture(scope="module")
def arm() -> robot.VirtualRobot:
    return robot.VirtualRobot()


@pytest.mark.parametrize(
    ("call", "told"),
    [
        (lambda c: mcc.VirtualCard(feeed=20), "no setting 'feeed'; did you mean 'feed'?"),
        (lambda c: mcc.Mcc(p_gian=20), "no setting 'p_gian'; did you mean 'p_gain'?"),
        (lambda c: c.mcc.update_param(rpm=1), "no setting 'rpm'; did you mean 'RPM'?"),
        (lambda c: c.mcc.line(5), "5: 6 values wanted"),
        (lambda c: c.mcc.line("abcdef"), "'a': a number wanted"),
        (lambda c: c.mcc.line_x("1"), "'1': a number wanted"),
        (lambda c: c.mcc.arc_xy([1, 2], 3), "3: 2 values wanted"),
        (lambda c: c.mcc.set_acc_type("TT"), "'TT': one letter wanted"),
        (lambda c: c.mcc.set_acc_type(3), "3: one letter wanted"),
        (lambda c: c.mcc.set_comp(0, 1, 1, 5), "rows (5,): one or two lists of pulses wanted"),
        (lambda c: c.mcc.take(-1), "count = -1: 0 or more wanted"),
        (lambda c: c.mcc.task_start(5), "5: a text wanted"),
        (lambda c: c.run("1"), "'1': a number wanted"),
        (lambda c: c.run_to(1.5), "clock 1.5: a whole number of 25 ns wanted"),
        (lambda c: c.run(2**31), "seconds = 2147483648 s: 0 to 100000 s wanted"),
        (lambda c: c.run_to(2**62), f"clock {2**62}: at most 100000 s beyond 0 s wanted"),
        (lambda c: c.run_until_stop(-1), "limit = -1 s: 0 to 100000 s wanted"),
        (lambda c: c.run_until_stop(100_001), "limit = 100001 s: 0 to 100000 s wanted"),
        (lambda c: c.record(1, 1e-9, "pulses"), "step = 1e-09 s: 25 ns or more wanted"),
        (lambda c: c.record(2**31, 1, "pulses"), "seconds = 2147483648 s: 0 to 100000 s wanted"),
        (lambda c: c.record(1, 1, "pulsess"), "no reading 'pulsess'; did you mean 'pulses'?"),
        (lambda c: c.record(1, "1", "pulses"), "'1': a number wanted"),
        (lambda c: c.set_encoder(6, "a"), "'a': a number wanted"),
        (lambda c: gcode.read(5), "5: a text wanted"),
        (
            lambda c: gcode.read(str(CIRCLE)),
            f"{str(CIRCLE)!r} is the name of a file; Path({str(CIRCLE)!r}) reads it",
        ),
        (lambda c: gcode.read("", jerkk=5), "no setting 'jerkk'; did you mean 'jerk'?"),
        (
            lambda c: tune.problem({"gain": ["a"]}),
            "gain = ['a']: unknown key; did you mean 'gains'?",
        ),
        (lambda c: sweep.Ways(worker=3), "Ways: no option 'worker'; did you mean 'workers'?"),
        (lambda c: motionfmu.load(5), "5: the path of a scenario wanted"),
        (lambda c: linear.margins(3), "3: an open loop wanted, such as model(...).loop(at)"),
    ],
)
def test_a_wrong_word_is_told(card: mcc.VirtualCard, call: Callable, told: str) -> None:
    with pytest.raises(InputError) as caught:
        call(card)
    assert str(caught.value) == told and repr(card.mcc).startswith("<Mcc STOPPED at [0, 0, 0, 0")
    assert card.clock == 0


def test_a_wrong_word_to_the_robot_changes_nothing(arm: robot.VirtualRobot) -> None:
    for call, told in (
        (lambda: arm.jog([1] * 6, speed="x"), "speed = 'x'"),
        (lambda: arm.move_line([1000, 100, 900, 180, 0, 180], fed=3), "did you mean 'feed'"),
        (lambda: arm.set_alarms("x"), "joint = 'x': 0 to 5 is wanted"),
        (lambda: arm.start(5), "5: a text wanted"),
    ):
        with pytest.raises(InputError, match=told):
            call()
    arm.run(0.05)
    assert repr(arm) == "<VirtualRobot at 0.05 s: IDLE at [945, 0, 1175, 180, 0, 180]>"


def test_a_wrong_name_of_a_scenario_is_told(theory: Scenario, axis: Any) -> None:
    with pytest.raises(InputError, match=r"no option 'stopp'; did you mean 'stop'\?"):
        Session(theory, ["mcc.p_gain"], stopp=3)
    with Session(theory, "mcc.p_gain", stop=0.01) as session:
        with pytest.raises(InputError, match=r"mcc.pgain is not varied.*did you mean 'mcc.p_gain'"):
            session.run({"mcc.pgain": 3})
        with pytest.raises(InputError, match=r"no figure 'error.max': contour.error.max and"):
            session.run({"mcc.p_gain": 100}).figure("error.max")
        assert repr(session) == "<Session circle_theory: varies mcc.p_gain>"
    with pytest.raises(InputError, match=r"no input.*; did you mean 'card.enc_phase'\?"):
        axis.loop("card.enc_phas")
    with pytest.raises(InputError, match=r"unknown table \[axi\]; did you mean 'axis'\?"):
        sweep.study(ROOT / "scenarios/circle", {"axi": {}})


def test_what_a_user_looks_at_is_one_line(theory: Scenario, axis: Any) -> None:
    assert len(gcode.read(CIRCLE).commands) > 3
    program = gcode.read("G1 X10 F600\nM2")
    study = sweep.study(ROOT / "scenarios/circle")
    contour = theory.run(stop=1.0).contour()
    for thing in (theory, axis, program, study, contour, mcc.VirtualCard(), robot.Kinematics()):
        assert re.fullmatch(r"<\w+[ :].{10,180}>", repr(thing)), repr(thing)
    assert repr(theory).startswith("<Scenario circle_theory: mcc, epcio, velocity_axes; until 3 s")
    assert "208 runs over mcc.p_gain, drives.velocity_gain" in repr(study)


def test_a_suggestion_does_not_mind_capitals() -> None:
    assert suggestion("CARD.STOCK", ["card.stock", "card.dac"]) == "; did you mean 'card.stock'?"
    assert suggestion("xyz", ["card.stock"]) == ""
