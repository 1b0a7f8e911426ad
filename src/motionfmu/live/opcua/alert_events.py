"""Alarms of a machine as events: AlertType of OPC 40501-1, an alarm condition."""

import uuid
from datetime import UTC, datetime

from asyncua import Server, ua
from asyncua.common.event_objects import AlarmCondition

from motionfmu.live.opcua.controller_channel import Alarm
from motionfmu.live.opcua.node_tree import NodePlace, NodeTree

SEVERITY = 800  # of 1 to 1000: the machine has stopped


class AlertEvents:
    """Sends alerts to the subscribers of some objects, of which each is above the one before."""

    def __init__(self, server: Server, tree: NodeTree, emitters: list[ua.NodeId]) -> None:
        self._server, self._tree, self._emitters = server, tree, emitters

    async def send(self, source: NodePlace, component: str, alarm: Alarm, active: bool) -> None:
        """Tell that an alarm has come or gone; nothing can be done about it from here."""
        place = NodePlace(
            "", ua.NodeId(f"{source.path}/Alert/{alarm.code}", source.node.NamespaceIndex)
        )
        event = AlarmCondition(severity=SEVERITY)
        event.EventType = self._tree.type("MachineTool:AlertType")
        event.add_property("ErrorCode", alarm.code, ua.VariantType.String)
        event.add_property("NodeId", place.node, ua.VariantType.NodeId)
        now = datetime.now(UTC)
        event.EventId = uuid.uuid4().bytes
        event.Time = event.ReceiveTime = now
        event.SourceNode, event.SourceName = source.node, component
        event.Message = ua.LocalizedText(f"{component}: {alarm.text}")
        event.ConditionName = f"{component} {alarm.code}"
        event.ConditionClassId = ua.NodeId(ua.ObjectIds.SystemConditionClassType)
        event.ConditionClassName = ua.LocalizedText("SystemConditionClassType")
        event.BranchId = ua.NodeId()
        event.Retain = active
        event.Quality = ua.StatusCode(ua.StatusCodes.Good)
        event.LastSeverity = SEVERITY
        event.Comment = ua.LocalizedText("")
        event.ClientUserId = ""
        event.InputNode = ua.NodeId()
        event.SuppressedOrShelved = False
        for state, true, words in (
            ("EnabledState", True, ("Disabled", "Enabled")),
            ("AckedState", True, ("Unacknowledged", "Acknowledged")),
            ("ActiveState", active, ("Inactive", "Active")),
        ):
            setattr(event, state, ua.LocalizedText(words[true]))
            setattr(event, f"{state}/Id", true)
        # The last one stays as the condition of a refresh, which clients ask of the server.
        for emitter in self._emitters:
            event.emitting_node = emitter
            await self._server.iserver.subscription_service.trigger_event(event)
