"""The console command as a user runs it."""

import os
import subprocess
import sys

from conftest import ROOT


def command(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run `motionfmu` with the sources of this checkout."""
    line = [sys.executable, "-m", "motionfmu", *map(str, arguments)]
    kept = {k: v for k, v in os.environ.items() if k in ("PATH", "HOME", "MOTIONFMU_FMUS")}
    own = {"PYTHONPATH": str(ROOT / "src"), "COLUMNS": "160"}
    return subprocess.run(line, capture_output=True, text=True, cwd=ROOT, env=own | kept)
