"""A live machine in a process of its own, so that nothing but its own work delays its clock.

Requests come on stdin and answers go to stdout: a head of two lengths, JSON, bytes. When stdin ends
the process saves what it was told to save, and ends.
"""

import contextlib
import json
import math
import os
import struct
import sys
import threading
from pathlib import Path
from queue import SimpleQueue
from typing import Any, BinaryIO

from motionfmu.base.errors import InputError
from motionfmu.base.toml_lines import is_file
from motionfmu.live.exchange import Exchange, ExchangePlan
from motionfmu.live.live_machine import LiveMachine
from motionfmu.live.machine_about import about
from motionfmu.live.machine_loop import LoopRequest, MachineLoop
from motionfmu.live.pace import Pace
from motionfmu.run.machine_program import machine_of, machine_scenario
from motionfmu.run.runner import Scenario

HEAD = struct.Struct("<II")  # bytes of JSON, bytes behind it
# [s] A thread that sends an answer may have the interpreter for so long while the clock waits.
_SWITCH = 5e-4
# Of a machine that runs before others: 1 to 99 there are, interrupts of the kernel have 50.
_PRIORITY = 49
# [s] within which a program that was made before is there.
_SOON = 1.5
_Message = tuple[dict[str, Any], bytes]


def packed(message: dict[str, Any], data: bytes = b"") -> bytes:
    """A message as it goes over a pipe."""
    text = json.dumps(message).encode()
    return HEAD.pack(len(text), len(data)) + text + data


def _whole(stream: BinaryIO, size: int) -> bytes | None:
    data = stream.read(size)
    return data if len(data) == size else None


def _received(stream: BinaryIO) -> _Message | None:
    head = _whole(stream, HEAD.size)
    if head is None:
        return None
    size, more = HEAD.unpack(head)
    text, data = _whole(stream, size), _whole(stream, more)
    return None if text is None or data is None else (json.loads(text), data)


class _Answers:
    """A thread that sends, so that a full pipe delays no step."""

    def __init__(self, stream: BinaryIO) -> None:
        self._stream = stream
        self._queue: SimpleQueue[bytes | None] = SimpleQueue()
        self._thread = threading.Thread(target=self._send, daemon=True)
        self._thread.start()

    def put(self, message: dict[str, Any], data: bytes = b"") -> None:
        self._queue.put(packed(message, data))

    def end(self) -> None:
        self._queue.put(None)
        self._thread.join(2.0)

    def _send(self) -> None:
        with contextlib.suppress(OSError, ValueError):
            while (data := self._queue.get()) is not None:
                self._stream.write(data)
                self._stream.flush()


def main() -> None:
    """Serve the machine that the first message names."""
    sys.setswitchinterval(_SWITCH)
    requests, out = sys.stdin.buffer, sys.stdout.buffer
    sys.stdout = sys.stderr
    first = _received(requests)
    if first is None:
        return
    told = before_others() if first[0]["realtime"] else ""
    answers = _Answers(out)  # a thread is scheduled as who began it
    try:
        if told:
            raise InputError(f"--realtime: {told}")
        _serve(first[0], requests, answers)
    except InputError as error:
        answers.put({"error": str(error)})
    answers.end()


def before_others() -> str:
    """Have this process run before all that have no such right; why not, if it may not."""
    if sys.platform != "linux":
        return "this system has no SCHED_FIFO"
    try:
        os.sched_setscheduler(0, os.SCHED_FIFO, os.sched_param(_PRIORITY))
    except OSError as error:
        return (
            f"{os.strerror(error.errno or 0)}: it takes root, or a line"
            f" `@realtime - rtprio {_PRIORITY}` in /etc/security/limits.conf for a group you are in"
        )
    return ""


def _serve(start: dict[str, Any], requests: BinaryIO, answers: _Answers) -> None:
    factor = start["pace"]
    pace = Pace()
    try:
        pace.set(math.inf if factor is None else factor)
    except ValueError as error:
        raise InputError(str(error)) from None
    save_as = start["save_as"]
    if save_as is not None and os.path.lexists(save_as):
        raise InputError(f"{save_as} is there already")
    scenario = _scenario(start["path"], start["program"])
    late = threading.Timer(_SOON, answers.put, ({"told": "compiling", "name": scenario.name},))
    late.start()
    try:
        machine = LiveMachine(scenario, start["set"])
    finally:
        late.cancel()
    with machine:
        plan, exchange = start["exchange"], None
        if plan is not None:
            exchange = Exchange(machine, ExchangePlan(**plan))
            answers.put({"told": "exchange", "port": exchange.port, "peer": plan["peer"]})
        loop = MachineLoop(machine, pace, start["running"], exchange=exchange, tell=answers.put)
        answers.put({"about": about(machine)})
        threading.Thread(target=_listen, args=(requests, loop, answers), daemon=True).start()
        loop.run()
        if save_as is not None and machine.steps:
            answers.put(
                {"told": "saved", "file": str(_saved(machine, save_as, start["save_last"]))}
            )


def _scenario(path: str, program: str | None) -> Scenario:
    """What is to be run, with a program; an operator starts it where a run would do so."""
    if program is None:
        return machine_scenario(path)
    machine = machine_of(path)
    if machine is not None:
        return machine.scenario(program, drive=[])
    scenario = machine_scenario(path)
    name = scenario.document.body.signals.program
    if name is None:
        raise InputError(f"{path}: its machine takes no program")
    if not is_file(Path(program)):
        raise InputError(f"{program}: no such program")
    return scenario.changed(set={name: str(Path(program).absolute())})


def _saved(machine: LiveMachine, folder: str, last: float | None) -> Path:
    """Save what was done, or the last seconds; beside a folder that has come there meanwhile."""
    kept = machine.kept
    begin = None if last is None else machine.time - last
    if begin is not None and (not kept or begin < kept[0]):
        begin = None
    place, more = Path(folder), 1
    while os.path.lexists(place):
        more += 1
        place = Path(f"{folder}-{more}")
    return machine.save(place, begin=begin)


def _listen(requests: BinaryIO, loop: MachineLoop, answers: _Answers) -> None:
    while (got := _received(requests)) is not None:
        asked, _ = got
        loop.asked.put(_request(asked, answers))
    loop.asked.put(LoopRequest("end", {}, lambda value, error: None))


def _request(asked: dict[str, Any], answers: _Answers) -> LoopRequest:
    def answer(value: Any, error: str | None) -> None:
        data = b""
        if isinstance(value, tuple):
            value, data = value
        answers.put({"id": asked["id"], "value": value, "error": error}, data)

    return LoopRequest(asked["name"], asked["arguments"], answer)
