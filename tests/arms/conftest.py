"""The machine made of the arm that a module's `file` describes, and its example's run."""

from pathlib import Path

import pytest
from test_arm_import import told

from motionfmu import run


@pytest.fixture(scope="module")
def folder(file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The machine, and beside it what was told."""
    made = tmp_path_factory.mktemp("arms") / file.stem
    (made.parent / "told").write_text(told("import", file, "-o", made), encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def result(folder: Path) -> run.Result:
    """Its example's run, the arm's own geometry without errors."""
    return run.machine(folder).scenario(folder / "example.job", set={"arm.origin_error": 0.0}).run()
