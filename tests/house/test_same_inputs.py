"""Tests get the same inputs on every machine: nothing is drawn without a seed."""

import ast
import os
import re
import subprocess
import sys
from pathlib import Path

import explore
import pytest
from conftest import ROOT

EXPLORE = ROOT / "tests/explore.py"
PARTS = ("tests", "scenarios", "examples")
# explore.py is what tries the tests in an order of its own.
FILES = sorted({p for part in PARTS for p in ROOT.glob(f"{part}/**/*.py")} - {EXPLORE})
PROPERTY = "tests/runs/test_contour_geometry.py::test_kepler_root_is_the_one_brent_finds"
# What draws from the day or the process, by the module it comes from (None: all of it), but for
# what is made with a seed.
NEVER = {
    "os": {"urandom", "getrandom"},
    "uuid": {"uuid1", "uuid4"},
    "builtins": {"hash"},
    "random": None,
    "numpy.random": None,
    "secrets": None,
}
SEEDED = {"Random", "default_rng", "Generator", "PCG64", "SeedSequence"}


def drawn(text: str) -> list[str]:
    """Calls of a module that draw without a seed."""
    tree = ast.parse(text)
    known = {"hash": "builtins.hash"}
    for node in ast.walk(tree):
        if isinstance(node, ast.Import):
            for a in node.names:
                head = a.name.split(".")[0]
                known[a.asname or head] = a.name if a.asname else head
        elif isinstance(node, ast.ImportFrom):
            known |= {a.asname or a.name: f"{node.module}.{a.name}" for a in node.names}
    found = []
    for node in ast.walk(tree):
        if not isinstance(node, ast.Call):
            continue
        said = ast.unparse(node.func)
        head, _, rest = said.partition(".")
        module, _, name = ".".join([known.get(head, ""), *([rest] if rest else [])]).rpartition(".")
        names = NEVER.get(module, set())
        seeded = name in SEEDED and (node.args or node.keywords)
        if (names is None or name in names) and not seeded:
            found.append(f"{node.lineno}: {said}")
    return found


@pytest.mark.parametrize(
    "text",
    [
        "import random\nrandom.Random()",
        "import random\nrandom.choice([1])",
        "from random import shuffle\nshuffle([])",
        "import numpy as np\nnp.random.default_rng()",
        "import numpy as np\nnp.random.uniform(0, 1)",
        "import os\nos.urandom(3)",
        "hash('a')",
    ],
)
def test_what_draws_without_a_seed_is_seen(text: str) -> None:
    assert len(drawn(text)) == 1


def test_what_has_a_seed_is_not() -> None:
    assert not drawn("import random\nrandom.Random(5).choice([1])")
    assert not drawn("import numpy as np\nnp.random.default_rng(seed=5).uniform(0, 1)")


def test_every_draw_has_a_seed() -> None:
    assert [f"{p.relative_to(ROOT)}:{line}" for p in FILES for line in drawn(p.read_text())] == []


def examples(seed: str, *options: str) -> list[str]:
    """What a property is tried with in a process whose sets have an order of their own.

    With the variable CI hypothesis takes other defaults, none of which may reach our profiles.
    """
    command = [sys.executable, "-m", "pytest", "-s", "--hypothesis-verbosity=verbose", PROPERTY]
    done = subprocess.run(
        [*command, *options],
        cwd=ROOT,
        env={**os.environ, "PYTHONHASHSEED": seed, "CI": "1"},
        capture_output=True,
        text=True,
    )
    assert done.returncode == 0, done.stdout
    return re.findall(r"^Test case: .*?^\)", done.stdout, re.MULTILINE | re.DOTALL)


@pytest.mark.more
def test_two_runs_draw_the_same_and_exploring_does_not() -> None:
    one = examples("1")
    assert len(one) >= 200
    assert examples("2") == one
    fresh = [examples("1", "--hypothesis-profile=fresh") for _ in range(2)]
    assert one not in fresh
    assert fresh[0] != fresh[1]


@pytest.mark.more
def test_an_exploration_tells_a_process_that_ended(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """As C code ends one: pytest names no test as failed then."""
    monkeypatch.setattr(explore, "ROOT", tmp_path)
    monkeypatch.setattr(explore, "FOUND", tmp_path / "found")
    (tmp_path / "tests").mkdir()
    (tmp_path / "pytest.ini").write_text("[pytest]\naddopts = -q\n")
    (tmp_path / "tests/conftest.py").write_text(
        "from hypothesis import settings\nsettings.register_profile('fresh', max_examples=1)\n"
    )
    (tmp_path / "tests/test_end.py").write_text(
        "import os\nfrom hypothesis import given, strategies\n"
        "@given(strategies.integers())\ndef test_end(x):\n    os._exit(77)\n"
    )
    assert explore.main(3600.0) == 1
    assert "pytest ended with 77" in capsys.readouterr().out
    (kept,) = (tmp_path / "found").iterdir()
    assert kept.read_text().startswith("tests/test_end.py::test_end\npytest ended with 77")
