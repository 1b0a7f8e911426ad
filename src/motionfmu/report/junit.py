"""Verdicts as JUnit XML, for what shows the tests of a continuous integration."""

from collections.abc import Sequence
from datetime import datetime
from xml.etree import ElementTree as ET

from motionfmu.run.checks import NOTHING
from motionfmu.run.suite import Case


def junit(cases: Sequence[Case], started: datetime) -> str:
    """One test case each; a failed check is a failure, a wrong input an error."""
    errors = sum(bool(case.error) for case in cases)
    counts = {
        "name": "motionfmu",
        "tests": str(len(cases)),
        "failures": str(sum(not case.ok for case in cases) - errors),
        "errors": str(errors),
        "time": f"{sum(case.seconds for case in cases):.3f}",
    }
    root = ET.Element("testsuites", counts)
    # Hours and minutes of this machine, as the schema asks.
    stamp = started.strftime("%Y-%m-%dT%H:%M:%S")
    suite = ET.SubElement(
        root,
        "testsuite",
        {
            **counts,
            "skipped": str(sum(case.silent for case in cases)),
            "timestamp": stamp,
        },
    )
    for case in cases:
        name = f"{case.scenario}, off: {case.off}" if case.off else case.scenario
        about = {"classname": _class(case), "name": _text(name), "time": f"{case.seconds:.3f}"}
        row = ET.SubElement(suite, "testcase", about)
        if case.error:
            lines = [_text(line) for line in case.error.split("\n")]
            error = ET.SubElement(row, "error", message=lines[0], type="InputError")
            error.text = "\n".join(lines)
        elif not case.ok:
            lines = [_text(line) for line in _failed(case)]
            failure = ET.SubElement(row, "failure", message=lines[0], type="check")
            failure.text = "\n".join(lines)
        elif case.silent:
            ET.SubElement(row, "skipped", message=NOTHING)
        lines = [f"{v.name} {v.bounds}: {v.value:.6g}" for v in case.checks]
        lines += [f"warning: {told}" for told in case.warnings]
        if lines:
            ET.SubElement(row, "system-out").text = "\n".join(map(_text, lines))
    ET.indent(root)
    head = '<?xml version="1.0" encoding="UTF-8"?>'
    return f"{head}\n{ET.tostring(root, encoding='unicode')}\n"


def _class(case: Case) -> str:
    """Folder around the scenario, in dots: viewers make groups of it."""
    parts = [part for part in case.path.split("/")[:-1] if part not in ("", ".", "..")]
    return ".".join(parts) or "scenarios"


def _failed(case: Case) -> list[str]:
    if case.off:
        return [f"{name} holds, though {case.off}" for name in case.holding]
    return [
        f"{v.name} = {v.value:.6g}, asked {v.bounds}" if not v.reason else f"{v.name}: {v.reason}"
        for v in case.checks
        if v.ok is False
    ]


def _text(text: str) -> str:
    """XML has no control characters, not even as references."""
    return "".join(c if c.isprintable() else " " for c in text)
