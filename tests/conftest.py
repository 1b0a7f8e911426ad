"""Shared by all tests: where the project and its FMUs are."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FMUS = Path(os.environ.setdefault("MOTIONFMU_FMUS", str(ROOT / "build" / "fmus")))
