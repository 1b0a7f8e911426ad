"""The build takes its own sources, whatever `motionfmu` the environment has."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

from conftest import ROOT

MARK = "/* made by the second checkout */\n"
FINDER = """
import importlib.util, sys
class First:
    @staticmethod
    def find_spec(name, path=None, target=None):
        if name == "motionfmu":
            return importlib.util.spec_from_file_location(
                name, {package!r} + "/__init__.py", submodule_search_locations=[{package!r}])
sys.meta_path.insert(0, First)
"""


def test_a_second_checkout_builds_its_own_sources(tmp_path: Path) -> None:
    """Its environment has the package of this one, by a finder as editable installs have."""
    second = tmp_path / "second"
    for part in ("src", "cmake", "fmus/scope"):
        shutil.copytree(ROOT / part, second / part, ignore=shutil.ignore_patterns("__pycache__"))
    for file in ("CMakeLists.txt", "pyproject.toml", "LICENSE"):
        shutil.copy(ROOT / file, second)
    tables = second / "src/motionfmu/fmu/ctables.py"
    text = tables.read_text()
    assert text.count("def header(") == 1
    tables.write_text(
        text + f"\n_own = header\n\n\ndef header(d):\n    return {MARK!r} + _own(d)\n"
    )
    site = tmp_path / "site"
    site.mkdir()
    (site / "sitecustomize.py").write_text(FINDER.format(package=str(ROOT / "src/motionfmu")))
    python = tmp_path / "python"
    # The finder comes in however the build sets PYTHONPATH.
    python.write_text(f'#!/bin/sh\nPYTHONPATH="{site}:$PYTHONPATH" exec {sys.executable} "$@"\n')
    python.chmod(0o755)
    build = second / "build"
    # cmake and ninja are those of the environment
    tools = os.environ | {"PATH": f"{Path(sys.executable).parent}:{os.environ['PATH']}"}
    options = [f"-DPython_EXECUTABLE={python}", "-DMOTIONFMU_TESTS=OFF", "-G", "Ninja"]
    for line in (
        ["cmake", "-S", second, "-B", build, *options],
        ["cmake", "--build", build, "--target", "scope_generated"],
    ):
        done = subprocess.run(line, capture_output=True, text=True, env=tools)
        assert done.returncode == 0, done.stdout + done.stderr
    assert (build / "gen/scope/vars.h").read_text().startswith(MARK)
