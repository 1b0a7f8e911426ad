"""Shared by all tests: where the FMUs are."""

import os
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
os.environ.setdefault("MOTIONFMU_FMUS", str(ROOT / "build" / "fmus"))
