"""FMUs for another platform by a C program of our own, under what runs that platform's programs."""

import array
import struct
import sys
import tempfile
from pathlib import Path

from jobs import Task, main

sys.path.insert(0, str(Path(__file__).parents[2] / "ports"))
import bits

from motionfmu.base.platforms import Platform

PLATFORM = Platform(sys.argv.pop(1))


def number(text: list[str]) -> float:
    """A value of a line: the bits of a double, or an integer."""
    return (
        float(struct.unpack(">d", bytes.fromhex(text[2]))[0]) if len(text) == 4 else float(text[2])
    )


def run(task: Task) -> str | None:
    """Run one job."""
    if why := bits.missing(PLATFORM):
        return why
    job = bits.Job(task.steps, task.step, values=True)
    with tempfile.TemporaryDirectory(prefix="importers-") as place:
        lines = bits.hashes(Path(task.fmu), PLATFORM, job, Path(place))
    with task.out.open("wb") as out:
        values = [words for line in lines if len(words := line.split()) > 2]
        array.array("d", map(number, values)).tofile(out)
    return None


main(run)
