"""Whether a verdict can fail: settings that switch off what a scenario shows."""

from typing import Any

from motionfmu.errors import InputError
from motionfmu.run.checks import Verdict
from motionfmu.scenarios import system
from motionfmu.scenarios.document import Contrary, Document
from motionfmu.scenarios.values import settings


def check(resolver: system.Resolver) -> None:
    """Refuse a [[contrary]] with a wrong name, value or check, of no effect, or named as
    another.
    """
    document, seen = resolver.document, set()
    wired = {w.target.name for w in system.wires(resolver)} if document.body.contrary else ()
    for number, case in enumerate(document.body.contrary):
        table = f"contrary.{number}"
        if case.off in seen:
            raise document.error(f"off = {case.off!r} is there twice", table, "off")
        seen.add(case.off)
        for name in case.fails:
            if name not in document.body.check:
                raise document.error(f"fails: {name} is not in [check]", table, "fails")
        for name, value in case.set.items():
            if name in wired:
                text = f"{name} is connected: a value has no effect"
                raise document.error(text, f"{table}.set", name)
            try:
                settings(resolver, {name: value})
            except InputError as error:
                raise document.error(str(error), f"{table}.set", name) from None


def options(document: Document, case: Contrary) -> dict[str, Any]:
    """Options of `Scenario.run` for a case; a value of a driven input stands for the whole run."""
    driven = {d.input for d in document.body.drive}
    return {"set": case.set, "undriven": driven & set(case.set)}


def survivors(case: Contrary, verdicts: list[Verdict]) -> list[str]:
    """Checks that hold although they are to fail; none if the verdict fails as it must."""
    failed = {v.name for v in verdicts if not v.ok}
    return [name for name in case.fails if name not in failed]
