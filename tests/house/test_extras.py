"""What is not in the base of the package is told by the extra that brings it, at once."""

import ast
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


EXAMPLES = sorted(file.parent for file in (ROOT / "examples").glob("*/README.md"))
# An extra as a text names it: of a wheel's file, or in words.
OF_A_FILE = re.compile(r"""\.whl\)?["']?\[([\w,]+)\]""")
IN_WORDS = re.compile(r"extras? ((?:`\w+`(?:, | and )?)+)")


def named(texts: list[str]) -> set[str]:
    """The extras that some texts name."""
    listed = [part for text in texts for part in OF_A_FILE.findall(text)]
    words = [part for text in texts for part in IN_WORDS.findall(text)]
    return {e for part in listed for e in part.split(",")} | {
        e for part in words for e in re.findall(r"\w+", part) if e != "and"
    }


def of_module(name: str) -> set[str]:
    """The extras that the folders of the package ask for when a module of theirs is imported."""
    parts = name.split(".")
    files = [ROOT / "src" / "/".join(parts[:n]) / "__init__.py" for n in range(2, len(parts) + 1)]
    texts = [f.read_text() for f in files if f.is_file()]
    told = {e for text in texts for e in re.findall(r'^ *needed\("(\w+)"\)', text, re.MULTILINE)}
    return told | {"tune" for text in texts if "= at_first_use(" in text}


def of_command(words: list[str]) -> set[str]:
    """The extras that a command asks for whatever its options are."""
    for name in ("_".join(words[:2]), words[0]):
        file = ROOT / f"src/motionfmu/cli/{name.replace('-', '_')}.py"
        if file.is_file():
            body = re.search(r"\) -> None:\n(.*?)(?=^\S|\Z)", file.read_text(), re.M | re.S)
            return set(re.findall(r'^    needed\("(\w+)"\)', body[1] if body else "", re.M))
    return set()


def asked(code: list[str], shell: list[str]) -> list[set[str]]:
    """What Python and commands need: of each thing the extras of which one must be there."""
    found = []
    for text in code:
        tree = list(ast.walk(ast.parse(text)))
        modules = {a.name for n in tree if isinstance(n, ast.Import) for a in n.names}
        froms = [n for n in tree if isinstance(n, ast.ImportFrom) and n.module]
        modules |= {f"{n.module}.{a.name}" for n in froms for a in n.names}
        tops = {m.split(".")[0] for m in modules}
        found += [{e for e, x in extras.EXTRAS.items() if top in x.packages} for top in tops]
        found += [{e} for m in modules if m.startswith("motionfmu.") for e in of_module(m)]
        found += [{"pandas"}] if ".to_pandas(" in text else []
    for text in shell:
        for line in re.findall(r"^(?:.* )?(?:motionfmu|motion) (.+)$", text, re.MULTILINE):
            found += [{e} for e in of_command(line.split())]
            found += [{"report"}] if "--pictures" in line else []
    return [one for one in found if one]


def parts(folder: Path) -> tuple[list[str], list[str], list[str]]:
    """Python of an example, what it runs in a shell, and all texts that may name an extra."""
    readme = (folder / "README.md").read_text()
    blocks = re.findall(r"^```(\w+)\n(.*?)^```", readme, re.MULTILINE | re.DOTALL)
    files = [f for f in folder.rglob("*") if f.suffix in (".yml", "") and f.is_file()]
    texts = [f.read_text("utf-8", "ignore") for f in files]
    code = [f.read_text() for f in folder.rglob("*.py")]
    code += [text for kind, text in blocks if kind == "python"]
    for file in folder.glob("*.ipynb"):
        cells = json.loads(file.read_text())["cells"]
        code.append("\n".join("".join(c["source"]) for c in cells if c["cell_type"] == "code"))
    return code, [text for kind, text in blocks if kind == "sh"] + texts, [readme, *texts]


@pytest.mark.parametrize("folder", EXAMPLES, ids=lambda f: f.name)
def test_an_example_names_the_extras_that_it_needs(folder: Path) -> None:
    code, shell, texts = parts(folder)
    told = named(texts)
    assert told <= PROJECT["optional-dependencies"].keys()
    assert [one for one in asked(code, shell) if not one & told] == []


def test_what_an_example_needs_is_found() -> None:
    assert named(['pip install "$(ls a.whl)[report,tune]"', "the extras `card` and `ros`"]) == {
        "report",
        "tune",
        "card",
        "ros",
    }
    code = "import motionfmu\nfrom motionfmu.study.tune import tune\nimport pandas as pd"
    assert asked([code], []) == [{"pandas"}, {"tune"}]
    assert asked(["from motionfmu import sweep"], []) == [{"study"}]
    lines = "motionfmu run circle --pictures\nmotionfmu identify a\ntime motionfmu card plan x"
    assert asked([], [lines]) == [{"report"}, {"tune"}, {"card"}]
    assert sum(bool(asked(*parts(folder)[:2])) for folder in EXAMPLES) > 4


def test_no_text_asks_an_index_for_the_project() -> None:
    files = [*ROOT.glob("*.*"), *ROOT.glob("Makefile")]
    for place in ("docs", "examples", "fmus", "scenarios", "src"):
        files += (f for f in (ROOT / place).rglob("*") if f.suffix in TEXTS)
    asking = re.compile(r"pip install \S*motionfmu(?!-)")
    found = [str(f) for f in files if f.is_file() and asking.search(f.read_text("utf-8", "ignore"))]
    assert found == [] and len(files) > 500
