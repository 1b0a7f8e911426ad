"""A client of an OPC UA server in a process of its own: requests on stdin, answers on stdout.

    python ua_reader.py URL

Each line is a JSON list, a request and its arguments; each answer is a line of JSON.
"""

import asyncio
import json
import sys
from typing import Any

from asyncua import Client, Node, ua

SPACES = {
    "DI": "http://opcfoundation.org/UA/DI/",
    "Machinery": "http://opcfoundation.org/UA/Machinery/",
    "MachineTool": "http://opcfoundation.org/UA/MachineTool/",
    "own": "urn:motionfmu:machine",
}
FIELDS = (
    ("EventType",),
    ("SourceName",),
    ("Message",),
    ("Severity",),
    ("Retain",),
    ("ErrorCode",),
    ("ActiveState", "Id"),
    ("AckedState", "Id"),
)


def plain(value: Any) -> Any:
    """A value as JSON."""
    if isinstance(value, ua.LocalizedText):
        return value.Text
    if isinstance(value, ua.NodeId):
        return [value.NamespaceIndex, value.Identifier]
    if isinstance(value, ua.QualifiedName):
        return value.Name
    if isinstance(value, ua.EUInformation):
        return [value.UnitId, value.DisplayName.Text]
    if isinstance(value, ua.Range):
        return [value.Low, value.High]
    if isinstance(value, list):
        return [plain(v) for v in value]
    return value


async def parts_of(node: Node) -> dict[tuple[int, str], Node]:
    """What belongs to a node, by browse name."""
    names = [(await n.read_browse_name(), n) for n in await node.get_children()]
    return {(name.NamespaceIndex, name.Name): n for name, n in names}


