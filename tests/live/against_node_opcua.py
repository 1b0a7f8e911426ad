"""Let node-opcua, a client that is not ours, read a live machine over a program with an alarm.

    PYTHONPATH=tests/helpers python tests/live/against_node_opcua.py

npm installs it into build/node_opcua. What it read is printed; ends with an error if it is not what
the machine did.
"""

import asyncio
import json
import subprocess
import tempfile
from pathlib import Path
from typing import Any

from opcua_bench import PATIENCE, server_of

ROOT = Path(__file__).resolve().parents[2]
PLACE = ROOT / "build/node_opcua"
READER = Path(__file__).with_name("node_opcua_reader.mjs")
VERSION = "2.186.4"


async def _told(process: asyncio.subprocess.Process) -> Any:
    assert process.stdout is not None
    while not (line := await asyncio.wait_for(process.stdout.readline(), PATIENCE)).startswith(
        b"{"
    ):
        assert line, "the reader has ended"  # node-opcua says which certificates it makes
    return json.loads(line)


async def _read(folder: Path) -> None:
    async with server_of(folder) as (link, port):
        process = await asyncio.create_subprocess_exec(
            *("node", str(READER), f"opc.tcp://127.0.0.1:{port}/motionfmu"),
            cwd=PLACE,
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        )
        first = await _told(process)
        print(json.dumps(first["tree"], indent=1))
        assert first["tree"]["Production"]["ActiveProgram"]["Name"] == "part.ngc"
        states: list[str] = []
        alerts: list[list[Any]] = []

        async def until(states_wanted: list[str], alerts_wanted: int) -> None:
            while states != states_wanted or len(alerts) != alerts_wanted:
                told = await _told(process)
                states.extend([told["state"]] if "state" in told else [])
                alerts.extend([told["alert"]] if "alert" in told else [])

        async def act(seconds: float, **values: Any) -> None:
            for name, value in values.items():
                await link.ask("set", name=name.replace("__", "."), value=value)
            await link.ask("step", count=round(seconds / link.about["step"]))

        way = ["Initializing"]
        await until(way, 0)
        await act(1.0)
        await until(way := [*way, "Running"], 0)
        await act(0.3, mcc__hold=True)
        await until(way := [*way, "Interrupted"], 0)
        await act(0.3, mcc__hold=False)
        await until(way := [*way, "Running"], 0)
        await act(1.0, drives__enable=[False] * 6)
        await until(way := [*way, "Aborted"], 1)
        await act(0.5, drives__enable=[True] * 6)
        await act(0.2, mcc__clear_error=True)
        await until(way := [*way, "Initializing"], 2)
        print("program:", *states)
        print("alerts:", *alerts, sep="\n  ")
        assert [a[1:] for a in alerts] == [
            ["mcc", "mcc: following error of axis 1", 800, True, "63489"],
            ["mcc", "mcc: following error of axis 1", 800, False, "63489"],
        ]
        assert process.stdin is not None
        process.stdin.close()
        assert await process.wait() == 0


def main() -> None:
    """Install the client, if it is not there, and let it read."""
    PLACE.mkdir(parents=True, exist_ok=True)
    if not (PLACE / "node_modules/node-opcua-client").is_dir():
        command = ["npm", "install", "--no-save", f"node-opcua-client@{VERSION}"]
        subprocess.run(command, cwd=PLACE, check=True)
    with tempfile.TemporaryDirectory() as folder:
        asyncio.run(_read(Path(folder)))


if __name__ == "__main__":
    main()
