"""Wires from component to component, put together of connections through nested systems."""

from collections.abc import Iterator
from dataclasses import dataclass, replace
from xml.etree import ElementTree as ET

from motionfmu.ssp.structure import COMMON, DESCRIPTION
from motionfmu.ssp.xml import Archive, number, plain

SSD = f"{{{DESCRIPTION}}}"
SSC = f"{{{COMMON}}}"
# Kinds of an element's connectors that give the system around it a value, and that take one.
_GIVES, _TAKES = ("output", "calculatedParameter"), ("input", "parameter")

Path = tuple[str, ...]  # names of the systems, from the outermost's children on, then the element
Node = tuple[Path, str]  # and a connector


@dataclass(frozen=True)
class WirePath:
    """A connection between two nodes, or a chain of connections."""

    source: Node
    target: Node
    source_index: tuple[int, ...] = ()
    target_index: tuple[int, ...] = ()
    factor: float = 1.0
    offset: float = 0.0
    as_it_is: bool = False  # a number in another unit is not converted


class Nodes:
    """All systems, components and connections of a description."""

    def __init__(self, archive: Archive, root: ET.Element) -> None:
        self.archive = archive
        self.systems: dict[Path, ET.Element] = {}
        self.components: dict[Path, ET.Element] = {}
        self.kinds: dict[Node, str] = {}
        self.steps: list[WirePath] = []
        self._system((), root)
        self._into: dict[Node, list[WirePath]] = {}
        for step in self.steps:
            self._into.setdefault(step.target, []).append(step)

    def _connectors(self, path: Path, element: ET.Element) -> None:
        for c in element.iterfind(f"{SSD}Connectors/{SSD}Connector"):
            self.kinds[path, c.get("name", "")] = c.get("kind", "")

    def _system(self, path: Path, system: ET.Element) -> None:
        self.systems[path] = system
        self._connectors(path, system)
        for element in system.iterfind(f"{SSD}Elements/*"):
            name = element.get("name", "")
            if not name or (*path, name) in self.systems | self.components:
                raise self.archive.error(f"two elements {name!r}, or one without a name")
            if plain(element) == "System":
                self._system((*path, name), element)
            elif plain(element) == "Component":
                self.components[*path, name] = element
                self._connectors((*path, name), element)
            else:
                told = "signal dictionaries are not taken over"
                raise self.archive.error(f"{shown((*path, name))}: {told}")
        for connection in system.iterfind(f"{SSD}Connections/{SSD}Connection"):
            self.steps.append(self._step(path, connection))

    def _step(self, path: Path, connection: ET.Element) -> WirePath:
        """Read one connection; which end is its source depends on the kinds of its connectors."""
        nodes, inside = [], []
        for end in ("start", "end"):
            element, connector = connection.get(f"{end}Element"), connection.get(f"{end}Connector")
            node = ((*path, element) if element else path, connector or "")
            if node not in self.kinds:
                raise self.archive.error(f"connection: no connector {shown(*node)}")
            nodes.append(node)
            inside.append(self.kinds[node] in (_TAKES if not element else _GIVES))
        if inside[0] == inside[1]:
            a, b = (shown(*n) for n in nodes)
            told = "both give a value" if inside[0] else "none gives a value"
            raise self.archive.error(f"connection of {a} and {b}: {told}")
        indices = [
            tuple(int(i) for i in connection.get(f"{end}Indices", "").split())
            for end in ("start", "end")
        ]
        if not inside[0]:
            nodes.reverse()
            indices.reverse()
        as_it_is = connection.get("suppressUnitConversion") in ("true", "1")
        way = WirePath(nodes[0], nodes[1], indices[0], indices[1], as_it_is=as_it_is)
        for child in connection:
            if plain(child) == "LinearTransformation":
                factor = number(self.archive, child, "factor", 1.0)
                way = replace(way, factor=factor, offset=number(self.archive, child, "offset", 0.0))
            elif plain(child).endswith("Transformation"):
                told = f"{plain(child)} is not taken over"
                raise self.archive.error(f"connection to {shown(*nodes[1])}: {told}")
        return way

    def ways(self) -> Iterator[WirePath]:
        """Wires between components; connections from outside the outermost system are left out."""
        for target in (n for n in self._into if n[0] in self.components):
            yield from self._back(target, frozenset())

    def _back(self, target: Node, seen: frozenset[Node]) -> Iterator[WirePath]:
        for step in self._into.get(target, ()):
            if step.source[0] in self.components:
                yield step
                continue
            if step.source in seen:
                raise self.archive.error(f"connections of {shown(*step.source)} go in a circle")
            for first in self._back(step.source, seen | {step.source}):
                yield self._joined(first, step)

    def _joined(self, first: WirePath, then: WirePath) -> WirePath:
        if first.target_index or then.source_index:
            told = "elements of arrays through a nested system are not taken over"
            raise self.archive.error(f"{shown(*then.source)}: {told}")
        return WirePath(
            first.source,
            then.target,
            first.source_index,
            then.target_index,
            first.factor * then.factor,
            first.offset * then.factor + then.offset,
            first.as_it_is or then.as_it_is,
        )

    def fed(self, node: Node) -> Iterator[Node]:
        """The variables of components to which a system's own connector leads."""
        for step in self.steps:
            if step.source == node:
                if step.target[0] in self.components:
                    yield step.target
                else:
                    yield from self.fed(step.target)


def shown(path: Path, connector: str = "") -> str:
    """The text of a node in messages."""
    return ".".join((*path, connector) if connector else path)
