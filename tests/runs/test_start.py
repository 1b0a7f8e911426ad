"""What a command imports: what it does not use would take longer than its work."""

import json
import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

PROGRAM = (
    "import atexit, sys; atexit.register(lambda: print(*sys.modules));"
    "from motionfmu.cli import main; main()"
)
# Each takes from 0.03 to 1 s of processor time to import.
LARGE = {"numpy", "scipy", "casadi", "fmpy", "lxml", "rich", "asyncio", "matplotlib", "plotly"}


def loaded(cache: Path | None, *line: str) -> set[str]:
    """Modules that a command has imported when it ends; it keeps things in a folder."""
    kept = {} if cache is None else {"MOTIONFMU_CACHE": str(cache)}
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, *line],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=os.environ | kept,
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
    # what checks and the engine are named by comes without what they are made by
    unused = {
        "motionfmu.analysis.contour.arcs",
        "motionfmu.fmu.pack",
        "motionfmu.analysis.linear.position_gain",
    }
    assert "motionfmu.analysis.contour.names" in second and not second & unused


def test_a_list_loads_its_own_module_and_no_pydantic(tmp_path) -> None:
    found = loaded(tmp_path, "list")
    assert "pydantic" not in found
    own = {"motionfmu.cli." + name for name in ("common", "console_text", "list")}
    assert {name for name in found if name.startswith("motionfmu.cli.")} == own


def test_a_command_loads_no_other(tmp_path) -> None:
    for line, own in (("info mcc", {"info"}), ("card plan --help", {"card", "card_plan"})):
        found = loaded(tmp_path, *line.split())
        assert {f"motionfmu.cli.{name}" for name in own} <= found
        assert ("motionfmu.cli.tune" in found) == (own != {"info"})


def test_a_run_with_its_report_loads_nothing_that_draws(tmp_path) -> None:
    # with what is kept already: a system that is compiled now would take seconds
    folder = tmp_path / "run"
    found = loaded(None, "run", "scenarios/circle", "--stop", "0.4", "--out", str(folder))
    assert "motionfmu.report.run_page" in found and (folder / "report.html").is_file()
    engine = json.loads((folder / "result.json").read_text())["options"]["engine"]
    used = {"numpy", "casadi"} | ({"fmpy", "lxml"} if engine != "fused" else set())
    assert found & (LARGE - used) == set()  # casadi: gains that are not kept yet
