"""The nodes of a live machine: a MachineToolType of OPC 40501-1 in the folder Machines."""

import math
from collections.abc import Mapping, Sequence
from typing import Any

from asyncua import ua

from motionfmu.base import project_version
from motionfmu.live.opcua.channel_watch import ChannelMode, ChannelState, ProgramState
from motionfmu.live.opcua.controller_channel import ControllerChannel
from motionfmu.live.opcua.node_tree import NodePlace, NodeTree, unit

_MANUFACTURER = "motionfmu (simulated machine)"
# Numbers of the nodes of types to which a machine's nodes point.
_MACHINES = 1001
_ITEM_STATES = {"NotAvailable": 5005, "OutOfService": 5004, "NotExecuting": 5007, "Executing": 5006}
_OPERATION_MODES = {"Setup": 5061, "Processing": 5060}
_PROGRAM_STATES = {
    ProgramState.Initializing: 5039,
    ProgramState.Running: 5041,
    ProgramState.Ended: 5038,
    ProgramState.Interrupted: 5040,
    ProgramState.Aborted: 5037,
}
_Pair = tuple[ProgramState, ProgramState]
# Node and TransitionNumber of each transition.
_TRANSITIONS: dict[_Pair, tuple[int, int]] = {
    (ProgramState.Initializing, ProgramState.Running): (91, 0),
    (ProgramState.Running, ProgramState.Ended): (92, 1),
    (ProgramState.Ended, ProgramState.Initializing): (106, 2),
    (ProgramState.Running, ProgramState.Interrupted): (109, 4),
    (ProgramState.Interrupted, ProgramState.Running): (107, 5),
    (ProgramState.Running, ProgramState.Aborted): (108, 6),
    (ProgramState.Interrupted, ProgramState.Aborted): (105, 7),
    (ProgramState.Aborted, ProgramState.Initializing): (102, 8),
    (ProgramState.Initializing, ProgramState.Aborted): (104, 9),
}
_MANUAL, _AUTOMATIC = 0, 1  # of the enumeration MachineOperationMode
_STATE_MACHINE = "MachineTool:ProductionProgramStateMachineType"


def _text(value: str) -> ua.Variant:
    return ua.Variant(value, ua.VariantType.String)


def _shown(value: str) -> ua.Variant:
    return ua.Variant(ua.LocalizedText(value), ua.VariantType.LocalizedText)


def _double(value: float) -> ua.Variant:
    return ua.Variant(float(value), ua.VariantType.Double)


def _truth(value: Any) -> ua.Variant:
    return ua.Variant(bool(value), ua.VariantType.Boolean)


def _uint32(value: int) -> ua.Variant:
    return ua.Variant(int(value), ua.VariantType.UInt32)


def _enumerated(value: int) -> ua.Variant:
    return ua.Variant(int(value), ua.VariantType.Int32)


def _node(value: ua.NodeId) -> ua.Variant:
    return ua.Variant(value, ua.VariantType.NodeId)


