"""Records of an arm that cannot be taken, and what is found of made-up ones."""

import numpy as np
import pytest
from arm_truth import plant_of

from motionfmu import InputError
from motionfmu.identify.arm_dynamics import ArmOptions, identify_arm
from motionfmu.identify.arm_dynamics.arm_options import ArmColumn, asked_of
from motionfmu.identify.arm_dynamics.arm_record import arm_record
from motionfmu.identify.arm_dynamics.link_regressor import regressor
from motionfmu.identify.arm_dynamics.possible_links import believed
from motionfmu.records import Record

COLUMNS = {"tau": ArmColumn("arm.torque"), "link": ArmColumn("arm.link_angle")}
BOTH = COLUMNS | {"motor": ArmColumn("arm.motor_angle")}
RATE, SECONDS = 100.0, 40.0
RATIO = np.array([100, 120, 120, 100, 100, 80.0])
COULOMB = np.array([9.0, 11.0, 7.0, 2.0, 3.0, 1.5])  # at the joints [N.m]
VISCOUS = np.array([8.0, 12.0, 9.0, 2.0, 3.0, 1.0])
OFFSET = np.array([0.0, 4.0, 0.0, 0.0, -1.0, 0.0])
MORE = np.array([3.0, 0.0, 0.0, 0.0, 0.0, 0.0])  # viscous, by direction


def motion(seconds=SECONDS):
    """Series of sines, and both derivatives."""
    t = np.arange(0.0, seconds, 1.0 / RATE)
    rng = np.random.default_rng(5)
    q, v, a = np.zeros((3, len(t), 6))
    for k in range(6):
        for n in range(1, 7):
            w = 2.0 * np.pi * (0.07 + 0.002 * k) * n
            size, phase = 1.0 / np.sqrt(n) * rng.normal(), rng.uniform(0.0, 6.28)
            q[:, k] += size * np.sin(w * t + phase)
            v[:, k] += size * w * np.cos(w * t + phase)
            a[:, k] -= size * w**2 * np.sin(w * t + phase)
    return t, (q, v, a)


def made(balance=0.0, seconds=SECONDS):
    """A record of rigid joints by the equation, with friction that differs by direction."""
    plant = plant_of()
    t, (q, v, a) = motion(seconds)
    own = believed(plant).standard(plant)
    torque = regressor(plant.axes, plant.origins, plant.gravity, (q, v, a)) @ own[:60]
    torque += own[60:] * a + COULOMB * np.sign(v) + VISCOUS * v + OFFSET + MORE * np.abs(v)
    torque[:, 1] += balance * np.sin(2.0 * q[:, 1])
    torque += 0.01 * torque.std(axis=0) * np.random.default_rng(6).normal(size=torque.shape)
    joints = plant.sign * (q + plant.offset)
    ns = np.round(t * 1e9).astype(np.int64)
    columns = {"tau": plant.sign * torque / RATIO, "link": joints, "motor": joints * RATIO}
    return plant, Record("made", ns, columns, {"tau": "N.m", "link": "rad", "motor": "rad"})


@pytest.fixture(scope="module")
def rigid():
    plant, record = made()
    return plant, identify_arm(plant.scenario, record, ArmOptions(COLUMNS))


@pytest.mark.more
def test_rigid_arm_is_found(rigid):
    _, found = rigid
    wrong = [
        (q.name, q.value, q.deviation, q.before)
        for q in found.base
        if abs(q.value - q.before) > 3.5 * q.deviation
    ]
    assert not wrong
    assert sum(q.told for q in found.base) >= 15
    for k in range(6):
        for name, exact in (("coulomb", COULOMB[k]), ("viscous", VISCOUS[k])):
            q = found.quantity(f"{name} {k + 1}")
            assert abs(q.value - exact) < 4.0 * q.deviation + 0.01 * exact, q
    assert not found.gears


@pytest.mark.more
def test_friction_that_differs_by_direction_is_chosen(rigid):
    _, found = rigid
    assert ("direction", 0) in found.chosen.laws
    for k, offset in enumerate(OFFSET):
        q = found.quantity(f"offset {k + 1}")
        assert q.value == pytest.approx(offset, abs=3.5 * q.deviation)
    assert found.quantity("offset 2").deviation < 0.4
    assert found.quantity("viscous difference 1").value == pytest.approx(3.0, rel=0.1)
    assert any("no such law" in n for n in found.notes)


@pytest.mark.more
def test_a_balancer_is_chosen():
    plant, record = made(balance=200.0)
    found = identify_arm(plant.scenario, record, ArmOptions(COLUMNS))
    assert ("balancer", 1) in found.chosen.laws
    assert found.quantity("sine twice 2").value == pytest.approx(200.0, rel=0.05)
    without = identify_arm(plant.scenario, record, ArmOptions(COLUMNS, laws=[]))
    assert without.kept[1] > 5.0 * found.kept[1]


