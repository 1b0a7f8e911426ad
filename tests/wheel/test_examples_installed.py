"""Every example does what its README says, outside the tree and with the wheel alone.

Its folder is what `motionfmu examples --copy` gives. The README is followed there; what a CI's file
or a Dockerfile has to run is run by hand, and a notebook cell by cell.
"""

import json
import re
import shutil
from pathlib import Path

import nbformat
import pytest
from conftest import ROOT
from followed_pages import Folder, own, steps
from installed_wheel import Installed
from page_cells import alike, cells_printed

pytestmark = [pytest.mark.more, pytest.mark.xdist_group("wheel")]

NAMES = sorted(file.parent.name for file in (ROOT / "examples").glob("*/README.md"))
# Where libraries and headers are installed as this one's README says.
CORES = "virtual_card"
OF_A_CI = (".gitlab-ci.yml", ".github/workflows/*.yml")


class Copies:
    """Examples as they are copied from the wheel, each followed once."""

    def __init__(self, installed: Installed, folder: Path) -> None:
        self.installed, self.folder = installed, folder
        self.told: dict[str, str | None] = {}

    def follow(self, name: str) -> str | None:
        """What went otherwise than an example says; None if nothing did."""
        if name not in self.told:
            self.told[name] = self._followed(name)
        return self.told[name]

    def _followed(self, name: str) -> str | None:
        done = self.installed.run("motionfmu", "examples", "--copy", name, str(self.folder))
        assert done.returncode == 0, done.stderr
        place = self.folder / name
        listed = place / "CMakeLists.txt"
        if listed.is_file() and "find_package(motionfmu" in listed.read_text():
            for tool in ("pkg-config", "g++"):
                if not shutil.which(tool):
                    pytest.skip(f"no {tool} here")
            assert name == CORES or self.follow(CORES) is None
        page = page_of(place)
        copy = Folder(place, self.installed.python, self.installed.environ)
        told = copy.follow(page)
        for pattern in OF_A_CI:
            for file in sorted(place.glob(pattern)):
                told = told or copy.follow_ci(str(file.relative_to(place)), (0,))
        for file in sorted(place.glob("*.ipynb")):
            told = told or notebook(file, self.installed)
        return told


def page_of(folder: Path) -> str:
    """What is to be followed of an example's README, its containers by hand."""
    page, box = (folder / "README.md").read_text(encoding="utf-8"), folder / "Dockerfile"
    return by_hand(page, box.read_text(encoding="utf-8")) if box.is_file() else page


def by_hand(page: str, dockerfile: str) -> str:
    """A page whose containers are replaced by the steps of their Dockerfile, run in the folder.

    What an image gets from other places, by apt-get and pip, is there already.
    """
    lines = re.sub(r"\\\n\s*", "", dockerfile).splitlines()
    told = [line.partition(" ")[::2] for line in lines if line and not line.startswith("#")]
    found: dict[str, list[str]] = {}
    for word, rest in told:
        found.setdefault(word, []).append(rest)
    entry, usual = (json.loads(found[word][-1]) for word in ("ENTRYPOINT", "CMD"))
    made = own("".join(f"{line}\n" for line in found["RUN"])).splitlines()
    steps_by_hand = "\n".join([*made, " ".join([*entry, *usual])])
    page = re.sub(r"^docker build .*", steps_by_hand, page, flags=re.MULTILINE)
    return re.sub(r"^docker run .* motion\b", " ".join(entry), page, flags=re.MULTILINE)


def notebook(file: Path, installed: Installed) -> str | None:
    """What a notebook prints or draws otherwise than it has it; None if nothing."""
    code = [c for c in nbformat.read(file, as_version=4).cells if c.cell_type == "code"]
    found = cells_printed(
        [c.source for c in code], file.parent, installed.python, installed.environ
    )
    for number, (cell, out) in enumerate(zip(code, found, strict=True)):
        kept = "".join(o.text for o in cell.outputs if o.output_type == "stream")
        if out != kept:
            return f"{cell.source}\nprinted: {out}\nin the notebook: {kept}"
        for shown in (o.data["image/png"] for o in cell.outputs if "data" in o):
            if not alike(file.parent / f"cell-{number}.png", shown):
                return f"{cell.source}\ndraws another picture"
    return None


@pytest.fixture(scope="session")
def copies(workbench: Installed, tmp_path_factory: pytest.TempPathFactory) -> Copies:
    return Copies(workbench, tmp_path_factory.mktemp("copies"))


@pytest.mark.parametrize("name", NAMES)
def test_an_example_does_what_it_says(name: str, copies: Copies) -> None:
    assert copies.follow(name) is None


@pytest.mark.parametrize("name", NAMES)
def test_an_example_has_something_to_follow(name: str) -> None:
    folder = ROOT / "examples" / name
    assert any(own(step.text).strip() for step in steps(page_of(folder))) or list(
        folder.glob("*.ipynb")
    )


@pytest.mark.parametrize("name", NAMES)
def test_every_file_of_an_example_is_in_its_readme(name: str) -> None:
    folder = ROOT / "examples" / name
    files = {f.relative_to(folder).as_posix() for f in folder.rglob("*") if f.is_file()}
    files = {f for f in files if "build/" not in f and "__pycache__" not in f} - {"README.md"}
    linked = re.findall(r"\]\(([\w./-]+)\)", (folder / "README.md").read_text(encoding="utf-8"))
    assert {f for f in files if not any(f == x or f.startswith(f"{x}/") for x in linked)} == set()


def test_a_container_is_run_by_hand() -> None:
    page = "```sh\ndocker build -t motion .\ndocker run --rm -v a:/b motion run x\n```\n"
    file = (
        '# Words.\nRUN apt-get update && \\\n    true\nRUN a b\nENTRYPOINT ["m"]\nCMD ["c", "d"]\n'
    )
    assert by_hand(page, file) == "```sh\na b\nm c d\nm run x\n```\n"


def test_the_environment_has_nothing_of_the_checkout(workbench: Installed) -> None:
    code = "import motionfmu, sys; print(motionfmu.__file__, *sys.path, sep='\\n')"
    done = workbench.run("python", "-c", code)
    assert done.returncode == 0 and str(workbench.site) in done.stdout
    assert str(ROOT) not in done.stdout + "".join(workbench.environ.values())
