"""What comes with the package: found by name from any folder, copied to work on."""

import re
from pathlib import Path

import pytest
from conftest import ROOT
from console import within

import motionfmu
from motionfmu.scenarios import package_files

NAMES = sorted(p.parent.name for p in (ROOT / "scenarios").glob("*/scenario.toml"))


def told(*line: object, folder: Path) -> str:
    """The one message of a command line that is wrong."""
    done = within(*line, folder=folder)
    assert done.returncode == 2 and done.stdout == "" and done.stderr.startswith("motionfmu: ")
    return done.stderr.removeprefix("motionfmu: ").strip()


def test_a_scenario_runs_by_its_name_in_an_empty_folder(tmp_path: Path) -> None:
    done = within("run", "schedule", "--stop", "0.1", folder=tmp_path)
    assert done.returncode in (0, 1) and done.stdout.endswith("/results/schedule/report.html\n")
    assert [p.name for p in tmp_path.iterdir()] == ["results"]
    assert (tmp_path / "results/schedule/report.html").is_file()


def test_a_path_and_a_scenario_here_come_before_one_of_the_package(tmp_path, monkeypatch) -> None:
    monkeypatch.chdir(tmp_path)
    assert motionfmu.load("schedule").document.file == ROOT / "scenarios/schedule/scenario.toml"
    within("examples", "--copy", "schedule", "scenarios", folder=tmp_path)
    assert motionfmu.load("schedule").document.file.is_relative_to(tmp_path / "scenarios")
    within("examples", "--copy", "schedule", folder=tmp_path)
    assert motionfmu.load("schedule").document.file.parent == tmp_path / "schedule"
    (tmp_path / "square").mkdir()  # what is there by this name is meant
    with pytest.raises(motionfmu.InputError, match="square: no such scenario"):
        motionfmu.load("square")


@pytest.mark.parametrize(
    "line",
    ["run", "info", "tune", "margins", "contour", "export", "check", "sweep", "compare schedule"],
)
def test_a_name_that_is_none_gets_what_is_near_it(tmp_path: Path, line: str) -> None:
    assert "; did you mean 'circle'?" in told(*line.split(), "circel", folder=tmp_path)
    assert list(tmp_path.iterdir()) == []


def test_a_name_unlike_any_gets_the_command_that_lists_them(tmp_path: Path) -> None:
    assert told("run", "zzzz", folder=tmp_path) == (
        "zzzz: no such scenario (motionfmu list shows them)"
    )


@pytest.mark.parametrize("command", ["run", "check", "export"])
def test_a_machine_is_no_scenario(tmp_path: Path, command: str) -> None:
    line = told(command, "mill3", folder=tmp_path)
    assert line.startswith("mill3: no such scenario")
    assert line.endswith(": it is a machine, on which a program runs: run PROGRAM --machine mill3")
    assert told(command, "mil3", folder=tmp_path).endswith("; did you mean 'mill3'?")


def test_examples_are_listed_and_copied(tmp_path: Path) -> None:
    listed = within("examples", folder=tmp_path).stdout
    assert all(f"\n  {name} " in f"\n{listed}" for name in (*NAMES, "student_backlash"))
    done = within("examples", "--copy", "circle", folder=tmp_path)
    assert done.stdout == ".: circle, circle_theory\nnext: motionfmu run circle\n"
    for file in (ROOT / "scenarios/circle").iterdir():
        if file.is_file():
            assert (tmp_path / "circle" / file.name).read_bytes() == file.read_bytes()
    (tmp_path / "circle/circle.ngc").unlink()
    text = told("examples", "--copy", "circle", folder=tmp_path)
    assert text == "circle is there already\ncircle_theory is there already"
    assert not (tmp_path / "circle/circle.ngc").exists()
    assert "'circle'" in told("examples", "--copy", "circl", folder=tmp_path)
    assert "--copy" in told("examples", "circle", "folder", folder=tmp_path)


def test_a_copy_shows_a_picture_or_its_words(tmp_path: Path, monkeypatch) -> None:
    whole = tmp_path / "there/scenarios/a"
    whole.mkdir(parents=True)
    (whole / "scenario.toml").write_text("")
    (whole / "README.md").write_text("# a\n\n![A path](a.png) ![Its error](b.png)\n")
    (whole / "a.png").write_bytes(b"a")
    monkeypatch.setattr(package_files, "folder", lambda kind: tmp_path / "there" / kind)
    within("examples", "--copy", "a", folder=tmp_path)
    assert (tmp_path / "a/README.md").read_text() == "# a\n\n![A path](a.png) *Its error*\n"


def test_a_folder_that_cannot_be_written_to_is_told(tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    text = told("examples", "--copy", "circle", "file", folder=tmp_path)
    assert text == "cannot write file: Not a directory"
    assert [p.name for p in tmp_path.iterdir()] == ["file"]


@pytest.mark.parametrize("name", NAMES)
def test_a_copy_has_all_files_that_it_names(name: str) -> None:
    """Beside it are those of others whose files it names."""
    places = package_files.needed(name)
    assert places[0] == ROOT / "scenarios" / name
    for file in (file for place in places for file in place.glob("*.toml")):
        for other in re.findall(r"\.\./(\w+)", file.read_text()):
            assert ROOT / "scenarios" / other in places


def test_what_the_others_name_is_copied_too(tmp_path: Path, monkeypatch) -> None:
    for name, text in (("a", '"../b/x.ngc"'), ("b", "'../c'"), ("c", '"../a/y"'), ("d", "")):
        (tmp_path / name).mkdir()
        (tmp_path / name / "scenario.toml").write_text(f"x = {text}\n")
    monkeypatch.setattr(package_files, "folder", lambda kind: tmp_path)
    assert [place.name for place in package_files.needed("a")] == ["a", "b", "c"]
