"""Shared by all tests: where the project and its FMUs are, and which inputs properties get."""

import os
from pathlib import Path

import pytest
from hypothesis import HealthCheck, settings
from hypothesis.database import DirectoryBasedExampleDatabase

import motionfmu

pytest_plugins = ["browser", "installed_wheel", "made_arm", "skip_list"]
ROOT = Path(__file__).resolve().parent.parent
FMUS = Path(os.environ.setdefault("MOTIONFMU_FMUS", str(ROOT / "build" / "fmus")))

if Path(motionfmu.__file__).resolve().parent != ROOT / "src/motionfmu":
    pytest.exit(f"the environment has another motionfmu, {motionfmu.__file__}: make build here", 4)

# Nothing about the inputs depends on the day or on the machine's speed: the same everywhere, or
# fresh ones for `make explore`, which keeps those that fail in .hypothesis.
ANYWHERE = {"deadline": None, "suppress_health_check": [HealthCheck.too_slow]}
settings.register_profile("same", derandomize=True, **ANYWHERE)
# On a CI machine hypothesis itself would repeat its inputs and keep none.
KEPT = DirectoryBasedExampleDatabase(ROOT / ".hypothesis/examples")
settings.register_profile("fresh", derandomize=False, database=KEPT, print_blob=True, **ANYWHERE)
settings.load_profile("same")
