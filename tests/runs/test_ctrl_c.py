"""Ctrl-C at any moment: one line, status 130, nothing half written."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
from conftest import ROOT

# Ends its own process as Ctrl-C does when a module of this name is looked for.
PROGRAM = """
import importlib.abc, os, signal, sys

class Interrupt(importlib.abc.MetaPathFinder):
    def find_spec(self, name, path=None, target=None):
        if name == module:
            sys.meta_path.remove(self)
            os.kill(os.getpid(), signal.SIGINT)

module = sys.argv.pop(1)
signal.signal(signal.SIGINT, signal.default_int_handler)  # ignored in the background
from motionfmu.__main__ import main
sys.meta_path.insert(0, Interrupt())
main()
"""
RUN = "run scenarios/mismatch_line --stop 0.02 --out"


def environment(folder: Path) -> dict[str, str]:
    return {**os.environ, "PYTHONPATH": str(ROOT / "src"), "TMPDIR": str(folder)}


@pytest.mark.parametrize(
    ("line", "module"),
    [
        ("list", "typer"),
        ("--help", "motionfmu.cli.info"),
        (RUN, "numpy"),
        (RUN, "motionfmu.run.engines.fused_engine"),  # the run has a folder by then
        (RUN, "motionfmu.run.contour_of"),  # so has its result
        ("card serve --page 0 --port 0 --folder", "motionfmu.cards.control"),
    ],
)
def test_an_interrupt_while_modules_are_loaded(line: str, module: str, tmp_path: Path) -> None:
    words = line.split()
    if words[-1].startswith("--") and words[-1] != "--help":
        words.append(str(tmp_path / "out"))
    done = subprocess.run(
        [sys.executable, "-c", PROGRAM, module, *words],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment(tmp_path),
        timeout=60,
    )
    assert (done.returncode, done.stderr) == (130, "motionfmu: stopped\n")
    assert "run" not in line or list(tmp_path.iterdir()) == []


EARLY = """
import os, signal, sys

class Interrupt:
    def find_spec(self, name, path=None, target=None):
        if name == module:
            os.kill(os.getpid(), signal.SIGINT)

module = sys.argv.pop(1)
for name in ("typing", "contextlib", "importlib.machinery"):
    sys.modules.pop(name, None)
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.meta_path.insert(0, Interrupt())
from motionfmu.__main__ import main
main()
"""


@pytest.mark.parametrize("module", ["motionfmu.cli", "typing", "motionfmu.cli.common", "typer"])
def test_an_interrupt_before_the_commands_are_there(module: str, tmp_path: Path) -> None:
    done = subprocess.run(
        [sys.executable, "-c", EARLY, module, "list"],
        capture_output=True,
        text=True,
        cwd=ROOT,
        env=environment(tmp_path),
        timeout=60,
    )
    assert (done.returncode, done.stdout, done.stderr) == (130, "", "motionfmu: stopped\n")


def test_the_package_is_there_before_it_imports_anything() -> None:
    """The handler stands behind it."""
    line = [sys.executable, "-S", "-c", "import sys; a = set(sys.modules); import motionfmu;"
            " print(*sorted(set(sys.modules) - a))"]  # fmt: skip
    done = subprocess.run(line, capture_output=True, text=True, env=environment(Path()))
    assert done.stdout == "motionfmu\n", done.stderr


def children(process: int) -> list[str]:
    threads = Path(f"/proc/{process}/task").glob("*/children")
    return [child for file in threads for child in file.read_text().split()]


def test_an_interrupt_of_a_check_in_processes_ends_them_all(tmp_path: Path) -> None:
    line = ["check", "scenarios/square", "scenarios/mismatch_line", "-j", "2"]
    program = subprocess.Popen(
        [sys.executable, "-m", "motionfmu", *line, "--junit", str(tmp_path / "check.xml")],
        cwd=ROOT,
        env=environment(tmp_path),
        start_new_session=True,
        preexec_fn=lambda: signal.signal(signal.SIGINT, signal.SIG_DFL),
        stdout=subprocess.PIPE,
        stderr=subprocess.PIPE,
        text=True,
    )
    while len(started := children(program.pid)) < 2 and program.poll() is None:
        time.sleep(0.01)
    os.killpg(program.pid, signal.SIGINT)  # as a terminal does
    end = time.monotonic() + 60
    out, err = program.communicate(timeout=60)
    assert (program.returncode, out, err) == (130, "", "motionfmu: stopped\n")
    while [child for child in started if Path(f"/proc/{child}").exists()]:
        time.sleep(0.01)  # whoever reaps them may be behind
        assert time.monotonic() < end
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("ignored", [True, False])
def test_a_signal_that_is_ignored_stays_so(ignored: bool) -> None:
    """In the background of a shell Ctrl-C is another program's; elsewhere it is told in a line."""
    shown = "import motionfmu.__main__ as m, signal; print(repr(signal.getsignal(signal.SIGINT)))"
    before = "SIG_IGN" if ignored else "default_int_handler"
    program = f"import signal; signal.signal(signal.SIGINT, signal.{before}); {shown}"
    ran = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert ("SIG_IGN" if ignored else "function _stop") in ran.stdout, ran.stderr
