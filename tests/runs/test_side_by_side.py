"""Runs side by side: each has the bits that it has alone, whatever goes on in the others."""

from collections.abc import Mapping
from typing import Any

import pytest
from conftest import ROOT
from few_cases import few

import motionfmu
from motionfmu.base.columns import Columns
from motionfmu.base.errors import InputError
from motionfmu.run.engines import fused_engine
from motionfmu.run.result import Result
from motionfmu.run.session import Session
from motionfmu.scenarios.values import start_values

CIRCLE = ROOT / "scenarios/circle"
MASS, STIFF, FORCE = "machine.table_mass", "machine.screw_stiffness", "machine.force"
# A table of axis 2 that a force beyond all bounds throws off at once, no stiffer than the others.
LIGHT = {f"{MASS}[2]": 0.9, f"{STIFF}[2]": 1e6, "machine.screw_damping[2]": 10.0}
LIGHT |= {f"machine.table_{kind}[2]": 0.0 for kind in ("coulomb", "static", "viscous")}
THROWN = {**LIGHT, f"{FORCE}[2]": 1.7e308}
NAMES = ["mcc.p_gain", "mcc.program", "drives.velocity_gain", MASS, STIFF, *THROWN]
# Eight runs that differ in gains and plants. Two plants need sub-steps, so they are no lanes of the
# others; one table flies off at once, one so far that its card refuses the phase.
GIVEN: list[dict[str, Any]] = [
    {"mcc.p_gain": 100, MASS: 30.0},
    {"mcc.p_gain": 200},
    {STIFF: 5e9},
    {"drives.velocity_gain": 5.0},
    THROWN,
    {"mcc.p_gain": 300, STIFF: 5e9, "mcc.program": "../circle_theory/circle.ngc"},
    {f"{MASS}[1]": 400.0},
    {f"{FORCE}[2]": 1e308},
]


def bits(ran: Result | InputError) -> object:
    """All that a run gave, to be compared."""
    if isinstance(ran, InputError):
        return str(ran)
    signals = {name: data.tobytes() for name, data in ran.signals.items()}
    return signals, ran.time.tobytes(), ran.geometry, ran.stopped, ran.signal_at, ran.parameters


def alone(session: Session, given: Mapping[str, Any]) -> object:
    try:
        return bits(session.run(given))
    except InputError as error:
        return str(error)


def same(one: object, other: object) -> bool:
    """Whether two runs gave the same, apart from the folder of the path they planned."""
    if isinstance(one, str) or isinstance(other, str):
        return one == other
    (*a, x), (*b, y) = one, other  # type: ignore[misc]
    names = [n for n in x if not n.endswith(".path_file")]
    return a == b and x.keys() == y.keys() and all(x[n] == y[n] for n in names)


@pytest.fixture(autouse=True)
def all_lanes(monkeypatch: pytest.MonkeyPatch) -> None:
    """As many as the programs are made for."""
    monkeypatch.setattr(fused_engine, "LANES", 8)


@pytest.fixture(scope="module")
def session() -> Any:
    with Session(motionfmu.load(CIRCLE), NAMES, stop=0.4) as made:
        yield made


@pytest.fixture(scope="module")
def each(session: Session) -> list[object]:
    return [alone(session, given) for given in GIVEN]


@pytest.mark.parametrize("width", [1, 2, 4, 8])
def test_each_of_so_many_runs_is_the_run_alone(
    width: int, session: Session, each: list[object]
) -> None:
    assert session.lanes == 8
    found: list[Any] = []
    for first in range(0, len(GIVEN), width):
        found += session.run_together(GIVEN[first : first + width])
    assert [same(bits(ran), own) for ran, own in zip(found, each, strict=True)] == [True] * 8
    assert "machine: axis 2: rotor.angle is nan at 0.0001" in str(found[4])
    assert "card: enc_phase[2] = " in str(found[7])
    good = [ran for ran in found if isinstance(ran, Result)]
    assert len(good) == 6
    finals = [float(ran["machine.table_position"][-1, 0]) for ran in good]
    assert len(set(finals)) == 6, "runs that do not differ show no mixing of lanes"


def test_a_run_of_the_scenario_has_the_same_bits(session: Session) -> None:
    some = GIVEN[1:4]
    for given, ran in zip(some, session.run_together(some), strict=True):
        assert isinstance(ran, Result)
        whole = motionfmu.load(CIRCLE).run(set=given, stop=0.4)
        for name in ran.signals:
            assert ran[name].tobytes() == whole[name].tobytes()


def test_runs_that_cannot_begin_leave_the_others_whole(
    session: Session, each: list[object]
) -> None:
    given = [{"mcc.p_gain": -5}, GIVEN[1], {"mcc.program": "none.ngc"}, GIVEN[3]]
    found = session.run_together(given)
    assert "outside 0 .. 65535" in str(found[0]) and "none.ngc" in str(found[2])
    assert same(bits(found[1]), each[1]) and same(bits(found[3]), each[3])


