"""A scenario's system as one FMU file gives the bits of a run in other importers."""

import sys
import zipfile
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from conftest import ROOT
from fmpy import read_model_description, simulate_fmu
from fmu_manipulation_toolbox.container import FMUContainer

import motionfmu
from motionfmu import cli
from motionfmu.export import as_ssp
from motionfmu.export.system_fmu import as_fmu as export
from motionfmu.export.system_fmu import identifier
from motionfmu.run.engines.slave import Slave

STOP, STEP = 0.3, 1e-4  # [s]
SHOWN = "card.pulse_count", "machine.table_position", "mcc.irq_latency"


@pytest.fixture(scope="module")
def demo() -> motionfmu.Scenario:
    return motionfmu.load(ROOT / "scenarios/circle")


@pytest.fixture(scope="module")
def run(demo: motionfmu.Scenario) -> motionfmu.Result:
    return demo.run(stop=STOP, set={"mcc.p_gain": 150})


@pytest.fixture(scope="module", params=[2, 3])
def made(
    request: Any, demo: motionfmu.Scenario, tmp_path_factory: pytest.TempPathFactory
) -> tuple[int, Path]:
    """The demo with another gain, as a file of each version."""
    file = tmp_path_factory.mktemp("export") / f"circle{request.param}.fmu"
    assert export(demo, file, request.param, {"mcc.p_gain": 150}) > 100
    return request.param, file


def signals(run: motionfmu.Result) -> dict[str, Any]:
    names = [n for n, x in run.signals.items() if x.dtype == np.float64 or x.dtype == np.int32]
    return {n: run[n] for n in names}


def test_fmpy_finds_the_bits_of_a_run(made: tuple[int, Path], run: motionfmu.Result) -> None:
    fmi, file = made
    wanted = signals(run)
    columns = {
        f"{n}[{k + 1}]" if x.ndim == 2 else n: x[:, k] if x.ndim == 2 else x
        for n, x in wanted.items()
        for k in range(x.shape[1] if x.ndim == 2 else 1)
    }
    names = list(columns) if fmi == 2 else list(wanted)
    found = simulate_fmu(
        str(file), stop_time=STOP, step_size=STEP, output_interval=STEP, output=names
    )
    expected = columns if fmi == 2 else wanted
    assert len(found) == len(run.time) + 1 and len(names) > 10
    for name in names:
        assert found[name][:-1].tobytes() == np.ascontiguousarray(expected[name]).tobytes(), name
    assert np.ptp(run["card.pulse_count"]) > 100


def test_the_container_toolbox_finds_the_bits_of_a_run(
    made: tuple[int, Path], run: motionfmu.Result, tmp_path: Path
) -> None:
    """Its master is C of its own; an FMU inside it is one among others."""
    fmi, file = made

    class Folder(FMUContainer):
        def make_fmu_package(self, base_directory: Path, fmu_filename: Path) -> None:
            """It stays a folder."""

    box = Folder("box", tmp_path, fmi_version=fmi)
    box.get_fmu(str(file), name="one.fmu")
    last = {}
    for name, x in signals(run).items():
        names = [name] if fmi == 3 or x.ndim == 1 else [f"{name}[{k + 1}]" for k in range(6)]
        if x.ndim == 1 or x.shape[1] == 6:
            last[name] = x
            for one in names:
                box.add_output("one.fmu", one, one)
    box.make_fmu("box.fmu", step_size=STEP, debug=True)
    slave = Slave("box", tmp_path / "box", fmi, [])
    try:
        slave.initialize()
        slave.start()
        slave.step(0.0, STOP - STEP)
        for name, x in last.items():
            kind = "Float64" if x.dtype == np.float64 else "Int32"
            values = slave.buffer(kind, x[-1].size)
            several = [f"{name}[{k + 1}]" for k in range(6)] if fmi == 2 and x.ndim == 2 else [name]
            first, *further = (slave.references[n] for n in several)
            slave.access("Get", kind, first, values, *further)()
            assert np.array(values).tobytes() == x[-1].tobytes(), name
    finally:
        slave.free()


def test_it_has_values_files_units_and_what_is_open(made: tuple[int, Path]) -> None:
    fmi, file = made
    description = read_model_description(str(file), validate=True)
    variables = {v.name: v for v in description.modelVariables}
    gain = variables["mcc.p_gain" if fmi == 3 else "mcc.p_gain[1]"]
    assert str(gain.start).split()[0] == "150" and gain.causality == "parameter"
    assert variables["mcc.path_feed"].unit == "mm/s"
    assert variables["mcc.hold"].causality == "input"
    assert variables["mcc.program"].start == "resource:circle.ngc"
    own = [v for n, v in variables.items() if n.startswith(("system.", "recorder.", "until."))]
    assert len(own) >= 5 and len({v.description for v in own} - {None, ""}) == len(own)
    with zipfile.ZipFile(file) as archive:
        program = archive.read("resources/circle.ngc")
        assert program == (ROOT / "scenarios/circle/circle.ngc").read_bytes()
        assert {"documentation/licenses/license.txt", "documentation/README.md"} <= set(
            archive.namelist()
        )
        assert not [n for n in archive.namelist() if n.startswith("sources/")]


def test_the_command_writes_a_whole_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.chdir(tmp_path)
    command = ["motionfmu", "export", str(ROOT / "scenarios/mismatch_line")]
    monkeypatch.setattr(sys, "argv", command)
    cli.main()
    assert capsys.readouterr().out.startswith("mismatch_line.fmu: FMI 3, ")
    assert [p.name for p in tmp_path.iterdir()] == ["mismatch_line.fmu"]
    monkeypatch.setattr(sys, "argv", [*command, "-o", "none/x.fmu"])
    with pytest.raises(SystemExit) as ended:
        cli.main()
    assert ended.value.code == 2
    assert "cannot write none/x.fmu: No such file" in capsys.readouterr().err


def test_a_scenarios_name_is_an_identifier() -> None:
    names = {"two_cards": "TwoCards", "a b-c": "ABC", "3d": "System3d", "ä": "System"}
    assert {name: identifier(name) for name in names} == names


def test_without_a_compiler_the_way_that_needs_none_is_told(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(sys.modules["motionfmu.fused.fused_program"], "compiler", lambda: None)
    demo = motionfmu.load(ROOT / "scenarios/circle")
    with pytest.raises(motionfmu.InputError, match=r"be one FMU: .* an SSP needs none"):
        export(demo, tmp_path / "x.fmu", 3, {})
    as_ssp(demo, tmp_path / "x.ssp", 3, {})
    assert [f.name for f in tmp_path.iterdir()] == ["x.ssp"]
