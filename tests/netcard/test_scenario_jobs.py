"""The jobs of the scenarios are those that their drawings give today."""

from pathlib import Path

import pytest
from conftest import ROOT
from typer.testing import CliRunner

from motionfmu.cli import app

DRAWN = sorted(p for p in (ROOT / "scenarios").glob("*/*.mcj") if p.with_suffix(".plt").exists())


@pytest.mark.parametrize("job", DRAWN, ids=lambda p: f"{p.parent.name}-{p.stem}")
def test_a_job_is_what_its_drawing_gives(job: Path, tmp_path: Path) -> None:
    made = tmp_path / job.name
    drawing, config = job.with_suffix(".plt"), job.with_name("card.toml")
    command = ["card", "plan", str(drawing), "-c", str(config), "-o", str(made)]
    result = CliRunner().invoke(app, command)
    assert result.exit_code == 0, result.output
    assert made.read_bytes() == job.read_bytes()
