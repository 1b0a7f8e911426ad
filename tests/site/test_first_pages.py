"""README.md and the tour do what they say, in an empty folder with the checkout's package."""

import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import FMUS, ROOT
from followed_pages import Folder

README, TOUR = ROOT / "README.md", ROOT / "docs/tour.md"
MOST_LINES = 90  # of README.md
# What is not run here: builds, what runs until Ctrl-C, what takes minutes.
LEFT_OUT = re.compile(r"make |motionfmu (live|card serve|card sim|machines|sweep)\b")
# Files that a page calls the user's own: what they are here.
OWN = {
    "part.ngc": "examples/docker/part.ngc",
    "pick.job": "examples/virtual_robot/plate.job",
    "pick.points": "examples/virtual_robot/plate.points",
    "irb120.urdf": "tests/arms/small_arm.urdf",
    "trace.csv": "examples/digital_twin/axis/record.csv",
    "part.plt": "scenarios/plt_plate/plate.plt",
}
DRAWING = (
    '<svg xmlns="http://www.w3.org/2000/svg" width="60mm" height="40mm" viewBox="0 0 60 40">'
    '<path d="M10 10H50V30H10Z"/></svg>\n'
)


def laser() -> str:
    """A positioning test as a laser's software writes it."""
    rows = ["Axis: X", "target [mm],run,direction,deviation [µm]"]
    rows += [
        f"{x},{run},{way},{0.02 * x - 8 * (way == 'down') + 0.1 * ((7 * run + x) % 3)}"
        for x in range(10, 250, 40)
        for run in range(1, 6)
        for way in ("up", "down")
    ]
    return "\n".join(rows) + "\n"


@pytest.fixture
def desk(tmp_path: Path) -> Folder:
    """A folder with the user's own files, and with what the pages name by its path."""
    for name, place in OWN.items():
        shutil.copy(ROOT / place, tmp_path / name)
    (tmp_path / "drawing.svg").write_text(DRAWING, encoding="utf-8")
    (tmp_path / "laser.csv").write_text(laser(), encoding="utf-8")
    path = os.pathsep.join((str(Path(sys.executable).parent), os.environ["PATH"]))
    told = os.environ | {"MOTIONFMU_FMUS": str(FMUS), "COLUMNS": "160", "PATH": path}
    for name, place in (("circle", "scenarios"), ("network_card_firmware", "examples")):
        line = [sys.executable, "-m", "motionfmu", "examples", "--copy", name, place]
        (tmp_path / place).mkdir()
        subprocess.run(line, cwd=tmp_path, env=told, check=True, capture_output=True)
    return Folder(tmp_path, Path(sys.executable), told)


def blocks(page: Path, kind: str) -> list[str]:
    """Blocks of a page without the commands that are left out; empty ones are none."""
    found = re.findall(
        rf"^```{kind}\n(.*?)^```$", page.read_text(encoding="utf-8"), re.MULTILINE | re.DOTALL
    )
    joined = (re.sub(r"\\\n\s*", "", text) for text in found)
    kept = ("".join(r for r in t.splitlines(True) if not LEFT_OUT.match(r)) for t in joined)
    return [text for text in kept if re.sub(r"^#.*", "", text, flags=re.MULTILINE).strip()]


def test_readme_is_short() -> None:
    assert len(README.read_text(encoding="utf-8").splitlines()) <= MOST_LINES


def test_one_page_says_how_long_make_test_takes() -> None:
    pages = [ROOT / "Makefile", *ROOT.glob("*.md"), *ROOT.glob("docs/**/*.md")]
    telling = re.compile(r"(make test\b(?!-)|^test: ).*\bminutes?\b", re.MULTILINE)
    found = [p.relative_to(ROOT).as_posix() for p in pages if telling.search(p.read_text("utf-8"))]
    assert found == ["docs/decisions/tests/time-and-skips.md"]


def test_most_commands_of_the_pages_are_run() -> None:
    shell = {page: "".join(blocks(page, "sh")).splitlines() for page in (README, TOUR)}
    count = {p: sum(row.startswith("motionfmu ") for row in rows) for p, rows in shell.items()}
    assert count[README] >= 13 and count[TOUR] >= 3
    assert len(blocks(README, "python")) == 1 and len(blocks(TOUR, "python")) == 3


@pytest.mark.more
@pytest.mark.parametrize("kind", ["sh", "python"])
@pytest.mark.parametrize("page", [README, TOUR], ids=lambda p: p.stem)
def test_a_first_page_does_what_it_says(page: Path, kind: str, desk: Folder) -> None:
    for text in blocks(page, kind):
        assert desk.follow(f"```{kind}\n{text}```\n") is None


@pytest.mark.more
@pytest.mark.parametrize("kind", ["sh", "python"])
def test_what_fails_is_told(kind: str, desk: Folder) -> None:
    text = {"sh": "motionfmu run nothing.ngc --machine mill3", "python": "1 / 0"}[kind]
    assert "exit status" in (desk.follow(f"```{kind}\n{text}\n```\n") or "")
