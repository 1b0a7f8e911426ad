"""Tests of a group go to one worker, which makes what they share once."""

import subprocess
import sys
from pathlib import Path

import pytest

TESTS = """
import pytest


@pytest.mark.xdist_group("some")
@pytest.mark.parametrize("k", range(6))
def test_some(k, worker_id):
    with open(f"{k}.txt", "w") as file:
        file.write(worker_id)
"""


@pytest.mark.more
def test_a_group_goes_to_one_worker(tmp_path: Path) -> None:
    (tmp_path / "pytest.ini").write_text("[pytest]\n")
    (tmp_path / "test_some.py").write_text(TESTS)
    line = [sys.executable, "-m", "pytest", "-n", "2", "--dist", "loadgroup", "-p"]
    done = subprocess.run([*line, "no:cacheprovider"], cwd=tmp_path, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout
    workers = [file.read_text() for file in tmp_path.glob("[0-9].txt")]
    assert len(workers) == 6 and len(set(workers)) == 1