class MachineNodes:
    """Makes the nodes of a machine and shows what it does; the first channel has the program."""

    def __init__(
        self, tree: NodeTree, about: Mapping[str, Any], channels: Sequence[ControllerChannel]
    ) -> None:
        self._tree, self._about, self._channels = tree, about, channels
        self._places: dict[str, NodePlace] = {}
        self.channels: dict[str, NodePlace] = {}  # by component

    async def begin(self) -> None:
        """Add all nodes."""
        tree, name = self._tree, str(self._about["name"])
        machines = NodePlace("", tree.spec("Machinery", _MACHINES))
        self.machine = await tree.object(
            machines, f":{name}", "MachineTool:MachineToolType", "Organizes", events=True
        )
        await self._identification(name)
        await tree.object(self.machine, "MachineTool:Equipment", "MachineTool:EquipmentType")
        kind = "MachineTool:MonitoringType"
        monitoring = await tree.object(self.machine, "MachineTool:Monitoring", kind)
        await self._whole(monitoring)
        for channel in self._channels:
            await self._channel(monitoring, channel)
            if channel.panel.readout.spindle is not None:
                await self._spindle(monitoring, channel)
        await self._production()
        kind = "MachineTool:NotificationType"
        notification = await tree.object(self.machine, "MachineTool:Notification", kind)
        self.messages = await tree.object(
            notification, "MachineTool:Messages", "MachineTool:MessagesType", events=True
        )
        await self._simulation()
        server, notifier = ua.NodeId(ua.ObjectIds.Server), tree.type("HasNotifier")
        await tree.refer(server, notifier, self.machine.node)
        await tree.refer(self.machine.node, notifier, self.messages.node)

    async def _identification(self, name: str) -> None:
        tree, version = self._tree, project_version.version()
        kind = "MachineTool:MachineToolIdentificationType"
        own = await tree.object(self.machine, "DI:Identification", kind, "HasAddIn")
        for what, value, data in (
            ("DI:Manufacturer", _shown(_MANUFACTURER), "LocalizedText"),
            ("DI:Model", _shown(name), "LocalizedText"),
            ("DI:DeviceClass", _text("Simulated machine tool"), "String"),
            ("DI:SerialNumber", _text("simulated"), "String"),
            ("DI:ProductInstanceUri", _text(f"urn:motionfmu:machine:{name}"), "String"),
            ("DI:SoftwareRevision", _text(version), "String"),
        ):
            await tree.variable(own, what, value, data)
        items = await tree.object(own, "MachineTool:SoftwareIdentification", "BaseObjectType")
        for channel in self._channels:
            kind = "MachineTool:SoftwareIdentificationType"
            item = await tree.object(items, f":{channel.component}", kind)
            name = channel.panel.title
            await tree.variable(item, "MachineTool:Identifier", _text(name), "String")
            await tree.variable(item, "DI:SoftwareRevision", _text(version), "String")

    async def _keep(
        self, parent: NodePlace, key: str, what: tuple[str, ua.Variant, str], kind: str
    ) -> NodePlace:
        """Add a variable that show() writes by its key."""
        name, value, data = what
        self._places[key] = await self._tree.variable(parent, name, value, data, kind)
        return self._places[key]

    async def _percent(
        self, parent: NodePlace, key: str, name: str, port: Mapping[str, Any]
    ) -> None:
        """Add an override: 1 of ours is 100 %."""
        what = (f"MachineTool:{name}", _double(100.0), "Double")
        place = await self._keep(parent, key, what, "AnalogUnitRangeType")
        low, high = (100.0 * (port[n] or 0.0) for n in ("low", "high"))
        limits = ua.Variant(ua.Range(Low=low, High=high), ua.VariantType.ExtensionObject)
        units = ua.Variant(unit("%"), ua.VariantType.ExtensionObject)
        await self._tree.variable(place, "EngineeringUnits", units, "EUInformation")
        await self._tree.variable(place, "EURange", limits, "Range")

    async def _state_machine(
        self, parent: NodePlace, key: str, name: str, kind: str, by: str = "HasComponent"
    ) -> NodePlace:
        """Add a state machine: its present state in words, and as a node."""
        own = await self._tree.object(parent, name, kind, by)
        state = ("CurrentState", _shown(""), "LocalizedText")
        place = await self._keep(own, key, state, "FiniteStateVariableType")
        await self._keep(place, f"{key}/Id", ("Id", _node(ua.NodeId()), "NodeId"), "PropertyType")
        return own

    async def _whole(self, monitoring: NodePlace) -> None:
        first, kind = self._channels[0], "MachineTool:MachineOperationMonitoringType"
        own = await self._tree.object(monitoring, "MachineTool:MachineTool", kind)
        mode = "MachineTool:MachineOperationMode"
        what = ("MachineTool:OperationMode", _enumerated(_AUTOMATIC), mode)
        await self._keep(own, "OperationMode", what, "BaseDataVariableType")
        for name in first.readable(first.monitor.feed):
            await self._percent(own, "FeedOverride", "FeedOverride", first.variables[name])
        what = ("MachineTool:PowerOnDuration", _uint32(0), "UInt32")
        await self._keep(own, "PowerOnHours", what, "BaseDataVariableType")
        kind = "Machinery:MachineryOperationCounterType"
        counters = await self._tree.object(own, "DI:OperationCounters", kind, "HasAddIn")
        what = ("DI:PowerOnDuration", _double(0.0), "Duration")
        await self._keep(counters, "PowerOnDuration", what, "PropertyType")
        for key, kind in (
            ("MachineryItemState", "Machinery:MachineryItemState_StateMachineType"),
            ("MachineryOperationMode", "MachineTool:MachineOperationModeStateMachineType"),
        ):
            await self._state_machine(own, key, f"Machinery:{key}", kind, "HasAddIn")

    async def _channel(self, monitoring: NodePlace, channel: ControllerChannel) -> None:
        tree, name, readout = self._tree, channel.component, channel.panel.readout
        kind = "MachineTool:ChannelMonitoringType"
        own = self.channels[name] = await tree.object(monitoring, f":{name}", kind)
        await tree.variable(own, "MachineTool:Name", _text(name), "String")
        for what, value in (
            ("ChannelMode", _enumerated(ChannelMode.Automatic)),
            ("ChannelState", _enumerated(ChannelState.Reset)),
        ):
            kept = (f"MachineTool:{what}", value, f"MachineTool:{what}")
            await self._keep(own, f"{name}/{what}", kept, "BaseDataVariableType")
        for what, variable in (
            ("FeedOverride", channel.monitor.feed),
            ("RapidOverride", channel.monitor.rapid),
        ):
            if channel.readable(variable):
                assert variable is not None
                port = channel.variables[variable]
            elif what == "FeedOverride":  # the specification wants one: it is 100 %
                port = {"low": 1.0, "high": 1.0}
            else:
                continue
            await self._percent(own, f"{name}/{what}", what, port)
        for what, variable in (
            ("Position", readout.machine),
            ("PathFeed", readout.feed),
            ("Line", channel.panel.line),
            ("Tool", readout.tool),
            ("ControllerState", channel.panel.state),
        ):
            for readable in channel.readable(variable):
                await self._quantity(own, f"{name}/{what}", what, channel.variables[readable])

    async def _quantity(
        self, parent: NodePlace, key: str, name: str, port: Mapping[str, Any]
    ) -> None:
        """Add a variable of ours, which no specification has."""
        data = "Double" if port["type"].startswith("Float") else "Int32"
        kind, count = ua.VariantType[data], math.prod(port["shape"])
        value = ua.Variant([0] * count if port["shape"] else 0, kind)
        units = unit(port["unit"])
        own = "BaseDataVariableType" if units is None else "AnalogUnitType"
        place = await self._keep(parent, key, (f":{name}", value, data), own)
        if units is not None:
            told = ua.Variant(units, ua.VariantType.ExtensionObject)
            await self._tree.variable(place, "EngineeringUnits", told, "EUInformation")

    async def _spindle(self, monitoring: NodePlace, channel: ControllerChannel) -> None:
        tree, name = self._tree, f"{channel.component}_spindle"
        kind = "MachineTool:SpindleMonitoringType"
        own = await tree.object(monitoring, f":{name}", kind)
        await tree.variable(own, "MachineTool:Name", _text(name), "String")
        what = ("MachineTool:IsRotating", _truth(False), "Boolean")
        await self._keep(own, f"{name}/IsRotating", what, "BaseDataVariableType")
        for readable in channel.readable(channel.monitor.spindle):
            port = channel.variables[readable]
            await self._percent(own, f"{name}/Override", "Override", port)
        speed = channel.panel.readout.spindle
        assert speed is not None
        await self._quantity(own, f"{name}/Speed", "CommandedSpeed", channel.variables[speed])

    async def _production(self) -> None:
        tree, program = self._tree, self._about["program"]
        kind = "MachineTool:ProductionType"
        production = await tree.object(self.machine, "MachineTool:Production", kind)
        kind = "MachineTool:ProductionActiveProgramType"
        own = await tree.object(production, "MachineTool:ActiveProgram", kind)
        name = _text(program["file"] if program else "")
        await tree.variable(own, "MachineTool:Name", name, "String")
        number = ua.Variant(0, ua.VariantType.UInt16)
        await tree.variable(own, "NumberInList", number, "UInt16")
        states = await self._state_machine(own, "Program", "MachineTool:State", _STATE_MACHINE)
        number_of = ("Number", _uint32(0), "UInt32")
        await self._keep(self._places["Program"], "Program/Number", number_of, "PropertyType")
        last = ("LastTransition", _shown(""), "LocalizedText")
        kind = "FiniteTransitionVariableType"
        place = await self._keep(states, "Transition", last, kind)
        await self._keep(
            place, "Transition/Id", ("Id", _node(ua.NodeId()), "NodeId"), "PropertyType"
        )
        await self._keep(place, "Transition/Number", number_of, "PropertyType")
        what = (":RunTime", _double(0.0), "Duration")
        await self._keep(own, "RunTime", what, "BaseDataVariableType")

    async def _simulation(self) -> None:
        """What a machine has only because it is simulated."""
        own = await self._tree.object(self.machine, ":Simulation", "BaseObjectType")
        for name, value, data in (
            ("Time", _double(0.0), "Duration"),
            ("Pace", _double(1.0), "Double"),
            ("Running", _truth(False), "Boolean"),
        ):
            what = (f":{name}", value, data)
            await self._keep(own, f"Simulation/{name}", what, "BaseDataVariableType")

    async def show(self, frame: Mapping[str, Any]) -> None:
        """Show a frame, which the channels have taken already."""
        first, time = self._channels[0], frame["time"]
        watch, pace = first.watch, frame["pace"]
        busy = any(c.watch.state is ChannelState.Active for c in self._channels)
        item = (
            "NotAvailable"
            if not frame["running"]
            else "OutOfService"
            if any(c.watch.fault for c in self._channels)
            else "Executing"
            if busy
            else "NotExecuting"
        )
        automatic = watch.mode is ChannelMode.Automatic
        mode = "Processing" if automatic else "Setup"
        await self._write("OperationMode", _enumerated(_AUTOMATIC if automatic else _MANUAL))
        await self._write("PowerOnHours", _uint32(int(time // 3600)))
        await self._write("PowerOnDuration", _double(1e3 * time))
        await self._write("Simulation/Time", _double(1e3 * time))
        await self._write("Simulation/Pace", _double(math.inf if pace is None else pace))
        await self._write("Simulation/Running", _truth(frame["running"]))
        await self._state("MachineryItemState", item, "Machinery", _ITEM_STATES[item])
        await self._state("MachineryOperationMode", mode, "MachineTool", _OPERATION_MODES[mode])
        number = _PROGRAM_STATES[watch.program]
        await self._state("Program", watch.program.name, "MachineTool", number)
        await self._write("Program/Number", _uint32(watch.program))
        await self._write("RunTime", _double(1e3 * watch.run_time))
        await self._override("FeedOverride", first, first.monitor.feed)
        for channel in self._channels:
            await self._show_channel(channel)

    async def show_transition(self, made: tuple[ProgramState, ProgramState]) -> None:
        """Show the latest transition of the program."""
        number, value = _TRANSITIONS[made]
        name = f"{made[0].name}To{made[1].name}"
        await self._state("Transition", name, "MachineTool", number)
        await self._write("Transition/Number", _uint32(value))

    async def _show_channel(self, channel: ControllerChannel) -> None:
        name, panel, monitor = channel.component, channel.panel, channel.monitor
        await self._write(f"{name}/ChannelMode", _enumerated(channel.watch.mode))
        await self._write(f"{name}/ChannelState", _enumerated(channel.watch.state))
        for key, variable in (
            (f"{name}/FeedOverride", monitor.feed),
            (f"{name}/RapidOverride", monitor.rapid),
            (f"{name}_spindle/Override", monitor.spindle),
        ):
            await self._override(key, channel, variable)
        for key, variable in (
            ("Position", panel.readout.machine),
            ("PathFeed", panel.readout.feed),
            ("Line", panel.line),
            ("Tool", panel.readout.tool),
            ("ControllerState", panel.state),
        ):
            await self._value(f"{name}/{key}", channel, variable)
        speed = panel.readout.spindle
        if speed is not None:
            await self._value(f"{name}_spindle/Speed", channel, speed)
            turns = bool(channel.value(speed))
            await self._write(f"{name}_spindle/IsRotating", _truth(turns))

    async def _override(self, key: str, channel: ControllerChannel, name: str | None) -> None:
        if key in self._places and (value := channel.value(name)) is not None:
            await self._write(key, _double(100.0 * value))

    async def _value(self, key: str, channel: ControllerChannel, name: str | None) -> None:
        found = channel.values.get(name or "")
        if key not in self._places or found is None or name is None:
            return
        port = channel.variables[name]
        double = port["type"].startswith("Float")
        values = [float(v) if double else int(v) for v in found]
        kind = ua.VariantType.Double if double else ua.VariantType.Int32
        await self._write(key, ua.Variant(values if port["shape"] else values[0], kind))

    async def _state(self, key: str, name: str, prefix: str, number: int) -> None:
        """Show a state, or a transition: its name and its node."""
        await self._write(key, _shown(name))
        await self._write(f"{key}/Id", _node(self._tree.spec(prefix, number)))

    async def _write(self, key: str, value: ua.Variant) -> None:
        await self._tree.write(self._places[key], value)
