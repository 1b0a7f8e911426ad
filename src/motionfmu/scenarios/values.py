"""The values a scenario gives: before the run, and while it runs."""

import math
from collections.abc import Mapping
from typing import Any

from motionfmu.errors import InputError
from motionfmu.fmu.describe import STRING_MAX
from motionfmu.scenarios.document import Document
from motionfmu.scenarios.fmus import Port
from motionfmu.scenarios.system import (
    NS_TOLERANCE,
    TIME_MAX,
    End,
    Resolver,
    Setting,
    Stimulus,
    Values,
)
from motionfmu.toml_lines import is_file, shown


def values_of(end: End, value: Any) -> Values:
    """Check a value; a single one goes to every element. A ValueError names variable and value."""
    listed = list(value) if isinstance(value, list | tuple) else [value] * end.port.count
    if len(listed) != end.port.count:
        raise ValueError(f"{end.name} has {end.port.count} elements, not {len(listed)}")
    kinds: dict[str, Any] = {
        "Float64": (int, float),
        "Int32": int,
        "Boolean": bool,
        "String": str,
    }
    out: list[float | int | bool | str] = []
    for given in listed:
        x: Any = given.item() if hasattr(given, "item") else given
        wrong = isinstance(x, bool) and end.port.type != "Boolean"
        if wrong or not isinstance(x, kinds[end.port.type]):
            raise ValueError(f"{end.name} = {shown(x)}: {end.port.type} wanted")
        if isinstance(x, str) and ("\0" in x or len(x.encode(errors="replace")) >= STRING_MAX):
            text = f"no NUL and less than {STRING_MAX} bytes wanted"
            raise ValueError(f"{end.name} = {shown(x)}: {text}")
        if isinstance(x, int | float) and not isinstance(x, bool):
            if not math.isfinite(x):
                raise ValueError(f"{end.name} = {x!r}: not a finite number")
            if not end.port.low <= x <= end.port.high:
                raise ValueError(
                    f"{end.name} = {x!r}: outside {end.port.low:g} .. {end.port.high:g}"
                )
        out.append(float(x) if end.port.type == "Float64" else x)
    return tuple(out)


def start_values(port: Port) -> Values:
    """The values a variable has if nothing sets it, one per element."""
    kind: Any = {"Float64": float, "Int32": int, "Boolean": "true".__eq__}.get(port.type, str)
    listed = (port.start or "").split() if port.type != "String" else [port.start or ""]
    return tuple(kind(x) for x in listed)


def _file_beside(document: Document, values: Values) -> Values:
    """A string that names a file beside the scenario becomes its path."""
    folder = document.file.parent
    return tuple(
        str(folder / x) if isinstance(x, str) and x and is_file(folder / x) else x for x in values
    )


def settings(resolver: Resolver, overrides: Mapping[str, Any]) -> list[Setting]:
    """Values set before the run: the scenario's, then the caller's, which are stronger."""
    document, found = resolver.document, {}
    for source, pairs in (("set", document.body.set), ("", overrides)):
        for name, value in pairs.items():
            end = resolver.end(name, source, name) if source else _override_end(resolver, name)
            if end.port.causality not in ("parameter", "input"):
                text = f"{name} is an {end.port.causality} and cannot be set"
                raise document.error(text, "set", name) if source else InputError(f"set {text}")
            try:
                found[name] = Setting(end, _file_beside(document, values_of(end, value)))
            except ValueError as error:
                raise (
                    document.error(str(error), "set", name)
                    if source
                    else InputError(f"set {error}")
                ) from None
    return list(found.values())


def _override_end(resolver: Resolver, name: str) -> End:
    try:
        return resolver.end(name, "set", name)
    except InputError as error:
        text = str(error).removeprefix(f"{resolver.document.file}:").partition(": ")[2]
        raise InputError(f"set {text}") from None


def stimuli(resolver: Resolver, step_ns: int) -> list[Stimulus]:
    """Stimuli of the scenario on its communication steps, ordered by step."""
    document, found = resolver.document, []
    for number, drive in enumerate(document.body.drive):
        table = f"drive.{number}"
        end = resolver.end(drive.input, table, "input")
        if end.port.causality != "input" and not end.port.tunable:
            raise document.error(f"{end.name} is no input ({end.port.causality})", table, "input")
        if len(drive.at) != len(drive.value):
            raise document.error(
                f"{len(drive.at)} times for {len(drive.value)} values", table, "value"
            )
        last = -1
        for time, value in zip(drive.at, drive.value, strict=True):
            if not 0.0 <= time <= TIME_MAX:
                text = f"at = {time!r} s is not within 0 .. {TIME_MAX:g} s"
                raise document.error(text, table, "at")
            step = round(time * 1e9 / step_ns)
            if abs(time * 1e9 - step * step_ns) > NS_TOLERANCE * max(1.0, time):
                raise document.error(f"at = {time!r} s is no whole number of steps", table, "at")
            if step <= last:
                raise document.error(
                    f"at = {time!r} s does not come after the one before", table, "at"
                )
            last = step
            try:
                found.append(Stimulus(end, step, values_of(end, value)))
            except ValueError as error:
                raise document.error(str(error), table, "value") from None
    return sorted(found, key=lambda s: s.step)
