"""The OPC UA server of a live machine."""

import asyncio
import contextlib
import logging
import os
from pathlib import Path
from types import TracebackType
from typing import Any

from asyncua import Server, ua
from asyncua.common.connection import TransportLimits
from asyncua.crypto.permission_rules import User, UserRole
from asyncua.server.binary_server_asyncio import BinaryServer, OPCUAProtocol
from asyncua.server.user_managers import UserManager

from motionfmu.base.errors import InputError
from motionfmu.live.opcua import nodesets
from motionfmu.live.opcua.alert_events import AlertEvents
from motionfmu.live.opcua.controller_channel import ActionReader, Alarm, channels_of
from motionfmu.live.opcua.machine_nodes import MachineNodes
from motionfmu.live.opcua.node_table import TypeNode
from motionfmu.live.opcua.node_tree import NodeTree
from motionfmu.live.serving.machine_link import MachineLink

HOST = "127.0.0.1"
PATH = "motionfmu"
PERIOD = 0.1  # [s] on the wall between two looks at the machine
CONNECTIONS_MAX = 50
MESSAGE_MAX = 1 << 20  # [byte] of a client
_CHUNK_MAX = 1 << 16  # [byte]


class _Guests(UserManager):
    """Everybody may look, nobody may change anything."""

    def get_user(
        self,
        iserver: Any,
        username: str | None = None,
        password: str | None = None,
        certificate: Any = None,
    ) -> User:
        return User(role=UserRole.User)


class _BoundedConnection(OPCUAProtocol):
    """A connection that keeps no more than a message of it may have; asyncua keeps any length."""

    _buffer: bytes

    def data_received(self, data: bytes) -> None:
        if len(self._buffer) + len(data) > MESSAGE_MAX:
            self._buffer = b""
            if self.transport is not None:
                self.transport.close()
            return
        super().data_received(data)


class _Listener(BinaryServer):
    def _make_protocol(self) -> OPCUAProtocol:
        return _BoundedConnection(
            self.iserver, self._policies, self.clients, self.closing_tasks, self.limits
        )


class _LocalServer(Server):
    """A server that everybody on this computer may look at."""

    def __init__(self) -> None:
        super().__init__(user_manager=_Guests())
        self.application_type = ua.ApplicationType.Server
        chunks = MESSAGE_MAX // _CHUNK_MAX
        self.limits = TransportLimits(_CHUNK_MAX, _CHUNK_MAX, chunks, MESSAGE_MAX)
        self.iserver.max_connections = CONNECTIONS_MAX
        self.iserver.bind_condition_methods = 1  # the severity of a refresh's begin and end
        self.set_security_policy([ua.SecurityPolicyType.NoSecurity])
        self.set_identity_tokens([ua.AnonymousIdentityToken])

    async def start(self) -> None:
        """Listen, as asyncua's own server does, with connections that are bounded."""
        await self._setup_server_nodes()
        await self.iserver.start()
        port = self.endpoint.port or 0
        self.bserver = _Listener(self.iserver, HOST, port, self.limits)
        self.bserver.set_policies(self._policies)
        try:
            await self.bserver.start()
        except OSError:
            await self.iserver.stop()
            raise


class OpcUaServer:
    """A live machine as a machine tool of OPC UA.

    In ``async with`` it serves, and gives the port. It can be read and subscribed to, from this
    computer, without encryption; nothing can be set.

    Parameters
    ----------
    link : MachineLink
        It is open.
    port : int
        0: the system chooses.
    folder : Path, optional
        Published nodesets; without them the server has those nodes of their types that it uses.

    Raises
    ------
    InputError
        No controller of the machine tells its state, the port is taken, a nodeset is missing.
    """

    def __init__(self, link: MachineLink, port: int, folder: Path | None = None) -> None:
        logging.getLogger("asyncua").addHandler(logging.NullHandler())
        self._link, self._port, self._folder = link, port, folder
        self._channels = channels_of(link.about)
        self._names = [n for c in self._channels for n in c.names]
        self._actions = ActionReader()
        self._shown: dict[str, Alarm] = {}  # alerts that are active, by component

    async def __aenter__(self) -> int:
        server = self._server = _LocalServer()
        await server.init()
        server.set_server_name(f"motionfmu: {self._link.about['name']}")
        server.set_endpoint(f"opc.tcp://{HOST}:{self._port}/{PATH}")
        await server.set_application_uri(f"urn:motionfmu:live:{self._link.about['name']}")
        if self._folder is not None:
            await nodesets.load(server, self._folder)
        tree = NodeTree(server)
        added = await tree.begin()
        if self._folder is not None and added:
            raise InputError(_without(self._folder, added[0]))
        self._nodes = MachineNodes(tree, self._link.about, self._channels)
        await self._nodes.begin()
        emitters = [self._nodes.messages.node, self._nodes.machine.node]
        self._alerts = AlertEvents(server, tree, [*emitters, ua.NodeId(ua.ObjectIds.Server)])
        await self._look()
        try:
            await server.start()
        except OSError as error:
            told = os.strerror(error.errno or 0)
            raise InputError(f"OPC UA {HOST}:{self._port}: {told}") from None
        self._following = asyncio.create_task(self._follow())
        assert server.bserver is not None
        return server.bserver.port

    async def __aexit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._following.cancel()
        with contextlib.suppress(asyncio.CancelledError, InputError):
            await self._following
        await self._server.stop()

    async def _follow(self) -> None:
        """Look at the machine again and again, until its process has ended."""
        loop = asyncio.get_running_loop()
        while True:
            due = loop.time() + PERIOD
            await self._look()
            await asyncio.sleep(max(0.0, due - loop.time()))

    async def _look(self) -> None:
        frame = await self._link.ask("frame", names=self._names)
        count = self._actions.wanted(frame)
        rows = await self._link.ask("journal", last=count) if count else []
        actions = [(name, values) for _, name, values in rows]
        for index, channel in enumerate(self._channels):
            made = channel.look(frame, actions)
            if index == 0:
                for pair in made:
                    await self._nodes.show_transition(pair)
        await self._nodes.show(frame)
        for channel in self._channels:
            await self._alert(channel.component, channel.alarm)

    async def _alert(self, component: str, alarm: Alarm | None) -> None:
        """Tell what has become of a controller's alarm."""
        before = self._shown.get(component)
        if alarm == before:
            return
        source = self._nodes.channels[component]
        if before is not None:
            await self._alerts.send(source, component, before, False)
            del self._shown[component]
        if alarm is not None:
            await self._alerts.send(source, component, alarm, True)
            self._shown[component] = alarm


def _without(folder: Path, node: TypeNode) -> str:
    """A message for nodesets that lack a node."""
    specification = node.specification
    wanted = f"{specification.version} or later is wanted"
    return f"{folder}: the nodeset of {specification.uri} has no {node.name}: {wanted}"
