"""The C compiler of the machine, and shared libraries made with it."""

import functools
import os
import shlex
import shutil
import subprocess
import sys
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from importlib import util
from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.base.extras import install

# The options of CMakeLists.txt, so that results have the same bits as those of the FMUs.
FLAGS = (
    "-std=c11",
    "-fPIC",
    "-fvisibility=hidden",
    "-ffp-contract=off",
    "-fno-math-errno",
    "-fno-trapping-math",
)

LINES = 3  # a message has so many lines of a compiler's errors


def none() -> str:
    """The message about a missing compiler, which suggests the extra with zig."""
    return f"there is no C compiler (gcc, clang; or {install('export')})"


class NotCompiled(InputError):
    """A compiler failed; the text is what it said."""


@dataclass(frozen=True)
class Compiler:
    """A command that compiles C as gcc does."""

    command: tuple[str, ...]
    version: str  # first line that it prints about its version

    def run(self, arguments: Sequence[str | Path], folder: Path) -> None:
        """Run the compiler in a folder; a `NotCompiled` with its errors if it fails."""
        whole = [*self.command, *map(str, arguments)]
        done = subprocess.run(whole, cwd=folder, capture_output=True, text=True, check=False)
        if done.returncode:
            said = done.stderr.strip().splitlines()
            first = [line for line in said if "error" in line] or said
            told = "; ".join(first[:LINES]) or f"status {done.returncode}"
            command = shlex.join(self.command)
            raise NotCompiled(f"{command} failed: {told} (CC names another compiler)")

    def library(
        self, files: Iterable[str | Path], target: str, folder: Path, *options: str
    ) -> Path:
        """Make a shared library of C files and objects in the folder that holds them."""
        self.run([*FLAGS, "-shared", *options, *files, "-o", target, "-lm"], folder)
        return folder / target


def _candidates() -> list[tuple[str, ...]]:
    named = os.environ.get("CC")
    found: list[tuple[str, ...]] = [tuple(shlex.split(named))] if named else []
    found += [(name,) for name in ("cc", "gcc", "clang")]
    if util.find_spec("ziglang"):
        found.append((sys.executable, "-m", "ziglang", "cc"))
    return found


def cross() -> Compiler | None:
    """The compiler of zig, which compiles for any platform; None without the extra `export`."""
    if not util.find_spec("ziglang"):
        return None
    return Compiler((sys.executable, "-m", "ziglang", "cc"), "zig")


def there() -> bool:
    """Whether the machine seems to have a compiler, which is not started for that."""
    return any(command and shutil.which(command[0]) for command in _candidates())


@functools.cache
def compiler() -> Compiler | None:
    """``$CC``, else cc, gcc, clang or zig's; None if the machine has none."""
    for command in _candidates():
        if not command or shutil.which(command[0]) is None:
            continue
        done = subprocess.run([*command, "--version"], capture_output=True, text=True, check=False)
        if done.returncode == 0:
            return Compiler(command, done.stdout.partition("\n")[0])
    return None
