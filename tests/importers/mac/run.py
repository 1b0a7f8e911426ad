"""The libraries for a Mac, which nothing here runs: symbols, name, oldest system, signature."""

import sys
from pathlib import Path

from jobs import Task, main

sys.path.insert(0, str(Path(__file__).parents[2] / "ports"))
from binary import mac_faults


def run(task: Task) -> str | None:
    """What is wrong with those of one archive."""
    return "; ".join(mac_faults(Path(task.fmu), task.fmi)) or None


main(run)
