"""Hold the server's nodes against the published nodesets of the companion specifications.

    python tests/live/against_nodesets.py FOLDER

FOLDER has the NodeSet2 files of DI, IA, Machinery, Machinery Jobs, ISA-95 job control and
MachineTool, or is a copy of github.com/OPCFoundation/UA-Nodeset. Two things are compared: each node
of type_nodes.txt with the files, and a machine's nodes with the types of the files, which a server
has loaded. Ends with status 1 if anything differs.
"""

import asyncio
import re
import sys
from collections import defaultdict
from pathlib import Path
from xml.etree import ElementTree

from asyncua import ua
from opcua_bench import client_of

from motionfmu.live.opcua import OpcUaServer, nodesets
from motionfmu.live.opcua.node_table import RULES, TypeNode, type_nodes
from motionfmu.live.serving import MachineLink, MachineStart

_TAG = "{http://opcfoundation.org/UA/2011/03/UANodeSet.xsd}"
_VALUE = "{http://opcfoundation.org/UA/2008/02/Types.xsd}"
_STANDARD = "http://opcfoundation.org/UA/"
Key = tuple[str, int]  # namespace and number
MACHINES = ("circle", "robot_line", "hydraulic_positioning")


class PublishedNodes:
    """All nodes of a nodeset's file."""

    def __init__(self, file: Path) -> None:
        root = ElementTree.parse(file).getroot()
        self._uris = [_STANDARD, *(u.text or "" for u in root.iterfind(f"{_TAG}NamespaceUris/*"))]
        self._aliases = {a.get("Alias"): a.text or "" for a in root.iterfind(f"{_TAG}Aliases/*")}
        rows = (row for row in root if row.get("NodeId"))
        self.rows = {self.key(row.get("NodeId", "")): row for row in rows}
        self._back: dict[Key, set[tuple[str, Key]]] = defaultdict(set)
        for key in self.rows:
            for kind, forward, other in self._given(key):
                if forward:
                    self._back[other].add((kind, key))

    def key(self, text: str) -> Key:
        found = re.fullmatch(r"(?:ns=(\d+);)?i=(\d+)", self._aliases.get(text, text))
        assert found, text
        return self._uris[int(found[1] or 0)], int(found[2])

    def name(self, text: str) -> tuple[str, str]:
        found = re.fullmatch(r"(?:(\d+):)?(.*)", text)
        assert found
        return self._uris[int(found[1] or 0)], found[2]

    def _given(self, key: Key) -> list[tuple[str, bool, Key]]:
        rows = self.rows[key].iterfind(f"{_TAG}References/*")
        return [
            (
                self._reference(r.get("ReferenceType", "")),
                r.get("IsForward") != "false",
                self.key(r.text or ""),
            )
            for r in rows
        ]

    def _reference(self, text: str) -> str:
        """Name of a kind of reference; of the standard's own ones only."""
        uri, number = self.key(text)
        return ua.ObjectIdNames[number] if uri == _STANDARD else text

    def to(self, key: Key) -> set[tuple[str, Key]]:
        """References that begin at a node."""
        return {(kind, other) for kind, forward, other in self._given(key) if forward}

    def from_(self, key: Key) -> set[tuple[str, Key]]:
        """References that end at it."""
        own = {(kind, other) for kind, forward, other in self._given(key) if not forward}
        return own | self._back[key]


class Comparison:
    """The table's nodes beside the published ones."""

    def __init__(self, folder: Path) -> None:
        found = nodesets.found(folder)
        self._nodes = type_nodes()
        self._uri = {n.specification.prefix: n.specification.uri for n in self._nodes}
        self._files = {uri: PublishedNodes(found[uri].file) for uri in self._uri.values()}
        self._types = {n.name: self._key(n, n.number) for n in self._nodes if n.is_type}

    def _key(self, node: TypeNode, number: int) -> Key:
        return node.specification.uri, number

    def _name(self, text: str) -> tuple[str, str]:
        prefix, colon, name = text.partition(":")
        return (self._uri[prefix], name) if colon else (_STANDARD, text)

    def _type(self, name: str) -> Key:
        return self._types.get(name) or (_STANDARD, getattr(ua.ObjectIds, name))

    def faults(self) -> list[str]:
        """What differs."""
        found = []
        for node in self._nodes:
            there = self._files[node.specification.uri]
            key = self._key(node, node.number)
            if key not in there.rows:
                found.append(f"{node.name} {node.number}: not there")
                continue
            for what, own, other in self._pairs(node, there, key):
                if own != other:
                    found.append(f"{node.name} {node.number}: {what} {own}, published is {other}")
        return found

    def count(self) -> int:
        """Nodes that are compared."""
        return len(self._nodes)

    def _pairs(
        self, node: TypeNode, there: PublishedNodes, key: Key
    ) -> list[tuple[str, object, object]]:
        row, to, from_ = there.rows[key], there.to(key), there.from_(key)
        data = row.get("DataType")
        pairs: list[tuple[str, object, object]] = [
            ("class", node.node_class, row.tag.removeprefix(f"{_TAG}UA")),
            ("browse name", self._name(node.name), there.name(row.get("BrowseName", ""))),
            ("data type", node.data and self._type(node.data), data and there.key(data)),
            ("rank", node.rank, int(row.get("ValueRank", -1))),
            ("abstract", node.abstract, row.get("IsAbstract") == "true"),
        ]
        base = self._type(node.base)
        if node.is_type:
            pairs.append(("base", {base}, {o for k, o in from_ if k == "HasSubtype"}))
        else:
            pairs.append(("type", {base}, {o for k, o in to if k == "HasTypeDefinition"}))
        rules = {(_STANDARD, getattr(ua.ObjectIds, RULES[node.rule]))} if node.rule else set()
        pairs.append(("rule", rules, {o for k, o in to if k == "HasModellingRule"}))
        if node.parent is not None:
            parent = (node.by, self._key(node, node.parent))
            pairs.append(("parent", parent if parent in from_ else None, parent))
        for kind, number in node.references:
            reference = (kind, self._key(node, number))
            pairs.append(("reference", reference if reference in to else None, reference))
        values = row.find(f"{_TAG}Value")
        if node.value is not None:
            told = None if values is None else values.findtext(f"{_VALUE}UInt32")
            pairs.append(("value", str(node.value), told))
        if node.names:
            kind = f"{_VALUE}EnumValueType"
            rows = [] if values is None else list(values.iter(kind))
            words = f"{_VALUE}DisplayName/{_VALUE}Text"
            listed = {r.findtext(f"{_VALUE}Value"): r.findtext(words) for r in rows}
            pairs.append(("names", {str(k): n for k, n in enumerate(node.names)}, listed))
        return pairs


async def _loaded(folder: Path, name: str) -> list[str]:
    """What the published types want of a machine that is not there."""
    async with (
        MachineLink(MachineStart(name, running=False)) as link,
        OpcUaServer(link, 0, folder) as port,
        client_of(port) as client,
    ):
        found: list[str] = await client.ask("missing", f"own:{name}")
        return found


def main() -> int:
    """Compare; the number of what differs is told."""
    folder = Path(sys.argv[1])
    comparison = Comparison(folder)
    faults = comparison.faults()
    print(f"type_nodes.txt: {comparison.count()} nodes, {len(faults)} differ")
    for name in MACHINES:
        missing = asyncio.run(_loaded(folder, name))
        print(f"{name}: {len(missing)} of the published types' wants not met")
        faults += missing
    print("\n".join(faults))
    return 1 if faults else 0


if __name__ == "__main__":
    sys.exit(main())
