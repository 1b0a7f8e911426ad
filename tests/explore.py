"""Fresh inputs for every property test, for as long as it is told; what fails is kept.

    python tests/explore.py 600            # [s]
    python tests/explore.py 600 contour    # tests with that in their names

A case that fails is told and kept in build/explore, one file for each test, with the line that
goes above the test; the next exploration begins with it, also with one found when the time was
over. Exit status 1 if there is one.
"""

import argparse
import random
import re
import subprocess
import sys
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
FOUND = ROOT / "build/explore"
PYTEST = [sys.executable, "-m", "pytest", "-m", "hypothesis", "-p", "no:cacheprovider"]
BATCH = 6  # tests between two looks at the clock
NAME = re.compile(r"^FAILED (\S+?\.py::[^\s]+)", re.MULTILINE)
CASE = re.compile(r"^E +\S.* (?:case|example): \w+\(\n(.*?)^E +\)", re.MULTILINE | re.DOTALL)


def pytest(*options: str, seconds: float | None = None) -> tuple[int | None, str]:
    """Status of pytest and what it says of the property tests among these; None: time is over."""
    try:
        done = subprocess.run(
            [*PYTEST, *options], cwd=ROOT, capture_output=True, text=True, timeout=seconds
        )
    except subprocess.TimeoutExpired:
        return None, ""
    return done.returncode, done.stdout + done.stderr


def names(words: str) -> list[str]:
    """Property tests with these words in their names."""
    files = [str(p) for p in ROOT.glob("tests/**/test_*.py") if "hypothesis" in p.read_text()]
    _, told = pytest("--collect-only", *files, *(["-k", words] if words else []))
    return [line for line in told.splitlines() if ".py::" in line and not line.startswith("E")]


def line_of(said: str) -> str:
    """The failing case as a line above the test, if hypothesis told one."""
    case = CASE.search(said)
    if case is None:
        return "(hypothesis told no case: see below)"
    rows = [re.sub(r"^E +", "", row) for row in case[1].splitlines()]
    return f"@example({' '.join(rows).strip().rstrip(',')})"


def keep(name: str) -> None:
    """Run what failed once more by itself, which begins with the case that was found."""
    _, said = pytest("--hypothesis-profile=fresh", name)
    tell(name, line_of(said), said)


def tell(name: str, line: str, said: str) -> None:
    """Write what was said into a file of that name, and say where it is."""
    file = FOUND / (re.sub(r"\W+", "_", name)[:200] + ".txt")
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(f"{name}\n{line}\n\n{said}")
    print(f"{name}\n  {line}\n  {file.relative_to(ROOT)}", flush=True)


def main(seconds: float, words: str = "") -> int:
    """Rounds of all tests in an order of their own; those that failed are left out afterwards."""
    left, failed, runs = names(words), 0, 0
    if not left:
        print(f"no property test has {words!r} in its name", file=sys.stderr)
        return 2
    end = time.monotonic() + seconds
    while left and time.monotonic() < end:
        order = random.SystemRandom().sample(left, len(left))
        for i in range(0, len(order), BATCH):
            rest = end - time.monotonic()
            if rest <= 0.0:
                break
            batch = order[i : i + BATCH]
            status, said = pytest("--hypothesis-profile=fresh", *batch, seconds=rest)
            if status is None:
                break
            if status not in (0, 1):  # C code may end the process: then no test is named as failed
                again = (
                    n for n in batch if pytest("--hypothesis-profile=fresh", n)[0] not in (0, 1)
                )
                ended = list(again) or batch
                tell(" ".join(ended), f"pytest ended with {status}", said)
                failed += 1
                left = [name for name in left if name not in ended]
            for name in NAME.findall(said):
                keep(name)
                failed += 1
                left.remove(name)
            runs += len(batch)
    print(f"{runs} property tests with fresh inputs, {failed} failed")
    return int(failed > 0)


if __name__ == "__main__":
    asked = argparse.ArgumentParser(description="Fresh inputs for every property test.")
    asked.add_argument("seconds", type=float)
    asked.add_argument("words", nargs="?", default="", help="of the names of tests")
    sys.exit(main(**vars(asked.parse_args())))
