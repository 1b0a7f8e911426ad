"""What is identified from runs of the arm's own FMU, whose parameters are known."""

import json
import tomllib
from dataclasses import replace

import numpy as np
import pytest
from arm_truth import ArmTruth, plant_of, simulated
from page_outline import shows_what_is_kept
from typer.testing import CliRunner

from motionfmu.cli import app
from motionfmu.identify.arm_dynamics import ArmOptions, held_arm, identify_arm
from motionfmu.identify.arm_dynamics.arm_options import ArmColumn
from motionfmu.identify.arm_dynamics.possible_links import believed
from motionfmu.identify.arm_dynamics.torque_laws import BASE, LAWS, OFFSET, JointState

pytestmark = pytest.mark.more
COLUMNS = {
    "tau": ArmColumn("arm.torque"),
    "motor": ArmColumn("arm.motor_angle"),
    "link": ArmColumn("arm.link_angle"),
}
# Values that a machine may have instead of the data sheet's.
OTHERS = {
    "mass": [35, 25, 24, 10, 3.3, 0.6],
    "motor_coulomb": [0.12, 0.09, 0.08, 0.02, 0.03, 0.02],
    "motor_viscous": [3e-4, 2e-4, 2e-4, 1e-4, 3e-4, 1e-4],
    "stiffness_1": [20e4, 22e4, 15e4, 3.4e4, 2.8e4, 1.6e4],
    "stiffness_2": [26e4, 35e4, 24e4, 5e4, 4.5e4, 2.5e4],
    "lost_motion": [6e-4, 1.2e-3, 6e-4, 5e-4, 1.2e-3, 8e-4],
    "payload_mass": 6.0,
}
ARC = 60.0 * 180.0 / np.pi


@pytest.fixture(scope="module")
def record():
    return simulated(ArmTruth())


@pytest.fixture(scope="module")
def found(record):
    return identify_arm(plant_of().scenario, record, ArmOptions(COLUMNS))


@pytest.fixture(scope="module")
def other():
    """A machine with other values, seen from the data sheet's."""
    truth = plant_of(**OTHERS)
    measured = simulated(ArmTruth(OTHERS, seed=2))
    return truth, identify_arm(plant_of().scenario, measured, ArmOptions(COLUMNS))


def base_is(found, truth):
    """All base parameters within four deviations, one beyond three at most; those that are told."""
    exact = found.equation.base.combine @ believed(truth).standard(truth)
    pairs = [(q, float(e)) for q, e in zip(found.base, exact, strict=True)]
    off = [abs(q.value - e) / (q.deviation + 0.002 * abs(e)) for q, e in pairs]
    assert max(off) < 4.0
    assert sum(x > 3.0 for x in off) <= 1
    told = [(q, e) for q, e in pairs if q.told]
    assert len(told) >= 18
    for q, e in told:
        assert q.value == pytest.approx(e, rel=0.03, abs=3.0 * q.deviation), q.name


def friction_is(found, truth):
    """Friction of each joint at speeds of its record, however its law is made up."""
    motors = truth.table.motors
    for k in range(6):
        most = np.abs(found.equation.motion.motors[1][:, k]).max()
        v = np.linspace(0.1, 0.9, 9) * most
        slow = truth.of(motors.stribeck)[k] / truth.ratio[k]
        least, rest = (truth.of(n)[k] for n in (motors.coulomb, motors.static))
        exact = truth.ratio[k] * (least + (rest - least) / (1.0 + (v / slow) ** 2))
        exact += v * (truth.of(motors.viscous)[k] * truth.ratio[k] ** 2)
        exact += v * truth.of("link_viscous")[k]
        state = JointState(0.0 * v, v, np.ones_like(v), slow)
        laws = (BASE, *(LAWS[n] for n, j in found.chosen.laws if j == k))
        own = sum(
            found.quantity(f"{term} {k + 1}").value * column
            for law in laws
            for (term, _), column in zip(law.terms, law.columns(state), strict=True)
            if term != OFFSET
        )
        assert own == pytest.approx(exact, rel=0.01), k + 1


def gears_are(found, truth, joints):
    names = ("stiffness_1", "stiffness_2", "stiffness_3")
    for k in joints:
        gear = found.gears[k]
        for own, deviation, name in zip(
            gear.stiffness, gear.stiffness_deviation, names, strict=False
        ):
            assert deviation < 0.05 * own
            assert own == pytest.approx(truth.of(name)[k], rel=0.03), (k, name)
        if np.isfinite(gear.values["lost"][1]):
            zero = truth.of("zero_error")[k]
            assert gear.values["zero"][0] == pytest.approx(zero, abs=1e-5)
            assert gear.values["lost"][0] == pytest.approx(truth.of("lost_motion")[k], rel=0.03)


def test_base_parameters_are_found(found):
    base_is(found, plant_of())
    assert found.kept.max() < 0.005  # 0.025 with what the errors of the gears make of torques


def test_friction_is_found(found):
    friction_is(found, plant_of())
    assert {law for law, _ in found.chosen.laws} == {"stribeck"}


