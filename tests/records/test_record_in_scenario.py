"""A record in a scenario: it drives inputs, lies over signals, its numbers are checked."""

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from console import within

import motionfmu
from motionfmu.base.errors import InputError
from motionfmu.records import Record

STEP = 1e-4
TIME = np.arange(5001) * 1e-4  # [s]
TORQUE = np.round(1.5 * np.sin(2 * np.pi * (3 * TIME + 10 * TIME**2)), 6)


def table(**record_file: Any) -> dict[str, Any]:
    return {
        "stop": 0.5,
        "step": STEP,
        "component": {"machine": "ball_screw_axes"},
        "set": {"machine.active": [True, True, False, False, False, False]},
        "leave": ["machine.force", "machine.torque_command"],
        "record": {"signals": ["machine.table_position", "machine.motor_torque"]},
        "record_file": record_file,
    }


def trace(folder: Path, every: int = 1, name: str = "trace.csv", unit: str = "N.m") -> Path:
    """A trace of the torque, one of so many steps."""
    record = Record(
        "trace",
        np.round(TIME[::every] * 1e9).astype(np.int64),
        {"torque": TORQUE[::every], "on": np.ones(len(TIME[::every]))},
        {"torque": unit, "on": None},
    )
    return record.save(folder / name)


def run(folder: Path, tables: dict[str, Any], **options: Any) -> motionfmu.Result:
    return motionfmu.scenario(tables, name="test", folder=folder).run(**options)


def test_a_record_drives_an_input_as_steps_do_in_every_engine(tmp_path: Path) -> None:
    trace(tmp_path)
    drive = {"machine.torque_command[2]": "torque"}
    given = table(file="trace.csv", drive=drive) | {"leave": ["machine.force"], "stop": 0.1}
    wanted = dict(given) | {
        "drive": [
            {
                "input": "machine.torque_command",
                "at": [round(k * 1e-4, 9) for k in range(1000)],
                "value": [[0.0, float(x), 0.0, 0.0, 0.0, 0.0] for x in TORQUE[:1000]],
            }
        ]
    }
    del wanted["record_file"]
    steps = run(tmp_path, wanted)
    moved = steps["machine.table_position[2]"]
    assert np.ptp(moved) > 1e-5 and np.ptp(steps["machine.table_position[1]"]) == 0.0
    for engine in ("fused", "native", "python", "fmpy"):
        for fmi in (2, 3):
            found = run(tmp_path, given, engine=engine, fmi=fmi)
            for name in steps:
                assert found[name].tobytes() == steps[name].tobytes(), (engine, fmi)


@pytest.mark.parametrize(("how", "error"), [("linear", 6e-3), ("hold", 0.25)])
def test_between_samples_the_input_is_as_asked(how: str, error: float, tmp_path: Path) -> None:
    trace(tmp_path, 20, unit="mN.m")
    drive = {"machine.torque_command[1]": "torque"}
    columns = {"torque": {"column": "torque", "scale": 1000, "unit": "mNm"}}
    given = table(file="trace.csv", drive=drive, resample=how, columns=columns)
    ideal = {"machine.current_time": 0.0, **given["set"]}
    found = run(tmp_path, given | {"leave": ["machine.force"], "set": ideal})
    torque = found["machine.motor_torque[1]"][1:]  # at the end of the step
    if how == "hold":
        np.testing.assert_allclose(torque, np.repeat(TORQUE[::20], 20)[:4999], rtol=1e-12)
    else:
        between = np.interp(TIME, TIME[::20], TORQUE[::20])[:4999]
        np.testing.assert_allclose(torque, between, rtol=1e-9, atol=1e-12)
    assert np.abs(torque - TORQUE[:4999]).max() < error


