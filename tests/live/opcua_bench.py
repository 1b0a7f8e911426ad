"""A live machine that stands, its OPC UA server, and a client in a process of its own."""

import asyncio
import contextlib
import json
import subprocess
import sys
from collections.abc import AsyncIterator
from pathlib import Path
from typing import Any

import pytest

from motionfmu.live.opcua import OpcUaServer
from motionfmu.live.serving import MachineLink, MachineStart

READER = Path(__file__).with_name("ua_reader.py")
# Straight lines at 50 mm/s, with a stop (M0) before the last one.
PROGRAM = "G21 G90 F3000\nG1 X120\nG1 Y20\nM0\nG1 Y10\nM2\n"
SCENARIO = """# A mill with a program.
machine = "mill3"
stop = 10.0

[set]
"mcc.program" = "part.ngc"
"mcc.start_delay" = 0.5
"""
TOOL = "own:part/MachineTool:"
CHANNEL = TOOL + "Monitoring/own:mcc/"
WHOLE = TOOL + "Monitoring/MachineTool:MachineTool/"
ACTIVE = TOOL + "Production/MachineTool:ActiveProgram/"
STATE = ACTIVE + "MachineTool:State/CurrentState"
TIME = "own:part/own:Simulation/own:Time"
PATIENCE = 300.0  # [s] on the wall, for what comes at once on a machine that is not busy


class Client:
    """The client's process."""

    def __init__(self, process: asyncio.subprocess.Process) -> None:
        self._process = process

    async def ask(self, *request: Any) -> Any:
        assert self._process.stdin and self._process.stdout
        self._process.stdin.write(json.dumps(request).encode() + b"\n")
        line = await asyncio.wait_for(self._process.stdout.readline(), PATIENCE)
        return json.loads(line)

    async def until(self, wanted: Any, *request: Any) -> None:
        """Ask until the answer is what is wanted."""
        found = None
        with contextlib.suppress(TimeoutError):
            async with asyncio.timeout(PATIENCE):
                while (found := await self.ask(*request)) != wanted:
                    await asyncio.sleep(0.02)
        assert found == wanted, request


class Bench:
    """A machine that stands, its server, and a client."""

    def __init__(self, link: MachineLink, client: Client) -> None:
        self.link, self.client = link, client

    async def step(self, seconds: float) -> None:
        """Let simulated time pass, and the client see its end."""
        time = await self.link.ask("step", count=round(seconds / self.link.about["step"]))
        await self.client.until([pytest.approx(1e3 * time)], "read", TIME)

    async def set(self, name: str, value: Any) -> None:
        await self.link.ask("set", name=name, value=value)

    async def read(self, *paths: str) -> list[Any]:
        found: list[Any] = await self.client.ask("read", *paths)
        return found


@contextlib.asynccontextmanager
async def client_of(port: int) -> AsyncIterator[Client]:
    process = await asyncio.create_subprocess_exec(
        *(sys.executable, str(READER), f"opc.tcp://127.0.0.1:{port}/motionfmu"),
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
    )
    try:
        yield Client(process)
    finally:
        assert process.stdin is not None
        process.stdin.close()
        try:
            await asyncio.wait_for(process.wait(), PATIENCE)
        except TimeoutError:
            process.kill()
            raise


@contextlib.asynccontextmanager
async def server_of(
    folder: Path, nodesets: Path | None = None
) -> AsyncIterator[tuple[MachineLink, int]]:
    """The mill with its program, and the port of its server."""
    place = folder / "part"
    place.mkdir()
    (place / "scenario.toml").write_text(SCENARIO)
    (place / "part.ngc").write_text(PROGRAM)
    async with (
        MachineLink(MachineStart(str(place), running=False)) as link,
        OpcUaServer(link, 0, nodesets) as port,
    ):
        yield link, port


@contextlib.asynccontextmanager
async def bench(folder: Path, nodesets: Path | None = None) -> AsyncIterator[Bench]:
    """The same with a client."""
    async with server_of(folder, nodesets) as (link, port), client_of(port) as client:
        yield Bench(link, client)
