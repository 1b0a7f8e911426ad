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
def quantities(fmu: str) -> Mapping[str, str]:
    """The variable by quantity, such as arm.start, that an FMU states of things outside it."""
    if not fmus.is_ours(fmu):
        return {}
    text = fmus.extra(fmu, AGREE)
    return {} if text is None else dict(json.loads(text))


def warnings(system: System) -> list[str]:
    """A sentence for each quantity to which two FMUs along the wires give different values.

    An FMU is compared with the nearest ones behind its outputs that know the quantity, through
    others that do not; two of the same kind, such as two controllers, are never compared.
    """
    given = {s.end.name: s.values for s in system.settings}
    behind = _behind(system.wires)
    known = {
        c: {
            quantity: name
            for quantity, name in quantities(fmu).items()
            if fmus.ports(fmu)[name].causality == "parameter"
        }
        for c, fmu in system.components.items()
    }
    found: dict[frozenset[str], str] = {}
    for one, own in known.items():
        for quantity, name in own.items():
            for other in _nearest(one, behind, {c for c in known if quantity in known[c]}):
                if system.components[one] == system.components[other]:
                    continue
                pair = f"{one}.{name}", f"{other}.{known[other][quantity]}"
                ports = [fmus.ports(system.components[p.partition(".")[0]]) for p in pair]
                sides = [
                    (p, port[p.partition(".")[2]]) for p, port in zip(pair, ports, strict=True)
                ]
                if frozenset(pair) not in found and (told := _apart(sides, given)):
                    found[frozenset(pair)] = f"{told}: both mean {quantity}"
    return list(found.values())


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


def _apart(sides: list[tuple[str, Port]], given: Mapping[str, Sequence[object]]) -> str:
    """The first pair of elements that differ, with names and values; empty if all are equal."""
    (a, left), (b, right) = sides
    if left.count != right.count:
        return f"{a} has {left.count} elements, {b} has {right.count}"
    factors = [units.parse(port.unit or "1").factor for port in (left, right)]
    values = [_values(port, given.get(name, ())) for name, port in sides]
    wrong = []
    for k, (x, y) in enumerate(zip(*values, strict=True), 1):
        p, q = x * factors[0], y * factors[1]
        if abs(p - q) > CLOSE * max(1.0, abs(p), abs(q)):
            at = f"[{k}]" if left.shape else ""
            wrong.append(f"{a}{at} = {_shown(x, left)} but {b}{at} = {_shown(y, right)}")
    more = f" and {len(wrong) - 1} more of its elements" if len(wrong) > 1 else ""
    return wrong[0] + more if wrong else ""


def _values(port: Port, given: Sequence[object]) -> list[float]:
    """The scenario's values of a variable, else its defaults, one number for each element."""
    values = [float(str(x)) for x in given or start_values(port)]
    return values * port.count if len(values) == 1 else values


def _shown(value: float, port: Port) -> str:
    """A value with its unit."""
    unit = units.spelled(port.unit)
    return f"{value:.9g}{'' if unit in ('', '°') else ' '}{unit}"