def test_gears_are_found(found):
    gears_are(found, plant_of(), (0, 1, 2, 3, 4))
    assert found.gears[1].kind == "the plant's"
    assert found.gears[1].values["viscous"][0] == pytest.approx(12.5, rel=0.05)
    assert found.gears[1].values["amplitude 1"][0] == pytest.approx(5.82e-5, rel=0.05)
    assert found.gears[1].values["amplitude 2"][0] == pytest.approx(8.73e-5, rel=0.05)
    assert not found.gears[2].told("lost")  # gravity loads it one way
    assert any("Joint 3 is loaded one way only" in n for n in found.notes)


def test_another_machine_is_found(other):
    truth, found = other
    base_is(found, truth)
    friction_is(found, truth)
    gears_are(found, truth, (0, 1, 2))
    assert found.kept.max() < 0.02


def test_the_fmu_with_what_was_found_follows_the_record(other):
    """Loops add little with what was found, and more with what was believed before."""
    _, found = other
    run, before = held_arm(found), held_arm(found, {})
    print(run.shares.round(4), before.shares.round(4), run.windup_shares.round(3))
    assert np.median(run.shares) < 0.005
    assert run.shares.max() < 0.05  # a joint that sticks for a moment does so another way
    assert before.shares.max() > 0.1
    assert (before.shares > 5.0 * run.shares).sum() == 6
    assert run.windup_shares[:3].max() < 0.1


def test_friction_by_direction_beside_the_fmu(record):
    """A torque from outside that differs by direction is told, and run as one."""
    plant = plant_of()
    speed = np.gradient(np.asarray(record["link"]), record.time, axis=0)
    more = np.zeros((len(speed), 6))
    more[:, 1] = 0.05 + 0.02 * np.abs(speed[:, 1])  # [N.m] at the motor
    changed = dict(record.columns) | {"tau": record["tau"] + more}
    found = identify_arm(plant.scenario, replace(record, columns=changed), ArmOptions(COLUMNS))
    offset = found.quantity("offset 2")
    assert offset.told
    assert offset.value == pytest.approx(6.0, abs=3.0 * offset.deviation + 0.3)
    assert ("direction", 1) in found.chosen.laws
    assert any("no such law: direction, offset" in n for n in found.notes)
    assert held_arm(found).shares[1] < 0.01


def test_motors_alone_tell_base_parameters(record):
    columns = {n: c for n, c in COLUMNS.items() if n != "link"}
    found = identify_arm(plant_of().scenario, record, ArmOptions(columns, low_pass=10.0))
    assert not found.gears
    truth = plant_of()
    exact = found.equation.base.combine @ believed(truth).standard(truth)
    for name in ("mz2", "mx3", "mz3", "mz5"):
        k = [q.name for q in found.base].index(name)
        assert found.base[k].value == pytest.approx(float(exact[k]), rel=0.01)


def test_command_reads_the_published_benchmark(record, tmp_path):
    """Names, units, shapes and rate of the record of a KUKA KR300 (Weigand et al. 2022)."""
    from scipy.io import savemat

    ratio = plant_of().ratio
    savemat(
        tmp_path / "recording.mat",
        {
            "time": record.time[None],
            "tau_meas": record["tau"].T,
            "q_mot_meas": np.degrees(record["motor"] / ratio).T,
            "q_se_meas": np.degrees(record["link"]).T,
        },
    )
    (tmp_path / "scenario.toml").write_text(
        '# An arm.\nstop = 1.0\nstep = 1e-4\nleave = ["arm.torque", "arm.force"]\n'
        '[component]\narm = "robot_arm"\n[record]\nsignals = ["arm.link_angle"]\n'
    )
    (tmp_path / "identify.toml").write_text(
        "[columns]\n"
        'tau_meas = { signal = "arm.torque", unit = "N.m" }\n'
        'q_mot_meas = { signal = "arm.motor_angle", unit = "deg" }\n'
        'q_se_meas = { signal = "arm.link_angle", unit = "deg" }\n'
    )
    words = ["identify", str(tmp_path), "--record", str(tmp_path / "recording.mat")]
    told = CliRunner().invoke(app, [*words, "-o", str(tmp_path / "out")])
    assert told.exit_code == 0, told.output
    assert "written as angles of the joints" in told.output
    numbers = json.loads((tmp_path / "out/result.json").read_text())
    assert numbers["base"]["mz2"]["value"] == pytest.approx(38.26, rel=0.01)
    assert numbers["gears"]["2"]["lost"]["value"] * ARC == pytest.approx(3.0, rel=0.03)
    assert max(numbers["run"]["added"]) < 0.01
    values = tomllib.loads((tmp_path / "out/found.toml").read_text())
    assert len(values["arm.mass"]) == 6
    assert len(values["arm.center"]) == 18
    page = (tmp_path / "out/report.html").read_text()
    shows_what_is_kept("identified_arm", page)
    refused = CliRunner().invoke(app, [*words, "--axis", "2", "-o", str(tmp_path / "no")])
    assert "axis = 2: an arm is identified as a whole" in str(refused.exception)
    assert not (tmp_path / "no").exists()
