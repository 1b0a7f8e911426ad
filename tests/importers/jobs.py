"""What drivers in Python share: reading a job, telling how it went. It imports no importer."""

import sys
import sysconfig
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class Value:
    """An output to be read."""

    type: str
    reference: int
    count: int
    name: str


@dataclass(frozen=True)
class Task:
    """A job as its file has it."""

    fmu: str
    fmi: int
    step: float  # [s]
    steps: int
    out: Path
    values: list[Value]
    every: int = 1  # steps from row to row

    @property
    def ssp(self) -> bool:
        """Whether it is a system, whose values are named COMPONENT.VARIABLE."""
        return self.fmu.endswith(".ssp")


def read(file: str) -> Task:
    """Read the file of a job."""
    keys: dict[str, str] = {}
    values = []
    for line in Path(file).read_text().splitlines():
        key, *rest = line.split("\t")
        if key == "value":
            values.append(Value(rest[0], int(rest[1]), int(rest[2]), rest[3]))
        else:
            keys[key] = rest[0]
    step, steps = float(keys["step"]), int(keys["steps"])
    every = int(keys.get("every", "1"))
    return Task(keys["fmu"], int(keys["fmi"]), step, steps, Path(keys["out"]), values, every)


def packages() -> Path:
    """Take a tool's folder from the command line; its packages are imported first."""
    place = Path(sys.argv.pop(1))
    sys.path.insert(0, sysconfig.get_path("purelib", vars={"base": str(place)}))
    return place


def main(run: Callable[[Task], str | None]) -> None:
    """Run every job of the command line; a function returns what is wrong, or raises it.

    "ok", a tab and a remark is what it returns if all is right but for something.
    """
    for file in sys.argv[1:]:
        try:
            told = run(read(file)) or "ok"
        except Exception as error:
            told = f"{type(error).__name__}: {error}"
        if not told.startswith("ok\t"):
            told = " ".join(told.split())
        print(file, told, sep="\t", flush=True)
