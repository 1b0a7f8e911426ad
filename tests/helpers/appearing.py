"""Files that another process makes."""

import time
from pathlib import Path

PATIENCE = 300.0  # [s] on the wall, that no file takes however slow the machine is


def appears(file: Path) -> None:
    """Wait until a file is there."""
    until = time.monotonic() + PATIENCE
    while not file.exists():
        assert time.monotonic() < until, f"{file.name} was not written"
        time.sleep(0.02)
