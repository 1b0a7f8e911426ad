"""An old name that still works is told once, at the user's line."""

import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT
from console import command

from motionfmu.base import deprecation
from motionfmu.base.deprecation import OldNameWarning, renamed

CARD = "examples/network_card_firmware/card.toml"


@pytest.fixture(autouse=True)
def fresh(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(deprecation, "_told", set())


def test_an_old_name_is_told_once(recwarn: pytest.WarningsRecorder) -> None:
    renamed("a", "b", ends="9.9")
    renamed("a", "b", ends="9.9")  # another line: Python alone would tell it again
    renamed("c", "d", ends="9.9")
    assert [str(w.message) for w in recwarn] == [
        "a is b now; version 9.9 refuses the old name",
        "c is d now; version 9.9 refuses the old name",
    ]
    assert all(w.filename == __file__ and w.category is OldNameWarning for w in recwarn)


def test_the_place_is_the_users_however_deep_the_package_is(
    recwarn: pytest.WarningsRecorder,
) -> None:
    names = {"__name__": "motionfmu.some.module", "renamed": renamed}
    exec("def inner(): renamed('e', 'f', ends='9.9')\ndef outer(): inner()", names)
    names["outer"]()
    assert [w.filename for w in recwarn] == [__file__]


def test_python_shows_it_by_itself() -> None:
    """In a module that is not the main program, where a DeprecationWarning would be hidden."""
    code = (
        "import sys, types; sys.path.insert(0, 'src')\n"
        "from motionfmu.base.deprecation import renamed\n"
        "exec(\"renamed('a', 'b', ends='9.9')\", {'__name__': 'library', 'renamed': renamed})\n"
    )
    done = subprocess.run([sys.executable, "-c", code], cwd=ROOT, capture_output=True, text=True)
    assert "OldNameWarning: a is b now; version 9.9 refuses the old name" in done.stderr


@pytest.mark.parametrize(
    ("option", "told"),
    [
        ("--output", "card plan --output is --out now; version 0.3 refuses the old name"),
        ("--out", ""),
    ],
)
def test_a_job_goes_where_the_old_option_says(tmp_path: Path, option: str, told: str) -> None:
    drawing = tmp_path / "line.plt"
    drawing.write_text("IN;SP1;PU0,0;PD400,0;PU;")
    done = command("card", "plan", drawing, "-c", CARD, option, tmp_path / "a.mcj")
    line = f"motionfmu: warning: {told}\n" if told else ""
    assert (done.returncode, done.stderr) == (0, line)
    assert (tmp_path / "a.mcj").is_file()
    assert option == "--out" or "--output" not in command("card", "plan", "--help").stdout
