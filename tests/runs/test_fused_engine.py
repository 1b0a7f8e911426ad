"""The fused engine where it cannot run, and what is told of it."""

import os
import re
import shutil
import signal
import subprocess
import sys
import time
import zipfile
from pathlib import Path

import pytest
from conftest import FMUS, ROOT

import motionfmu
import motionfmu.fused
from motionfmu import cli
from motionfmu.base import compiler
from motionfmu.base.compiler import Compiler

STOP = 0.01  # [s]


@pytest.fixture
def line() -> motionfmu.Scenario:
    return motionfmu.load(ROOT / "scenarios/mismatch_line")


def ran(scenario: motionfmu.Scenario, engine: str | None = None) -> motionfmu.Result:
    return scenario.run(engine=engine, stop=STOP)


def use(monkeypatch: pytest.MonkeyPatch, cache: Path, cc: Compiler | None) -> None:
    """This compiler, and nothing kept."""
    monkeypatch.setenv("MOTIONFMU_CACHE", str(cache))
    monkeypatch.setattr(sys.modules["motionfmu.fused.fused_program"], "compiler", lambda: cc)


def test_without_a_compiler_the_container_runs(
    line: motionfmu.Scenario, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    use(monkeypatch, tmp_path, None)
    result = ran(line)
    assert result.options["engine"] == "native"
    told = "there is no C compiler (gcc, clang; or pip install"
    (once,) = result.warnings
    assert once.startswith(f"engine native instead of fused: {told}")
    with pytest.raises(motionfmu.InputError, match=re.escape(f"engine fused: {told}")):
        ran(line, "fused")


def test_a_compile_that_fails_is_told_and_the_container_runs(
    line: motionfmu.Scenario, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    bad = tmp_path / "bad"
    bad.write_text(
        "#!/bin/sh\necho note >&2\nfor i in 1 2 3 4; do echo a.c:$i: error: x >&2; done\nexit 1\n"
    )
    bad.chmod(0o755)
    use(monkeypatch, tmp_path / "cache", Compiler((str(bad),), "bad 1"))
    told = f"{bad} failed: a.c:1: error: x; a.c:2: error: x; a.c:3: error: x (CC names another"
    result = ran(line)
    assert result.options["engine"] == "native" and len(result.warnings) == 1
    assert result.warnings[0].startswith(f"engine native instead of fused: {told}")
    with pytest.raises(motionfmu.InputError) as caught:
        ran(line, "fused")
    assert told in str(caught.value) and "\n" not in str(caught.value)
    assert list((tmp_path / "cache/fused").iterdir()) == []


def test_a_place_that_cannot_be_written_to_serves_the_process(
    line: motionfmu.Scenario, monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    (tmp_path / "file").write_text("")
    use(monkeypatch, tmp_path / "file", compiler.compiler())
    for _ in range(2):
        assert ran(line).options["engine"] == "fused"


def test_an_fmu_that_is_built_again_makes_another_program(
    monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    fmus = tmp_path / "fmus"
    fmus.mkdir()
    for file in FMUS.glob("*.fmu"):
        (fmus / file.name).symlink_to(file)
    monkeypatch.setenv("MOTIONFMU_FMUS", str(fmus))
    use(monkeypatch, tmp_path / "cache", compiler.compiler())
    scenario = motionfmu.load(ROOT / "scenarios/mismatch_line")
    one = ran(scenario)
    kept = tmp_path / "cache/fused"
    assert len(list(kept.iterdir())) == 1
    ran(scenario)
    assert len(list(kept.iterdir())) == 1
    other = fmus / "velocity_axes.fmi3.fmu"
    other.unlink()
    shutil.copy(FMUS / other.name, other)
    with zipfile.ZipFile(other, "a") as archive:
        archive.writestr("documentation/new.txt", "built again")
    again = ran(scenario)
    assert len(list(kept.iterdir())) == 2
    assert all(again[n].tobytes() == one[n].tobytes() for n in one.signals)


def test_a_variable_names_the_usual_engine(
    line: motionfmu.Scenario, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("MOTIONFMU_ENGINE", "native")
    assert ran(line).options["engine"] == "native"
    assert ran(line, "fused").options["engine"] == "fused"
    monkeypatch.setenv("MOTIONFMU_ENGINE", "natve")
    told = r"MOTIONFMU_ENGINE: no engine 'natve' \(there are: fused, .*did you mean 'native'\?"
    with pytest.raises(motionfmu.InputError, match=told):
        ran(line)


def test_info_says_which_engine_runs(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.setattr(sys, "argv", ["motionfmu", "info", str(ROOT / "scenarios/mismatch_line")])
    cli.main()
    assert "\nengine: fused\n" in capsys.readouterr().out
    monkeypatch.setattr("motionfmu.run.engines.there", lambda: False)
    cli.main()
    assert "\nengine: native (there is no C compiler)\n" in capsys.readouterr().out
    monkeypatch.setenv("MOTIONFMU_ENGINE", "python")
    cli.main()
    assert "\nengine: python (MOTIONFMU_ENGINE)\n" in capsys.readouterr().out


def test_what_an_fmu_refuses_has_the_words_of_the_container(line: motionfmu.Scenario) -> None:
    for given in ({"mcc.acc_type": "Q"}, {"mcc.program": "/none"}, {"mcc.comp_file": "/none"}):
        told = []
        for engine in ("fused", "native", "python", "fmpy"):
            with pytest.raises(motionfmu.InputError) as caught:
                line.run(engine=engine, stop=STOP, set=given)
            told.append(str(caught.value).replace(", fmi3ExitInitializationMode", ""))
        assert told == [told[0]] * 4 and "mcc: " in told[0]


def test_an_interrupt_ends_a_run_within_a_fraction_of_a_second(tmp_path: Path) -> None:
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src"), "TMPDIR": str(tmp_path)}
    code = (
        "import motionfmu, signal\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        f"s = motionfmu.load({str(ROOT / 'scenarios/circle')!r})\n"
        "print('now', flush=True)\n"
        "try: s.run(engine='fused', stop=2000.0, progress=lambda share: print('on', flush=True))\n"
        "except KeyboardInterrupt: print('stopped', flush=True)\n"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", code], stdout=subprocess.PIPE, text=True, env=environment
    )
    assert process.stdout is not None
    lines = [process.stdout.readline(), process.stdout.readline()]
    assert lines == ["now\n", "on\n"]
    begin = time.process_time()
    os.kill(process.pid, signal.SIGINT)
    rest = process.stdout.read().split()
    assert process.wait(20) == 0 and rest[-1] == "stopped" and rest.count("on") <= 3
    assert time.process_time() - begin < 5 and list(tmp_path.iterdir()) == []
