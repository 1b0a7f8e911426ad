"""The card's commands on a system without fcntl and Unix sockets, as Windows is one."""

import errno
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT

from motionfmu.base.errors import InputError
from motionfmu.cards.keys import alone

# Its msvcrt locks a byte by another way of this system, so that locks still keep others out.
HIDDEN = """
import asyncio, fcntl, subprocess, sys, types  # the first two look for the real msvcrt

def locking(file, mode, count):
    fcntl.lockf(file, fcntl.LOCK_EX | (fcntl.LOCK_NB if mode else 0), count)

sys.modules["msvcrt"] = types.SimpleNamespace(locking=locking, LK_LOCK=0, LK_NBLCK=1)
sys.modules["fcntl"] = None
import motionfmu.cards.control as control
control.socket = types.SimpleNamespace()
from motionfmu.__main__ import main
sys.argv[0] = "motionfmu"
sys.exit(main())
"""


def told(folder: Path, *words: str) -> tuple[int, str, str]:
    """Status, output and errors of a command there."""
    done = subprocess.run(
        [sys.executable, "-c", HIDDEN, *words], cwd=folder, capture_output=True, text=True
    )
    assert "Traceback" not in done.stderr
    return done.returncode, done.stdout, done.stderr


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    shutil.copy(ROOT / "examples/network_card_firmware/card.toml", tmp_path)
    (tmp_path / "a.plt").write_text("PU400,400;PD2000,400;")
    return tmp_path


def test_drawings_keys_and_headers_are_as_everywhere(folder: Path) -> None:
    status, said, _ = told(folder, "card", "plan", "a.plt", "-c", "card.toml", "-o", "a.mcj")
    assert status == 0 and "pen down 40.0 mm" in said and (folder / "a.mcj").stat().st_size > 256
    assert told(folder, "card", "show", "a.mcj")[0] == 0
    assert told(folder, "card", "headers", "card.toml", "-o", "include")[0] == 0
    assert told(folder, "card", "key", "new", "3")[0] == 0
    (keys,) = folder.rglob("keys.toml")
    keys.chmod(0o666)  # as every file there is: Windows has no such bits
    status, _, wrong = told(folder, "card", "key", "new", "3")
    assert status == 2 and "card 3 has a key" in wrong
    assert told(folder, "card", "key", "new", "4")[0] == 0


@pytest.mark.parametrize("words", [["serve", "--page", "0"], ["stop", "1"], ["status"]])
def test_what_needs_a_unix_socket_says_so(folder: Path, words: list[str]) -> None:
    status, _, wrong = told(folder, "card", *words)
    assert status == 2 and "Unix socket" in wrong
    assert wrong.count("\n") <= 3


def test_a_lock_by_msvcrt_keeps_others_out(folder: Path) -> None:
    held = f"""
from motionfmu.cards.keys import alone
from pathlib import Path
with alone(Path({str(folder)!r}), wait=False):
    print(subprocess.run([sys.executable, "-c", {HIDDEN!r}, "card", "sim", "--flash",
                          {str(folder)!r}], capture_output=True, text=True).stderr)
"""
    code = HIDDEN.split("from motionfmu.__main__")[0] + held
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    assert "another program uses this folder" in done.stdout, done.stderr


def test_a_lock_that_is_not_to_be_had_for_another_reason_says_which(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def no_locks(*_: int) -> None:
        raise OSError(errno.ENOLCK, os.strerror(errno.ENOLCK))

    monkeypatch.setattr("fcntl.flock", no_locks)
    with pytest.raises(InputError, match=f"^{tmp_path}: No locks available$"), alone(tmp_path):
        pass
