"""The card as a program: its own C code behind links that cut, and against its FMU."""

import asyncio
import hashlib
import random
import signal
import struct
import sys
import tomllib
from pathlib import Path

import numpy as np
import pytest
from card_links import HOST, bench, run, until
from conftest import ROOT
from fmi_tools import OK, Instance

from motionfmu.base.binding import library
from motionfmu.base.errors import InputError
from motionfmu.cards import messages as m
from motionfmu.cards.card_job import Job, encode
from motionfmu.cards.keys import new_key
from motionfmu.cards.sim import FLASH_BYTES, FlashFile, VirtualNetCard, simulate
from motionfmu.cards.transfer import JobFile, Transfer
from motionfmu.cards.views import Code
from motionfmu.cards.wire import OPEN_KEY, PcEnd
from motionfmu.cli.card_sim import sim

KEY = bytes(range(32))
MS = 1_000_000  # [ns]


def smooth(frames: int, way: int = 6000) -> np.ndarray:
    """Commands of two axes from rest to rest, opposite to each other."""
    share = np.linspace(0, 1, frames + 1)
    place = np.round(way * (share - np.sin(2 * np.pi * share) / (2 * np.pi))).astype(int)
    found = np.zeros((frames, 4), int)
    found[:, 0], found[:, 1] = np.diff(place), -np.diff(place)
    return found


def job_of(frames: int = 600) -> bytes:
    """A job of the card."""
    four = ((1_000_000,) * 4, (60_000,) * 4, (1_000_000,) * 4, (100_000_000,) * 4)
    return encode(Job(MS, 3, smooth(frames), np.zeros(frames, int), [], *four))


class Pc:
    """The PC's end for one job and commands, as bytes."""

    def __init__(self, job: bytes, key: bytes = OPEN_KEY) -> None:
        self.file, self.key = JobFile(job), key
        self.sent = 0  # pages
        self.results: list[m.ResultMessage] = []
        self.told: list[m.Message] = []
        self.open()

    def open(self) -> None:
        """A new connection."""
        self.end, self.out = PcEnd(lambda _: self.key, 20), b""
        self.transfer: Transfer | None = None

    def hear(self, data: bytes) -> None:
        """Bytes of the card."""
        for _, _, message in self.end.feed(data):
            if isinstance(message, m.Ping):
                self.end.send(m.Pong(message.token))
            elif isinstance(message, m.ResultMessage):
                self.results.append(message)
            elif isinstance(message, m.Config):
                self.told.append(message)
            elif isinstance(message, m.Ack) and self.transfer:
                self.transfer.ack(message)
            elif isinstance(message, m.Nak) and self.transfer:
                self.transfer.nak(message)
        if self.end.ready and self.transfer is None:
            self.transfer = Transfer(self.file, self.end.send)
        if self.transfer:
            before = self.transfer.sent
            self.transfer.pump(8)
            self.sent += self.transfer.sent - before

    @property
    def there(self) -> bool:
        """Whether the job is in the card."""
        return bool(self.transfer and self.transfer.code == 0)

    def more(self, room: int) -> bytes:
        """Bytes for the card."""
        self.out += self.end.take()
        now, self.out = self.out[:room], self.out[room:]
        return now


def exchange(card: VirtualNetCard, pc: Pc, room: int = 512) -> None:
    """Carry bytes both ways."""
    data = pc.more(room)
    taken = card.receive(data)
    pc.out = data[taken:] + pc.out
    pc.hear(card.send())


def bring(card: VirtualNetCard, pc: Pc, chance: random.Random | None = None) -> int:
    """Bring the job, with a cut now and then; returns how many there were."""
    cuts, up = 0, False
    for _ in range(60_000):
        if pc.there:
            return cuts
        if not up and card.wants:
            pc.open()
            card.connected(True)
            up = True
        elif up and (not card.wants or (chance and chance.random() < 0.04)):
            card.connected(False)
            up = False
            cuts += 1
        elif up:
            exchange(card, pc, chance.randint(1, 2000) if chance else 2000)
        card.run(card.now + MS)
    raise AssertionError("the job did not arrive")


