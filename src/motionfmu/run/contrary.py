"""Whether a verdict can fail: settings that switch off what a scenario shows."""

from typing import Any

from motionfmu.base.errors import Faults, InputError, suggestion
from motionfmu.run.checks import Verdict
from motionfmu.scenarios import system
from motionfmu.scenarios.body import Contrary
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.values import setting, unplaced


def check(resolver: system.Resolver, named: bool = True) -> None:
    """Refuse a [[contrary]] with a wrong name, value or check, without effect, or with the name of
    another; its checks are looked at only if those of the scenario have right names.
    """
    document, faults = resolver.document, Faults()
    wired: set[str] = set()
    if document.body.contrary:
        wired = {w.target.name for w in Faults().of(lambda: system.wires(resolver)) or []}
    asked = [name for _, name, _ in document.body.asked]
    offs = [case.off for case in document.body.contrary]
    for number, case in enumerate(document.body.contrary):
        table = f"contrary.{number}"
        with faults.each():
            if case.off in offs[:number]:
                first = document.place(f"contrary.{offs.index(case.off)}")
                text = f"off = {case.off!r} is there twice, first at {first}"
                raise document.error(text, table, "off")
        for name in case.fails if named else ():
            with faults.each():
                if name not in asked:
                    text = f"fails: {name} is not in [check] or [expect]{suggestion(name, asked)}"
                    raise document.error(text, table, "fails")
        for name, value in case.set.items():
            with faults.each():
                _check_value(resolver, wired, table, name, value)
    faults.tell()


def _check_value(
    resolver: system.Resolver, wired: set[str], table: str, name: str, value: Any
) -> None:
    document = resolver.document
    if resolver.split(name)[0] in wired:
        text = f"{name} is connected: a value has no effect"
        raise document.error(text, f"{table}.set", name)
    try:
        setting(resolver, name, value, {})
    except InputError as error:
        if not error.args:
            raise
        raise document.error(str(unplaced(document, error)), f"{table}.set", name) from None


def options(document: Document, case: Contrary) -> dict[str, Any]:
    """Options of `Scenario.run` for a case; a driven input keeps its value for the whole run."""
    driven = document.body.driven
    undriven = {n for n in driven if n in case.set or any(s.startswith(f"{n}[") for s in case.set)}
    return {"set": case.set, "undriven": undriven}


def survivors(case: Contrary, verdicts: list[Verdict]) -> list[str]:
    """Checks that hold although they must fail; none if the verdict fails as it must."""
    failed = {v.name for v in verdicts if not v.within}
    return [name for name in case.fails if name not in failed]
