"""The values a scenario gives: before the run, and while it runs."""

import math
from collections.abc import Callable, Mapping
from typing import Any

from motionfmu.base.errors import Faults, InputError
from motionfmu.base.toml_lines import shown
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

# Limits of the types that are whole numbers.
WHOLE = {f"Int{n}": (-(2 ** (n - 1)), 2 ** (n - 1) - 1) for n in (8, 16, 32, 64)}
WHOLE |= {f"UInt{n}": (0, 2**n - 1) for n in (8, 16, 32, 64)}
# What a resolver keeps of the scenario's own values.
WRITTEN = "written"
# In words, which values of a scenario each type takes.
KINDS: dict[str, Any] = {
    "Float64": (int, float),
    "Float32": (int, float),
    "Boolean": bool,
    "String": str,
} | dict.fromkeys(WHOLE, int)


def values_of(end: End, value: Any) -> Values:
    """Check a value, one for all elements or a list; a ValueError names variable and value."""
    listed = list(value) if isinstance(value, list | tuple) else [value] * end.port.count
    if len(listed) != end.port.count:
        raise ValueError(f"{end.name} has {end.port.count} elements, not {len(listed)}")
    kind = KINDS.get(end.port.type)
    if kind is None:
        raise ValueError(f"{end.name} is {end.port.type}, of which nothing is set here")
    out: list[float | int | bool | str] = []
    for given in listed:
        x: Any = given.item() if hasattr(given, "item") else given
        wrong = isinstance(x, bool) and end.port.type != "Boolean"
        if wrong or not isinstance(x, kind):
            raise ValueError(f"{end.name} = {shown(x)}: {end.port.type} wanted")
        if isinstance(x, str) and ("\0" in x or len(x.encode(errors="replace")) >= STRING_MAX):
            text = f"no NUL and less than {STRING_MAX} bytes wanted"
            raise ValueError(f"{end.name} = {shown(x)}: {text}")
        if isinstance(x, int | float) and not isinstance(x, bool):
            _check_number(end, x)
        out.append(float(x) if end.port.type.startswith("Float") else x)
    return tuple(out)


def _check_number(end: End, x: int | float) -> None:
    """Refuse what is not finite, or outside the limits of a variable or of its type."""
    if not math.isfinite(x):
        raise ValueError(f"{end.name} = {x!r}: not a finite number")
    least, most = WHOLE.get(end.port.type, (-math.inf, math.inf))
    low, high = max(end.port.low, least), min(end.port.high, most)
    if not low <= x <= high:
        raise ValueError(f"{end.name} = {x!r}: outside {_bound(low)} .. {_bound(high)}")


def _bound(limit: float) -> str:
    """The text of a limit; a limit of the type itself has all its digits."""
    return str(limit) if isinstance(limit, int) else f"{limit:g}"


def start_values(port: Port) -> Values:
    """The values a variable has if nothing sets it, one per element."""
    kind: Any = KINDS.get(port.type, str)
    kind = {bool: lambda x: x in ("true", "1")}.get(
        kind, float if isinstance(kind, tuple) else kind
    )
    listed = (port.start or "").split() if port.type != "String" else [port.start or ""]
    return tuple(kind(x) for x in listed)


def value_of(resolver: Resolver, given: Mapping[str, Values], name: str) -> Values:
    """A variable's values by ``component.variable``: those given, or of its FMU's description."""
    return given[name] if name in given else start_values(resolver.end(name, "set", name).port)


def values_in(given: Mapping[str, Values], component: str, port: Port) -> Values:
    """A variable's values, one per element, where these are set by ``component.variable``."""
    values = given.get(f"{component}.{port.name}") or start_values(port)
    return values if len(values) == port.count else values * port.count


def later(set: Mapping[str, Any], new: Mapping[str, Any]) -> dict[str, Any]:
    """Both together: what is new counts, and a whole array also over elements set before."""
    kept = {n: v for n, v in set.items() if n.partition("[")[0] not in new}
    return {**kept, **new}


def settings(resolver: Resolver, *stronger: Mapping[str, Any]) -> list[Setting]:
    """Values set before the run: the scenario's, then the caller's, each stronger than before.

    A value of one element, ``component.variable[i]``, leaves the others as they are.
    """
    document, faults = resolver.document, Faults()
    found = dict(_written(resolver, faults))
    for pairs in stronger:
        _add(resolver, pairs, found, faults, lambda error: unplaced(document, error))
    faults.tell()
    return [_placed(document, s) for s in found.values()]


def written(resolver: Resolver, name: str) -> Values | None:
    """What the scenario itself gives a variable, if anything."""
    faults = Faults()
    own = _written(resolver, faults).get(name)
    faults.tell()
    return _placed(resolver.document, own).values if own else None


