"""Whether FMUs that describe the same thing, such as an arm and its controller, agree on it."""

import functools
import json
from collections.abc import Iterable, Iterator, Mapping, Sequence

from motionfmu.base import units
from motionfmu.fmu.archive_names import AGREE
from motionfmu.scenarios import fmus
from motionfmu.scenarios.port import Port
from motionfmu.scenarios.system import System, Wire
from motionfmu.scenarios.values import start_values

# Two values in SI units are equal if they differ by less than this, or by less than this share of
# their size: 1 um, 0.2 arc seconds. No machine repeats so well, and printed digits lose less.
CLOSE = 1e-6
# A quantity whose name ends so is what one FMU commands; the other FMU's actual value has the name
# without this ending.
COMMAND = "_command"


@functools.cache
def _stated(fmu: str) -> Mapping[str, str | float]:
    """The variable by quantity, such as arm.start, or the value that an FMU alone can have."""
    if not fmus.is_ours(fmu):
        return {}
    text = fmus.extra(fmu, AGREE)
    return {} if text is None else dict(json.loads(text))


@functools.cache
def quantities(fmu: str) -> Mapping[str, str]:
    """The variable by quantity, such as arm.start, that an FMU states of things outside it."""
    return {quantity: name for quantity, name in _stated(fmu).items() if isinstance(name, str)}


def warnings(system: System) -> list[str]:
    """A sentence for each quantity to which two FMUs along the wires give different values.

    An FMU is compared with the nearest ones behind its outputs that know the quantity, through
    others that do not; two of the same kind, such as two controllers, are never compared.
    """
    given = {s.end.name: s.values for s in system.settings}
    found: dict[frozenset[str], str] = {}
    for quantity, sides in _pairs(system):
        pair = frozenset(name for name, _ in sides)
        if pair not in found and (told := _apart(sides, given)):
            found[pair] = f"{told}: both mean {quantity}"
    return list(found.values())


def _pairs(system: System) -> Iterator[tuple[str, list[tuple[str, Port | float]]]]:
    """Quantities, and of the two FMUs that are to agree the parameter or the value of each."""
    behind = _behind(system.wires)
    known = {c: _fixed(fmu) for c, fmu in system.components.items()}
    for one, own in known.items():
        for quantity in own:
            for other in _nearest(one, behind, {c for c in known if quantity in known[c]}):
                if system.components[one] == system.components[other]:
                    continue
                sides = [(c, *known[c][quantity]) for c in (one, other)]
                yield quantity, [(f"{c}.{name}", what) for c, name, what in sides]


def _fixed(fmu: str) -> dict[str, tuple[str, Port | float]]:
    """By quantity the name and parameter of an FMU, or the value that it alone can have."""
    found: dict[str, tuple[str, Port | float]] = {}
    for quantity, stated in _stated(fmu).items():
        if not isinstance(stated, str):
            found[quantity] = quantity.rpartition(".")[2], stated
        elif (port := fmus.ports(fmu)[stated]).causality == "parameter":
            found[quantity] = stated, port
    return found


def commanded(
    components: Mapping[str, str], wires: Iterable[Wire], asked: Sequence[str]
) -> dict[str, list[tuple[str, str]]]:
    """Pairs of outputs for each quantity: one FMU's command, the actual value of one behind it."""
    behind = _behind(wires)
    known = {c: quantities(fmu) for c, fmu in components.items()}
    found: dict[str, list[tuple[str, str]]] = {quantity: [] for quantity in asked}
    for quantity, pairs in found.items():
        having = {c for c in known if quantity in known[c]}
        for one, own in known.items():
            if quantity + COMMAND in own:
                command = f"{one}.{own[quantity + COMMAND]}"
                others = list(_nearest(one, behind, having))
                pairs += [(command, f"{c}.{known[c][quantity]}") for c in others]
    return found


def _behind(wires: Iterable[Wire]) -> dict[str, set[str]]:
    """For each component those to which wires lead from it."""
    behind: dict[str, set[str]] = {}
    for wire in wires:
        behind.setdefault(wire.source.component, set()).add(wire.target.component)
    return behind


def _nearest(start: str, behind: Mapping[str, set[str]], knowing: set[str]) -> Iterator[str]:
    """The nearest components along the wires that know a quantity, by distance, then by name."""
    seen, edge = {start}, {start}
    while edge:
        edge = {t for c in edge for t in behind.get(c, ())} - seen
        seen |= edge
        yield from sorted(edge & knowing)
        edge -= knowing


def _apart(sides: Sequence[tuple[str, Port | float]], given: Mapping[str, Sequence[object]]) -> str:
    """The first pair of elements that differ, with names and values; empty if all are equal.

    A side that is a number has it at all elements of the other, in SI units.
    """
    ports = [what for _, what in sides if not isinstance(what, int | float)]
    if not ports:
        return ""
    (a, left), (b, right) = [
        (name, ports[0] if isinstance(what, int | float) else what) for name, what in sides
    ]
    if left.count != right.count:
        return f"{a} has {left.count} elements, {b} has {right.count}"
    factors = [units.parse(port.unit or "1").factor for port in (left, right)]
    values = [_values(what, given.get(name, ()), ports[0]) for name, what in sides]
    wrong = []
    for k, (x, y) in enumerate(zip(*values, strict=True), 1):
        if _differ(x * factors[0], y * factors[1]):
            at = f"[{k}]" if left.shape else ""
            wrong.append(f"{a}{at} = {_shown(x, left)} but {b}{at} = {_shown(y, right)}")
    more = f" and {len(wrong) - 1} more of its elements" if len(wrong) > 1 else ""
    return wrong[0] + more if wrong else ""


def _differ(p: float, q: float) -> bool:
    return abs(p - q) > CLOSE * max(1.0, abs(p), abs(q))


def _values(what: Port | float, given: Sequence[object], like: Port) -> list[float]:
    """The scenario's values of a variable, else its defaults, one number for each element.

    Of a number in SI units as many as of the variable `like`, in its unit.
    """
    if isinstance(what, int | float):
        return [what / units.parse(like.unit or "1").factor] * like.count
    values = [float(str(x)) for x in given or start_values(what)]
    return values * what.count if len(values) == 1 else values


def _shown(value: float, port: Port) -> str:
    """A value with its unit."""
    unit = units.spelled(port.unit)
    return f"{value:.9g}{'' if unit in ('', '°') else ' '}{unit}"
