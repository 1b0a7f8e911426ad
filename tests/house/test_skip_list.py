"""A skip that no line of tests/skips.toml names is an error, if that is asked for."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
import skip_list
from conftest import ROOT

TESTS = """
import pytest


def test_holds():
    pass


@pytest.mark.parametrize("name", ["[a]", "b"])
def test_runs(name):
    pytest.skip("there is no such program")


@pytest.mark.xdist_group("some")
@pytest.mark.skipif(True, reason="not made")
def test_made():
    pass


@pytest.mark.slow
def test_slow():
    pytest.skip("it is late")


@pytest.mark.xfail(reason="known")
def test_known():
    assert False
"""
INI = """[pytest]
addopts = -q -m "not slow"
testpaths = tests
markers = slow: not always
"""
BOTH = """
[[skip]]
tests = "tests/test_some.py::test_runs[*]"
why   = "the program is dear"

[[skip]]
tests = "tests/test_some.py::test_made"
why   = "so it is"
"""
UNLISTED = "skipped, and not in tests/skips.toml: an error"
STRANGER = "in tests/skips.toml, and no test has that name: an error"
IDLE = "in tests/skips.toml, and not skipped"
TWO = pytest.param(("-n", "2", "--dist", "loadgroup"), marks=pytest.mark.more, id="two")
WORKERS = pytest.mark.parametrize("workers", [pytest.param((), id="one"), TWO])


def run(
    folder: Path, listed: str, *options: str, asked: str = "listed"
) -> subprocess.CompletedProcess[str]:
    """A folder of tests, and what pytest says of it."""
    (folder / "tests").mkdir(exist_ok=True)
    (folder / "pytest.ini").write_text(INI)
    (folder / "tests/test_some.py").write_text(TESTS)
    (folder / "tests/conftest.py").write_text('pytest_plugins = ["skip_list"]\n')
    (folder / "tests/skips.toml").write_text(listed)
    own = {"MOTIONFMU_SKIPS": asked, "PYTHONPATH": str(ROOT / "tests/helpers")}
    line = [sys.executable, "-m", "pytest", "-p", "no:cacheprovider"]
    return subprocess.run(
        [*line, *options], cwd=folder, env=os.environ | own, capture_output=True, text=True
    )


def section(told: str, title: str) -> list[str]:
    """The rows below a title."""
    _, found, rest = told.partition(f" {title} ")
    rows = rest.split("\n")[1:] if found else []
    return rows[: next((k for k, row in enumerate(rows) if "::" not in row and ":" not in row), 0)]


@pytest.mark.more
@WORKERS
def test_a_skip_without_a_line_is_an_error(workers: tuple[str, ...], tmp_path: Path) -> None:
    done = run(tmp_path, BOTH.split("\n\n")[0], *workers)
    assert done.returncode == 1
    (row,) = section(done.stdout, UNLISTED)
    assert row.replace("@some", "") == "tests/test_some.py::test_made: not made"
    assert STRANGER not in done.stdout and IDLE not in done.stdout
    done = run(tmp_path, "", *workers)
    assert done.returncode == 1
    assert [row.replace("@some", "") for row in section(done.stdout, UNLISTED)] == [
        "tests/test_some.py::test_made: not made",
        "tests/test_some.py::test_runs[[a]]: there is no such program",
        "tests/test_some.py::test_runs[b]: there is no such program",
    ]


@WORKERS
def test_skips_with_a_line_are_none(workers: tuple[str, ...], tmp_path: Path) -> None:
    done = run(tmp_path, BOTH, *workers)
    assert done.returncode == 0, done.stdout
    assert "1 passed, 3 skipped" in done.stdout and "toml" not in done.stdout


@pytest.mark.more
def test_nothing_is_asked_of_a_person(tmp_path: Path) -> None:
    done = run(tmp_path, "", asked="")
    assert done.returncode == 0 and "toml" not in done.stdout
    done = run(tmp_path, "skip = 3", asked="all")
    assert done.returncode == 4 and "it is `listed`, or is not set" in done.stderr
    done = run(tmp_path, "skip = 3")
    assert done.returncode == 4 and "a line is a table [[skip]]" in done.stderr


@pytest.mark.more
def test_a_skip_is_an_error_while_what_it_needs_is_there(tmp_path: Path) -> None:
    for programs, status in (('["no-such", "sh"]', 1), ('["no-such", "nor-this"]', 0)):
        done = run(tmp_path, f"{BOTH}unless = {programs}\n")
        assert done.returncode == status
        assert ("test_made: not made" in done.stdout) == bool(status)


@pytest.mark.more
@WORKERS
def test_lines_without_a_skip_are_told_after_a_whole_run(
    workers: tuple[str, ...], tmp_path: Path
) -> None:
    more = "".join(
        f'[[skip]]\ntests = "tests/test_some.py::{name}"\nwhy = "once"\n'
        for name in ("test_holds", "test_gone", "test_slow")
    )
    done = run(tmp_path, BOTH + more, *workers)
    assert done.returncode == 1
    assert section(done.stdout, STRANGER) == ["tests/test_some.py::test_gone"]
    assert section(done.stdout, IDLE) == ["tests/test_some.py::test_holds"]
    for few in (("-k", "holds"), ("tests/test_some.py",)):
        done = run(tmp_path, BOTH + more, *few, *workers)
        assert done.returncode == 0 and "toml" not in done.stdout, done.stdout
    done = run(tmp_path, BOTH + more.replace("test_gone", "test_made"), *workers)
    assert done.returncode == 0 and section(done.stdout, IDLE)


@pytest.mark.more
@WORKERS
def test_a_module_that_is_skipped_is_one(workers: tuple[str, ...], tmp_path: Path) -> None:
    run(tmp_path, BOTH)
    (tmp_path / "tests/test_other.py").write_text("import pytest\npytest.importorskip('no_such')\n")
    done = run(tmp_path, BOTH, *workers)
    (row,) = section(done.stdout, UNLISTED)
    assert done.returncode == 1 and row.startswith(
        "tests/test_other.py: could not import 'no_such'"
    )


def test_a_failure_stays_one(tmp_path: Path) -> None:
    (tmp_path / "tests").mkdir()
    (tmp_path / "tests/test_wrong.py").write_text("def test_wrong():\n    assert False\n")
    done = run(tmp_path, BOTH)
    assert done.returncode == 1 and "1 failed" in done.stdout and "toml" not in done.stdout


@pytest.mark.parametrize(
    "text",
    [
        '[[skip]]\ntests = "a"\n',
        '[[skip]]\ntests = "a"\nwhy = ""\n',
        '[[skip]]\ntests = "a"\nwhy = "b"\nunless = "wine"\n',
        '[[skip]]\ntests = "a"\nwhy = "b"\nelse = "c"\n',
        "skip = 3\n",
        "[skips]\n",
        "skip =\n",
    ],
)
def test_a_wrong_list_is_told(text: str, tmp_path: Path) -> None:
    (tmp_path / "skips.toml").write_text(text)
    with pytest.raises(pytest.UsageError, match=r"skips\.toml: "):
        skip_list.read(tmp_path / "skips.toml")


def test_the_list_of_the_project_is_read() -> None:
    lines = skip_list.read(ROOT / "tests/skips.toml")
    assert len(lines) > 5 and all(line.tests.startswith("tests/") for line in lines)