def test_a_record_over_a_run_has_its_numbers(tmp_path: Path) -> None:
    trace(tmp_path)
    drive = {"machine.torque_command[1]": "torque"}
    given = table(file="trace.csv", drive=drive) | {"leave": ["machine.force"]}
    first = run(tmp_path, given)
    position = first["machine.table_position[1]"]
    late = np.interp(first.time - 2.3e-3, first.time, position) * 1e3 * 1.01
    columns = {"torque": TORQUE[:5000], "x": late}
    ns = np.round(first.time * 1e9).astype(np.int64)
    units = {"torque": "N.m", "x": "mm"}
    Record("measured", ns, columns, units).save(tmp_path / "measured.parquet")
    over = {"machine.table_position[1]": "x", "machine.motor_torque[1]": "torque"}
    again = table(file="measured.parquet", drive=drive, over=over) | {
        "leave": ["machine.force"],
        "check": {
            "record.x.nrmse": {"max": 0.5},
            "record.machine.table_position[1].lag": {"min": -0.0024, "max": -0.0022},
            "record.torque.max": {"absmax": 1e-9},
        },
    }
    result = run(tmp_path, again)
    numbers = result.record_matches().numbers()["machine.table_position[1]"]
    off = position - late * 1e-3
    assert numbers["nrmse"] == pytest.approx(np.linalg.norm(off) / np.linalg.norm(late * 1e-3))
    assert numbers["lag"] == pytest.approx(-2.3e-3, abs=2e-5)  # the run comes before the record
    assert numbers["unit"] == "m" and numbers["column"] == "x"
    # The current loop's lag: of 0.5 ms.
    lag = result.record_matches().numbers()["machine.motor_torque[1]"]["lag"]
    assert 4e-4 < lag < 7e-4
    assert [v.ok for v in result.checks] == [True, True, True, False]
    page = result.save(tmp_path / "result")
    made = json.loads((page.parent / "result.json").read_text())
    assert made["record"]["machine.table_position[1]"]["nrmse"] == numbers["nrmse"]
    assert made["run"]["record"]["file"] == "measured.parquet"
    assert "Record over run" in page.read_text()


def test_a_result_is_a_record(tmp_path: Path) -> None:
    trace(tmp_path)
    drive = {"machine.torque_command[1]": "torque"}
    result = run(tmp_path, table(file="trace.csv", drive=drive) | {"leave": ["machine.force"]})
    own = motionfmu.record(result)
    assert own.units["machine.table_position"] == "m"
    result.save(tmp_path / "result", csv=True)
    kept = motionfmu.record(tmp_path / "result")
    text = motionfmu.record(tmp_path / "result/signals.csv")
    for other in (kept, text):
        assert np.array_equal(other.ns, own.ns)
        for name in own:
            assert np.array_equal(other[name], own[name])
    # It drives the next run: its torque, the machine's own, through the folder of the result.
    names = {"torque": "machine.motor_torque[1]"}
    given = table(file="result", columns=names, drive=drive) | {"leave": ["machine.force"]}
    again = run(tmp_path, given)
    assert np.ptp(again["machine.table_position[1]"]) > 1e-5


def test_a_contrary_and_a_sweep_see_the_record(tmp_path: Path) -> None:
    trace(tmp_path)
    drive = {"machine.torque_command": "torque"}
    Record(
        "six",
        np.round(TIME * 1e9).astype(np.int64),
        {"torque": np.outer(TORQUE, [1, 0, 0, 0, 0, 0])},
        {"torque": "N.m"},
    ).save(tmp_path / "six.csv")
    given = table(file="six.csv", drive=drive) | {
        "leave": ["machine.force"],
        "check": {"machine.motor_torque[1]": {"peak": [1.0, 2.0]}},
        "contrary": {
            "no torque": {
                "set": {"machine.torque_command": 0.0},
                "fails": ["machine.motor_torque[1]"],
            }
        },
    }
    scenario = motionfmu.scenario(given, name="test", folder=tmp_path)
    assert scenario.run().ok
    still = scenario.run(set={"machine.torque_command": 0.0}, undriven={"machine.torque_command"})
    assert not still.ok
    assert still.overrides == ["machine.torque_command: its record is left out"]


