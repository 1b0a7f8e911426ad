"""Nodes of an OPC UA server: those of the specifications' types, and those of a machine."""

from collections.abc import Iterable
from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any

from asyncua import Server, ua

from motionfmu.live.opcua.node_table import RULES, Specification, TypeNode, type_nodes

OWN = "urn:motionfmu:machine"  # namespace of the nodes of machines
UNITS = "http://www.opcfoundation.org/UA/units/un/cefact"
# Common codes of UN/CEFACT Recommendation 20, with the words that OPC 10000-8 gives them.
_UNITS = {
    "%": ("P1", "%", "percent"),
    "mm": ("MMT", "mm", "millimetre"),
    "m": ("MTR", "m", "metre"),
    "mm/s": ("C16", "mm/s", "millimetre per second"),
    "rad": ("C81", "rad", "radian"),
    "rpm": ("RPM", "r/min", "revolutions per minute"),
}
# Where an object stands that is part of no other node.
_PLACES = {"Machinery:Machines": "ObjectsFolder"}


def unit(symbol: str | None) -> ua.EUInformation | None:
    """A unit of ours as OPC UA tells it; None for one that it is not asked for."""
    if symbol not in _UNITS:
        return None
    code, shown, said = _UNITS[symbol]
    return ua.EUInformation(
        NamespaceUri=UNITS,
        UnitId=int.from_bytes(code.encode(), "big"),
        DisplayName=ua.LocalizedText(shown),
        Description=ua.LocalizedText(said),
    )


@dataclass(frozen=True)
class NodePlace:
    """A node of the machine by its path, and its NodeId."""

    path: str
    node: ua.NodeId


