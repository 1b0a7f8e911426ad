"""Changes of one line: what `make mutants` draws from, and the tests that it asks."""

import ast
import random
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

sys.path.append(str(ROOT / "tests/mutants"))

import mutants
from changes import Change, changes
from nearest_tests import of_c, of_python

C = """/* a < b */
int f(int a)
{
    const char *s = "a == b";
    if (a < 10) {
        a = g(a, 3);
    }
    return a * 2; /* a + 1 */
}
"""
PYTHON = '''"""A text with a < b and 3."""
LIMIT = "x == 1"


def f(a: int) -> str:
    if a < 10:
        a = a + 1  # and 2
    return f"{a:3d} == {a}"
'''


def made(name: str, text: str) -> list[tuple[int, str]]:
    return [(c.line, c.became.strip()) for c in changes(Path(name), text)]


def test_code_is_changed_and_neither_text_nor_comments() -> None:
    assert made("f.c", C) == [
        (5, "if (a <= 10) {"),
        (5, "if (a < 11) {"),
        (5, "if (!(a < 10)) {"),
        (6, "a = g(a, 4);"),
        (6, ";"),
        (8, "return a / 2; /* a + 1 */"),
        (8, "return a * 3; /* a + 1 */"),
    ]
    assert made("f.py", PYTHON) == [
        (6, "if a <= 10:"),
        (6, "if a < 11:"),
        (6, "if not (a < 10):"),
        (7, "a = a - 1  # and 2"),
        (7, "a = a + 2  # and 2"),
        (7, "pass"),
    ]


def test_what_is_the_same_either_way_is_no_change() -> None:
    """The less of two that are equal, and a place of an array that nobody reads."""
    within = "int f(int a, int b)\n{{\n    {}\n}}\n"
    for line, became in {
        "const int c[3] = { a, b };": [],
        "struct step all[STEPS + 1];": [],
        "return a < b ? a : b;": [],
        "return p->a[i] > b.c ? b.c : p->a[i];": [],
        "return a < (int)b ? a : (int)b;": [],
        "return a < (int)b ? a : b;": ["return a <= (int)b ? a : b;"],
        "return a < b ? a : c;": ["return a <= b ? a : c;"],
        "return a < b ? a : b + c;": ["return a <= b ? a : b + c;", "return a < b ? a : b - c;"],
        "return c + a < b ? a : b;": ["return c + a <= b ? a : b;", "return c - a < b ? a : b;"],
        "return a < b ? b : a[0];": ["return a <= b ? b : a[0];", "return a < b ? b : a[1];"],
        "return c[3];": ["return c[4];"],
    }.items():
        assert [text for _, text in made("f.c", within.format(line))] == became, line
    for line, became in {
        "b = a.reshape(len(a), -1)": ["pass"],
        "b = a.reshape(-1, 3)": ["b = a.reshape(-1, 4)", "pass"],
        "b = a[-1]": ["b = a[-2]", "pass"],
    }.items():
        assert [text for _, text in made("f.py", f"def f(a):\n    {line}\n")] == became, line


@pytest.mark.parametrize("pattern", ["src/*/*/*.c", "src/motionfmu/**/*.py"])
def test_a_change_is_one_line_and_python_stays_python(pattern: str) -> None:
    files = random.Random(1).sample(sorted(ROOT.glob(pattern)), 25)
    for file in files:
        text = file.read_text()
        found: list[Change] = list(changes(file, text))
        for change in random.Random(2).sample(found, min(10, len(found))):
            pairs = zip(text.split("\n"), change.text(text).split("\n"), strict=True)
            assert [k + 1 for k, (a, b) in enumerate(pairs) if a != b] == [change.line]
            if file.suffix == ".py":
                ast.parse(change.text(text))


def test_most_cores_have_tests_that_are_near() -> None:
    """The others are seen by tests of FMUs alone, and told as such."""
    cores = [f.parent for f in ROOT.glob("src/*/*/core.toml")]
    near = [core.name for core in cores if of_c(ROOT, next(core.glob("*.c")))]
    assert 0.8 * len(cores) <= len(near)
    assert of_c(ROOT, ROOT / "src/controllers/netcard/flash_chip.c")[0].startswith("flash")


def test_tests_of_a_module_are_those_that_name_it() -> None:
    near = of_python(ROOT, ROOT / "src/motionfmu/study/tune/choice.py")
    assert len(near) == 12 and all("tun" in test for test in near[:3])


def test_tests_of_a_private_function_are_those_of_its_callers() -> None:
    file = ROOT / "src/motionfmu/run/session.py"
    lines = file.read_text().splitlines()
    line = next(k for k, text in enumerate(lines, 1) if "def _side_by_side(" in text)
    assert "tests/runs/test_side_by_side.py" in of_python(ROOT, file, line + 1)


def test_tests_name_what_their_helpers_name() -> None:
    near = of_python(ROOT, ROOT / "src/motionfmu/report/studies/sweep_page.py")
    assert "tests/pages/test_outlines.py" in near


def test_tests_of_a_command_reach_what_its_module_hands_on_to() -> None:
    """`contour` is typed; its module has another one, which writes the page."""
    near = of_python(ROOT, ROOT / "src/motionfmu/report/cause_pages/record_page.py")
    assert "tests/records/test_record_contour.py" in near


def test_what_is_for_a_checker_alone_is_not_changed() -> None:
    text = "if TYPE_CHECKING:\n    import json\n\nx = 1\n"
    assert {c.line for c in changes(Path("x.py"), text)} == {4}


@pytest.mark.more
def test_tests_that_make_test_leaves_out_are_asked(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mutants, "TREE", tmp_path)
    monkeypatch.setattr(mutants, "PYTHON", Path(sys.executable))
    (tmp_path / "pytest.ini").write_text(
        "[pytest]\naddopts = -m 'not long and not more'\nmarkers =\n    more\n    long\n"
    )
    text = (
        "import pytest\ndef test_one():\n    pass\n@pytest.mark.more\ndef test_two():\n    assert "
    )
    for outcome in (True, False):
        (tmp_path / "test_some.py").write_text(f"{text}{outcome}\n")
        assert mutants.python_tests(["test_some.py"]) == outcome


def test_processes_that_tests_start_have_the_package_of_the_copy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    python = tmp_path / "venv/bin/python"
    monkeypatch.setattr(mutants, "TREE", tmp_path)
    monkeypatch.setattr(mutants, "PYTHON", python)
    (tmp_path / "src/motionfmu").mkdir(parents=True)
    (tmp_path / "src/motionfmu/__init__.py").write_text("")
    mutants.interpreter()
    line = "import motionfmu, numpy, sys, subprocess as s; print(motionfmu.__file__, flush=True);"
    line += " len(sys.argv) > 1 or s.run([sys.executable, '-c', sys.orig_argv[2], 'again'])"
    told = subprocess.run([python, "-c", line], capture_output=True, text=True, cwd=tmp_path)
    assert told.stdout.split() == 2 * [str(tmp_path / "src/motionfmu/__init__.py")], told.stderr
