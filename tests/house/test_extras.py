"""What is not in the base of the package is told by the extra that brings it, at once."""

import json
import re
import tomllib
from importlib import metadata
from pathlib import Path
from types import SimpleNamespace

import pytest
from conftest import ROOT
from console import within

import motionfmu

# Loaded already, as in a session: what they ask for when they are loaded is not asked again.
import motionfmu.analysis.explain
import motionfmu.analysis.freq
import motionfmu.study.tune
import motionfmu.sweep
from motionfmu.base import extras

PROJECT = tomllib.loads((ROOT / "pyproject.toml").read_text())["project"]
WHEEL = f"motionfmu-{PROJECT['version']}-....whl"
TEXTS = {".md", ".py", ".toml", ".cmake", ".txt", ".c", ".h", ".html", ".js"}
LARGE = "distributed|pandas|scipy|matplotlib|casadi|control|pyarrow|starlette|ziglang|ezdxf"


def names(requirements: list[str]) -> set[str]:
    return {re.split(r"[<>=~]", r)[0].lower() for r in requirements}


def test_extras_are_those_of_the_project() -> None:
    listed = {k: v for k, v in PROJECT["optional-dependencies"].items() if k != "dev"}
    assert set(listed) == set(extras.EXTRAS)
    for name, requirements in listed.items():
        packages = extras.EXTRAS[name].packages
        assert names(requirements) == {extras.PROJECTS.get(p, p) for p in packages}
    large = {p for extra in extras.EXTRAS.values() for p in extra.packages}
    assert not names(PROJECT["dependencies"]) & large and large >= set(LARGE.split("|"))


@pytest.fixture
def base(monkeypatch: pytest.MonkeyPatch) -> None:
    """Without what extras bring, as far as is looked."""
    large = {p for extra in extras.EXTRAS.values() for p in extra.packages}
    found = extras.find_spec
    monkeypatch.setattr(extras, "find_spec", lambda name: None if name in large else found(name))


@pytest.mark.parametrize(
    ("line", "extra"),
    [
        ("tune circle", "tune"),
        ("margins circle", "tune"),
        ("contour mismatch_line", "report"),
        ("sweep circle", "study"),
        ("run circle --pictures", "report"),
        ("card plan none.plt -c none.toml", "card"),
        ("card show none.plt --picture a.png", "report"),
        ("card show none.svg", "drawing"),
        ("gcode none.dxf", "drawing"),
    ],
)
def test_a_missing_extra_is_one_message(base, tmp_path: Path, line: str, extra: str) -> None:
    done = within(*line.split(), folder=tmp_path)
    assert done.returncode == 2 and done.stdout == ""
    packages = extras.EXTRAS[extra].packages
    told = f"{', '.join(packages)}: pip install {' '.join(packages)}\n"
    assert done.stderr.count("\n") == 1 and done.stderr.endswith(f" needs {told}")
    assert list(tmp_path.iterdir()) == []


def test_a_result_says_what_its_pictures_and_tables_need(base) -> None:
    result = motionfmu.load("schedule").run(stop=0.1)
    for ask, extra in ((result.plot, "report"), (result.to_pandas, "pandas")):
        with pytest.raises(extras.Missing, match=f"pip install {extras.EXTRAS[extra].packages[0]}"):
            ask()


def test_gains_that_are_not_kept_are_left_out(base, tmp_path: Path, monkeypatch) -> None:
    monkeypatch.setenv("MOTIONFMU_CACHE", str(tmp_path / "cache"))
    told = " ".join(within("info", "circle").stdout.split())
    assert " gain in 1/s: a linear model needs casadi, control, " in told
    assert "pip install casadi control " in told


def test_an_extra_is_asked_of_the_wheels_file(tmp_path: Path, monkeypatch) -> None:
    """No index has the project: whoever took its name there would be installed by it."""
    wheel = tmp_path / "my wheels" / f"motionfmu-{PROJECT['version']}-py3-none-any.whl"
    given = {"url": wheel.as_uri(), "archive_info": {}}
    own = SimpleNamespace(version=PROJECT["version"], read_text=lambda name: json.dumps(given))
    monkeypatch.setattr(metadata, "distribution", lambda name: own)
    assert extras.install("tune") == f'pip install "{WHEEL}[tune]"', "the file is gone"
    wheel.parent.mkdir()
    wheel.touch()
    assert extras.install("tune") == f'pip install "{wheel}[tune]"'
    given.update(url=tmp_path.as_uri(), dir_info={"editable": True})
    assert extras.install("study") == "pip install matplotlib pyarrow scipy", "of a checkout"
    own.read_text = lambda name: None
    assert extras.install("card") == f'pip install "{WHEEL}[card]"'


def test_no_text_asks_an_index_for_the_project() -> None:
    files = [*ROOT.glob("*.*"), *ROOT.glob("Makefile")]
    for place in ("docs", "examples", "fmus", "scenarios", "src"):
        files += (f for f in (ROOT / place).rglob("*") if f.suffix in TEXTS)
    asking = re.compile(r"pip install \S*motionfmu(?!-)")
    found = [str(f) for f in files if f.is_file() and asking.search(f.read_text("utf-8", "ignore"))]
    assert found == [] and len(files) > 500
