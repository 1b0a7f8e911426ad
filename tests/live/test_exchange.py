"""A live machine and another program that exchange signals by UDP."""

import math
import shutil
import socket
import struct
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import numpy as np
import pytest

from motionfmu import run
from motionfmu.base.errors import InputError
from motionfmu.live import LiveMachine
from motionfmu.live.exchange import HEAD, LOST, MAGIC, Exchange, ExchangePlan

ROOT = Path(__file__).resolve().parents[2]
SEND = ["machine.table_position[1]", "machine.table_speed[1]"]
TAKE = {"machine.force[1]": 0.0, "mcc.hold": 1.0, "mcc.digital_in": 3.0}


@pytest.fixture
def mill() -> Iterator[LiveMachine]:
    with LiveMachine(run.scenario({"machine": "mill3", "stop": 1.0}, name="mill")) as machine:
        yield machine


class Peer:
    """The other side, step by step."""

    def __init__(self) -> None:
        self.link = socket.socket(socket.AF_INET, socket.SOCK_DGRAM)
        self.link.bind(("127.0.0.1", 0))
        self.link.settimeout(5.0)
        self.number = 0

    @property
    def url(self) -> str:
        return f"udp://127.0.0.1:{self.link.getsockname()[1]}"

    def hear(self) -> tuple[int, int, int, int, tuple[float, ...]]:
        magic, number, heard, time, flags, count = HEAD.unpack_from(data := self.link.recv(4096))
        assert magic == MAGIC and len(data) == HEAD.size + 8 * count
        return number, heard, time, flags, struct.unpack_from(f"<{count}d", data, HEAD.size)

    def say(
        self, port: int, *values: float, number: int | None = None, magic: bytes = MAGIC
    ) -> None:
        self.number = self.number + 1 if number is None else number
        head = HEAD.pack(magic, self.number, 0, 0, 0, len(values))
        self.link.sendto(head + struct.pack(f"<{len(values)}d", *values), ("127.0.0.1", port))


@pytest.fixture
def peer() -> Iterator[Peer]:
    made = Peer()
    yield made
    made.link.close()


def step(exchange: Exchange, machine: LiveMachine, count: int = 1) -> None:
    for _ in range(count):
        exchange.step()
        machine.step()


def test_what_is_sent_is_what_the_machine_has_and_what_comes_acts(
    mill: LiveMachine, peer: Peer
) -> None:
    exchange = Exchange(mill, ExchangePlan(peer.url, SEND, TAKE))
    assert mill["mcc.hold"] and mill["mcc.digital_in"] == 3  # safe until it is heard
    for k in range(50):
        there = [mill["machine.table_position"][0], mill["machine.table_speed"][0]]
        step(exchange, mill)
        number, heard, time, flags, values = peer.hear()
        assert (number, heard, time) == (k + 1, k, k * 100_000)
        assert (flags == LOST) == (k == 0)
        assert list(values) == there
        peer.say(exchange.port, 10.0 * k, k % 2, k)
    assert mill["machine.force"][0] == 480.0 and mill["machine.force"][2] == -883.0
    assert not mill["mcc.hold"] and mill["mcc.digital_in"] == 48
    assert vars(exchange.counts) == {"sent": 50, "taken": 49, "late": 0, "wrong": 0, "lost": 0}
    exchange.close()


def test_a_peer_that_falls_silent_is_lost_after_the_watchdog_and_may_begin_anew(
    mill: LiveMachine, peer: Peer
) -> None:
    exchange = Exchange(mill, ExchangePlan(peer.url, SEND, TAKE, watchdog=0.005))
    peer.say(exchange.port, 700.0, 0.0, 9.0)
    step(exchange, mill, 51)
    assert mill["machine.force"][0] == 700.0 and not exchange.lost
    step(exchange, mill)
    assert exchange.lost and exchange.counts.lost == 1
    assert mill["machine.force"][0] == 0.0 and mill["mcc.hold"] and mill["mcc.digital_in"] == 3
    peer.number = 0
    peer.say(exchange.port, 1.0, 0.0, 0.0)  # number 1 again
    step(exchange, mill)
    assert not exchange.lost and mill["machine.force"][0] == 1.0
    exchange.close()


def test_only_whole_new_datagrams_are_taken(mill: LiveMachine, peer: Peer) -> None:
    exchange = Exchange(mill, ExchangePlan(peer.url, SEND, TAKE))
    peer.say(exchange.port, 5.0, 0.0, 1.0, number=10)
    step(exchange, mill)
    for values, number, magic in (
        ((6.0, 0.0, 1.0), 10, MAGIC),  # repeated
        ((6.0, 0.0, 1.0), 9, MAGIC),  # overtaken
        ((6.0, 0.0), 11, MAGIC),
        ((6.0, 0.0, 1.0, 1.0), 11, MAGIC),
        ((math.nan, 0.0, 1.0), 11, MAGIC),
        ((6.0, 0.0, 1.0), 11, b"MFX2"),
    ):
        peer.say(exchange.port, *values, number=number, magic=magic)
    for data in (b"", b"x", bytes(2048), bytes(4000)):
        peer.link.sendto(data, ("127.0.0.1", exchange.port))
    step(exchange, mill)
    assert mill["machine.force"][0] == 5.0
    assert (exchange.counts.late, exchange.counts.wrong) == (2, 8)
    # A value beyond an input's range leaves that input alone, the others are set.
    peer.say(exchange.port, 7.0, 1.0, 1e30, number=12)
    step(exchange, mill)
    assert mill["machine.force"][0] == 7.0 and mill["mcc.digital_in"] == 1
    assert exchange.counts.wrong == 9
    # The latest of several counts; its number may have passed 2^32.
    peer.say(exchange.port, 8.0, 0.0, 1.0, number=2**31 + 11)
    step(exchange, mill)
    peer.say(exchange.port, 8.0, 0.0, 1.0, number=2**32 - 1)
    peer.say(exchange.port, 9.0, 0.0, 1.0, number=3)
    step(exchange, mill)
    assert mill["machine.force"][0] == 9.0
    exchange.close()