CUTS = [{"mcc.p_gain": g, "drives.velocity_gain": 0.5 + 0.001 * g} for g in range(100, 900, 100)]
LONG = 1.5  # [s] so long that signals of a run by itself have files, with much of the first circle


@pytest.fixture(scope="module")
def by_files() -> list[str]:
    """The contour's numbers of each run by itself."""
    found = []
    for given in CUTS:
        ran = motionfmu.load(CIRCLE).run(set=given, stop=LONG)
        assert isinstance(ran.signals, Columns)
        found.append(str(ran.contour().numbers()))
    assert len(set(found)) == len(CUTS)
    return found


@pytest.mark.parametrize("width", [1, 2, 4, 8])
def test_the_contour_in_memory_is_the_one_by_way_of_files(width: int, by_files: list[str]) -> None:
    with Session(motionfmu.load(CIRCLE), CUTS[0], stop=LONG) as made:
        found: list[str] = []
        for first in range(0, len(CUTS), width):
            for ran in made.run_together(CUTS[first : first + width]):
                assert isinstance(ran, Result) and isinstance(ran.signals, dict)
                found.append(str(ran.contour().numbers()))
    assert found == by_files


@pytest.mark.parametrize("fmi", [2, 3])
def test_an_instance_serves_the_next_run_unless_its_run_failed(fmi: int) -> None:
    """A run behind another one has the bits of a first one, and messages of its own."""
    scenario = motionfmu.load(CIRCLE)
    with Session(scenario, NAMES, stop=0.05, fmi=fmi) as made:
        (library,) = made._engine._libraries  # type: ignore[attr-defined]
        first = alone(made, GIVEN[0])
        address = library.instance.value
        for given in (GIVEN[5], GIVEN[1]):
            assert not same(alone(made, given), first)
            assert library.instance.value == address
        assert same(alone(made, GIVEN[0]), first)
        for _ in range(2):
            assert "outside 0 .. 65535" in str(alone(made, {"mcc.p_gain": -5}))
            assert "machine: axis 2: rotor.angle is nan" in str(alone(made, THROWN))
            assert not library.instance
        assert same(alone(made, GIVEN[0]), first)


def test_runs_end_behind_their_own_signals() -> None:
    """Of two programs one is done earlier; its run stands still while the other goes on."""
    scenario = motionfmu.load(ROOT / "scenarios/circle_theory").changed(
        stop="mcc.done", limit=4.0, settle=0.01
    )
    given = [{"mcc.override": x} for x in (1.0, 1.2, 1.5)]
    with Session(scenario, ["mcc.override"]) as made:
        found = made.run_together(given)
        for own, ran in zip(given, found, strict=True):
            assert same(bits(ran), alone(made, own))
    assert len({ran.signal_at for ran in found if isinstance(ran, Result)}) == 3


def test_an_engine_without_lanes_takes_one_after_the_other() -> None:
    scenario = motionfmu.load(ROOT / "scenarios/circle_theory")
    given = [{"mcc.p_gain": 100}, {"mcc.p_gain": -1}]
    with Session(scenario, ["mcc.p_gain"], stop=0.02, engine="native") as made:
        assert made.lanes == 1
        good, bad = made.run_together(given)
        assert same(bits(good), alone(made, given[0])) and "outside" in str(bad)


# Parameters of plants, one of which each plant has.
TURNED = ("table_mass", "motor_inertia", "link_viscous", "tau", "mass")


def turned(scenario: motionfmu.Scenario, share: float) -> dict[str, Any]:
    """Values of all `TURNED` that are larger by a share."""
    found: dict[str, Any] = {}
    for component, ports in scenario.resolver.ports.items():
        for port in (ports[name] for name in TURNED if name in ports):
            values = [x * (1.0 + share) for x in start_values(port)]
            found[f"{component}.{port.name}"] = values if port.shape else values[0]
    return found


SCENARIOS = sorted(f.parent.name for f in ROOT.glob("scenarios/*/scenario.toml"))
# In `make test-more`: a mill, two groups of a card, a network card, a robot, a hydraulic axis.
KEPT = {"pocket", "fourteen_axes", "plt_plate", "robot_line", "hydraulic_positioning"}


@pytest.mark.more
@pytest.mark.parametrize("fmi", [2, 3])
@pytest.mark.parametrize("name", few(SCENARIOS, KEPT, pytest.mark.long))
def test_lanes_of_every_scenario(name: str, fmi: int) -> None:
    """One, two, four and eight lanes whose plants differ by parts in a thousand."""
    scenario = motionfmu.load(ROOT / "scenarios" / name)
    given = [turned(scenario, 1e-3 * k) for k in range(8)]
    stop = 200 * scenario.document.body.step
    with Session(scenario, given[0], stop=stop, fmi=fmi) as made:
        own = [alone(made, values) for values in given]
        for width in (1, 2, 4, 8):
            groups = [given[k : k + width] for k in range(0, 8, width)]
            found = [bits(ran) for group in groups for ran in made.run_together(group)]
            assert [same(*pair) for pair in zip(found, own, strict=True)] == [True] * 8, width
