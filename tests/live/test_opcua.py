"""A live machine as OPC UA tells of machine tools, read by a client in a process of its own."""

import asyncio
import re
import socket
import subprocess
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest
from console import within
from opcua_bench import ACTIVE, CHANNEL, STATE, TOOL, WHOLE, Bench, bench, client_of, server_of

from motionfmu.base import extras
from motionfmu.base.errors import InputError
from motionfmu.live.opcua import OpcUaServer
from motionfmu.live.opcua.opcua_server import MESSAGE_MAX
from motionfmu.live.serving import MachineLink, MachineStart


def test_a_program_with_hold_override_alarm_and_reset(tmp_path: Path) -> None:
    async def work() -> None:
        async with bench(tmp_path) as b:
            read = (
                STATE,
                CHANNEL + "MachineTool:ChannelState",
                CHANNEL + "MachineTool:ChannelMode",
            )
            last = ACTIVE + "MachineTool:State/LastTransition"
            await b.client.ask("follow", STATE)
            await b.client.ask("subscribe", "server")
            await b.client.ask("subscribe", "messages", TOOL + "Notification/MachineTool:Messages")
            await b.step(0.3)
            assert await b.read(*read) == ["Initializing", 2, 0]
            assert (await b.read(ACTIVE + "MachineTool:Name", last)) == ["part.ngc", ""]

            await b.step(0.7)
            assert await b.read(*read) == ["Running", 0, 0]
            feed, line, there = await b.read(
                *(CHANNEL + f"own:{n}" for n in ("PathFeed", "Line", "Position"))
            )
            assert feed == pytest.approx(50.0, rel=1e-3) and line == 2
            read_there = (await b.link.ask("frame", names=["mcc.position"]))["values"]
            assert there == read_there["mcc.position"] and 0.0 < there[0] < 40.0

            await b.set("mcc.override", 0.5)
            await b.step(0.3)
            both = await b.read(
                WHOLE + "MachineTool:FeedOverride", CHANNEL + "MachineTool:FeedOverride"
            )
            assert both == [50.0, 50.0]
            assert (await b.read(CHANNEL + "own:PathFeed"))[0] == pytest.approx(25.0, rel=1e-3)

            await b.set("mcc.hold", True)
            await b.step(0.3)
            assert await b.read(*read, last) == ["Interrupted", 1, 0, "RunningToInterrupted"]
            await b.set("mcc.hold", False)
            await b.step(0.2)
            assert await b.read(*read, last) == ["Running", 0, 0, "InterruptedToRunning"]
            assert (await b.read(last + "/Number", last + "/Id"))[0] == 5

            await b.set("mcc.override", 2.0)
            await b.step(0.1)
            await b.set("drives.enable[1]", False)
            await b.step(1.0)
            assert await b.read(*read, last) == ["Aborted", 2, 0, "RunningToAborted"]
            alert = {
                "EventType": [(await b.client.ask("spaces"))["MachineTool"], 39],
                "SourceName": "mcc",
                "Message": "mcc: following error of axis 1",
                "Severity": 800,
                "Retain": True,
                "ErrorCode": "63489",
                "ActiveState/Id": True,
                "AckedState/Id": True,
            }
            await b.client.until([alert], "alerts", "server")
            await b.client.until([alert], "alerts", "messages")
            # Who comes later asks for what is active.
            await b.client.ask("subscribe", "late")
            await b.client.ask("refresh")
            await b.client.until([alert], "alerts", "late")

            await b.set("drives.enable[1]", True)
            await b.step(0.5)
            assert await b.read(*read) == ["Aborted", 2, 0]
            await b.set("mcc.clear_error", True)
            await b.step(0.2)
            gone = {**alert, "Retain": False, "ActiveState/Id": False}
            await b.client.until([alert, gone], "alerts", "server")
            assert await b.read(*read) == ["Initializing", 2, 0]

            await b.set("mcc.cycle_start", True)
            await b.step(0.5)
            assert await b.read(*read) == ["Running", 0, 0]
            await b.set("mcc.cycle_start", False)
            await b.step(2.5)
            assert await b.read(*read) == ["Interrupted", 1, 0]  # M0
            await b.set("mcc.cycle_start", True)
            await b.step(0.1)
            assert await b.read(*read) == ["Running", 0, 0]
            await b.step(1.0)
            assert await b.read(*read, last) == ["Ended", 2, 0, "RunningToEnded"]
            way = ["Initializing", "Running", "Interrupted", "Running"]
            await b.client.until([*way, "Aborted", *way, "Ended"], "changes")

    asyncio.run(work())