def test_what_came_by_the_wire_is_a_scenario_with_the_same_bits(
    mill: LiveMachine, peer: Peer, tmp_path: Path
) -> None:
    exchange = Exchange(mill, ExchangePlan(peer.url, SEND, {"machine.force[1]": 0.0}, every=3))
    rows = []
    for k in range(300):
        if k % 3 == 0:
            exchange.step()
            position, speed = peer.hear()[4]
            peer.say(exchange.port, 300.0 - 1e7 * position - 1e4 * speed)
        rows.append(mill.trace(["machine.table_position"], 1)["machine.table_position"][0])
    scenario = run.load(mill.save(tmp_path / "wire"))
    exchange.close()
    record = {"every": 1, "signals": ["machine.table_position"]}
    found = scenario.changed(record=record).run()["machine.table_position"]
    assert np.ptp(found[:, 0]) > 1e-7
    assert (found == np.array(rows)).all()


@pytest.mark.parametrize(
    ("plan", "said"),
    [
        ({"peer": "tcp://127.0.0.1:9"}, "tcp://127.0.0.1:9: udp://HOST:PORT wanted"),
        ({"peer": "udp://127.0.0.1"}, "udp://HOST:PORT wanted"),
        ({"peer": "udp://127.0.0.1:99999"}, "udp://HOST:PORT wanted"),
        ({"send": ["machine.table_position"]}, r"it has the elements machine.table_position\[1\]"),
        ({"send": ["machine.tabel"]}, "machine.tabel: no such signal"),
        ({"take": {"mcc.override": 3.0}}, "mcc.override"),
        ({"take": {"machine.table_speed[1]": 0.0}}, "is an output"),
        ({"every": 0}, "every 0 steps"),
        ({"watchdog": math.inf}, "watchdog inf s"),
        ({"bind": "127.0.0.1"}, "HOST:PORT wanted"),
        ({"bind": "192.0.2.1:1"}, "192.0.2.1:1: "),
        ({"send": ["mcc.path_feed"] * 181}, "180 values"),
    ],
)
def test_a_wrong_plan_has_one_message(
    mill: LiveMachine, plan: dict[str, object], said: str
) -> None:
    with pytest.raises(InputError, match=said):
        Exchange(mill, ExchangePlan(**{"peer": "udp://127.0.0.1:9", **plan}))  # type: ignore[arg-type]


@pytest.mark.more
def test_the_command_says_what_is_wrong_with_an_exchange() -> None:
    url = ["--exchange", "udp://127.0.0.1:9"]
    for given, said in (
        (["--take", "mcc.hold=1"], "--send and --take go with --exchange udp://HOST:PORT"),
        ([*url, "--take", "mcc.hold=no"], "--take mcc.hold=no: a number, true or false wanted"),
        ([*url, "--take", "mcc.hold"], "--take mcc.hold: INPUT=SAFE wanted"),
        ([*url, "--take", "mcc.hlod=1"], "mcc.hlod: no such signal"),
    ):
        command = [sys.executable, "-m", "motionfmu", "live", "mill3", "--port", "0", *given]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        assert done.returncode == 2 and said in done.stderr, done.stderr


@pytest.mark.parametrize("peer_of", ["peer.c", "peer.py"])
def test_a_spring_in_another_process_pulls_the_table_back(
    mill: LiveMachine, tmp_path: Path, peer_of: str
) -> None:
    """With a spring of 1e5 N/m the table stands where force and servo are in balance."""
    source, port = ROOT / "examples/exchange" / peer_of, free_port()
    command = [sys.executable, str(source)]
    if source.suffix == ".c":
        compiler = shutil.which("cc") or shutil.which("gcc")
        assert compiler
        command = [str(tmp_path / "peer")]
        subprocess.run([compiler, "-O2", "-Wall", "-Werror", "-o", *command, source], check=True)
    plan = ExchangePlan(f"udp://127.0.0.1:{port}", SEND, {"machine.force[1]": 0.0}, watchdog=1e6)
    mill.set("mcc.jog[1]", 1)
    mill.step(5000)
    mill.set("mcc.jog[1]", 0)
    mill.step(5000)
    exchange = Exchange(mill, plan)
    other = subprocess.Popen([*command, str(port), "127.0.0.1", str(exchange.port), "60"])
    try:
        for _ in range(60_000):  # a minute, if nobody answers
            step(exchange, mill)
            if exchange.counts.taken > 200:
                break
            time.sleep(1e-3)
        position = mill["machine.table_position"][0]
        assert exchange.counts.taken > 200, exchange.counts
        assert mill["machine.force"][0] == pytest.approx(-1e5 * position, rel=0.05)
        assert position > 0.02
    finally:
        other.kill()
        other.wait()
        exchange.close()


def free_port() -> int:
    with socket.socket(socket.AF_INET, socket.SOCK_DGRAM) as link:
        link.bind(("127.0.0.1", 0))
        return int(link.getsockname()[1])
