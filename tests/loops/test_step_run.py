"""Answers of loops to a step: of the running FMUs, of their linear model, and by formulas."""

import math

import numpy as np
import pytest

import motionfmu
from motionfmu.analysis.data_sheet.sheet_loops import POSITION, VELOCITY, axis_model, loops
from motionfmu.analysis.freq.loop_study import LoopStudyOptions, study
from motionfmu.analysis.freq.step_run import step_of
from motionfmu.analysis.linear import model
from motionfmu.analysis.linear.closed_step import closed_step, settling_length
from motionfmu.analysis.positioning import step_figures

SPEED = {"machine.table_speed": 0.05}


@pytest.mark.parametrize("gain", [60, 400])
def test_an_integrator_with_p_answers_with_1_over_kp(gain: int) -> None:
    """Rise ln 9 / Kp, settling ln 50 / Kp, within the loop's delay and a count."""
    kp = gain / 64 * (20 / 65536) * 300 * 10000 / 60
    linear = model(motionfmu.machine("first_order").plan(), 1, set={"mcc.p_gain": gain})
    (found,) = loops(linear)
    assert found.kind == POSITION and found.kp == pytest.approx(kp, rel=1e-9)
    for answer in (found.model, found.measured):
        assert answer is not None
        assert answer.rise == pytest.approx(math.log(9.0) / kp, rel=0.02)
        assert answer.settling == pytest.approx(math.log(50.0) / kp, rel=0.05)
        assert answer.overshoot < 0.01
    assert found.time[-1] <= 2.0 * found.step.settling


def test_fmus_and_model_of_a_mill_answer_alike() -> None:
    linear = model(motionfmu.machine("mill3").plan(), 2, SPEED)
    outer, inner = loops(linear)
    assert (outer.kind, inner.kind) == (POSITION, VELOCITY)
    assert outer.kp == pytest.approx(47.68, abs=0.01) and inner.kp is None
    for loop in (outer, inner):
        assert loop.measured is not None
        assert loop.measured.rise == pytest.approx(loop.model.rise, rel=0.02)
        assert loop.measured.overshoot == pytest.approx(loop.model.overshoot, abs=0.01)
        assert loop.measured.settling == pytest.approx(loop.model.settling, rel=0.03)
    # The position answers with 1/Kp, as the velocity loop is ten times as quick.
    assert outer.model.rise == pytest.approx(math.log(9.0) / outer.kp, rel=0.2)
    assert inner.model.overshoot > 0.1


def test_the_step_of_a_drive_that_closes_the_position_loop_is_one_of_its_command() -> None:
    """The loop of the drive's feedback has the velocity loop in it, and is ten times as quick."""
    gantry = motionfmu.machine("gantry").plan()
    linear = axis_model(gantry, 4, SPEED, {})  # Y2, which the controller does not know
    (found,) = loops(linear)
    step = step_of(linear, found.at, (), False)
    assert (step.at, step.command) == ("drives.phase", "drives.pulse_count")
    # a turn of 10,000 pulses is 2500 periods of the encoder's lines
    assert step.gain == pytest.approx(0.25, rel=1e-3)
    assert found.model.rise == pytest.approx(math.log(9.0) / 47.7, rel=0.2)
    assert found.measured is not None
    assert found.measured.rise == pytest.approx(found.model.rise, rel=0.03)
    length = settling_length(linear.loop(found.at), found.margins)
    fed = step_figures(*closed_step(linear.loop(found.at), length))
    assert fed.rise < 0.2 * found.model.rise


def test_added_to_the_feedback_a_step_is_one_of_the_command() -> None:
    """The card's command arises inside: T = L / (1 + L) is the answer to either."""
    linear = model(motionfmu.machine("xy_table").plan(), 1, SPEED)
    outer = study(linear, LoopStudyOptions(loop="card.enc_phase", simulate=False))[0]
    time, answer = step_of(linear, outer.at, outer.cut, False).by_model(0.3)
    again, closed = closed_step(outer.loop, 0.3)
    assert np.allclose(time, again) and np.allclose(answer, closed, atol=1e-9)


def test_margins_are_those_of_the_loop_study() -> None:
    linear = model(motionfmu.machine("mill4").plan(), 4, SPEED)
    wanted = study(linear, LoopStudyOptions(simulate=False))
    found = loops(linear, simulate=False)
    assert [(x.at, x.margins) for x in found] == [(s.at, s.margins) for s in wanted]
    assert all(x.measured is None and x.step == x.model for x in found)
