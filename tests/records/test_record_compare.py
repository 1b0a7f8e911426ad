"""A run beside a measured record by `compare`, with a mapping or the scenario's own."""

import json
import re
from pathlib import Path

import numpy as np
import pytest
from console import within

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.compare import compare_record
from motionfmu.records import Record
from motionfmu.run import Result

POSITION = "machine.table_position[1]"
TABLES = {
    "stop": 0.3,
    "step": 1e-4,
    "component": {"machine": "ball_screw_axes"},
    "leave": ["machine.force"],
    "drive": {
        "machine.torque_command": {"at": [0.0, 0.05, 0.15], "value": [1.0, -1.0, 0.5]},
    },
    "record": {"signals": ["machine.table_position", "machine.motor_torque"]},
}


@pytest.fixture(scope="module")
def result() -> Result:
    return motionfmu.scenario(TABLES, name="axis").run()


@pytest.fixture(scope="module")
def place(result: Result, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder with the run's result and what a drive might have measured: in mm, 2 ms later."""
    folder = tmp_path_factory.mktemp("compare")
    result.save(folder / "run")
    late = np.interp(result.time - 2e-3, result.time, result[POSITION])
    ns = np.round(result.time[::10] * 1e9).astype(np.int64)
    record = Record("axis", ns, {"X": 1.02e3 * late[::10]}, {"X": "mm"})
    record.save(folder / "drive.csv")
    return folder


def test_a_record_over_a_run_in_python(result: Result, place: Path) -> None:
    found = compare_record(result, place / "drive.csv", {POSITION: "X"})
    numbers = found.numbers()["record"][POSITION]
    run = result[POSITION][::10]
    measured = motionfmu.record(place / "drive.csv").in_unit("X", "m")
    assert numbers["nrmse"] == pytest.approx(
        np.linalg.norm(run - measured) / np.linalg.norm(measured), rel=1e-12
    )
    assert numbers["lag"] == pytest.approx(-2e-3, abs=5e-5)
    other = compare_record(place / "drive.csv", result, {"X": POSITION})
    assert other.numbers()["record"]["X"]["lag"] == pytest.approx(2e-3, abs=5e-5)
    assert other.units == {"X": "mm"}


def test_the_command_writes_a_page(place: Path) -> None:
    told = within("compare", "run", "drive.csv", "--map", f"{POSITION}=X", folder=place)
    assert told.returncode == 0, told.stderr
    assert "NRMSE" in told.stdout and "ms" in told.stdout
    made = json.loads((place / "results/run.compare/result.json").read_text())
    assert made["record"][POSITION]["column"] == "X"
    assert POSITION in (place / "results/run.compare/report.html").read_text()
    told = within("compare", "run", "drive.csv", "--json", "--map", f"{POSITION}=X", folder=place)
    assert json.loads(told.stdout)["record"] == made["record"]


def test_a_layout_names_columns_and_what_they_lie_over(place: Path) -> None:
    text = "\n".join(f"{k / 1000:.3f};{k}" for k in range(200))
    (place / "raw.csv").write_text(f"t [s];counts\n{text}\n")
    (place / "raw.toml").write_text(
        '[columns]\nX = { column = "counts", scale = 1e-3, unit = "mm" }\n'
        f'[over]\n"{POSITION}" = "X"\n'
    )
    told = within("compare", "run", "raw.csv", "--layout", "raw.toml", "--json", folder=place)
    assert told.returncode == 0, told.stderr
    assert json.loads(told.stdout)["record"][POSITION]["samples"] == 200


def test_the_scenario_knows_its_record(place: Path) -> None:
    tables = TABLES | {"record_file": {"file": "drive.csv", "over": {POSITION: "X"}}}
    scenario = motionfmu.scenario(tables, name="axis", folder=place)
    result = scenario.run()
    result.save(place / "known")
    for a in (scenario, result, place / "known"):
        found = compare_record(a, place / "drive.csv")
        assert found.numbers()["record"] == {POSITION: result.record_matches().numbers()[POSITION]}


@pytest.mark.parametrize(
    ("over", "told"),
    [
        (["X"], r"--map X: SIGNAL=COLUMN wanted"),
        ([f"{POSITION}=Y"], r"drive.csv: no column 'Y'"),
        (["machine.motor_torque[1]=X"], r"X is in \[mm\], \[N·m\] wanted"),
        (["machine.table_position=X"], r"have not as many elements"),
        (["machine.table=X"], r"no signal 'machine.table'; did you mean"),
        ([], r"have no name in common: say which lies over which \(columns: X\)"),
    ],
)
def test_a_wrong_mapping_is_told(over: list[str], told: str, place: Path) -> None:
    maps = [x for text in over for x in ("--map", text)]
    found = within("compare", "run", "drive.csv", *maps, folder=place)
    assert found.returncode == 2 and found.stderr.count("\n") == 1
    assert re.search(told, found.stderr), found.stderr


def test_records_that_never_meet(place: Path) -> None:
    record = motionfmu.record(place / "drive.csv")
    with pytest.raises(InputError, match="do not overlap"):
        compare_record(record, record.shifted(10.0), {"X": "X"})