class Reader:
    """What is asked of a server."""

    def __init__(self, client: Client) -> None:
        self._client = client
        self._index: dict[str, int] = {"0": 0}
        self._events: dict[str, list[Any]] = {}
        self._changes: list[Any] = []

    async def begin(self) -> None:
        for name, uri in SPACES.items():
            self._index[name] = await self._client.get_namespace_index(uri)

    async def node(self, path: str) -> Node:
        """A node from the folder of machines on, by its browse names with their prefixes."""
        node = self._client.get_node(ua.NodeId(1001, self._index["Machinery"]))
        names = []
        for step in path.split("/"):
            prefix, _, name = step.rpartition(":")
            names.append(ua.QualifiedName(name, self._index[prefix or "0"]))
        return await node.get_child(names) if path else node

    async def do_read(self, *paths: str) -> Any:
        return [plain(await (await self.node(p)).read_value()) for p in paths]

    async def do_type(self, path: str) -> Any:
        """Namespace and number of a node's type, and of its type of data."""
        node = await self.node(path)
        kind = await node.read_type_definition()
        data = None
        if await node.read_node_class() is ua.NodeClass.Variable:
            data = plain(await node.read_data_type())
        return [plain(kind), data]

    async def do_spaces(self) -> Any:
        return self._index

    async def do_base(self, prefix: str, number: int) -> Any:
        """Name of a node, and of the types above it."""
        node, found = self._client.get_node(ua.NodeId(number, self._index[prefix])), []
        while True:
            found.append((await node.read_browse_name()).Name)
            above = await node.get_referenced_nodes(
                ua.ObjectIds.HasSubtype, ua.BrowseDirection.Inverse
            )
            if not above:
                return found
            node = above[0]

    async def do_missing(self, path: str) -> Any:
        """What types want of a node, and of those below it, that is not there."""
        found: list[str] = []
        await self._compare(await self.node(path), path, found)
        return found

    async def _compare(self, node: Node, path: str, found: list[str]) -> None:
        kind, here = self._client.get_node(await node.read_type_definition()), await parts_of(node)
        done: set[str] = set()  # what a subtype declares anew
        while kind.nodeid.NamespaceIndex or kind.nodeid.Identifier != ua.ObjectIds.BaseObjectType:
            await self._declared(kind, (here, path, done), found)
            above = await kind.get_referenced_nodes(
                ua.ObjectIds.HasSubtype, ua.BrowseDirection.Inverse
            )
            if not above:
                break
            kind = above[0]
        for (_, name), part in here.items():
            await self._compare(part, f"{path}/{name}", found)

    async def _declared(
        self, kind: Node, place: tuple[dict[tuple[int, str], Node], str, set[str]], found: list[str]
    ) -> None:
        """Hold what a type, or a part of one, declares against what is there."""
        here, path, done = place
        for name, declared in (await parts_of(kind)).items():
            rules = await declared.get_referenced_nodes(ua.ObjectIds.HasModellingRule)
            if not rules or name[1].startswith("<"):
                continue
            own, part = f"{path}/{name[1]}", here.get(name)
            if own in done:
                continue
            done.add(own)
            if part is None:
                if rules[0].nodeid.Identifier == ua.ObjectIds.ModellingRule_Mandatory:
                    found.append(own)
                continue
            for read in ("read_node_class", "read_type_definition", "read_data_type"):
                if read == "read_data_type" and (
                    await part.read_node_class() is not ua.NodeClass.Variable
                ):
                    continue
                wanted, there = await getattr(declared, read)(), await getattr(part, read)()
                if wanted != there:
                    found.append(f"{own}: {read} {there}, {wanted} is wanted")
            await self._declared(declared, (await parts_of(part), own, done), found)

    async def do_below(self, path: str) -> Any:
        node = await self.node(path)
        return [(await n.read_browse_name()).Name for n in await node.get_children()]

    async def do_write(self, path: str, value: float) -> Any:
        """The answer to an attempt to write."""
        try:
            await (await self.node(path)).write_value(ua.Variant(value, ua.VariantType.Double))
        except ua.UaStatusCodeError as error:
            return type(error).__name__
        return "written"

    async def do_add(self) -> Any:
        """The answer to an attempt to add a node."""
        try:
            await self._client.nodes.objects.add_variable(self._index["own"], "mine", 1.0)
        except ua.UaStatusCodeError as error:
            return type(error).__name__
        return "added"

    async def do_subscribe(self, name: str, path: str | None = None) -> None:
        """Collect events of a node, the server without one, under a name."""
        here = self._events.setdefault(name, [])
        fields = [
            [ua.QualifiedName(n, self._index["MachineTool"] if n == "ErrorCode" else 0) for n in f]
            for f in FIELDS
        ]
        wanted = ua.EventFilter(
            SelectClauses=[
                ua.SimpleAttributeOperand(
                    TypeDefinitionId=ua.NodeId(ua.ObjectIds.BaseEventType),
                    BrowsePath=f,
                    AttributeId=ua.AttributeIds.Value,
                )
                for f in fields
            ]
        )

        class Handler:
            def event_notification(self, event: Any) -> None:
                found = event.get_event_props_as_fields_dict()
                here.append({"/".join(f): plain(found["/".join(f)].Value) for f in FIELDS})

        node = self._client.nodes.server if path is None else await self.node(path)
        self._refreshed = await self._client.create_subscription(20, Handler())
        await self._refreshed.subscribe_events(node, evfilter=wanted)

    async def do_refresh(self) -> None:
        """Ask for the alarms that are active, for the latest subscription."""
        kind = self._client.get_node(ua.NodeId(ua.ObjectIds.ConditionType))
        method = ua.NodeId(ua.ObjectIds.ConditionType_ConditionRefresh)
        number = ua.Variant(self._refreshed.subscription_id, ua.VariantType.UInt32)
        await kind.call_method(method, number)

    async def do_alerts(self, name: str) -> Any:
        """What a subscription got, but the begin and the end of a refresh."""
        return [e for e in self._events[name] if e["ErrorCode"] is not None]

    async def do_follow(self, path: str) -> None:
        """Collect the values of a variable from now on."""
        here = self._changes

        class Handler:
            def datachange_notification(self, node: Node, value: Any, data: Any) -> None:
                here.append(plain(value))

        subscription = await self._client.create_subscription(20, Handler())
        await subscription.subscribe_data_change(await self.node(path), queuesize=100)

    async def do_changes(self) -> Any:
        return self._changes


async def main(url: str) -> None:
    """Serve stdin."""
    async with Client(url) as client:
        reader = Reader(client)
        await reader.begin()
        loop = asyncio.get_running_loop()
        while line := await loop.run_in_executor(None, sys.stdin.readline):
            name, *arguments = json.loads(line)
            answer = await getattr(reader, f"do_{name}")(*arguments)
            print(json.dumps(answer), flush=True)


if __name__ == "__main__":
    asyncio.run(main(sys.argv[1]))
