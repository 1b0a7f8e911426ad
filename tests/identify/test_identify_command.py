"""The command: what it prints, writes and returns, on a machine of the package."""

from pathlib import Path

import numpy as np
import pytest
from page_outline import shows_what_is_kept
from typer.testing import CliRunner

import motionfmu
from motionfmu.cli import app
from motionfmu.identify import identify_file
from motionfmu.identify.ground import IdentifyOptions
from motionfmu.identify.recorded_loop import ColumnUse

PERIOD, STOP = 1e-3, 1.5  # [s]


@pytest.fixture(scope="module")
def trace(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A trace of the X axis of xy_table, driven by a voltage: its table weighs 100 kg."""
    time = np.arange(0.0, STOP, PERIOD)
    volt = np.round(1.5 * np.sin(2 * np.pi * 2.0 * time) + 0.8 * np.sin(2 * np.pi * 9.0 * time), 4)
    ran = (
        motionfmu.machine("xy_table")
        .plan()
        .changed(
            connect={"drives.dac": None},
            drive=[
                {
                    "input": "drives.dac",
                    "at": [round(t, 6) for t in time.tolist()],
                    "value": [[v, 0.0, 0.0, 0.0, 0.0, 0.0] for v in volt.tolist()],
                }
            ],
            record={"every": 1, "signals": ["drives.torque", "machine.motor_phase"]},
            stop=STOP,
            check={},
        )
        .run()
    )
    rows = np.arange(len(time)) * round(PERIOD / 1e-4)
    names = ("drives.torque", "machine.motor_phase")
    torque, phase = (np.asarray(ran[n])[:, 0][rows] for n in names)
    file = tmp_path_factory.mktemp("trace") / "trace.csv"
    lines = ["time [s],volt [V],torque [N.m],phase [1]"]
    lines += [
        f"{t:.3f},{v:.4f},{m:.5f},{p:.4f}"
        for t, v, m, p in zip(time, volt, torque, phase, strict=True)
    ]
    file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return file


def run(trace: Path, *more: object):
    columns = ("volt=drives.dac", "torque=drives.torque", "phase=machine.motor_phase")
    asked = [x for c in columns for x in ("--column", c)]
    line = ["identify", "xy_table", "--record", str(trace), *asked, *map(str, more)]
    return CliRunner().invoke(app, line)


@pytest.mark.more
def test_a_machines_name_is_enough(trace: Path, tmp_path: Path) -> None:
    done = run(trace, "--law", "offset", "--out", tmp_path / "out")
    assert done.exit_code == 0, done.output
    assert "machine.table_mass" in done.output
    shows_what_is_kept("identified", (tmp_path / "out/report.html").read_text())
    text = (tmp_path / "out/found.toml").read_text()
    mass = next(line for line in text.splitlines() if line.startswith('"machine.table_mass[1]"'))
    assert float(mass.partition("=")[2]) == pytest.approx(100.0, rel=0.02)


@pytest.mark.parametrize(
    ("more", "told"),
    [
        (["--column", "amps=drives.speed"], "no column 'amps'"),
        (["--column", "amps"], "--column amps: COLUMN=COMP.VAR"),
        (["--column", "torque=drives.torque*much"], "'much' is no number"),
        (
            ["--column", "torque=drives.turque"],
            "drives.turque: drives has no such signal; did you mean 'torque'?",
        ),
        (["--axis", 9], "axis"),
        (["--free", "table_masss"], "table_mass"),
        (["--fix", "table_masss"], "table_mass"),
        (["--law", "ofset"], "offset"),
    ],
)
def test_what_is_wrong_is_told_and_nothing_is_written(
    trace: Path, tmp_path: Path, more: list[object], told: str
) -> None:
    done = run(trace, *more, "--out", tmp_path / "out")
    assert done.exit_code != 0
    assert isinstance(done.exception, motionfmu.InputError), done.exception
    assert told in str(done.exception)
    assert not (tmp_path / "out").exists()


def test_a_file_of_columns_alone_asks_for_the_defaults() -> None:
    asked = identify_file.options({"columns": {"volt": "drives.dac"}}, "identify.toml")
    assert asked == IdentifyOptions({"volt": ColumnUse("drives.dac")}, fix=[])
    more = {"axis": 2, "free": ["a"], "fix": ["b"], "laws": [], "keep": 0.2, "controller": False}
    asked = identify_file.options({"columns": {"volt": "drives.dac"}, **more}, "identify.toml")
    assert {k: getattr(asked, k) for k in more} == more


def test_a_column_of_the_command_line_takes_the_place_of_the_files_of_that_signal() -> None:
    file = {"axis": 2, "columns": {"drives.torque[1]": "drives.torque", "x": {"signal": "m.x"}}}
    tables = identify_file.with_columns(file, ["Iq-Ist=drives.torque*0.56"])
    uses = identify_file.options(tables, "identify.toml").columns
    assert {n: (u.signal, u.scale) for n, u in uses.items()} == {
        "x": ("m.x", None),
        "Iq-Ist": ("drives.torque", 0.56),
    }
    assert tables["axis"] == 2
    with pytest.raises(motionfmu.InputError, match="two columns are that signal"):
        identify_file.options(identify_file.with_columns({}, ["a=m.x", "b=m.x"]), "--column")
