"""A page is followed: its files are written, its commands run, and print what stands below.

On a page a block behind a line that ends in `NAME`: is that file. Blocks of sh and of Python run in
its order in one folder; a text block right behind one has lines of what it prints, in their order.
What a YAML file has to run runs, too, and its status may be that of a failed check.
"""

import os
import re
import signal
import subprocess
from collections.abc import Collection, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path

import yaml

BLOCK = re.compile(r"^```(\w+)\n(.*?)^```\n", re.MULTILINE | re.DOTALL)
NAMED = re.compile(r"`([\w./-]+)`:\s*\Z")
# Commands of a user's machine or CI around ours.
AROUND = ("apt-get ", "docker ", "jupyter ", "pip install ")


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


def own(lines: str) -> str:
    """Lines of a shell but those that are around ours."""
    return "".join(row for row in lines.splitlines(True) if not row.startswith(AROUND))


class Folder:
    """A folder in which a page is followed, by this Python and with these variables alone.

    It ends what is left running.
    """

    def __init__(self, folder: Path, python: Path, environ: Mapping[str, str]) -> None:
        self.folder, self.python, self.environ = folder, python, environ
        self.groups: list[int] = []

    def follow(self, page: str) -> str | None:
        """What went otherwise than the page says; None if nothing did."""
        try:
            return next(filter(None, map(self._do, steps(page))), None)
        finally:
            self._end()

    def _end(self) -> None:
        for group in self.groups:
            try:
                os.killpg(group, signal.SIGKILL)
            except ProcessLookupError:
                continue

    def _do(self, step: Step) -> str | None:
        if not step.name:
            status, out = self._run(Step(step.kind, own(step.text)))
            if status:
                return f"{step.text}\nexit status {status}\n{out[-2000:]}"
            line = missing(step.prints, out)
            return line and f"{step.text}\ndid not print: {line}\nbut: {out[-2000:]}"
        file = self.folder / step.name
        file.parent.mkdir(parents=True, exist_ok=True)
        file.write_text(step.text, encoding="utf-8")
        return self._by_ci(step.name) if step.kind == "yaml" else None

    def follow_ci(self, name: str, good: Collection[int]) -> str | None:
        """What of a CI's file ended with a status that is not good; None if nothing did."""
        try:
            return self._by_ci(name, good)
        finally:
            self._end()

    def _by_ci(self, name: str, good: Collection[int] = (0, 1)) -> str | None:
        for command in commands(yaml.safe_load((self.folder / name).read_text(encoding="utf-8"))):
            status, out = self._run(Step("sh", own(command)))
            if status not in good:
                return f"{name}: {command}\nexit status {status}\n{out[-2000:]}"
        return None

    def _run(self, step: Step) -> tuple[int, str]:
        line = {"sh": ["bash", "-e", "-c"], "python": [str(self.python), "-c"]}[step.kind]
        # A file, as what is left running would keep a pipe open.
        with (self.folder / ".printed").open("w+", encoding="utf-8") as printed:
            done = subprocess.Popen(
                [*line, step.text], cwd=self.folder, env=dict(self.environ), text=True,
                stdout=printed, stderr=subprocess.STDOUT, start_new_session=True,
            )  # fmt: skip
            self.groups.append(done.pid)
            status = done.wait(1800)  # [s] only what hangs takes so long
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
