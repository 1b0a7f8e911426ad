"""A scenario that begins in a saved state goes on with the bits of the run from time 0."""

import json
import shutil
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from few_cases import few

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine
from motionfmu.live.machine_loop import MachineLoop
from motionfmu.live.machine_process import _saved
from motionfmu.run.engines import ENGINES

# A scenario, when it is in motion [s], and what is done before and behind that.
MACHINES: list[tuple[str, float, dict[str, Any], dict[str, Any]]] = [
    (
        "circle",
        0.9,
        {"mcc.override": 0.6, "drives.velocity_gain[1]": 0.4, "machine.force[2]": 200.0},
        {"mcc.hold": True, "machine.force[2]": -150.0},
    ),
    (
        "hydraulic_positioning",
        0.7,
        {"axis.force": 1500.0, "controller.p_gain": 30},
        {"axis.force": -800.0},
    ),
    ("robot_line", 1.2, {"soft.override": 0.7}, {"soft.hold": True}),
    ("plt_plate", 1.0, {"machine.force[1]": 4.0}, {"machine.force[1]": -3.0}),
]
REST = 0.2  # [s]


def worked_at(name: str, at: float, before: Any, behind: Any, place: Path) -> None:
    """Work at a machine, go back once, and save all of it and what was behind a state."""
    with LiveMachine(name) as machine:
        steps = round(at / machine.step_seconds)
        rest = round(REST / machine.step_seconds)
        machine.step(steps // 2)
        for variable, value in before.items():
            machine.set(variable, value)
        machine.step(steps - steps // 2)
        machine.keep()
        for variable, value in behind.items():  # forgotten: one goes back
            machine.set(variable, value)
        machine.step(rest // 4)
        machine.keep()
        machine.step(rest)
        machine.back(at)
        machine.step(rest // 2)
        for variable, value in behind.items():
            machine.set(variable, value)
        machine.step(rest - rest // 2)
        before_it = machine.read(machine.names[0])
        machine.save(place / "late", begin=at)
        assert machine.read(machine.names[0]) == before_it  # saving moves nothing
        machine.save(place / "whole")


def signals_of(scenario: Path, engine: str) -> Any:
    plan = motionfmu.load(scenario)
    return plan.changed(record={"signals": ["*.*"]}).run(engine=engine)


@pytest.mark.parametrize(
    ("name", "at", "before", "behind"), few(MACHINES, 1), ids=[m[0] for m in MACHINES]
)
def test_every_engine_goes_on_with_the_bits_of_the_run_from_0(
    name: str, at: float, before: Any, behind: Any, tmp_path: Path
) -> None:
    worked_at(name, at, before, behind, tmp_path)
    whole = signals_of(tmp_path / "whole", "fused")
    written = (tmp_path / "late" / "scenario.toml").read_text()
    head = written.partition("\n\n")[0]
    for variable in before:
        assert f"# {variable.partition('[')[0]} = " in head
    drives = [d["input"] for d in motionfmu.load(tmp_path / "late").document.tables["drive"]]
    assert set(drives) >= {v.partition("[")[0] for v in behind}
    for engine in ENGINES:
        late = signals_of(tmp_path / "late", engine)
        first = int(np.searchsorted(whole.time, at - 1e-9))
        assert late.time[0] == pytest.approx(at, abs=1e-12) and len(late.time) > 100
        assert late.time.tobytes() == whole.time[first:].tobytes()
        assert set(late.signals) == set(whole.signals) and len(late.signals) > 10
        for signal in late.signals:
            there = whole[signal][first:]
            assert late[signal].tobytes() == np.ascontiguousarray(there).tobytes(), (engine, signal)
        assert any(np.ptp(np.asarray(late[s], float)) > 0 for s in late.signals)
        assert late.stopped == f"stop = {whole.time[-1] + whole.time[1]:.9g} s"


@pytest.mark.parametrize("fmi", few((2, 3), 1))
@pytest.mark.parametrize("engine", few(("native", "fmpy", "fused"), 1))
def test_of_so_many_steps_one_is_recorded_from_the_begin_on(
    engine: str, fmi: int, tmp_path: Path
) -> None:
    worked_at(*MACHINES[0], tmp_path)
    late, whole = (motionfmu.load(tmp_path / n) for n in ("late", "whole"))
    a, b = late.run(engine=engine, fmi=fmi, every=10), whole.run(every=10)
    assert (
        len(a.time) == round(REST / 1e-3) and a.time.tobytes() == b.time[-len(a.time) :].tobytes()
    )
    for name in a.signals:
        there = np.ascontiguousarray(b[name][-len(a.time) :])
        assert np.ascontiguousarray(a[name]).tobytes() == there.tobytes(), name
    with pytest.raises(InputError, match=r"begin.zip is of 0.9 s, no whole number of recorded"):
        late.run(every=7)


@pytest.fixture(scope="module")
def saved(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The circle, saved in its first step."""
    place = tmp_path_factory.mktemp("saved")
    worked_at(*MACHINES[0], place)
    return place / "late"


def copied(saved: Path, place: Path) -> Path:
    return Path(shutil.copytree(saved, place / "copy"))


def rewritten(folder: Path, change: Any) -> None:
    """Write the files in a saved state anew, changed."""
    file = folder / "begin.zip"
    with zipfile.ZipFile(file) as archive:
        found = {n: archive.read(n) for n in archive.namelist()}
    about = json.loads(found["state.json"])
    change(found, about)
    found["state.json"] = json.dumps(about).encode()
    with zipfile.ZipFile(file, "w") as archive:
        for name, data in found.items():
            archive.writestr(name, data)


def test_a_damaged_file_is_refused(saved: Path, tmp_path: Path) -> None:
    folder = copied(saved, tmp_path)
    file = folder / "begin.zip"
    data = file.read_bytes()
    line = (folder / "scenario.toml").read_text().splitlines().index('begin = "begin.zip"') + 1
    with zipfile.ZipFile(file) as archive:
        place = next(i.header_offset for i in archive.infolist() if i.filename == "card.state")
    for wrong, words in (
        (data[: len(data) // 2], "begin.zip is damaged"),
        (b"", "begin.zip is damaged"),
        (data[: place + 200] + bytes([data[place + 200] ^ 4]) + data[place + 201 :], "damaged"),
    ):
        file.write_bytes(wrong)
        with pytest.raises(InputError, match=words) as told:
            motionfmu.load(folder)
        assert len(told.value.args) == 1 and f"scenario.toml:{line}: " in str(told.value)
    file.unlink()
    with pytest.raises(InputError, match="there is no such file"):
        motionfmu.load(folder)


# What is changed in a saved state, and what is said of it.
OTHERS: list[tuple[Any, str]] = [
    (lambda f, a: f.pop("card.state"), "it has no state of component card"),
    (lambda f, a: a["components"].pop("card"), "it has no state of component card"),
    (lambda f, a: a["components"].update(more={}), "of another scenario: more is no component"),
    (
        lambda f, a: a["components"]["card"].update(a["components"]["drives"]),
        "card: it is the state of a ServoDrives, not Epcio",
    ),
    (
        lambda f, a: a["components"]["card"].update(token="{0}"),
        "card: it is the state of another version",
    ),
    (lambda f, a: a.pop("given"), "no saved state: 'given'"),
    (lambda f, a: a.update(format=2), "format 2; 1 is known here"),
    (lambda f, a: a.update(ns=0), "ns = 0"),
]


@pytest.mark.parametrize(("change", "words"), OTHERS, ids=[w for _, w in OTHERS])
def test_a_state_of_something_else_is_refused(
    saved: Path, tmp_path: Path, change: Any, words: str
) -> None:
    folder = copied(saved, tmp_path)
    rewritten(folder, change)
    with pytest.raises(InputError, match=words) as told:
        motionfmu.load(folder)
    assert len(told.value.args) == 1


@pytest.mark.parametrize("engine", list(ENGINES))
def test_an_fmu_refuses_bytes_that_are_not_its_state(
    saved: Path, tmp_path: Path, engine: str
) -> None:
    folder = copied(saved, tmp_path)

    def flipped(found: dict[str, bytes], about: Any) -> None:
        data = bytearray(found["card.state"])
        data[-40] ^= 1
        found["card.state"] = bytes(data)

    rewritten(folder, flipped)
    with pytest.raises(InputError, match=r"card: begin_state: .*its bytes have changed"):
        motionfmu.load(folder).run(engine=engine)


def test_another_program_is_refused(saved: Path, tmp_path: Path) -> None:
    folder = copied(saved, tmp_path)
    program = folder / "circle.ngc"
    program.write_text(program.read_text() + "\n")
    with pytest.raises(InputError, match=r"mcc.program: the file is not as it was"):
        motionfmu.load(folder)


@pytest.mark.parametrize("engine", list(ENGINES))
def test_a_fixed_parameter_is_that_of_the_state(saved: Path, engine: str) -> None:
    plan = motionfmu.load(saved)
    with pytest.raises(InputError, match=r"set mcc.acc_time = .* the saved state has"):
        plan.run(engine=engine, set={"mcc.acc_time": 0.3})


@pytest.mark.parametrize("engine", list(ENGINES))
def test_a_value_that_is_given_later_acts_from_the_begin_on(saved: Path, engine: str) -> None:
    """As a [[drive]] at the begin; what the state has of others stays."""
    plan = motionfmu.load(saved)
    asked = {"drives.torque_limit": 0.5}
    result = plan.run(engine=engine, set=asked)
    drive = {"input": "drives.torque_limit", "at": [0.9], "value": [0.5]}
    other = plan.changed(drive=[*plan.document.tables["drive"], drive]).run(engine="fused")
    assert result["drives.torque"].tobytes() == other["drives.torque"].tobytes()
    assert result["drives.torque"].tobytes() != plan.run()["drives.torque"].tobytes()


def test_a_run_cannot_end_before_it_begins(saved: Path) -> None:
    with pytest.raises(InputError, match=r"is of 0.9 s, and the run ends at 0.5 s"):
        motionfmu.load(saved).run(stop=0.5)


def test_a_machine_goes_on_from_a_saved_state_and_is_saved_again(
    saved: Path, tmp_path: Path
) -> None:
    whole = motionfmu.load(saved.parent / "whole").changed(stop=1.4)
    with LiveMachine(saved) as machine:
        assert machine.time == pytest.approx(0.9)
        assert machine["mcc.override"] == 0.6  # in force, from the state
        with pytest.raises(InputError, match="driven by the scenario"):
            machine.set("mcc.hold", False)
        machine.step(3000)
        machine.keep()
        machine.set("drives.velocity_gain", 0.5)
        machine.step(2000)
        machine.save(tmp_path / "again", begin=machine.time - 0.2)
    drive = {"input": "drives.velocity_gain", "at": [1.2], "value": [0.5]}
    other = whole.changed(drive=[*whole.document.tables["drive"], drive])
    drives = other.document.tables["drive"]
    gains = [d for d in drives if d["input"] == "drives.velocity_gain"]
    rest = [d for d in drives if d["input"] != "drives.velocity_gain"]
    one = {
        "input": "drives.velocity_gain",
        "at": [t for d in gains for t in d["at"]],
        "value": [v for d in gains for v in d["value"]],
    }
    expected = whole.changed(drive=[*rest, one]).run()
    result = motionfmu.load(tmp_path / "again").run()
    assert result.time[0] == pytest.approx(1.2)
    for name in result.signals:
        there = np.ascontiguousarray(expected[name][-len(result.time) :])
        assert np.ascontiguousarray(result[name]).tobytes() == there.tobytes(), name


def test_no_state_is_kept_from_then(tmp_path: Path) -> None:
    with LiveMachine("circle") as machine:
        machine.step(100)
        machine.keep()
        machine.step(10)
        with pytest.raises(InputError, match=r"no state is kept at or before 0.005 s"):
            machine.save(tmp_path / "x", begin=0.005)
        with pytest.raises(InputError, match="finite"):
            machine.save(tmp_path / "x", begin=float("nan"))
        assert not (tmp_path / "x").exists() and not list(tmp_path.iterdir())


def test_what_looks_at_a_run_finds_the_later_begin(tmp_path: Path) -> None:
    """Checks with windows, the contour and a figure count in the run's own, absolute time."""
    worked_at(*MACHINES[0], tmp_path)
    late, whole = (motionfmu.load(tmp_path / n) for n in ("late", "whole"))
    check = {
        "machine.table_position[1]": {"at": 1.0, "final": (-1e6, 1e6)},
        "drives.torque": {"max": 1e3, "windows": [(0.95, 1.05)]},
    }
    assert late.changed(check=check).run().ok
    a, b = (plan.run().contour() for plan in (late, whole))
    count = len(a.track.distance)
    assert 1000 < count < len(b.track.distance)
    assert np.abs(a.track.distance - b.track.distance[-count:]).max() < 1e-9


def test_a_program_is_saved_as_it_was_loaded(tmp_path: Path) -> None:
    """Somebody edits the file in the meantime; the machine and its scenario keep the loaded one."""
    program = tmp_path / "part.ngc"
    program.write_text("G91 G1 X5 F1000\no<more> call\nM2\n")
    (tmp_path / "more.ngc").write_text("o<more> sub\nG1 Y3\no<more> endsub\nM2\n")
    loaded = program.read_text()
    plan = motionfmu.machine("mill3").scenario(program)
    with LiveMachine(plan) as machine:
        machine.step(1000)
        program.write_text("G91 G1 X-50 F3000\nM2\n")
        (tmp_path / "more.ngc").unlink()
        rows = machine.trace(["mcc.position"], 5000)["mcc.position"]
        machine.save(tmp_path / "saved")
        kept = machine.as_scenario()
    assert (tmp_path / "saved" / "part.ngc").read_text() == loaded
    assert (tmp_path / "saved" / "more.ngc").is_file()
    for scenario in (motionfmu.load(tmp_path / "saved"), kept):
        result = scenario.changed(record=["mcc.position"]).run()
        assert result["mcc.position"][1000:6000].tobytes() == rows.tobytes()
    assert np.ptp(rows[:, 0]) > 1.0


def test_a_request_and_the_end_save_the_last_seconds(tmp_path: Path) -> None:
    """States are kept each second; of a machine that has not run for so long all is saved."""
    with LiveMachine("circle") as machine:
        loop = MachineLoop(machine)
        loop.advance(32_000)
        asked = loop.do_save(str(tmp_path / "asked"), None, 1.7)
        ended = _saved(machine, str(tmp_path / "ended"), 1.0)
        short = _saved(machine, str(tmp_path / "short"), 60.0)
        again = _saved(machine, str(tmp_path / "short"), None)
    begins = [motionfmu.load(f).begin for f in (asked, ended, short, again)]
    assert [None if b is None else b.ns for b in begins] == [10**9, 2 * 10**9, None, None]
    assert again.parent.name == "short-2"


def test_what_ends_as_it_is_is_read_when_it_is_saved(tmp_path: Path) -> None:
    """Nobody's view of it, which is older: the checks hold in a run of what was saved."""
    with LiveMachine("circle") as machine:
        loop = MachineLoop(machine)
        loop.advance(16_001)
        ends = {"mcc.position[1]": 1e-9, "card.enc_count[2]": 0.0, "card.err_count[1]": 0.0}
        loop.do_save(str(tmp_path / "saved"), {"card.err_count[2]": {"max": 10**6}}, None, ends)
        x, counts, errors = (machine[name] for name in ends)
        with pytest.raises(InputError, match=r"mcc\.position: it is an array; name an element"):
            machine.save(tmp_path / "no", ends={"mcc.position": 0.0})
    plan = motionfmu.load(tmp_path / "saved")
    saved = plan.document.tables["check"]
    assert saved.pop("card.err_count[2]") == {"max": 10**6}
    assert saved == {
        n: {"final": v} for n, v in zip(ends, ([x - 1e-9, x + 1e-9], counts, errors), strict=True)
    }
    assert plan.run().ok
