"""How-to pages do what they say: files are written, commands run, and print what stands below.

On a page a block behind a line that ends in `NAME`: is that file. Blocks of sh and of Python run in
its order in one empty folder; a text block right behind one has lines of what it prints, in their
order. What a YAML file has to run runs, too, and its status may be that of a failed check.
"""

import os
import re
import signal
import subprocess
import sys
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import pytest
import yaml
from conftest import FMUS, ROOT

pytestmark = pytest.mark.more

PAGES = sorted((ROOT / "docs/how-to").glob("*.md"))
BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"`([\w./-]+)`:\s*\Z")
# Commands that a user's CI has around ours.
AROUND = ("pip install ",)


@dataclass(frozen=True)
class Step:
    """What a page asks for: a file, or something to run and lines that it prints."""

    kind: str
    text: str
    name: str = ""
    prints: str = ""


def steps(page: str) -> list[Step]:
    """The blocks of a page in their order."""
    found: list[Step] = []
    end = 0
    for match in BLOCK.finditer(page):
        between, (kind, text) = page[end : match.start()], match.groups()
        end = match.end()
        named = NAMED.search(between)
        if kind == "text" and not named:
            assert found and found[-1].kind in ("sh", "python") and not between.strip(), text
            found[-1] = Step(found[-1].kind, found[-1].text, prints=text)
        elif kind in ("sh", "python") and not named:
            found.append(Step(kind, text))
        else:
            assert named, f"a block of {kind} has no file: {text[:60]}"
            found.append(Step(kind, text, named[1]))
    return found


def missing(lines: str, out: str) -> str | None:
    """The first line that was not printed behind those before it; None if all were."""
    printed = iter(" ".join(line.split()) for line in out.splitlines())
    for line in lines.splitlines():
        if " ".join(line.split()) not in printed:
            return line
    return None


class Folder:
    """An empty folder in which a page is followed; ends what is left running."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.groups: list[int] = []

    def follow(self, page: str) -> str | None:
        """What went otherwise than the page says; None if nothing did."""
        try:
            return next(filter(None, map(self._do, steps(page))), None)
        finally:
            for group in self.groups:
                try:
                    os.killpg(group, signal.SIGKILL)
                except ProcessLookupError:
                    continue

    def _do(self, step: Step) -> str | None:
        if not step.name:
            status, out = self._run(step)
            if status:
                return f"{step.text}\nexit status {status}\n{out[-2000:]}"
            line = missing(step.prints, out)
            return line and f"{step.text}\ndid not print: {line}\nbut: {out[-2000:]}"
        file = self.folder / step.name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(step.text, encoding="utf-8")
        if step.kind != "yaml":
            return None
        for command in commands(yaml.safe_load(step.text)):
            if not command.startswith(AROUND):
                status, out = self._run(Step("sh", command))
                if status not in (0, 1):
                    return f"{step.name}: {command}\nexit status {status}\n{out[-2000:]}"
        return None

    def _run(self, step: Step) -> tuple[int, str]:
        places = (str(Path(sys.executable).parent), os.environ["PATH"])
        told = {"MOTIONFMU_FMUS": str(FMUS), "COLUMNS": "160", "PATH": os.pathsep.join(places)}
        line = {"sh": ["bash", "-e", "-c"], "python": [sys.executable, "-c"]}[step.kind]
        # A file, as what is left running would keep a pipe open.
        with (self.folder / ".printed").open("w+", encoding="utf-8") as printed:
            done = subprocess.Popen(
                [*line, step.text], cwd=self.folder, env=os.environ | told, text=True,
                stdout=printed, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
            self.groups.append(done.pid)
            status = done.wait(300)
            printed.seek(0)
            return status, printed.read()


def commands(what: object) -> Iterator[str]:
    """Lines that a file of a CI has run: those of `run` and of `script`."""
    if isinstance(what, dict):
        for key, value in what.items():
            if key in ("run", "script"):
                rows = value if isinstance(value, list) else value.splitlines()
                yield from (str(row) for row in rows)
            else:
                yield from commands(value)
    elif isinstance(what, list):
        for value in what:
            yield from commands(value)


@pytest.mark.parametrize("page", PAGES, ids=lambda p: p.stem)
def test_a_page_does_what_it_says(page: Path, tmp_path: Path) -> None:
    text = page.read_text(encoding="utf-8")
    assert any(step.kind in ("sh", "python") and not step.name for step in steps(text))
    assert Folder(tmp_path).follow(text) is None


def test_the_manual_leads_to_every_page() -> None:
    manual = (ROOT / "src/motionfmu/README.md").read_text(encoding="utf-8")
    assert [p.name for p in PAGES if f"](../../docs/how-to/{p.name})" not in manual] == []


@pytest.mark.parametrize(
    ("page", "told"),
    [
        ("# A\n\n```sh\nfalse\n```\n", "exit status 1"),
        ("# A\n\n```sh\nfalse\necho on\n```\n", "exit status 1"),
        ("# A\n\n```sh\necho a; echo b\n```\n\n```text\nb\na\n```\n", "did not print: a"),
        ("# A\n\n```python\nprint(1)\n```\n\n```text\n2\n```\n", "did not print: 2"),
        ("In `a.txt`:\n\n```csv\nx\n```\n\n```sh\ngrep y a.txt\n```\n", "exit status 1"),
        ("In `a.yml`:\n\n```yaml\njob:\n  script: [exit 2]\n```\n", "exit status 2"),
    ],
)
def test_what_is_otherwise_is_told(page: str, told: str, tmp_path: Path) -> None:
    assert told in (Folder(tmp_path).follow(page) or "")


def test_a_good_page_is_followed(tmp_path: Path) -> None:
    page = (
        "In `b/a.toml`:\n\n```toml\nx = 1\n```\n\n```sh\ncat b/a.toml\n```\n\n```text\nx = 1\n```\n"
    )
    assert Folder(tmp_path).follow(page) is None


def test_a_block_that_is_neither_file_nor_output_is_refused() -> None:
    for page in ("Words.\n\n```toml\nx = 1\n```\n", "Words.\n\n```text\na\n```\n"):
        with pytest.raises(AssertionError):
            steps(page)
