"""The console command for a machine that runs while somebody works at it."""

import sys
from dataclasses import dataclass, replace
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

from motionfmu.base.errors import InputError
from motionfmu.base.extras import needed
from motionfmu.cli.common import FAILED, Set, app, out, setting, settings

if TYPE_CHECKING:
    from motionfmu.live.serving import MachineStart


@app.command()
def live(  # noqa: PLR0913  (each is an option of the command)
    path: Annotated[
        Path, typer.Argument(help="A scenario, or a machine: its folder, or a name of either.")
    ],
    program: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Program that the machine has.")
    ] = None,
    port: Annotated[int, typer.Option(help="Port of the page on 127.0.0.1; 0: any.")] = 8770,
    pace: Annotated[
        float, typer.Option(help="Simulated seconds for each on the wall: 0.01 to 100, or inf.")
    ] = 1.0,
    paused: Annotated[bool, typer.Option("--paused", help="Stand at first.")] = False,
    save_as: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Scenario of what was done, written when it ends."),
    ] = None,
    save_last: Annotated[
        float | None,
        typer.Option(metavar="SECONDS", help="Of a longer time, --save-as has the end only."),
    ] = None,
    grbl: Annotated[
        str | None,
        typer.Option(metavar="PORT|pty", help="Be a Grbl 1.1 for its senders, on 127.0.0.1."),
    ] = None,
    opcua: Annotated[
        int | None,
        typer.Option(metavar="PORT", help="OPC UA for Machine Tools on this port; 0: any."),
    ] = None,
    opcua_nodesets: Annotated[
        Path | None,
        typer.Option(metavar="FOLDER", help="Its published nodesets, instead of own types."),
    ] = None,
    exchange: Annotated[
        str | None,
        typer.Option(metavar="udp://HOST:PORT", help="Another program: see --send and --take."),
    ] = None,
    send: Annotated[
        list[str], typer.Option(metavar="SIGNAL", help="Goes to it: COMP.VAR or COMP.VAR[I].")
    ] = [],  # noqa: B006
    take: Annotated[
        list[str],
        typer.Option(metavar="INPUT=SAFE", help="Comes from it; SAFE while it is not heard."),
    ] = [],  # noqa: B006
    every: Annotated[int, typer.Option(help="Of so many communication steps one exchanges.")] = 1,
    watchdog: Annotated[
        float, typer.Option(help="Simulated time after which it counts as lost [s].")
    ] = 0.1,
    bind: Annotated[
        str, typer.Option(metavar="HOST:PORT", help="Where it sends to; port 0: any.")
    ] = "127.0.0.1:0",
    realtime: Annotated[
        bool, typer.Option("--realtime", help="Before this computer's other work: SCHED_FIFO.")
    ] = False,
    open_: Annotated[bool, typer.Option("--open", help="Open the page in the browser.")] = False,
    set_: Set = [],  # noqa: B006
) -> None:
    """Run a machine in real time with a page to work at it; until Ctrl-C."""
    import asyncio
    import math

    needed("live")
    if opcua is not None:
        needed("opcua")
    elif opcua_nodesets is not None:
        raise InputError("--opcua-nodesets goes with --opcua")
    from motionfmu.base.page_server import PORT_MAX

    if not 0 <= port <= PORT_MAX:
        raise InputError(f"--port {port}: 0 to {PORT_MAX} wanted")
    if save_last is not None and (save_as is None or not 0.0 < save_last < math.inf):
        raise InputError(f"--save-last {save_last:g}: seconds wanted, with --save-as FOLDER")
    from motionfmu.live.exchange import ExchangePlan
    from motionfmu.live.serving import MachineStart

    plan = None
    if exchange is None and (send or take):
        raise InputError("--send and --take go with --exchange udp://HOST:PORT")
    if exchange is not None:
        taken = {name: _number(name, value) for name, value in map(_pair, take)}
        plan = ExchangePlan(exchange, tuple(send), taken, every, watchdog, bind)
    start = MachineStart(
        str(path),
        None if program is None else str(program),
        settings(set_),
        None if pace == math.inf else pace,
        not paused,
        None if save_as is None else str(save_as),
        save_last,
        plan,
        realtime,
    )
    asyncio.run(_serve(start, _Ports(port, opcua, opcua_nodesets, grbl), open_))


@dataclass(frozen=True)
class _Ports:
    """Where the machine can be reached, on this computer."""

    page: int
    opcua: int | None
    nodesets: Path | None
    grbl: str | None


def _pair(text: str) -> tuple[str, Any]:
    if "=" not in text:
        raise InputError(f"--take {text}: INPUT=SAFE wanted, its value while nobody is heard")
    return setting(text)


def _number(name: str, value: Any) -> float:
    """The safe value of an input."""
    if isinstance(value, bool | int | float):
        return float(value)
    raise InputError(f"--take {name}={value}: a number, true or false wanted")


async def _serve(start: "MachineStart", ports: _Ports, opened: bool) -> None:
    import asyncio
    import secrets
    import webbrowser
    from contextlib import AsyncExitStack

    from motionfmu.base.page_server import PageServer
    from motionfmu.cli.card import on_end, stopped
    from motionfmu.live.serving import MESSAGE_MAX, GrblPort, MachineLink, application

    ended = asyncio.Event()
    came = on_end(ended.set)
    token = secrets.token_urlsafe(16)
    link = MachineLink(replace(start, running=False), _tell)
    # The port is taken before the machine begins: one that is in use is told at once.
    serving = PageServer(application(link, token), ports.page, message_max=MESSAGE_MAX)
    opening = None if ports.grbl is None else GrblPort(link, ports.grbl)
    async with AsyncExitStack() as stack:
        begins = asyncio.create_task(stack.enter_async_context(link))
        stops = asyncio.create_task(ended.wait())
        await asyncio.wait({begins, stops}, return_when=asyncio.FIRST_COMPLETED)
        if stops.done():
            begins.cancel()
            await asyncio.wait({begins})
        else:
            await begins
            if ports.opcua is not None:
                from motionfmu.live.opcua import OpcUaServer

                server = OpcUaServer(link, ports.opcua, ports.nodesets)
                there = await stack.enter_async_context(server)
                out.print(f"OPC UA: opc.tcp://127.0.0.1:{there}/motionfmu", soft_wrap=True)
            there = await stack.enter_async_context(serving)
            address = f"http://127.0.0.1:{there}/?token={token}"
            out.print(f"page: {address}", soft_wrap=True)
            if opening is not None:
                await stack.enter_async_context(opening)
                out.print(f"grbl: {opening.address}", soft_wrap=True)
            if start.running:  # who looks at it is there now
                await link.ask("go")
            if opened:
                webbrowser.open(address)
            ends = asyncio.create_task(link.ended.wait())
            await asyncio.wait({stops, ends}, return_when=asyncio.FIRST_COMPLETED)
    if not came:
        print(f"motionfmu: {link.why}", file=sys.stderr)
        raise typer.Exit(FAILED)
    stopped(came)


def _tell(message: dict[str, Any], data: bytes) -> None:
    """Say on the console what the machine's process says by itself."""
    import contextlib

    word = message["told"]
    if word == "compiling":
        text = f"{message['name']}: its program is compiled, once; this takes some seconds"
    elif word == "saved":
        text = f"saved: {message['file']}"
    elif word == "exchange":
        text = f"exchange: {message['peer']} sends to port {message['port']}"
    elif word == "peer":
        text = f"exchange: {message['peer']} is {'lost' if message['lost'] else 'heard'}"
    else:
        return
    with contextlib.suppress(OSError):  # the terminal is gone
        print(text, flush=True)