@pytest.mark.more
def test_possible_links_make_the_base_parameters(rigid):
    """From beliefs that are wrong by a quarter to links that make the torques."""
    plant, right = rigid
    wrong = {
        "arm.mass": (1.25 * plant.of("mass")).tolist(),
        "arm.motor_inertia": (0.8 * plant.of("motor_inertia")).tolist(),
    }
    _, record = made()
    found = identify_arm(plant.scenario, record, ArmOptions(COLUMNS), wrong)
    base = found.equation.base
    own = base.combine @ found.links.standard(found.plant)
    asked = np.array([q.value for q in found.base])
    deviations = np.array([q.deviation for q in found.base])
    assert np.abs((own - asked) / deviations).max() < 4.0
    before = base.combine @ believed(found.plant).standard(found.plant)
    assert np.abs((before - asked) / deviations).max() > 50.0
    assert (found.links.mass >= 0.0).all()
    assert (2.0 * found.links.inertia <= 1.001 * found.links.inertia.sum(axis=1)[:, None]).all()
    assert [q.value for q in right.base] == pytest.approx(asked, abs=5.0 * deviations.max())


def taken(columns=BOTH, **changed):
    plant, record = made(seconds=5.0)
    whole = {n: x.copy() for n, x in record.columns.items()}
    units = dict(record.units) | changed.pop("units", {})
    ns = changed.pop("ns", record.ns)
    for name, change in changed.items():
        whole[name] = change(whole[name])
    return arm_record(plant, Record("rec.csv", ns, whole, units), columns)


def unsure(x):
    x[7, 2] = np.nan
    return x


@pytest.mark.parametrize(
    ("changed", "told"),
    [
        ({"tau": unsure}, r"rec\.csv: sample 8: tau\[3\] = nan"),
        ({"motor": lambda x: -x}, r"motor 1 turns -100 times as far.*gear_ratio\[1\] = 100"),
        ({"tau": lambda x: x[:, :5]}, r"tau has 5 values a sample, arm\.torque has 6"),
        ({"units": {"link": "mm"}}, r"link is in \[mm\], \[rad\] wanted"),
        ({"units": {"tau": None}}, r"tau has no unit; \[N·m\] wanted"),
        ({"ns": np.cumsum(np.r_[np.full(250, 10**7), np.full(250, 2 * 10**7)])}, "apart"),
        ({"columns": {"link": BOTH["link"]}}, r"no column is arm\.torque"),
        ({"columns": {"tau": BOTH["tau"]}}, r"no column is arm\.motor_angle"),
        ({"columns": {"tau": ArmColumn("arm.torqe")}}, r"'arm\.torqe'.*did you mean"),
        ({"columns": BOTH | {"link": ArmColumn("arm.torque")}}, "are both arm.torque"),
        ({"link": lambda x: 0.0 * x, "motor": lambda x: 0.0 * x}, "no joint moves"),
    ],
)
def test_what_is_wrong_is_told(changed, told):
    with pytest.raises(InputError, match=told):
        taken(**changed)


def test_motors_may_be_written_at_the_joints():
    found = taken(motor=lambda x: x / RATIO)
    assert not found.seen.any()
    assert any("written as angles of the joints" in n for n in found.notes)
    assert any("have one encoder" in n for n in found.notes)


@pytest.mark.parametrize(
    ("tables", "told"),
    [
        ({}, r"identify\.toml: \[columns\]"),
        ({"axis": 2}, "axis = 2: an arm is identified as a whole"),
        ({"columns": {"a": "arm.torque"}, "laws": ["stribek"]}, "laws: 'stribek'"),
        ({"columns": {"a": "arm.torque"}, "keep": 0.9}, "keep = 0.9"),
        ({"columns": {"a": {"signal": "arm.torque", "scal": 1.0}}}, "scal"),
    ],
)
def test_options_that_are_wrong(tables, told):
    with pytest.raises(InputError, match=told):
        asked_of(tables, "identify.toml")


@pytest.mark.more
def test_a_record_of_few_samples_a_second():
    """10 Hz, as the benchmark of a KUKA KR300 has it beside its raw records."""
    plant, record = made(seconds=400.0)
    few = Record(
        "few", record.ns[::10], {n: x[::10] for n, x in record.columns.items()}, record.units
    )
    found = identify_arm(plant.scenario, few, ArmOptions(COLUMNS, laws=["direction"]))
    for name in ("mz2", "mx3", "mz3", "mz5"):
        q = found.quantity(name)
        assert q.value == pytest.approx(q.before, rel=0.01)
    assert found.quantity("viscous 1").value == pytest.approx(VISCOUS[0], rel=0.05)


def test_a_short_record_is_refused():
    plant, record = made(seconds=3.0)
    with pytest.raises(InputError, match="too short"):
        identify_arm(plant.scenario, record, ArmOptions(COLUMNS))
