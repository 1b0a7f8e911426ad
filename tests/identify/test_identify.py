"""What is identified from runs of the FMUs, whose parameters are known."""

import re
from dataclasses import replace

import numpy as np
import pytest
from axis_truth import COLUMNS, PERIOD, drawn, moves, simulated

from motionfmu import InputError
from motionfmu.identify import AxisRecord, ColumnUse, IdentifyOptions, identify, run_of_record
from motionfmu.identify.ground import ground
from motionfmu.identify.loop_motion import LoopMotion
from motionfmu.identify.shooting import Guess
from motionfmu.identify.tellable import start_values

NOISE = 0.01  # of the torque, as a share of its RMS
BASE = ["table_mass", "table_coulomb", "table_viscous", "force"]


def record_of(seed: int, stop: float):
    truth, rng, (speed, acceleration) = drawn(seed)
    return truth, simulated(truth, moves(rng, stop, speed, acceleration), rng, NOISE)


def hold(truth, found):
    """Every quantity that is told, within three deviations and 5 % of what is true."""
    told = [p for p in found.parameters if p.told]
    wrong = []
    for p in told:
        away = abs(p.value - truth.values[p.name])
        if away > 3.0 * p.deviation or away > 0.05 * abs(truth.values[p.name]) + p.deviation:
            wrong.append((p.name, p.value, p.deviation, truth.values[p.name]))
    return told, wrong


@pytest.mark.parametrize(
    "seed", [pytest.param(k, marks=[] if k == 1 else pytest.mark.more) for k in range(5)]
)
def test_known_machine_is_found(seed):
    truth, record = record_of(seed, 3.0)
    found = identify(truth.scenario(), record, IdentifyOptions(COLUMNS))
    told, wrong = hold(truth, found)
    assert not wrong
    assert {"machine.table_mass", "machine.table_coulomb", "machine.table_viscous"} <= {
        p.name for p in told
    }
    curve = found.curve  # the friction of the record, and that of the law, over speed
    assert len(curve.speed) > 10 and curve.speed[0] < 0.0 < curve.speed[-1]
    size = np.abs(curve.law).max()
    assert np.abs(curve.drive - curve.law).max() < 0.1 * size and np.ptp(curve.law) > 0.5 * size


@pytest.mark.parametrize("speed", [0.0, 0.05])
def test_a_record_at_rest_or_at_one_speed_tells_nothing(speed):
    truth, rng, _ = drawn(1)
    truth = replace(truth, values=truth.values | {"machine.force": 0.0})  # else it creeps
    command = speed * 0.1 * PERIOD * np.arange(1500)
    whole = simulated(truth, command, rng, NOISE)
    late = 1000  # the axis has come to its speed
    columns = {n: c[late:] for n, c in whole.columns.items()}
    record = AxisRecord(whole.time[late:] - whole.time[late], columns, whole.units)
    found = identify(truth.scenario(), record, IdentifyOptions(COLUMNS, laws=["offset"]))
    assert [p.name for p in found.parameters if p.told] == []
    assert any("tells nothing" in note for note in found.notes)
    for p in found.parameters:
        assert p.value == p.before
        assert p.why


@pytest.fixture(scope="module")
def short():
    truth, record = record_of(1, 1.5)
    return truth, record, ground(truth.scenario(), record, IdentifyOptions(COLUMNS), ({}, {}))


def problem_of(own):
    free = own.free(BASE)
    shooting, starts = own.shooting(free, (own.first, own.data.samples - 1), free.start)
    return free, shooting, Guess(free.start, starts)


def test_compiled_loop_and_casadis_machine_move_alike(short):
    own = short[2]
    free, shooting, guess = problem_of(own)
    plain = LoopMotion(own.loop, own.rates, compiled=False)
    arguments = guess.start, shooting.stretch.pieces, own.data.driven, free.values(guess.free)
    fast, slow = own.motion.run(*arguments), plain.run(*arguments)
    for a, b in ((fast.y, slow.y), (fast.slopes, slow.slopes), (fast.ends, slow.ends)):
        size = np.abs(b).max(axis=0)
        assert (np.abs(a - b).max(axis=0) <= 1e-9 * size + 1e-12).all()


