"""What a command imports: what it does not use would take longer than its work."""

import os
import subprocess
import sys

import pytest
from conftest import ROOT

PROGRAM = "import sys; from motionfmu.cli import main; main(); print(*sys.modules)"
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
    assert done.returncode == 0, done.stderr
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
