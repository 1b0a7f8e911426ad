"""The wheel in a new environment outside the tree, with nothing of the checkout on its paths.

The other packages are links to those of the environment that runs the tests, so that nothing is
asked of a package index; their commands are copied for the new Python.
"""

import os
import re
import subprocess
import tomllib
from collections.abc import Iterable
from importlib import metadata
from pathlib import Path

import pytest
import wheel_making
from conftest import ROOT
from packaging.requirements import Requirement

# Everything but what compiles for other platforms.
EXTRAS = ("card", "dask", "drawing", "live", "pandas", "report", "ros", "study", "tune")


def packages(extras: Iterable[str] = ()) -> set[str]:
    """Distributions that the base and some extras ask for, and those that they do."""
    found: set[str] = set()
    project = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
    rows = [*project["dependencies"]]
    rows += (row for name in extras for row in project["optional-dependencies"][name])
    waiting = [Requirement(row).name for row in rows]
    while waiting:
        name = re.sub(r"[-_.]+", "-", waiting.pop()).lower()
        if name not in found:
            found.add(name)
            asked = map(Requirement, metadata.requires(name) or [])
            waiting += [r.name for r in asked if not r.marker or r.marker.evaluate({"extra": ""})]
    return found


class Installed:
    """An environment with a wheel, a home and an empty folder to stand in."""

    def __init__(self, folder: Path, file: Path, extras: Iterable[str] = ()) -> None:
        self.file, self.home, self.empty = file, folder / "home", folder / "empty"
        self.python = wheel_making.environment(folder / "env")
        self.site, self.bin = wheel_making.site(self.python), self.python.parent
        for name in packages(extras):
            self._link(metadata.distribution(name))
        self.others = wheel_making.sizes(self.site)
        line = ("--python", self.python, "install", "--no-deps", "--no-index", file)
        wheel_making.output(*wheel_making.PIP, *line)
        self.own = wheel_making.sizes(self.site)["motionfmu"]
        for place in (self.home, self.empty):
            place.mkdir()

    def _link(self, there: metadata.Distribution) -> None:
        files = [Path(str(there.locate_file(file))) for file in there.files or ()]
        tops = {file.parts[0] for file in there.files or ()} - {".."}
        for top in tops - {p.name for p in self.site.iterdir()}:
            (self.site / top).symlink_to(Path(str(there.locate_file(top))).resolve())
        for file in (f for f in files if f.parent.name == "bin" and f.is_file()):
            head, _, rest = file.read_bytes().partition(b"\n")
            if head.startswith(b"#!") and b"python" in head:
                (self.bin / file.name).write_bytes(b"#!%s\n" % bytes(self.python) + rest)
                (self.bin / file.name).chmod(0o755)

    @property
    def environ(self) -> dict[str, str]:
        """What its processes see: nothing that leads to the checkout."""
        kept = [p for p in os.environ["PATH"].split(os.pathsep) if ".venv" not in Path(p).parts]
        path = os.pathsep.join([str(self.bin), *kept])
        return {"PATH": path, "HOME": str(self.home), "COLUMNS": "160", "LANG": "C.UTF-8"}

    def run(self, *line: str, **more: str) -> subprocess.CompletedProcess[str]:
        """A command of the environment, in the empty folder."""
        whole = [self.bin / line[0], *line[1:]]
        env = self.environ | more
        return subprocess.run(whole, cwd=self.empty, env=env, capture_output=True, text=True)


@pytest.fixture(scope="session")
def wheel_file(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel of the source distribution, so that this has all that a wheel needs."""
    folder = tmp_path_factory.mktemp("made")
    return wheel_making.build(wheel_making.source(folder), ROOT / "build", folder / "wheel")


@pytest.fixture(scope="session")
def workbench(wheel_file: Path, tmp_path_factory: pytest.TempPathFactory) -> Installed:
    """The wheel with its extras, as somebody has it who works with it."""
    return Installed(tmp_path_factory.mktemp("workbench"), wheel_file, EXTRAS)
