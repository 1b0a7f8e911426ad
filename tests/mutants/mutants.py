"""Change one line at a time and see whether the nearest tests notice: `make mutants`.

Changes are drawn by a seed, as many of each folder of the cores and of the package as the square
root of its lines asks for. They are made in a copy under build/mutants, never in this tree. What
nobody notices is listed with file, line and texts; accepted.toml names those that change nothing
that matters, with the reason, and they are told no more.

    mutants.py [--count 300] [--seed 1] [--minutes 60] [--only src/controllers/robot] [--ending c]
"""

import argparse
import hashlib
import itertools
import math
import os
import random
import resource
import shutil
import subprocess
import sys
import time
import tomllib
import venv
from collections import Counter, defaultdict
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path

from changes import Change, changes
from nearest_tests import of_c, of_python
from rich.console import Console
from rich.progress import Progress

ROOT = Path(__file__).resolve().parents[2]
PLACE = ROOT / "build/mutants"
TREE, BUILT, PYTHON = PLACE / "tree", PLACE / "built", PLACE / "venv/bin/python"
# For the tests of a change, which take seconds, or minutes on a busy machine: their processor's
# time, and a sleeper's. What a C test takes by itself is known: a change has so many times that.
PATIENCE, SLEEP = 900, 3600  # [s]
LONGER, AT_LEAST = 10, 30  # [s]
NEAREST = 3  # Python tests that are asked in one go
# No C test compiles these: a plant is made of its template, others are loaded built, by Python.
ELSEWHERE = ("src/plant", "src/python", "src/controllers/robot_station")


def copy() -> None:
    """Bring the copy up to date; a file that is the same keeps its time and is not built anew."""
    listed = subprocess.check_output(
        ["git", "ls-files", "-co", "--exclude-standard", "-z"], cwd=ROOT, text=True
    )
    names = {n for n in listed.split("\0") if n and (ROOT / n).is_file()}
    for old in [f for f in TREE.rglob("*") if f.is_file() and not f.is_symlink()]:
        if str(old.relative_to(TREE)) not in names and "__pycache__" not in old.parts:
            old.unlink()
    for name in names:
        to, data = TREE / name, (ROOT / name).read_bytes()
        if not to.exists() or to.read_bytes() != data:
            to.parent.mkdir(parents=True, exist_ok=True)
            to.write_bytes(data)
    if not (TREE / "build").exists():  # what Python tests run is what is built
        (TREE / "build").symlink_to(ROOT / "build")


def interpreter() -> None:
    """Make a Python that has this one's packages, but for motionfmu, which it has from the copy.

    So have the processes that tests start: an installed checkout is found before any path.
    """
    if not PYTHON.exists():
        venv.create(PYTHON.parents[1], symlinks=True)
    (site,) = PYTHON.parents[1].glob("lib/python*/site-packages")
    packages = [TREE / "src", *(p for p in sys.path if "site-packages" in p)]
    (site / "packages.pth").write_text("".join(f"{p}\n" for p in packages))


def draw(count: int, seed: int, only: str, ending: str) -> list[Change]:
    """Changes of all folders, in an order in which any beginning has some of each."""
    folders: dict[str, list[list[Change]]] = defaultdict(list)  # of a line each: tables are long
    lines: Counter[str] = Counter()
    for file in sorted(
        [
            *TREE.glob("src/*/*.c"),
            *TREE.glob("src/*/*/*.c"),
            *TREE.glob("src/fmi/*.inc"),
            *TREE.glob("src/motionfmu/**/*.py"),
        ]
    ):
        folder = str(file.parent.relative_to(TREE))
        if folder.startswith(only) and file.suffix.endswith(ending) and folder not in ELSEWHERE:
            text = file.read_text()
            folders[folder] += [
                list(of) for _, of in itertools.groupby(changes(file, text), lambda c: c.line)
            ]
            lines[folder] += text.count("\n")
    picker = random.Random(seed)
    total = sum(math.sqrt(n) for n in lines.values())
    drawn = []
    for folder, found in sorted(folders.items()):
        share = max(1, round(count * math.sqrt(lines[folder]) / total))
        chosen = picker.sample(found, min(share, len(found)))
        drawn += [(k / share, picker.choice(of_line)) for k, of_line in enumerate(chosen)]
    picker.shuffle(drawn)
    return [change for _, change in sorted(drawn, key=lambda d: d[0])][:count]


def used() -> float:
    """Processor's time of all commands so far [s]."""
    children = resource.getrusage(resource.RUSAGE_CHILDREN)
    return children.ru_utime + children.ru_stime


def ran(line: list[str], cwd: Path, patience: int = PATIENCE) -> bool:
    """Whether a command holds within its processor's time [s]."""

    def limited() -> None:
        resource.setrlimit(resource.RLIMIT_CPU, (patience, patience))

    try:
        quiet = {
            "stdin": subprocess.DEVNULL,
            "stdout": subprocess.DEVNULL,
            "stderr": subprocess.DEVNULL,
        }
        done = subprocess.run(
            line, cwd=cwd, timeout=SLEEP, check=False, preexec_fn=limited, **quiet
        )
        return done.returncode == 0
    except subprocess.TimeoutExpired:
        return False


def make(targets: list[str]) -> bool:
    return (
        subprocess.run(
            ["ninja", "-C", BUILT, *targets], capture_output=True, check=False
        ).returncode
        == 0
    )


def python_tests(files: list[str]) -> bool:
    # Those too that `make test` leaves to `make test-more`.
    options = ["-x", "-q", "-m", "not long", "-p", "no:cacheprovider", "-p", "no:randomly"]
    return ran([str(PYTHON), "-m", "pytest", *options, *files], TREE)


