"""Every example does what its README says, outside the tree and with the wheel alone.

Its folder is what `motionfmu examples --copy` gives. The README is followed there; what a CI's file
or a Dockerfile has to run is run by hand, and a notebook cell by cell.
"""

import json
import re
import shutil
from pathlib import Path
from xml.etree import ElementTree

import nbformat
import pytest
from conftest import ROOT
from few_cases import few
from followed_pages import Folder, own, steps
from installed_wheel import Installed
from page_cells import alike, cells_printed

pytestmark = [pytest.mark.more, pytest.mark.xdist_group("wheel")]

NAMES = sorted(file.parent.name for file in (ROOT / "examples").glob("*/README.md"))
# Those that show each way of use: Python alone, a CI, a notebook, somebody's own master.
INSTALLED_TOO = ("continuous_integration", "fmpy_loop", "notebook", "student_backlash")
# Where libraries and headers are installed as this one's README says.
CORES = "virtual_card"
NOTEBOOK = "*.ipynb"
JUNIT = "check.xml"
# What a README shows.
PICTURE = re.compile(r"!\[[^\]]*\]\(([\w./-]+)\)")
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
        for file in files_of(name, *OF_A_CI):
            (place / JUNIT).unlink(missing_ok=True)
            told = told or copy.follow_ci(file, (0,)) or verdicts(place / JUNIT)
        for file in files_of(name, NOTEBOOK):
            told = told or notebook(place / file, self.installed)
        return told


def files_of(name: str, *patterns: str) -> list[str]:
    """Files of an example in the tree, which its copy must have."""
    folder = ROOT / "examples" / name
    found = [file for pattern in patterns for file in sorted(folder.glob(pattern))]
    return [file.relative_to(folder).as_posix() for file in found]


def verdicts(file: Path) -> str | None:
    """What is wrong with the verdicts that a CI keeps; None if nothing."""
    if not file.is_file():
        return f"no {file.name} was written"
    cases = list(ElementTree.parse(file).getroot().iter("testcase"))
    failed = [c.get("name") for c in cases if c.find("failure") is not None]
    return None if cases and not failed else f"{file.name}: {len(cases)} cases, failed: {failed}"


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


@pytest.mark.parametrize("name", few(NAMES, INSTALLED_TOO, pytest.mark.long))
def test_an_example_does_what_it_says(name: str, copies: Copies) -> None:
    assert copies.follow(name) is None


def test_files_of_a_ci_and_notebooks_are_found() -> None:
    for pattern in (*OF_A_CI, NOTEBOOK):
        assert any(files_of(name, pattern) for name in NAMES), pattern


def test_what_a_ci_keeps_is_read(tmp_path: Path) -> None:
    file = tmp_path / JUNIT
    assert verdicts(file) == "no check.xml was written"
    for case, told in (
        ("<testcase name='a'/>", None),
        ("", "check.xml: 0 cases, failed: []"),
        ("<testcase name='a'><failure/></testcase>", "check.xml: 1 cases, failed: ['a']"),
    ):
        file.write_text(f"<testsuites><testsuite>{case}</testsuite></testsuites>")
        assert verdicts(file) == told


@pytest.mark.parametrize("name", [*NAMES, "circle", "robot_line"])
def test_a_copy_shows_no_dead_picture(name: str, workbench: Installed, tmp_path: Path) -> None:
    done = workbench.run("motionfmu", "examples", "--copy", name, str(tmp_path))
    assert done.returncode == 0, done.stderr
    readme = (tmp_path / name / "README.md").read_text(encoding="utf-8")
    own = (ROOT / ("examples" if name in NAMES else "scenarios") / name / "README.md").read_text()
    assert [p for p in PICTURE.findall(readme) if not (tmp_path / name / p).is_file()] == []
    assert (readme == own) == (name in NAMES)


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
