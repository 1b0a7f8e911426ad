"""What a command imports: what it does not use would take longer than its work."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT

PROGRAM = (
    "import atexit, sys; atexit.register(lambda: print(*sys.modules));"
    "from motionfmu.cli import main; main()"
)
# Each takes from 0.03 to 1 s of processor time to import.
LARGE = {"numpy", "scipy", "casadi", "fmpy", "lxml", "rich", "asyncio", "matplotlib", "plotly"}


def loaded(cache, *line: str) -> set[str]:
    """Modules that a command has imported when it ends."""
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *line],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=os.environ | {"MOTIONFMU_CACHE": str(cache)},
    )
    assert done.returncode in (0, 1), done.stderr  # 1: a check failed
    found = set(done.stdout.splitlines()[-1].split())
    assert "typer" in found
    return found


@pytest.mark.parametrize("line", ["--help", "list", "info mcc"])
def test_small_commands_load_no_large_package(tmp_path, line) -> None:
    assert not loaded(tmp_path, *line.split()) & LARGE


def test_gains_of_a_scenario_are_kept_for_the_next_command(tmp_path) -> None:
    first = loaded(tmp_path, "info", "scenarios/circle")
    assert "casadi" in first and not first & {"scipy", "fmpy", "matplotlib"}
    second = loaded(tmp_path, "info", "scenarios/circle")
    assert second & LARGE == {"numpy"}


def test_a_run_with_its_report_loads_nothing_that_draws(tmp_path) -> None:
    line = ("run", "scenarios/circle", "--stop", "0.4", "--out", str(tmp_path / "run"))
    found = loaded(tmp_path / "kept", *line)
    assert (tmp_path / "run/report.html").is_file()
    assert "motionfmu.report.page" in found and not found & {"matplotlib", "plotly", "rich"}
