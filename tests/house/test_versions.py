"""The version stands in pyproject.toml, and everything that shows one has that."""

import re
import tomllib
import zipfile
from pathlib import Path
from xml.etree import ElementTree

import pytest
import yaml
from conftest import ROOT
from console import command

import motionfmu
from motionfmu.base import project_version
from motionfmu.fmu import licence

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
VERSION = PROJECT["version"]
# Required by the schema of CFF 1.2.0, and the others that we have.
CITATION_KEYS = {"cff-version", "message", "title", "authors"}
CITATION_MORE = {"abstract", "type", "version", "license", "keywords", "date-released"}
# Beside pyproject.toml they state it, as people and other programs read them without us.
STATED = {"pyproject.toml", "CITATION.cff", "CHANGELOG.md", "docs/decisions/house/versions.md"}


def test_the_package_and_the_command_say_it() -> None:
    assert motionfmu.__version__ == project_version.version() == VERSION
    assert command("--version").stdout == f"motionfmu {VERSION}\n"
    assert licence.attributes()["version"] == VERSION


def test_an_installed_package_says_that_of_its_metadata(tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setattr(project_version, "_ROOT", tmp_path)
    monkeypatch.setattr("importlib.metadata.version", lambda name: f"that of {name}")
    assert project_version.version() == "that of motionfmu"
    (tmp_path / "pyproject.toml").write_text('[project]\nversion = "7.8.9"\n')
    assert project_version.version() == "7.8.9"


@pytest.mark.parametrize("fmi", [2, 3])
def test_each_fmu_says_it(fmi: int) -> None:
    built = sorted((ROOT / "build/fmus").glob(f"*.fmi{fmi}.fmu"))
    assert len(built) > 20
    for file in built:
        with zipfile.ZipFile(file) as archive:
            root = ElementTree.fromstring(archive.read("modelDescription.xml"))
        assert root.get("version") == VERSION, file.name


def test_c_packages_say_it() -> None:
    packages = sorted((ROOT / "build/pkgconfig").glob("motionfmu-*.pc"))
    assert len(packages) > 20
    assert {re.search("Version: (.*)", p.read_text())[1] for p in packages} == {VERSION}
    text = (ROOT / "build/motionfmuConfigVersion.cmake").read_text()
    assert f'set(PACKAGE_VERSION "{VERSION}")' in text


def test_the_changelogs_newest_heading_is_it() -> None:
    headings = re.findall(r"^## (\S+)", (ROOT / "CHANGELOG.md").read_text(), re.MULTILINE)
    assert headings[0] == VERSION and len(headings) == len(set(headings))


def test_no_other_file_states_it() -> None:
    places = ("docs", "examples", "fmus", "scenarios", "src", "tests", ".github")
    files = [f for place in places for f in (ROOT / place).rglob("*") if f.is_file()]
    files += [f for f in ROOT.glob("*.*") if f.is_file()]
    word = re.compile(rf"(?<![\w.]){re.escape(VERSION)}(?![\w.])")
    found = set()
    for file in files:
        if "__pycache__" not in file.parts and word.search(file.read_text("utf-8", "ignore")):
            found.add(file.relative_to(ROOT).as_posix())
    assert found <= STATED and {"pyproject.toml", "CITATION.cff", "CHANGELOG.md"} <= found


def test_the_citation_is_one() -> None:
    """CFF 1.2.0: required keys, no unknown ones, authors that are an entity each."""
    cited = yaml.safe_load((ROOT / "CITATION.cff").read_text())
    assert cited.keys() >= CITATION_KEYS and cited.keys() <= CITATION_KEYS | CITATION_MORE
    assert (cited["cff-version"], cited["type"]) == ("1.2.0", "software")
    assert (cited["title"], cited["version"]) == (PROJECT["name"], VERSION)
    assert cited["authors"] == PROJECT["authors"] and all(a["name"] for a in cited["authors"])
    assert cited["license"] == PROJECT["license"]["text"] == licence.SPDX
    assert f"Copyright (c) 2026 {cited['authors'][0]['name']}\n" in (ROOT / "LICENSE").read_text()


def test_classifiers_are_pypis() -> None:
    """As the register has them; those of Python are what the wheel is tried on."""
    known = {
        "Development Status :: 4 - Beta",
        "Environment :: Console",
        "Intended Audience :: Developers",
        "Intended Audience :: Education",
        "Intended Audience :: Manufacturing",
        "Intended Audience :: Science/Research",
        "License :: OSI Approved :: MIT License",
        "Operating System :: POSIX :: Linux",
        "Programming Language :: C",
        "Programming Language :: Python :: 3 :: Only",
        "Topic :: Scientific/Engineering",
        "Typing :: Typed",
    }
    listed = PROJECT["classifiers"]
    python = {c for c in listed if re.fullmatch(r"Programming Language :: Python :: 3\.\d+", c)}
    assert {*listed} - python == known and len(listed) == len(set(listed))
    least = PROJECT["requires-python"].removeprefix(">=")
    assert min(python, key=lambda c: int(c.rpartition(".")[2])).endswith(f" {least}")
    assert "urls" not in PROJECT, "docs/decisions/house/versions.md: there is no public address"


@pytest.mark.parametrize("name", ["bug", "feature", "question"])
def test_an_issue_form_is_one(name: str) -> None:
    """As GitHub reads them: names, elements of known kinds with ids of their own and labels."""
    form = yaml.safe_load((ROOT / f".github/ISSUE_TEMPLATE/{name}.yml").read_text())
    assert form.keys() == {"name", "description", "labels", "body"}
    ids = [part["id"] for part in form["body"]]
    assert len(ids) == len(set(ids)) > 1
    for part in form["body"]:
        assert part.keys() <= {"type", "id", "attributes", "validations"}
        assert part["type"] in ("textarea", "input") and part["attributes"]["label"]
    assert any(part.get("validations", {}).get("required") for part in form["body"])
    assert name != "bug" or {"file", "command", "output", "version"} <= set(ids)