def test_slopes_are_those_of_the_motion(short):
    own = short[2]
    _, shooting, guess = problem_of(own)
    first = shooting.linear(guess).moved
    for k, size in enumerate((1e-3, 1e-3, 1e-3, 1e-2)):
        ends = []
        for sign in (1.0, -1.0):
            moved = guess.free.copy()
            moved[k] += sign * size
            ends.append(shooting.linear(Guess(moved, guess.start)).moved.y)
        slope = (ends[0] - ends[1]) / (2.0 * size)
        exact = first.slopes[:, :, own.motion.width + k]
        assert np.abs(slope - exact).max() <= 1e-4 * np.abs(exact).max()


def test_inverse_dynamics_give_the_drive_that_the_plant_needs(short):
    truth, _, own = short
    free = own.free(BASE)
    true = np.array([truth.values[f"machine.{n}"] for n in BASE])
    drive = own.follow(free, true, own.points).drive
    rest = own.force[own.points] - drive
    assert np.sqrt(np.mean(rest**2)) < 0.08 * np.sqrt(np.mean(own.force[own.points] ** 2))


def test_fmus_repeat_their_own_record(short):
    truth, record, _ = short
    found = identify(truth.scenario(), record, IdentifyOptions(COLUMNS, laws=["offset"]))
    run = run_of_record(found)
    assert run.differences["following error"] < 2e-3
    assert run.differences["drives.torque"] < 2.0 * NOISE


@pytest.mark.parametrize(
    ("columns", "told"),
    [
        ({"command": ColumnUse("drives.pulses")}, "drives.pulses"),
        ({"command": ColumnUse("drive.pulse_count")}, "no component 'drive'"),
        ({"here": ColumnUse("drives.pulse_count")}, "no column 'here'"),
        ({**COLUMNS, "torque": ColumnUse("machine.motor_phase")}, "scale must be said"),
        ({"torque": ColumnUse("drives.torque")}, "neither a position"),
    ],
)
def test_wrong_columns_are_told(short, columns, told):
    truth, record, _ = short
    with pytest.raises(InputError, match=re.escape(told)):
        identify(truth.scenario(), record, IdentifyOptions(columns))


def test_wrong_names_are_told(short):
    truth, record, _ = short
    for options in (
        IdentifyOptions(COLUMNS, free=["table_masss"]),
        IdentifyOptions(COLUMNS, fix=["table_masss"]),
    ):
        with pytest.raises(InputError, match="table_mass"):
            identify(truth.scenario(), record, options)
    with pytest.raises(InputError, match="offset"):
        identify(truth.scenario(), record, IdentifyOptions(COLUMNS, laws=["ofset"]))


def test_a_quantity_that_a_rigid_axis_does_not_show_leaves_the_others_their_start_values():
    """A stiffness between motor and table: it moves the drive by rounding alone, and stays."""
    truth, record = record_of(4, 3.0)
    names = (*BASE, "table_viscous_asymmetry", "screw_damping", "screw_stiffness")
    own = ground(truth.scenario(), record, IdentifyOptions(COLUMNS, free=names, laws=[]), ({}, {}))
    free = own.free(names)
    values, deviations = start_values(own, free)
    alone, _ = start_values(own, own.free(names[:-2]))
    assert values[:-2] == pytest.approx(alone, rel=1e-6)
    assert values[-2:].tolist() == free.start[-2:].tolist()
    assert np.isinf(deviations[-2:]).all() and np.isfinite(deviations[:-2]).all()
    assert abs(values[0] - truth.values["machine.table_mass"]) < 0.02 * values[0]
