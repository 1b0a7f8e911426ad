"""The network card as an FMU: a job to its last pulse whatever comes between, a job from a PC.

More: CARD_EXAMPLES=500 pytest tests/cards/test_network_card.py
"""

import hashlib
import os
import re
import tomllib
import zlib
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from fmi_tools import OK, Instance
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

from motionfmu.base.units import spelled
from motionfmu.cards import messages as m
from motionfmu.cards.card_job import FrameEvent, Job, encode
from motionfmu.cards.keys import OPEN_KEY
from motionfmu.cards.wire import PcEnd
from motionfmu.scenarios import fmus as built
from motionfmu.scenarios.fault_advice import advice, meanings

ROOT = Path(__file__).parents[2]
RUNS = settings(
    max_examples=int(os.environ.get("CARD_EXAMPLES", "12")),
    phases=[Phase.explicit, Phase.generate],
)
START, PAUSE, STOP, HOME, RESET = range(32, 37)
READY, RUNNING, PAUSED, HOMING, FAULT = 1, 2, 4, 6, 7


def job_of(frames: int, top: int = 100) -> Job:
    """Two axes on a wavy path, from rest to rest."""
    k = np.arange(frames)
    x = np.minimum(np.minimum(k, k[::-1]), top)
    commands = np.zeros((frames, 4), int)
    commands[:, 0] = x
    commands[:, 1] = np.round(x * np.sin(0.01 * k))
    events = np.where(k == frames // 2, 1, 0)
    return Job(
        period_ns=1000000,
        mask=3,
        commands=commands,
        frame_events=events,
        events=[FrameEvent(pins=0x11, pulse=False, level=1)],
        speed_max=(1000 * top,) * 4,
        acc_max=(2000000,) * 4,
        jerk_max=(200000000,) * 4,
    )


@pytest.fixture(scope="module")
def job(tmp_path_factory: pytest.TempPathFactory) -> tuple[str, Job]:
    """A job of 0.6 s, and its file."""
    job = job_of(600)
    file = tmp_path_factory.mktemp("job") / "a.mcj"
    file.write_bytes(encode(job))
    return str(file), job


class Card:
    """An instance with a keyboard."""

    def __init__(self, fmi: int = 3, **values: Any) -> None:
        self.fmu = Instance("network_card", fmi).initialize(values)
        self.seq = 0

    def order(self, command: int) -> None:
        self.seq += 1
        assert self.fmu.set("command", command) == OK
        assert self.fmu.set("command_seq", self.seq) == OK

    def step(self, size: float = 1e-3) -> None:
        assert self.fmu.step(size) == OK, self.fmu.said

    def get(self, name: str) -> Any:
        values = self.fmu.get(name)
        return values[0] if len(values) == 1 else values

    def seen(self) -> list[Any]:
        names = ("state", "pulse_count", "frame", "rate", "task", "task_busy", "idle", "interrupts")
        return [self.fmu.get(name) for name in names]

    def until(self, state: int, steps: int) -> None:
        for _ in range(steps):
            if self.get("state") == state:
                return
            self.step()
        assert self.get("state") == state


def test_homing_that_cannot_be_planned_is_a_fault_with_its_meaning() -> None:
    card = Card(reserve=1.0)  # leaves no acceleration
    card.order(HOME)
    card.until(FAULT, 100)
    number = card.get("error")
    assert number == 6
    assert meanings(built.ports("network_card")["error"])[number].startswith("settings of homing")
    assert "reserve" in advice("network_card")["error"][number]


def test_the_parameters_are_the_settings_of_the_card() -> None:
    text = (ROOT / "src/controllers/netcard/card_settings.h").read_text().replace("\\\n", "")
    rows = re.findall(
        r'X\((bool|int32_t|double),\s*(\w+),\s*(?:\[(\d+)\])?\s*,\s*"([^"]*)",\s*([^,]+),'
        r'\s*([^,]+),\s*([^,]+),\s*"([^"]*)"\)',
        text,
    )
    kinds = {"bool": "bool", "int32_t": "i32", "double": "f64"}
    file = (ROOT / "fmus/network_card/fmu.toml").read_text()
    parameters = tomllib.loads(file)["parameter"]
    assert len(rows) > 50
    assert [r[1] for r in rows] == [p for p in parameters if p not in ("bus_period", "job", "key")]
    for kind, name, elements, unit, start, low, high, words in rows:
        p = parameters[name]
        assert p["type"] == kinds[kind]
        assert p.get("dims", [""]) == ([int(elements)] if elements else [""])
        said = re.sub(r"\[(.*)\]$", lambda m: f"[{spelled(m[1])}]", words)
        if values := p.get("values"):
            numbers = sorted(map(int, values)) if isinstance(values, dict) else range(len(values))
            assert {int(n) for n in re.findall(r"\b\d+\b", words)} == set(numbers)
            p = {"min": numbers[0], "max": numbers[-1], **p}
        else:
            assert p["doc"].removesuffix(f" [{spelled(unit)}]") == said
        if kind == "bool":
            assert p["start"] == (start == "true")
        else:
            assert (p["start"], p["min"], p["max"]) == (float(start), float(low), float(high))


# At so many ms: a command, for so many ms of patience; the order is what the table accepts.
PAUSES = st.lists(st.tuples(st.integers(1, 250), st.integers(0, 250)), max_size=4)


@RUNS
@given(pauses=PAUSES, part=st.sampled_from([1e-3, 1e-4, 37e-5, 20e-9 * 12345]))
def test_pauses_change_no_pulse(
    job: tuple[str, Job], pauses: list[tuple[int, int]], part: float
) -> None:
    file, plan = job
    cards = [Card(2, job=file), Card(3, job=file)]

    def step() -> None:
        cards[0].step()
        parts = int(1e-3 / part)
        for _ in range(parts):
            cards[1].step(part)
        if rest := round((1e-3 - parts * part) / 20e-9):
            cards[1].step(rest * 20e-9)
        for card in cards:
            card.fmu.time = round(card.fmu.time, 9)
        assert cards[0].seen() == cards[1].seen()

    def order(command: int, steps: int) -> None:
        for card in cards:
            card.order(command)
        for _ in range(steps):
            step()

    order(START, 1)
    for run, wait in pauses:
        for _ in range(run):
            step()
        if cards[0].get("state") != RUNNING:
            break
        order(PAUSE, 1 + wait)
        order(START, 1)
    while cards[0].get("state") != READY:
        step()
        assert cards[0].fmu.time < 4.0
    assert cards[0].fmu.outputs() == cards[1].fmu.outputs()
    for card in cards:
        assert card.get("pulse_count") == [*plan.commands.sum(axis=0).tolist(), 0, 0]
        assert card.get("underflows") == 0 and card.get("jobs") == 1
        assert card.get("out") == 0x11
        spent = sum(card.get("task_busy")) + card.get("interrupt_busy") + card.get("kernel_busy")
        assert spent + card.get("idle") == pytest.approx(card.fmu.time, abs=1e-9)


@pytest.mark.parametrize("fmi", [2, 3])
def test_a_state_saved_in_a_pause_goes_on_from_there(job: tuple[str, Job], fmi: int) -> None:
    file, plan = job
    card = Card(fmi, job=file)
    card.order(START)
    for _ in range(200):
        card.step()
    card.order(PAUSE)
    for _ in range(30):
        card.step()
    assert 0.0 < card.get("rate") < 1.0
    time, state = card.fmu.time, card.fmu.save()
    copy = card.fmu.serialize(state)
    runs = []
    for _ in range(2):
        card.until(PAUSED, 300)
        card.order(START)
        card.until(READY, 800)
        runs.append(card.fmu.outputs())
        assert card.get("pulse_count")[:2] == plan.commands.sum(axis=0)[:2].tolist()
        card = Card(fmi, job=file)
        card.seq = 10
        status, state = card.fmu.deserialize(copy)
        assert status == OK and card.fmu.restore(state, time) == OK
    assert runs[0] == runs[1]


class Cable:
    """The PC's end of the link on the card's words, an instant of 1 ms at a time."""

    def __init__(self, card: Card, number: int) -> None:
        self.card, self.end = card, PcEnd(lambda _: OPEN_KEY)
        self.taken = self.sent = 0
        self.waiting = b""
        self.heard: list[tuple[int, Any]] = []
        assert card.fmu.set("connection", number) == OK

    def step(self) -> None:
        fmu = self.card.fmu
        self.card.step()
        ring = np.array(fmu.get("tx_words"), np.int32).tobytes()
        count = self.card.get("tx_count")
        data = bytes(ring[n % 512] for n in range(self.taken, count))
        self.taken = count
        self.heard += [(seq, message) for seq, _, message in self.end.feed(data)]
        self.waiting += self.end.take()
        room = 512 - (self.sent - self.card.get("rx_taken"))
        words = bytearray(np.array(fmu.get("rx_words"), np.int32).tobytes())
        for byte in self.waiting[:room]:
            words[self.sent % 512] = byte
            self.sent += 1
        self.waiting = self.waiting[room:]
        assert fmu.set("rx_words", np.frombuffer(bytes(words), np.int32).tolist()) == OK
        assert fmu.set("rx_count", self.sent) == OK
        assert fmu.set("tx_taken", self.taken) == OK

    def wait(self, kind: type, steps: int = 2000) -> Any:
        """The next message of this kind."""
        for _ in range(steps):
            for k, (_, message) in enumerate(self.heard):
                if isinstance(message, kind):
                    del self.heard[: k + 1]
                    return message
            self.step()
        raise AssertionError(f"no {kind.__name__}")


def test_a_job_comes_over_the_link_in_two_pieces_of_a_state() -> None:
    plan = job_of(400)
    file = encode(plan)
    pages = len(file) // 256
    card = Card()
    while not card.get("connect"):
        card.step()
    cable = Cable(card, 1)
    while not cable.end.ready:
        cable.step()
    begin = m.JobBegin(len(file), hashlib.sha256(file).digest(), zlib.crc32(file))
    cable.end.send(begin)
    ack = cable.wait(m.Ack)
    assert ack.missing == 0 and ack.credit >= 4
    cable.end.send(m.JobData(0, file[: 2 * 256]))
    assert cable.wait(m.Ack).missing == 2
    assert card.get("receiving")
    for _ in range(3):
        cable.step()
    # All that the card has goes into another instance, in the middle of the upload.
    time, copy = card.fmu.time, card.fmu.serialize(card.fmu.save())
    other = Card()
    status, state = other.fmu.deserialize(copy)
    assert status == OK and other.fmu.restore(state, time) == OK
    for name in other.fmu.names(lambda v: v.causality == "input" and v.type != "String"):
        other.fmu.set(name, card.fmu.get(name))
    cable.card = other
    cable.end.send(m.JobData(2, file[2 * 256 :]))
    assert cable.wait(m.Ack).missing == (0xFFFF if pages > 2 else 2)
    cable.end.send(m.JobEnd(zlib.crc32(file)))
    cable.wait(m.Ack, 5000)
    cable.end.send(m.Start(cable.end.hello.done + 1))
    result = cable.wait(m.ResultMessage)
    assert (result.code, result.state) == (0, RUNNING)
    while other.get("state") != READY:
        cable.step()
    assert other.get("pulse_count")[:2] == plan.commands.sum(axis=0)[:2].tolist()
    assert other.get("flash_programs") == pages + 2  # the mark, the record
    cable.heard.clear()
    assert cable.wait(m.Status).state == READY


def test_literal_rules_start_again_behind_a_stop(job: tuple[str, Job]) -> None:
    jobs = []
    for policy in (0, 1):
        card = Card(job=job[0], policy=policy)
        card.order(START)
        card.step()
        card.order(START)
        for _ in range(100):
            card.step()
        card.order(STOP)
        for _ in range(400):
            card.step()
        jobs.append((card.get("jobs"), card.get("state")))
    assert jobs == [(1, READY), (2, RUNNING)]