@pytest.mark.more
def test_nodes_are_those_of_the_specification(tmp_path: Path) -> None:
    async def work() -> None:
        async with bench(tmp_path) as b:
            assert await b.client.ask("missing", "own:part") == []
            spaces = await b.client.ask("spaces")
            assert await b.client.ask("type", "own:part") == [[spaces["MachineTool"], 13], None]
            mode = await b.client.ask("type", WHOLE + "MachineTool:OperationMode")
            assert mode == [[0, 63], [spaces["MachineTool"], 65]]
            assert await b.client.ask("base", "MachineTool", 39) == [
                *("AlertType", "AlarmConditionType", "AcknowledgeableConditionType"),
                *("ConditionType", "BaseEventType", "BaseObjectType"),
            ]
            identification = "own:part/DI:Identification/DI:"
            read = await b.read(*(identification + n for n in ("Manufacturer", "Model")))
            assert read == ["motionfmu (simulated machine)", "part"]
            override = CHANNEL + "MachineTool:FeedOverride/"
            told = await b.read(override + "EngineeringUnits", override + "EURange")
            assert told == [[20529, "%"], [0.0, 200.0]]  # of UNECE_to_OPCUA.csv
            units = await b.read(CHANNEL + "own:Position/EngineeringUnits")
            assert units == [[5066068, "mm"]]

    asyncio.run(work())


@pytest.mark.more
def test_states_of_the_machine(tmp_path: Path) -> None:
    item, mode = (
        f"{WHOLE}Machinery:{n}/CurrentState"
        for n in ("MachineryItemState", "MachineryOperationMode")
    )
    manual = WHOLE + "MachineTool:OperationMode"

    async def work() -> None:
        async with bench(tmp_path) as b:
            # While simulated time stands, nothing of it can be had.
            assert await b.read(item, mode, manual) == ["NotAvailable", "Processing", 1]
            await b.link.ask("pace", factor=0.01)
            await b.link.ask("go")
            await b.client.until(["NotExecuting"], "read", item)
            await b.link.ask("pause")
            await b.set("mcc.jog[2]", 1)
            await b.step(0.3)
            assert await b.read(mode, manual) == ["Setup", 0]
            await b.link.ask("go")
            await b.client.until(["Executing"], "read", item)
            await b.link.ask("pause")
            await b.set("mcc.jog[2]", 0)
            await b.set("card.io_stop", True)
            await b.step(0.4)
            await b.link.ask("go")
            await b.client.until(["OutOfService"], "read", item)
            assert await b.read(STATE) == ["Initializing"]

    asyncio.run(work())


@pytest.mark.more
def test_nothing_can_be_changed_from_there(tmp_path: Path) -> None:
    async def work() -> None:
        async with bench(tmp_path) as b:
            override = CHANNEL + "MachineTool:FeedOverride"
            assert await b.client.ask("write", override, 10.0) == "BadUserAccessDenied"
            assert await b.client.ask("add") == "BadUserAccessDenied"
            assert await b.read(override) == [100.0]
            assert (await b.link.ask("frame", names=["mcc.override"]))["values"] == {
                "mcc.override": [1.0]
            }

    asyncio.run(work())


@pytest.mark.more
def test_a_message_that_is_too_long_ends_its_connection(tmp_path: Path) -> None:
    async def closed(port: int, size: int) -> bool:
        """Whether the server ends a connection that has sent so much of a long message."""
        reader, writer = await asyncio.open_connection("127.0.0.1", port)
        writer.write(b"HELF" + (1 << 30).to_bytes(4, "little") + bytes(size - 8))
        try:
            await writer.drain()
            return await asyncio.wait_for(reader.read(1), 0.5) == b""
        except TimeoutError:
            return False
        except ConnectionError:
            return True
        finally:
            writer.close()

    async def work() -> None:
        async with server_of(tmp_path) as (_, port):
            assert not await closed(port, MESSAGE_MAX)
            assert await closed(port, MESSAGE_MAX + 1)
            async with client_of(port) as client:
                assert await client.ask("read", STATE) == ["Initializing"]

    asyncio.run(work())


