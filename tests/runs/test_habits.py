"""What all commands share: -o, -q, -v, --open, --json, completion; a package with types."""

import json
import os
import subprocess
import sys
from importlib.resources import files
from pathlib import Path

import pytest
from console import within

from motionfmu.cli import _commands

ROOT = Path(__file__).parents[2]
LINE = ROOT / "scenarios/mismatch_line"


def every() -> dict[str, dict[str, list[str]]]:
    """Options of each command, by parameter."""
    import typer

    found = {}

    def walk(name: str, command) -> None:
        for key, inner in getattr(command, "commands", {}).items():
            walk(f"{name} {key}", inner)
        if not hasattr(command, "commands"):
            found[name] = {p.name: p.opts for p in command.params}

    walk("", typer.main.get_command(_commands()))
    return found


def test_every_command_has_the_habits() -> None:
    commands = every()
    assert {" run", " card plan", " new fmu"} < {*commands}
    for name, options in commands.items():
        assert {*options["quiet"]} == {"-q", "--quiet"}, name
        assert {*options["verbose"]} == {"-v", "--verbose"}, name
        outs = [opts for opts in options.values() if "--out" in opts]
        assert all("-o" in opts for opts in outs), name
        assert ("open" in options) == ("folder" in options), name
    assert sum("open" in options for options in commands.values()) >= 7


def test_quiet_prints_nothing_and_verbose_more(tmp_path: Path) -> None:
    done = within("run", LINE, "-q", "-o", tmp_path / "r")
    assert (done.returncode, done.stdout, done.stderr) == (0, "", "")
    assert (tmp_path / "r/report.html").is_file()
    usual, more = (
        within("run", LINE, "-o", tmp_path / "r"),
        within("run", LINE, "-v", "-o", tmp_path / "r"),
    )
    assert "engine:" not in usual.stdout and "engine: " in more.stdout and "took " in more.stderr
    judged = within("check", LINE, "-v")
    assert "contour.error.max" in judged.stdout and "1 hold" in judged.stdout
    wrong = within("run", "nothing", "-q")
    assert wrong.returncode == 2 and "no such scenario" in wrong.stderr


def test_json_of_a_run_is_its_result_json(tmp_path: Path) -> None:
    done = within("run", LINE, "--json", "-q")
    assert done.returncode == 0
    told = json.loads(done.stdout)
    within("run", LINE, "-o", tmp_path / "r", "--json")
    assert told == json.loads((tmp_path / "r/result.json").read_text()) and told["ok"] is True


def test_open_opens_the_page(tmp_path: Path) -> None:
    browser = tmp_path / "browser"
    browser.write_text(f'#!/bin/sh\necho "$1" > {tmp_path}/opened\n')
    browser.chmod(0o755)
    env = {**os.environ, "BROWSER": f"{browser} %s"}
    command = [sys.executable, "-m", "motionfmu", "run", LINE, "-o", tmp_path / "r", "--open"]
    subprocess.run(command, env=env, check=True, capture_output=True)
    assert (tmp_path / "opened").read_text().strip() == (tmp_path / "r/report.html").as_uri()


@pytest.mark.parametrize(
    ("words", "count", "offered"),
    [("motionfmu ru", 1, ["run"]), ("motionfmu run circ", 2, ["circle", "circle_theory"])],
)
def test_a_shell_is_offered_commands_and_scenarios(words, count, offered) -> None:
    env = {**os.environ, "_MOTIONFMU_COMPLETE": "complete_bash"}
    env |= {"COMP_WORDS": words, "COMP_CWORD": str(count)}
    done = subprocess.run(
        [Path(sys.executable).parent / "motionfmu"], env=env, capture_output=True, text=True
    )
    assert done.stdout.split() == offered


@pytest.mark.more
def test_a_consumer_is_checked_by_the_types_of_the_package(tmp_path: Path) -> None:
    assert (files("motionfmu") / "py.typed").is_file()
    file = tmp_path / "mine.py"
    file.write_text(
        'import motionfmu\n\nresult: motionfmu.Result = motionfmu.load("x").run(stop=1.0)\n'
        "error: float = result.contour().error.max\n"
    )
    env = {**os.environ, "MYPYPATH": ""}
    command = [sys.executable, "-m", "mypy", "--strict", "--follow-imports=silent"]
    command += ["--config-file=", "--cache-dir", tmp_path / "cache"]

    def checked() -> subprocess.CompletedProcess:
        return subprocess.run(
            [*command, file], env=env, cwd=tmp_path, capture_output=True, text=True
        )

    good = checked()
    assert good.returncode == 0, good.stdout
    file.write_text(file.read_text() + 'wrong: str = motionfmu.load("x").run().ok\n')
    assert "Incompatible types" in checked().stdout
