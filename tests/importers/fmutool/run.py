"""Archives checked by fmutool of the FMU manipulation toolbox."""

import subprocess
import sys
from pathlib import Path

from jobs import Task, main


def run(task: Task) -> str | None:
    """What it complains of in one archive."""
    command = [str(Path(sys.executable).with_name("fmutool")), "-input", task.fmu, "-check"]
    ran = subprocess.run(command, capture_output=True, text=True, errors="replace")
    told = ran.stdout + ran.stderr
    good = f"compliant with FMI-{task.fmi}.0" in told and "No semantic error" in told
    if good and "ERROR" not in told:
        return None
    return next((line for line in told.splitlines() if "ERROR" in line), told or "no answer")


main(run)
