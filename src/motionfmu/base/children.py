"""Child processes in Python, which import this package and nothing from the working folder."""

import os
import sys
from pathlib import Path
from typing import Any

_PLACE = str(Path(__file__).resolve().parents[2])


def child(program: str, **own: str) -> tuple[list[str], dict[str, Any]]:
    """Command and options of a process that runs a Python program; `own` adds to its environment.

    Ctrl-C reaches the parent process only.
    """
    path = [_PLACE, *filter(None, [os.environ.get("PYTHONPATH")])]
    environment = {**os.environ, **own, "PYTHONPATH": os.pathsep.join(path)}
    command = [sys.executable, "-P", "-c", program]
    return command, {"env": environment, "start_new_session": True}
