"""Processes of this package's own: Python that imports it, and nothing from where it runs."""

import os
import sys
from pathlib import Path
from typing import Any

_PLACE = str(Path(__file__).resolve().parents[2])


def child(program: str, **own: str) -> tuple[list[str], dict[str, Any]]:
    """Command and options of a process that runs a program, with variables of its own beside ours.

    An interrupt from the keyboard is for its parent alone.
    """
    path = [_PLACE, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, **own, "PYTHONPATH": os.pathsep.join(path)}
    command = [sys.executable, "-P", "-c", program]
    return command, {"env": environment, "start_new_session": True}
