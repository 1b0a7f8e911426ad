"""Archives checked by VDMCheck2, the rules of FMI 2 as a VDM model."""

import subprocess
import sys

from jobs import Task, main

PLACE = sys.argv.pop(1)


def run(task: Task) -> str | None:
    """What it complains of in one archive."""
    command = ["java", "-jar", f"{PLACE}/vdmcheck2.jar", task.fmu]
    told = subprocess.run(command, capture_output=True, text=True).stdout.strip()
    return None if told.endswith("No errors found.") else told or "no answer"


main(run)