WRONG: list[tuple[dict[str, Any], str]] = [
    ({"file": "none.csv"}, "<test>:[record_file] file: file = 'none.csv': no such record"),
    ({"delimiter": "::"}, "<test>:[record_file]: delimiter = '::': one character wanted"),
    (
        {"over": {"machine.table_position[1]": "torqe"}},
        "<test>:[record_file.over] machine.table_position[1]: FOLDER/trace.csv: no column 'torqe'"
        "; did you mean 'torque'?",
    ),
    (
        {"over": {"machine.table_position[1]": "torque"}},
        "<test>:[record_file.over] machine.table_position[1]: FOLDER/trace.csv: torque is in"
        " [N·m], [m] wanted",
    ),
    (
        {"over": {"machine.motor_torque": "torque"}},
        "<test>:[record_file.over] machine.motor_torque: torque has 1 elements,"
        " machine.motor_torque has 6",
    ),
    (
        {"over": {"machine.table_positon[1]": "torque"}},
        "<test>:[record_file.over] machine.table_positon[1]: machine.table_positon:"
        " ball_screw_axes has no variable 'table_positon'; did you mean 'table_position'?",
    ),
    (
        {"drive": {"machine.table_position": "torque"}},
        "<test>:[record_file.drive] machine.table_position: machine.table_position is no input"
        " (output)",
    ),
    (
        {"drive": {"machine.force[1]": "torque"}},
        "<test>:[record_file.drive] machine.force[1]: FOLDER/trace.csv: torque is in [N·m], [N]"
        " wanted",
    ),
    (
        {"drive": {"machine.torque_command[7]": "torque"}},
        "<test>:[record_file.drive] machine.torque_command[7]: machine.torque_command[7]: no such"
        " element",
    ),
    (
        {"drive": {"machine.torque_command[1]": "torque"}, "offset": 0.1},
        "<test>:[record_file.drive] machine.torque_command[1]: machine.torque_command[1]:"
        " FOLDER/trace.csv has 0.1 to 0.6 s, the run has steps from 0 to 0.4999 s",
    ),
    (
        {"drive": {"machine.torque_command[1]": "torque"}, "offset": -0.1},
        "<test>:[record_file.drive] machine.torque_command[1]: machine.torque_command[1]:"
        " FOLDER/trace.csv has -0.1 to 0.4 s, the run has steps from 0 to 0.4999 s",
    ),
]


@pytest.mark.parametrize(("change", "told"), WRONG)
def test_a_wrong_table_has_its_message(change: dict[str, Any], told: str, tmp_path: Path) -> None:
    trace(tmp_path)
    given = table(**({"file": "trace.csv"} | change))
    with pytest.raises(InputError) as error:
        run(tmp_path, given)
    assert error.value.args[0] == told.replace("FOLDER", str(tmp_path))


@pytest.mark.parametrize(
    ("old", "new", "told"),
    [
        ("1.5", "", ":4:5: u has no value, which drives machine.torque_command[1]"),
        ("0.0002,", "0.3,", ": no samples from 0.0001 to 0.3 s, which drive"),
    ],
)
def test_a_gap_is_refused_unless_it_is_to_be_bridged(
    old: str, new: str, told: str, tmp_path: Path
) -> None:
    rows = "".join(f"{k * 1e-4:.4f},{1.5 if k == 2 else 1.0}\n" for k in range(5001))
    (tmp_path / "a.csv").write_text("t [s],u [N.m]\n" + rows.replace(old, new))
    given = table(file="a.csv", drive={"machine.torque_command[1]": "u"})
    if new == "0.3,":
        text = "t [s],u [N.m]\n" + "".join(
            f"{k * 1e-4:.4f},1.0\n" for k in range(5001) if k < 2 or k > 2999
        )
        (tmp_path / "a.csv").write_text(text)
    with pytest.raises(InputError) as error:
        run(tmp_path, given | {"leave": ["machine.force"]})
    assert told.partition(": ")[2] in str(error.value)
    assert 'gaps = "interpolate" bridges it' in str(error.value)
    given["record_file"]["gaps"] = "interpolate"
    found = run(tmp_path, given | {"leave": ["machine.force"]})
    assert found["machine.motor_torque[1]"][-1] == pytest.approx(1.0)


