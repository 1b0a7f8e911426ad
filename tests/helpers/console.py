"""The console command as a user runs it."""

import contextlib
import io
import os
import subprocess
import sys
from pathlib import Path
from unittest import mock

from conftest import ROOT

from motionfmu import cli


def command(*arguments: object) -> subprocess.CompletedProcess[str]:
    """Run `motionfmu` with the sources of this checkout."""
    line = [sys.executable, "-m", "motionfmu", *map(str, arguments)]
    kept = {k: v for k, v in os.environ.items() if k in ("PATH", "HOME", "MOTIONFMU_FMUS")}
    own = {"PYTHONPATH": str(ROOT / "src"), "COLUMNS": "160"}
    return subprocess.run(line, capture_output=True, text=True, cwd=ROOT, env=own | kept)


def within(
    *arguments: object, columns: int = 160, folder: Path = ROOT
) -> subprocess.CompletedProcess[str]:
    """Run `motionfmu` in this process, which takes a tenth of the time of a new one."""
    out, err = io.StringIO(), io.StringIO()
    line = ["motionfmu", *map(str, arguments)]
    with (
        contextlib.chdir(folder),
        contextlib.redirect_stdout(out),
        contextlib.redirect_stderr(err),
        mock.patch.object(sys, "argv", line),
        mock.patch.dict(os.environ, COLUMNS=str(columns)),
    ):
        try:
            cli.main()
            status = 0
        except SystemExit as end:
            status = int(end.code or 0)
    return subprocess.CompletedProcess(line, status, out.getvalue(), err.getvalue())
