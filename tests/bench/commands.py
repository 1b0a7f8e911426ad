"""Processor time of the commands that one gives all day."""

import os
import resource
import subprocess
import sys
import tempfile

COMMANDS = ("--help", "list", "info mcc", "info scenarios/circle")


class Command:
    """One command: processor time of its process [s], the best of all rounds."""

    def __init__(self, line: str, cache: str) -> None:
        self.line, self.seconds = line, float("inf")
        # Compiled once, as where it is installed, whatever this environment says.
        kept = {k: v for k, v in os.environ.items() if k != "PYTHONDONTWRITEBYTECODE"}
        self._environment = kept | {"PYTHONPYCACHEPREFIX": cache}
        self._run()

    def _run(self) -> float:
        before = resource.getrusage(resource.RUSAGE_CHILDREN)
        line = [sys.executable, "-m", "motionfmu", *self.line.split()]
        subprocess.run(line, check=True, stdout=subprocess.DEVNULL, env=self._environment)
        after = resource.getrusage(resource.RUSAGE_CHILDREN)
        return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime

    def __call__(self) -> None:
        self.seconds = min(self.seconds, self._run())


_CACHE = tempfile.TemporaryDirectory(prefix="motionfmu-")


def all_commands() -> list[Command]:
    """Each of `COMMANDS`, run once so that its modules are compiled."""
    return [Command(line, _CACHE.name) for line in COMMANDS]