def test_numbers_that_no_run_has_are_refused(tmp_path: Path) -> None:
    trace(tmp_path)
    given = table(file="trace.csv", over={"machine.motor_torque[1]": "torque"})
    for name, told in (
        ("record.torque.nrms", "no number 'nrms'; did you mean 'nrmse'?"),
        ("record.torqe.nrmse", "nothing lies over 'torqe'; did you mean 'torque'?"),
    ):
        with pytest.raises(InputError, match=told.replace("?", r"\?")):
            run(tmp_path, given | {"check": {name: {"max": 1.0}}})
    del given["record_file"]
    with pytest.raises(InputError, match=r"there is no \[record_file\] table"):
        run(tmp_path, given | {"check": {"record.torque.nrmse": {"max": 1.0}}})


def test_a_machine_has_a_record_and_its_copies_have_it_too(tmp_path: Path) -> None:
    """A machine.toml names it beside itself; `new machine` and `run --save-as` copy the file."""
    place = tmp_path / "machines/traced"
    place.mkdir(parents=True)
    record = Record(
        "trace",
        np.arange(0, 40_000_000_000, 10_000_000),
        {"feed": np.linspace(0.0, 1.0, 4000)},
        {"feed": "mm/s"},
    )
    record.save(place / "feed.csv")
    (place / "machine.toml").write_text(
        '# The table with a trace.\nextends = "xy_table"\n[record_file]\nfile = "feed.csv"\n'
        'over = { "mcc.path_feed" = "feed" }\n'
    )
    (tmp_path / "part.ngc").write_text("G21 G90 G0 X0 Y0\nG1 X5 F3000\nM30\n")
    machine = motionfmu.machine(place)
    found = machine.run(tmp_path / "part.ngc").record_matches().numbers()
    assert found["mcc.path_feed"]["column"] == "feed" and found["mcc.path_feed"]["samples"] > 10
    told = within("new", "machine", "mine", "--like", place, folder=tmp_path)
    assert told.returncode == 0, told.stderr
    copied = motionfmu.machine(tmp_path / "machines/mine").run(tmp_path / "part.ngc")
    assert copied.record_matches().numbers() == found
    trace(tmp_path)
    over = {"file": str(tmp_path / "trace.csv"), "over": {"drives.torque[1]": "torque"}}
    scenario = machine.scenario(tmp_path / "part.ngc", record_file=over)
    from motionfmu.run.run_plan import Options
    from motionfmu.run.saved_scenario import save_scenario

    save_scenario(scenario, tmp_path / "saved", Options())
    saved = motionfmu.load(tmp_path / "saved").run()
    assert "drives.torque[1]" in saved.record_matches().found


def test_an_export_says_what_it_does_not_carry(tmp_path: Path) -> None:
    """One FMU leaves the driven input open; an SSP has room for few steps and says so."""
    trace(tmp_path)
    drive = {"machine.torque_command[1]": "torque"}
    given = table(file="trace.csv", drive=drive) | {"leave": ["machine.force"]}
    scenario = motionfmu.scenario(given, name="test", folder=tmp_path)
    from motionfmu.export.system_ssp import as_ssp

    written = as_ssp(scenario, tmp_path / "a.ssp", 3, {})
    assert len(written.left_out) == 1
    assert written.left_out[0].startswith("[record_file] machine.torque_command: ")