def _written(resolver: Resolver, faults: Faults) -> Mapping[str, Setting]:
    """The scenario's own settings, read once."""
    found: dict[str, Setting] = resolver.known.get(WRITTEN, {})
    if not found:
        _add(resolver, resolver.document.body.set, found, faults, lambda error: error)
        if not faults.lines:
            resolver.known[WRITTEN] = found
    return found


def _placed(document: Document, setting: Setting) -> Setting:
    """The setting with the path of a file beside the scenario, looked for anew at each run."""
    if setting.end.port.type != "String":
        return setting
    return Setting(setting.end, tuple(str(document.beside(str(x)) or x) for x in setting.values))


def _add(
    resolver: Resolver,
    pairs: Mapping[str, Any],
    found: dict[str, Setting],
    faults: Faults,
    told: Callable[[InputError], InputError],
) -> None:
    """Add the settings of some values, those of whole arrays first."""
    for name in sorted(pairs, key=lambda n: resolver.split(n)[1] is not None):
        with faults.each():
            try:
                given = setting(resolver, name, pairs[name], found)
                found[given.end.name] = given
            except InputError as error:
                raise told(error) from None


def setting(resolver: Resolver, name: str, value: Any, found: Mapping[str, Setting]) -> Setting:
    """The setting of a variable, or of one element, whose others keep what `found` has for them.

    A file is still by its name.
    """
    document = resolver.document
    whole, element = resolver.split(name)
    end = resolver.end(whole, "set", name)
    if end.port.causality not in ("parameter", "input"):
        text = f"{name} is an {end.port.causality} and cannot be set"
        raise document.error(text, "set", name)
    try:
        if element is not None:
            if not 0 <= element < end.port.count * bool(end.port.shape):
                raise ValueError(f"{name}: {whole} has {_elements(end)}")
            if isinstance(value, list | tuple):
                raise ValueError(f"{name} = {shown(value)}: one value wanted")
            before = found[whole].values if whole in found else start_values(end.port)
            value = [*before[:element], value, *before[element + 1 :]]
        return Setting(end, values_of(end, value))
    except ValueError as error:
        raise document.error(str(error), "set", name) from None


def _elements(end: End) -> str:
    return f"elements 1 to {end.port.count}" if end.port.shape else "a single value"


def unplaced(document: Document, error: InputError) -> InputError:
    """An error without its place in the scenario's file, for a value that is not from there."""
    return InputError(*(f"set {text}" for text in texts(document, error)))


def texts(document: Document, error: InputError) -> list[str]:
    """The lines of an error without their places in the scenario's files."""
    names = [s.name for s in document.sources]
    ends = [max((len(n) for n in names if line.startswith(n)), default=0) for line in error.args]
    pairs = zip(error.args, ends, strict=True)
    return [line[end:].partition(": ")[2] if end else line for line, end in pairs]


def stimuli(resolver: Resolver, step_ns: int) -> list[Stimulus]:
    """Stimuli of the scenario on its communication steps, ordered by step."""
    found: list[Stimulus] = []
    faults = Faults()
    for number in range(len(resolver.document.body.drive)):
        with faults.each():
            found += _driven(resolver, number, step_ns)
    faults.tell()
    return sorted(found, key=lambda s: s.step)


def _driven(resolver: Resolver, number: int, step_ns: int) -> list[Stimulus]:
    """The stimuli of one [[drive]]."""
    document, table = resolver.document, f"drive.{number}"
    drive, found, last = document.body.drive[number], [], -1
    end = resolver.end(drive.input, table, "input")
    if end.port.causality != "input" and not end.port.tunable:
        raise document.error(f"{end.name} is no input ({end.port.causality})", table, "input")
    if len(drive.at) != len(drive.value):
        text = f"{len(drive.at)} times for {len(drive.value)} values"
        raise document.error(text, table, "value")
    for time, value in zip(drive.at, drive.value, strict=True):
        if not 0.0 <= time <= TIME_MAX:
            text = f"at = {time!r} s is not within 0 .. {TIME_MAX:g} s"
            raise document.error(text, table, "at")
        step = round(time * 1e9 / step_ns)
        if abs(time * 1e9 - step * step_ns) > NS_TOLERANCE * max(1.0, time):
            raise document.error(f"at = {time!r} s is no whole number of steps", table, "at")
        if step <= last:
            text = f"at = {time!r} s does not come after the one before"
            raise document.error(text, table, "at")
        last = step
        try:
            found.append(Stimulus(end, step, values_of(end, value)))
        except ValueError as error:
            raise document.error(str(error), table, "value") from None
    return found
