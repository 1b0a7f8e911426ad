"""wine is started again where it did not start, and first by one process, with a wine of ours."""

import subprocess
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest
from starting import TRIES, first_start, start

HINT = "it looks like wine32 is missing, you should install it."  # Debian's first line
GONE = "wine: chdir to wine-x/server-y : No such file or directory"
# Complains each time, starts at the given one; `cmd` is what it is first started with.
COUNTED = f"""#!/bin/sh
echo "{HINT}" >&2
test "$1" = cmd && exit 0
echo "$1" >> started
echo "{{told}}" >&2
test "$(wc -l < started)" -ge {{there}} || exit 3
"""
# Fails as Debian's wine does if another one starts while there is no folder of a server.
RACING = f"""#!/bin/sh
test -d server && exit 0
mkdir starting 2>/dev/null || {{ echo "{GONE}" >&2; exit 1; }}
sleep 0.3
mkdir server
rmdir starting
"""


@pytest.fixture
def place(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> Iterator[Path]:
    """A folder for files of its own, with a program that stands for wine."""
    monkeypatch.setenv("PATH", str(tmp_path), prepend=":")
    monkeypatch.setenv("TMPDIR", str(tmp_path))
    first_start.cache_clear()
    yield tmp_path
    first_start.cache_clear()


def made(place: Path, text: str) -> None:
    (place / "wine").write_text(text)
    (place / "wine").chmod(0o755)


@pytest.mark.parametrize(
    ("told", "there", "starts", "code"),
    [
        (GONE, 2, 2, 0),
        ("wine client error:0: write: Bad file descriptor", 3, 3, 0),
        ("preloader: Warning: failed to reserve range", 2, 2, 0),
        (GONE, 9, TRIES, 3),
        ("part.ngc: No such file or directory", 2, 1, 3),
    ],
)
def test_what_did_not_start_is_started_again(
    told: str, there: int, starts: int, code: int, place: Path
) -> None:
    """A program that ran and failed is not."""
    made(place, COUNTED.format(told=told, there=there))
    done = start(("wine", "program.exe"), place)
    assert (done.returncode, (place / "started").read_text().count("\n")) == (code, starts)
    assert HINT in done.stderr.decode()


def test_one_process_makes_the_first_start(place: Path) -> None:
    made(place, RACING)
    words = f"""import sys
sys.path[:0] = [{str(Path(__file__).parent)!r}]
from pathlib import Path
from starting import start
sys.exit(start(("wine", "program.exe"), Path()).returncode)"""
    at_once = [subprocess.Popen((sys.executable, "-c", words), cwd=place) for _ in range(4)]
    assert [one.wait() for one in at_once] == [0] * 4
