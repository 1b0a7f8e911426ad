"""A skip is an error unless tests/skips.toml has it, where MOTIONFMU_SKIPS is `listed`.

A line of the list is a table `[[skip]]`:

    tests  = "tests/ports/test_ports.py::test_*"   # one id of pytest or many: * is any text
    why    = "wine runs libraries for Windows"
    unless = ["wine"]                              # the skip is none while one of these is on PATH

A line that names no test, and one whose tests all ran, is told where the whole folder was run; the
first is an error.
"""

import os
import re
import shutil
import tomllib
from collections.abc import Generator, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import pytest

ASKED = "MOTIONFMU_SKIPS"
_KEYS = {"tests": str, "why": str, "unless": list}


@dataclass(frozen=True)
class Line:
    """What may be skipped, and why."""

    tests: str
    why: str
    unless: Sequence[str] = ()

    def names(self, test: str) -> bool:
        """Whether it is about a test."""
        rule = ".*".join(map(re.escape, self.tests.split("*")))
        head, at, group = test.rpartition("@")  # of xdist
        bare = head if at and "]" not in group else test
        return re.fullmatch(rule, bare, re.DOTALL) is not None

    @property
    def holds(self) -> bool:
        """Whether its skip may be, on this machine."""
        return not any(map(shutil.which, self.unless))


def read(file: Path) -> list[Line]:
    """The list; its first fault is a UsageError."""
    try:
        rows = tomllib.loads(file.read_text()) if file.is_file() else {}
    except tomllib.TOMLDecodeError as error:
        raise pytest.UsageError(f"{file}: {error}") from error
    listed = rows.pop("skip", [])
    if rows or not isinstance(listed, list):
        raise pytest.UsageError(f"{file}: a line is a table [[skip]]")
    for k, row in enumerate(listed, 1):
        good = all(isinstance(x, _KEYS.get(key, ())) and x for key, x in row.items())
        if not good or not {"tests", "why"} <= row.keys():
            raise pytest.UsageError(
                f"{file}: [[skip]] {k} needs tests and why, texts, and may have unless, a list"
            )
    return [Line(**row) for row in listed]


@dataclass(eq=False)
class Listed:
    """The plugin: what was skipped, and for each line how many tests it names and how many ran."""

    lines: list[Line]
    skipped: dict[str, str] = field(default_factory=dict)
    named: list[int] = field(default_factory=list)
    chosen: list[int] = field(default_factory=list)
    whole: bool = False

    @pytest.hookimpl(wrapper=True, tryfirst=True)
    def pytest_collection_modifyitems(
        self, config: pytest.Config, items: list[pytest.Item]
    ) -> Generator[None, None, None]:
        self.named = self._counted(items)
        yield
        self.chosen = self._counted(items)
        self.whole = config.args == config.getini("testpaths") and not config.option.keyword

    def _counted(self, items: list[pytest.Item]) -> list[int]:
        return [sum(line.names(item.nodeid) for item in items) for line in self.lines]

    def pytest_runtest_logreport(self, report: pytest.TestReport) -> None:
        if report.skipped and not hasattr(report, "wasxfail"):
            self.skipped[report.nodeid] = _told(report)

    def pytest_collectreport(self, report: pytest.CollectReport) -> None:
        if report.skipped:
            self.skipped[report.nodeid] = _told(report)

    @pytest.hookimpl(optionalhook=True)
    def pytest_testnodedown(self, node: Any, error: object) -> None:
        """A worker of xdist is done: what it has collected, all have."""
        found = getattr(node, "workeroutput", {}).get(ASKED)
        if found:
            self.named, self.chosen, self.whole = found

    @pytest.hookimpl(trylast=True)
    def pytest_sessionfinish(self, session: pytest.Session) -> None:
        output = getattr(session.config, "workeroutput", None)
        if output is not None:
            output[ASKED] = (self.named, self.chosen, self.whole)
        elif (self.unlisted() or self.strangers()) and session.exitstatus in (
            pytest.ExitCode.OK,
            pytest.ExitCode.NO_TESTS_COLLECTED,
        ):
            session.exitstatus = pytest.ExitCode.TESTS_FAILED

    def unlisted(self) -> list[str]:
        """Skips that no line allows here, with what they told."""
        return [
            f"{test}: {told}"
            for test, told in sorted(self.skipped.items())
            if not any(line.names(test) and line.holds for line in self.lines)
        ]

    def strangers(self) -> list[str]:
        """Lines that name no test."""
        found = zip(self.lines, self.named, strict=False)
        return [line.tests for line, named in found if self.whole and not named]

    def idle(self) -> list[str]:
        """Lines whose tests all ran, though they might have been skipped here."""
        found = zip(self.lines, self.named, self.chosen, strict=False)
        return [
            line.tests
            for line, named, chosen in found
            if self.whole and line.holds and 0 < named == chosen
            if not any(map(line.names, self.skipped))
        ]

    def pytest_terminal_summary(self, terminalreporter: pytest.TerminalReporter) -> None:
        for title, rows in (
            ("skipped, and not in tests/skips.toml: an error", self.unlisted()),
            ("in tests/skips.toml, and no test has that name: an error", self.strangers()),
            ("in tests/skips.toml, and not skipped", self.idle()),
        ):
            if rows:
                terminalreporter.section(title)
                for row in rows:
                    terminalreporter.line(row)


def _told(report: pytest.TestReport | pytest.CollectReport) -> str:
    """Why a test says it was skipped."""
    told = report.longrepr[2] if isinstance(report.longrepr, tuple) else report.longrepr
    return str(told).removeprefix("Skipped: ")


def pytest_configure(config: pytest.Config) -> None:
    asked = os.environ.get(ASKED, "")
    if asked not in ("", "listed"):
        raise pytest.UsageError(f"{ASKED} = {asked!r}: it is `listed`, or is not set")
    if asked:
        config.pluginmanager.register(Listed(read(config.rootpath / "tests/skips.toml")), "listed")
