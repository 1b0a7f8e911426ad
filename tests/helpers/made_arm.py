"""The machine made of the arm that a module's `file` describes, and its example's run."""

from pathlib import Path

import pytest
from typer.testing import CliRunner

from motionfmu import run
from motionfmu.base.errors import InputError
from motionfmu.cli import app


def told(*words: str | Path) -> str:
    """What a command prints, on one line."""
    result = CliRunner().invoke(app, list(map(str, words)))
    if isinstance(result.exception, InputError):
        raise result.exception
    assert result.exit_code == 0, result.output
    return " ".join(result.output.split())


@pytest.fixture(scope="module")
def arm_folder(file: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The machine, and beside it what was told."""
    made = tmp_path_factory.mktemp("arms") / file.stem
    (made.parent / "told").write_text(told("import", file, "-o", made), encoding="utf-8")
    return made


@pytest.fixture(scope="module")
def arm_run(arm_folder: Path) -> run.Result:
    """Its example's run, the arm's own geometry without errors."""
    scenario = run.machine(arm_folder).scenario(
        arm_folder / "example.job", set={"arm.origin_error": 0.0}
    )
    return scenario.run()