# Scenario, simulated time [s], and the channel's and the program's states then.
OTHERS = [
    ("robot_line", 0.5, "soft", 0, "Running"),
    ("hydraulic_positioning", 0.3, "controller", 0, "Initializing"),  # it looks for its home switch
]


@pytest.mark.more
@pytest.mark.parametrize(("name", "time", "component", "state", "program"), OTHERS)
def test_other_machines(name: str, time: float, component: str, state: int, program: str) -> None:
    async def work() -> None:
        async with (
            MachineLink(MachineStart(name, running=False)) as link,
            OpcUaServer(link, 0) as port,
            client_of(port) as client,
        ):
            b = Bench(link, client)
            there = await link.ask("step", count=round(time / link.about["step"]))
            path = f"own:{name}/own:Simulation/own:Time"
            await client.until([pytest.approx(1e3 * there)], "read", path)
            channel = f"own:{name}/MachineTool:Monitoring/own:{component}/MachineTool:ChannelState"
            active = f"own:{name}/MachineTool:Production/MachineTool:ActiveProgram/"
            read = await b.read(channel, active + "MachineTool:State/CurrentState")
            assert read == [state, program]
            assert await client.ask("missing", f"own:{name}") == []

    asyncio.run(work())


def refused(link: Any, port: int = 0, folder: Path | None = None) -> str:
    async def work() -> None:
        async with OpcUaServer(link, port, folder):
            pass

    with pytest.raises(InputError) as found:
        asyncio.run(work())
    return str(found.value)


@pytest.mark.more
def test_a_port_that_is_taken(tmp_path: Path) -> None:
    async def work() -> None:
        with socket.create_server(("127.0.0.1", 0)) as taken:
            port = taken.getsockname()[1]
            async with MachineLink(MachineStart("circle", running=False)) as link:
                with pytest.raises(InputError, match=rf"^OPC UA 127\.0\.0\.1:{port}: Address alr"):
                    async with OpcUaServer(link, port):
                        pass

    asyncio.run(work())


def test_a_machine_without_a_controller_that_tells_its_state() -> None:
    about = {"name": "loose", "components": {"card": {"fmu": "epcio", "variables": {}}}}
    assert (
        refused(SimpleNamespace(about=about))
        == "OPC UA: no FMU of loose has a panel.toml with [monitor]"
    )


def test_what_the_command_needs(monkeypatch: pytest.MonkeyPatch) -> None:
    said = within("live", "circle", "--opcua-nodesets", "here").stderr
    assert "--opcua-nodesets goes with --opcua" in said
    found = extras.find_spec
    monkeypatch.setattr(extras, "find_spec", lambda n: None if n == "asyncua" else found(n))
    ended = within("live", "circle", "--opcua", "0")
    assert ended.returncode == 2
    assert ended.stderr.count("\n") == 1 and "an OPC UA server needs asyncua: pip" in ended.stderr


@pytest.mark.more
def test_the_command_tells_the_address_before_the_machine_begins() -> None:
    async def work() -> None:
        process = await asyncio.create_subprocess_exec(
            *(sys.executable, "-m", "motionfmu", "live", "circle", "--port", "0", "--opcua", "0"),
            stdout=subprocess.PIPE,
        )
        assert process.stdout is not None
        line = (await process.stdout.readline()).decode()
        found = re.fullmatch(r"OPC UA: opc\.tcp://127\.0\.0\.1:(\d+)/motionfmu\n", line)
        assert found, line
        async with client_of(int(found[1])) as client:
            path = "own:circle/MachineTool:Production/MachineTool:ActiveProgram/MachineTool:Name"
            assert await client.ask("read", path) == ["circle.ngc"]
        process.send_signal(2)
        assert await process.wait() == 130

    asyncio.run(work())
