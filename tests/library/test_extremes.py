"""Numbers at the ends of what there is, at every public call of the Python bindings."""

import os
import subprocess
import sys
from pathlib import Path

import pytest
from conftest import ROOT
from few_cases import few

WALK = Path(__file__).with_name("extremes.py")


def walked(which: str, every: int) -> None:
    """Every n-th of the calls in a process of its own, which a call may end."""
    line = [sys.executable, str(WALK), which, str(every)]
    kept = {k: v for k, v in os.environ.items() if k in ("PATH", "HOME")}
    own = {"PYTHONPATH": f"{ROOT / 'src'}"}
    done = subprocess.run(line, capture_output=True, text=True, env=own | kept)
    last = done.stdout.splitlines()[-1:]
    assert done.returncode == 0, f"{done.stderr or 'ended in'} {last}"


@pytest.mark.parametrize(
    ("which", "every"), few([("card", 7), ("mcc", 41), ("robot", 41), ("arm", 7)], 1)
)
def test_each_call_returns_or_refuses_and_a_plain_move_still_works(which: str, every: int) -> None:
    walked(which, every)


@pytest.mark.long
@pytest.mark.parametrize("which", ["card", "mcc", "robot", "arm"])
def test_all_of_them(which: str) -> None:
    walked(which, 1)