class NodeTree:
    """Adds nodes to a server that is initialized and not started, and keeps their values."""

    def __init__(self, server: Server) -> None:
        self._server = server
        self._spaces: dict[str, int] = {}  # by prefix; the empty one is the machine's
        self._types: dict[str, ua.NodeId] = {}
        self._shown: dict[str, Any] = {}

    async def begin(self) -> list[TypeNode]:
        """Make the namespaces, and the nodes of the specifications that are not there: these."""
        nodes, server = type_nodes(), self._server
        for node in nodes:
            specification = node.specification
            if specification.prefix not in self._spaces:
                index = await server.register_namespace(specification.uri)
                self._spaces[specification.prefix] = index
        self._spaces[""] = await server.register_namespace(OWN)
        for node in nodes:
            if node.is_type:
                self._types[node.name] = self._id(node, node.number)
        there = [n for n in nodes if self._id(n, n.number) in server.iserver.aspace]
        added = [n for n in nodes if n not in there]
        for node in added:
            await self._add_type(node, [n for n in nodes if n.parent == node.number])
        for node in added:
            await self._refer(node)
        return added

    def _id(self, node: TypeNode, number: int) -> ua.NodeId:
        return ua.NodeId(number, self._spaces[node.specification.prefix])

    def spec(self, prefix: str, number: int) -> ua.NodeId:
        """A node of a specification."""
        return ua.NodeId(number, self._spaces[prefix])

    def type(self, name: str) -> ua.NodeId:
        """A type by its name, with the prefix of its specification."""
        return self._types.get(name) or ua.NodeId(getattr(ua.ObjectIds, name))

    def name(self, text: str) -> ua.QualifiedName:
        """A browse name from one with a prefix; the standard's are after a colon alone."""
        prefix, colon, name = text.partition(":")
        if colon and prefix in self._spaces:
            return ua.QualifiedName(name, self._spaces[prefix])
        return ua.QualifiedName(text, 0)

    async def _add_type(self, node: TypeNode, parts: list[TypeNode]) -> None:
        base = self.type(node.base)
        if node.parent is not None:
            parent = self._id(node, node.parent)
        elif node.is_type:
            parent = base
        else:
            place = _PLACES.get(node.name, "Server_Namespaces")
            parent = ua.NodeId(getattr(ua.ObjectIds, place))
        item = ua.AddNodesItem(
            ParentNodeId=parent,
            ReferenceTypeId=self.type(node.by),
            RequestedNewNodeId=self._id(node, node.number),
            BrowseName=self.name(node.name),
            NodeClass=ua.NodeClass[node.node_class],
            NodeAttributes=self._attributes(node, parts),
            TypeDefinition=ua.NodeId() if node.is_type else base,
        )
        await self._add(item)

    def _attributes(self, node: TypeNode, parts: list[TypeNode]) -> Any:
        shown = ua.LocalizedText(self.name(node.name).Name)
        match node.node_class:
            case "ObjectType":
                return ua.ObjectTypeAttributes(DisplayName=shown, IsAbstract=node.abstract)
            case "DataType":
                fields = [
                    ua.EnumField(Value=k, DisplayName=ua.LocalizedText(name), Name=name)
                    for part in parts
                    if part.specification is node.specification
                    for k, name in enumerate(part.names)
                ]
                return ua.DataTypeAttributes(
                    DisplayName=shown,
                    IsAbstract=False,
                    DataTypeDefinition=ua.EnumDefinition(Fields=fields),
                )
            case "Object":
                return ua.ObjectAttributes(DisplayName=shown)
        assert node.data is not None
        return ua.VariableAttributes(
            DisplayName=shown,
            Value=_value_of(node),
            DataType=self.type(node.data),
            ValueRank=ua.ValueRank(node.rank),
            ArrayDimensions=[len(node.names)] if node.names else None,
        )

    async def _refer(self, node: TypeNode) -> None:
        """The references that a node has beside those to parent, base and type."""
        found = [(self.type(kind), self._id(node, to)) for kind, to in node.references]
        if node.rule is not None:
            rule = ua.NodeId(getattr(ua.ObjectIds, RULES[node.rule]))
            found.append((ua.NodeId(ua.ObjectIds.HasModellingRule), rule))
        own = self._id(node, node.number)
        for kind, to in found:
            await self.refer(own, kind, to)

    async def refer(self, source: ua.NodeId, kind: ua.NodeId, target: ua.NodeId) -> None:
        """Add a reference, and its inverse."""
        there = ua.AddReferencesItem(source, kind, True, "", target, ua.NodeClass.Unspecified)
        back = ua.AddReferencesItem(target, kind, False, "", source, ua.NodeClass.Unspecified)
        for result in await self._server.iserver.isession.add_references([there, back]):
            result.check()

    async def _add(self, item: ua.AddNodesItem) -> None:
        result = (await self._server.iserver.isession.add_nodes([item]))[0]
        result.StatusCode.check()

    async def object(
        self,
        parent: NodePlace,
        name: str,
        kind: str,
        by: str = "HasComponent",
        events: bool = False,
    ) -> NodePlace:
        """Add an object of the machine."""
        place = self._place(parent, name)
        notifier = ua.EventNotifier.SubscribeToEvents.mask if events else 0
        qualified = self.name(name)
        shown = ua.LocalizedText(qualified.Name)
        item = ua.AddNodesItem(
            ParentNodeId=parent.node,
            ReferenceTypeId=self.type(by),
            RequestedNewNodeId=place.node,
            BrowseName=qualified,
            NodeClass=ua.NodeClass.Object,
            NodeAttributes=ua.ObjectAttributes(DisplayName=shown, EventNotifier=notifier),
            TypeDefinition=self.type(kind),
        )
        await self._add(item)
        return place

    def _place(self, parent: NodePlace, name: str) -> NodePlace:
        path = f"{parent.path}/{self.name(name).Name}" if parent.path else self.name(name).Name
        return NodePlace(path, ua.NodeId(path, self._spaces[""]))

    async def variable(
        self, parent: NodePlace, name: str, value: ua.Variant, data: str, kind: str = "PropertyType"
    ) -> NodePlace:
        """Add a variable of the machine, or a property, with its first value."""
        place = self._place(parent, name)
        qualified = self.name(name)
        by = "HasProperty" if kind == "PropertyType" else "HasComponent"
        item = ua.AddNodesItem(
            ParentNodeId=parent.node,
            ReferenceTypeId=self.type(by),
            RequestedNewNodeId=place.node,
            BrowseName=qualified,
            NodeClass=ua.NodeClass.Variable,
            NodeAttributes=ua.VariableAttributes(
                DisplayName=ua.LocalizedText(qualified.Name),
                Value=value,
                DataType=self.type(data),
                ValueRank=ua.ValueRank.OneDimension if value.is_array else ua.ValueRank.Scalar,
                ArrayDimensions=[len(value.Value)] if value.is_array else None,
            ),
            TypeDefinition=self.type(kind),
        )
        await self._add(item)
        return place

    async def write(self, place: NodePlace, value: ua.Variant) -> None:
        """Give a variable a value, if it is another one."""
        if self._shown.get(place.path) == value:
            return
        self._shown[place.path] = value
        now = datetime.now(UTC)
        data = ua.DataValue(value, SourceTimestamp=now, ServerTimestamp=now)
        await self._server.write_attribute_value(place.node, data)


def _value_of(node: TypeNode) -> ua.Variant:
    """The value of a variable of a type."""
    if node.names:
        values: Iterable[Any] = (
            ua.EnumValueType(Value=k, DisplayName=ua.LocalizedText(name))
            for k, name in enumerate(node.names)
        )
        return ua.Variant(list(values), ua.VariantType.ExtensionObject, is_array=True)
    if node.value is not None:
        return ua.Variant(node.value, ua.VariantType.UInt32)
    return _of_namespace(node.specification).get(node.name, ua.Variant())


def _of_namespace(specification: Specification) -> dict[str, ua.Variant]:
    """What is told of a namespace: only a part of it is here."""
    return {
        "NamespaceUri": ua.Variant(specification.uri, ua.VariantType.String),
        "NamespaceVersion": ua.Variant(specification.version, ua.VariantType.String),
        "NamespacePublicationDate": ua.Variant(specification.published, ua.VariantType.DateTime),
        "IsNamespaceSubset": ua.Variant(True, ua.VariantType.Boolean),
    }
