"""Starts programs of other platforms: wine by one process at first, and again if it did not."""

import functools
import re
import subprocess
import tempfile
from collections.abc import Sequence
from pathlib import Path

from motionfmu.base.locking import lock

# What wine says in place of a program: that its place in the address space, which the system
# draws, is taken, or that the folder of its server is gone.
UNSTARTED = re.compile(rb"^(?:wine: (?:failed|chdir)|wine client error|preloader:)", re.MULTILINE)
TRIES = 3


def start(words: Sequence[str], folder: Path) -> subprocess.CompletedProcess[bytes]:
    """Run a program in a folder until its end, whether it fails or not."""
    if words[0] == "wine":
        first_start()
    return tried(words, folder)


def tried(words: Sequence[str], folder: Path) -> subprocess.CompletedProcess[bytes]:
    for _ in range(TRIES):
        done = subprocess.run(words, cwd=folder, capture_output=True, check=False)
        if not done.returncode or not UNSTARTED.search(done.stderr):
            break
    return done


@functools.cache
def first_start() -> None:
    """Start wine while no other process of the tests starts it for its first time.

    Debian's wine keeps the name of its server's folder in the user's; where there is none, two that
    start at once make one each, and the first looks for its server in the wrong one.
    """
    place = Path(tempfile.gettempdir()) / "motionfmu-wine.lock"
    with place.open("w") as file:
        lock(file.fileno(), place, "taken", wait=True)
        tried(("wine", "cmd", "/c", "exit"), place.parent)