def begin(card: VirtualNetCard, pc: Pc, command: m.Message) -> m.ResultMessage:
    """Send a command and wait for its result."""
    pc.end.send(command)
    before = len(pc.results)
    while len(pc.results) == before:
        exchange(card, pc)
        card.run(card.now + MS // 10)
    return pc.results[-1]


def slot(card: VirtualNetCard, k: int, size: int) -> bytes:
    """First bytes of a slot of the flash."""
    return card.flash[k * 256 * 4096 :][:size]


@pytest.mark.parametrize("key", [OPEN_KEY, KEY], ids=["open", "key"])
def test_over_a_link_that_cuts_each_page_is_sent_and_written_once(key: bytes) -> None:
    job = job_of(9000)
    straight, cut = VirtualNetCard(5, key), VirtualNetCard(5, key)
    first, second = Pc(job, key), Pc(job, key)
    assert bring(straight, first) == 0
    cuts = bring(cut, second, random.Random(3))
    assert cuts >= 3
    assert slot(straight, 0, len(job)) == slot(cut, 0, len(job)) == job
    for name in ("programs", "sector_erases", "block_erases"):
        assert straight[name] == cut[name], name
    assert first.sent == len(job) // 256 <= second.sent <= first.sent + 32 * cuts


def test_the_pulses_are_the_jobs_whatever_pauses_came_between() -> None:
    card, pc = VirtualNetCard(5), Pc(job_of())
    bring(card, pc)
    chance, number = random.Random(1), 1
    assert begin(card, pc, m.Start(number)).code == 0
    while card.state != m.State.READY:
        card.run(card.now + chance.randint(1, 120) * MS)
        number += 1
        paused = card.state == m.State.PAUSED
        begin(card, pc, (m.Start if paused else m.Pause)(number))
        assert card.pulses[0] == -card.pulses[1]
    assert number > 6
    assert card.pulses == [6000, -6000, 0, 0]
    assert begin(card, pc, m.Start(number)).code == pc.results[-1].code
    assert card["repeats"] == 1


def test_settings_are_told_and_changed_where_they_may() -> None:
    parameters = tomllib.loads((ROOT / "fmus/network_card/fmu.toml").read_text())["parameter"]
    names = [name for name in parameters if name not in ("bus_period", "job", "key")]
    card, pc = VirtualNetCard(5), Pc(job_of())
    bring(card, pc)

    def asked(name: str, index: int = 0) -> int:
        """A setting, as the card tells it."""
        before = len(pc.told)
        pc.end.send(m.ConfigGet(names.index(name), index))
        while len(pc.told) == before:
            exchange(card, pc)
            card.run(card.now + MS // 10)
        found = pc.told[-1]
        assert isinstance(found, m.Config)
        assert (found.id, found.index) == (names.index(name), index)
        return found.value

    for name in names:
        if parameters[name]["type"] != "f64" and name != "card_id":
            assert asked(name) == parameters[name]["start"], name
    for number, (name, index, value, code) in enumerate(
        [
            ("acc_max", 3, 777, Code.DONE),
            ("acc_max", 4, 777, Code.RANGE),
            ("position_low", 1, -5, Code.DONE),
            ("fifo_depth", 0, 15, Code.RANGE),
            ("period_ns", 0, 1_000_010, Code.RANGE),
        ],
        1,
    ):
        set_to = m.ConfigSet(number, names.index(name), index, value)
        assert begin(card, pc, set_to).code == code, name
    assert (asked("acc_max", 3), asked("position_low", 1)) == (777, -5)
    assert (asked("fifo_depth"), asked("period_ns")) == (512, MS)
    assert begin(card, pc, m.Start(6)).code == Code.DONE
    assert begin(card, pc, m.ConfigSet(7, names.index("acc_max"), 0, 5)).code == Code.BUSY
    assert asked("acc_max") == parameters["acc_max"]["start"]


def test_a_command_before_the_power_went_is_not_known_behind_it() -> None:
    card, pc = VirtualNetCard(5), Pc(job_of())
    bring(card, pc)
    assert begin(card, pc, m.Start(7)).code == 0
    before = pc.end.hello
    card.power_cycle()
    pc.open()
    while not pc.end.ready:
        if card.wants and not card["connections"]:
            card.connected(True)
        exchange(card, pc)
        card.run(card.now + MS)
    assert before and pc.end.hello
    assert pc.end.hello.done == 0 and pc.end.hello.life != before.life
    assert pc.end.hello.job == hashlib.sha256(job_of()).digest()


class Ring:
    """The PC's side of the wires of the FMU: 512 bytes in 128 words."""

    def __init__(self, fmu: Instance, pc: Pc) -> None:
        self.fmu, self.pc = fmu, pc
        self.words = bytearray(512)
        self.count = self.taken = 0

    def instant(self) -> int:
        """What the wires carry at an instant; returns how many bytes went to the card."""
        (count,), (rx_taken,) = self.fmu.get("tx_count"), self.fmu.get("rx_taken")
        shown = struct.pack("<128i", *self.fmu.get("tx_words"))
        self.pc.hear(bytes(shown[i % 512] for i in range(self.taken, count)))
        self.taken = count
        data = self.pc.more(512 - (self.count - rx_taken))
        for byte in data:
            self.words[self.count % 512] = byte
            self.count += 1
        self.fmu.set("rx_words", list(struct.unpack("<128i", self.words)))
        self.fmu.set("rx_count", self.count)
        self.fmu.set("tx_taken", self.taken)
        return len(data)


def test_program_and_fmu_put_out_the_same_pulses_at_the_same_time() -> None:
    """The same bytes at the same instants; what differs is random, and has no length."""
    job, step = job_of(300), MS // 2
    fmu = Instance("network_card", 3).initialize({"bus_period": step * 1e-9, "card_id": 5})
    card = VirtualNetCard(5)
    ours, theirs = Pc(job), Pc(job)
    ring = Ring(fmu, theirs)
    assert fmu.get("connect") == [True] and card.wants
    started, moved, heard, held = 0, 0, b"", b""
    for k in range(6000):
        ring.instant()
        ours.hear(heard)
        if k == 0:
            fmu.set("connection", 1)
            card.connected(True)
        held += ours.more(512 - len(held))
        held = held[card.receive(held) :]
        heard = card.send()
        assert fmu.step(step * 1e-9) == OK, fmu.said
        card.run(card.now + step)
        assert fmu.get("pulse_count")[:4] == card.pulses, k
        assert fmu.get("state") == [card.state]
        assert fmu.get("flash_programs") == [card["programs"]]
        moved += card.state == m.State.RUNNING
        if ours.there and theirs.there and not started:
            started = k
            for pc in (ours, theirs):
                pc.end.send(m.Start(1))
        if started and moved and card.state == m.State.READY:
            break
    assert moved > 500 and card.pulses == [6000, -6000, 0, 0]
    assert slot(card, 0, len(job)) == job
    fmu.free()


def test_the_flash_outlives_the_program(tmp_path: Path) -> None:
    file = FlashFile(tmp_path / "5.flash")
    assert file.load() == b""
    card, pc = VirtualNetCard(5), Pc(job_of())
    bring(card, pc)
    file.save(card)
    again = VirtualNetCard(5, flash=file.load())
    again.run(10 * MS)
    assert again.state == m.State.READY and again.flash == card.flash
    (tmp_path / "5.flash").write_bytes(bytes(5))
    with pytest.raises(InputError, match=f"5 bytes, a flash has {FLASH_BYTES}"):
        file.load()
    with pytest.raises(InputError, match=r"fifo_depth\[0\] = 1: out of range"):
        VirtualNetCard(5, fifo_depth=1)


@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_card_that_is_ended_keeps_its_flash(tmp_path: Path, number: signal.Signals) -> None:
    async def main() -> None:
        async with bench() as b:
            line = [sys.executable, "-m", "motionfmu", "card", "sim", "--flash", str(tmp_path)]
            program = await asyncio.create_subprocess_exec(
                *line, "--server", f"{HOST}:{b.port}", stdout=asyncio.subprocess.DEVNULL, cwd=ROOT
            )
            await b.online([1])
            assert (await b.cards.upload(1, job_of(300))).ok
            with pytest.raises(InputError, match="another program uses this folder"):
                sim(server=f"{HOST}:{b.port}", flash=tmp_path)
            program.send_signal(number)
            assert await program.wait() == (130 if number == signal.SIGINT else 0)
        kept = VirtualNetCard(1, flash=FlashFile(tmp_path / "1.flash").load())
        kept.run(10 * MS)
        assert kept.state == m.State.READY

    run(main())


def test_inputs_and_homing_of_the_machine() -> None:
    card = VirtualNetCard(5, in_action=[3] + [0] * 15, home_plus=[True, False, True, False])
    card.run(MS)
    library().netcard_command(card._card, 3, 15)
    card.run(500 * MS)
    assert card.state == m.State.HOMING
    card.set_inputs(1)
    card.run(card.now + 500 * MS)
    assert card.state == m.State.EMPTY and card["homed"] == 0
    card.set_inputs(0)
    library().netcard_command(card._card, 3, 15)
    card.run(card.now + 8000 * MS)
    assert (card.state, card["homed"]) == (m.State.EMPTY, 15)
    assert [abs(x) for x in card.pulses] == pytest.approx([5000] * 4, abs=30)


def test_cards_serve_a_server_in_real_time(tmp_path: Path) -> None:
    keys = {i: new_key(tmp_path / "keys.toml", i) for i in (1, 2)}

    async def main() -> None:
        async with bench(folder=tmp_path) as b:
            cards = [VirtualNetCard(i, keys[i]) for i in (1, 2)]
            task = asyncio.create_task(simulate(cards, (HOST, b.port), 10.0))
            await b.online([1, 2])
            assert (await b.cards.command(1, "start")).text == "there is no job in the card"
            ends = await asyncio.gather(*(b.cards.upload(i, job_of()) for i in (1, 2)))
            assert all(r.ok for r in ends)
            await until(lambda: b.view(1).state == "READY")
            assert (await b.cards.command(1, "start")).state == "RUNNING"
            await until(lambda: cards[0].state == m.State.READY)
            assert cards[0].pulses == [6000, -6000, 0, 0] and cards[1].pulses == [0] * 4
            await until(lambda: b.view(1).status.position == (6000, -6000, 0, 0))
            task.cancel()

    run(main())