@dataclass
class Run:
    """What is known of the tests, and what became of each change."""

    good: dict[str, bool] = field(default_factory=dict)  # does a test hold without any change?
    takes: dict[str, float] = field(default_factory=dict)  # a C test without any change [s]
    fate: dict[Change, str] = field(default_factory=dict)

    def holds(self, test: str) -> bool:
        """Whether a test holds without any change, found when it is first asked for."""
        if test not in self.good:
            if test.endswith(".py"):
                self.good[test] = python_tests([test])
            else:
                made = make([f"test_{test}"])
                before = used()
                self.good[test] = made and ran([f"./test_{test}"], BUILT)
                self.takes[test] = used() - before
        return self.good[test]

    def judge(self, change: Change) -> str:
        return self._python(change) if change.file.suffix == ".py" else self._c(change)

    def _python(self, change: Change) -> str:
        """The nearest tests in one go, then those farther away one after the other."""
        near = of_python(TREE, change.file, change.line)
        groups = [near[:NEAREST], *([test] for test in near[NEAREST:])]
        asked = False
        for group in groups:
            while tests := [t for t in group if self.good.get(t, True)]:
                with changed(change):
                    held = python_tests(tests)
                if held:
                    asked = True
                    break
                # What fails without the change as well says nothing.
                if not [t for t in tests if not self.holds(t)]:
                    return "caught"
        return "held" if asked else "no test is near"

    def _c(self, change: Change) -> str:
        tests = [t for t in of_c(TREE, change.file) if self.holds(t)]
        if not tests:
            return "no test is near"
        objects = self._objects(change.file)
        with changed(change):
            for k, test in enumerate(tests):
                if not make([f"test_{test}"]):
                    return "does not compile"
                if k == 0 and objects and self._objects(change.file) == objects:
                    return "compiles to the same"
                patience = AT_LEAST + math.ceil(LONGER * self.takes[test])
                if not ran([f"./test_{test}"], BUILT, patience):
                    return "caught"
        return "held"

    @staticmethod
    def _objects(file: Path) -> dict[Path, str]:
        """What a core's file was compiled to."""
        found = BUILT.glob(f"CMakeFiles/{file.parent.name}.dir/{file.relative_to(TREE)}.o")
        return {f: hashlib.sha256(f.read_bytes()).hexdigest() for f in found}


@contextmanager
def changed(change: Change) -> Iterator[None]:
    """A change is made, and is taken back in the end."""
    whole = change.file.read_text()
    try:
        change.file.write_text(change.text(whole))
        yield
    finally:
        change.file.write_text(whole)


def accepted() -> set[tuple[str, str, str]]:
    listed = tomllib.loads((Path(__file__).parent / "accepted.toml").read_text())
    return {(a["file"], a["was"], a["became"]) for a in listed.get("accepted", [])}


def row(change: Change) -> str:
    name = change.file.relative_to(TREE)
    texts = f"    was     {change.was.strip()}\n    became  {change.became.strip()}"
    return f"{name}:{change.line}\n{texts}"


def main() -> None:
    asked = argparse.ArgumentParser(description=__doc__.split("\n")[0])
    asked.add_argument("--count", type=int, default=300)
    asked.add_argument("--seed", type=int, default=1)
    asked.add_argument("--minutes", type=float, default=60.0)
    asked.add_argument("--only", default="", help="begin of the folders")
    asked.add_argument("--ending", default="", help="of the files: c, inc, py")
    options = asked.parse_args()
    end = time.monotonic() + 60 * options.minutes
    copy()
    interpreter()
    options_of_build = {
        "Python_EXECUTABLE": sys.executable,
        "MOTIONFMU_FMUS": "OFF",
        "CMAKE_BUILD_TYPE": "Debug",
        # A step beyond an array ends the test, as in the sanitized build of `make test-more`.
        "CMAKE_C_FLAGS_DEBUG": "-O1 -fsanitize=bounds -fsanitize-undefined-trap-on-error",
    }
    configured = ["cmake", "-G", "Ninja", "-S", TREE, "-B", BUILT]
    configured += [f"-D{name}={value}" for name, value in options_of_build.items()]
    subprocess.run(configured, check=True, stdout=subprocess.DEVNULL)
    known, run, fresh = accepted(), Run(), []
    drawn = draw(options.count, options.seed, options.only, options.ending)
    with Progress(transient=True, console=Console(stderr=True)) as bar:
        for change in bar.track(drawn, description="changes"):
            if time.monotonic() > end:
                break
            fate = run.fate[change] = run.judge(change)
            key = (str(change.file.relative_to(TREE)), change.was.strip(), change.became.strip())
            if fate == "held" and key in known:
                run.fate[change] = "accepted"
            elif fate in ("held", "no test is near"):
                fresh.append(change)
                print(f"{fate} ({len(run.fate)} of {len(drawn)}): {row(change)}", flush=True)
    counted = Counter(run.fate.values())
    judged = counted["caught"] + counted["held"] + counted["no test is near"]
    print(f"{len(run.fate)} changes (seed {options.seed}): {dict(counted)}")
    failing = sorted(t for t, good in run.good.items() if not good)
    if failing:
        print(f"not asked, as they fail without a change: {', '.join(failing)}")
    if judged:
        print(f"caught: {counted['caught']} of {judged}, {100 * counted['caught'] / judged:.0f} %")
    (PLACE / "held.txt").write_text("".join(row(c) + "\n" for c in fresh))
    sys.exit(1 if fresh else 0)


if __name__ == "__main__":
    if not shutil.which("ninja"):
        sys.exit("mutants: there is no ninja: make build installs it, make mutants finds it")
    os.nice(19)
    main()
