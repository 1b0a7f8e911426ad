"""Shared by all tests: where the project and its FMUs are."""

import os
from pathlib import Path

import pytest

import motionfmu

pytest_plugins = ["browser"]
ROOT = Path(__file__).resolve().parent.parent
FMUS = Path(os.environ.setdefault("MOTIONFMU_FMUS", str(ROOT / "build" / "fmus")))

if Path(motionfmu.__file__).resolve().parent != ROOT / "src/motionfmu":
    pytest.exit(f"the environment has another motionfmu, {motionfmu.__file__}: make build here", 4)
