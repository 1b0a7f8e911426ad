"""The build takes its own sources, whatever `motionfmu` the environment has."""

import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
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
    for part in ("src", "fmus/scope"):
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


@pytest.mark.parametrize(
    ("given", "told"),
    [
        ("PYTHON=./old", "is Python 3.9, 3.11 or newer is needed: make PYTHON=..."),
        ("PYTHON=./none", "There is no ./none: Python 3.11 or newer is needed, or make PYTHON=..."),
        ("CC=./none", "There is no C compiler ./none: install gcc, or make CC=..."),
    ],
)
def test_make_says_what_it_needs_before_it_makes_anything(
    given: str, told: str, tmp_path: Path
) -> None:
    for file in ("Makefile", "pyproject.toml"):
        shutil.copy(ROOT / file, tmp_path)
    old = "import sys; sys.version_info = (3, 9, 2)\n"
    (tmp_path / "sitecustomize.py").write_text(old)
    (tmp_path / "old").write_text(f'#!/bin/sh\nPYTHONPATH=. exec {sys.executable} "$@"\n')
    (tmp_path / "old").chmod(0o755)
    before = sorted(tmp_path.rglob("*"))
    done = subprocess.run(["make", "demo", given], cwd=tmp_path, capture_output=True, text=True)
    lines = done.stderr.splitlines()
    assert done.returncode == 2 and lines[0].endswith(told) and len(lines) == 2
    assert [p for p in sorted(tmp_path.rglob("*")) if "__pycache__" not in str(p)] == before
