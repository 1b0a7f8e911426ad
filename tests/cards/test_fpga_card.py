"""The FPGA card does what a literal model of it does that ticks every 25 ns, whatever comes when.

The model shares no code: it keeps the slots as they were written and looks at every clock what is
due. Both get the same wires at the same instants; after each communication step, a part of the
wires' period, every output is the same.

More: CARD_EXAMPLES=5000 pytest tests/cards/test_fpga_card.py
"""

import os
from typing import Any

import pytest
from fmi_tools import ERROR, OK, Instance
from hypothesis import Phase, given, settings
from hypothesis import strategies as st

RUNS = settings(
    max_examples=int(os.environ.get("CARD_EXAMPLES", "150")),
    phases=[Phase.explicit, Phase.generate],
)
CLOCK = 25e-9  # [s]
LEVELS = {
    "host_run": False,
    "host_servo": 0,
    "drive_ready": [False] * 6,
    "drive_alarm": [0] * 6,
    "emergency_stop": False,
}


def signed(bits: int) -> int:
    return bits - (1 << 32) if bits >> 31 else bits


def pulses_of(byte: int, bits: bool, most: int) -> int | None:
    """Pulses that a byte of a slot means; None if none."""
    if bits:
        return {0: 0, 1: 1, 2: 0, 3: -1}.get(byte)
    n = byte - 256 if byte > 127 else byte
    return n if abs(n) <= most else None


def volts_of(value: float) -> float:
    code = round(value / 10 * 32768)
    return max(-32768, min(32767, code)) * 10 / 32768


class Ticks:
    """The card, a clock at a time."""

    def __init__(self, config: dict[str, Any]) -> None:
        self.c, self.slot = config, config["slot_clocks"]
        self.every = round(config["irq_every"] / CLOCK)
        self.memories: list[list[list[int]] | None] = [None, None]
        self.marked: list[int] = []
        self.playing, self.start, self.timer = -1, 0, self.every
        self.count, self.dropped, self.rate = [0] * 7, [0] * 7, [0.0] * 7
        self.writes: list[dict[str, Any]] = []
        self.entries: list[tuple[int, int, int]] = []
        self.analog: list[tuple[int, list[float]]] = []
        self.edges: dict[int, int] = {}
        self.pins = self.image = self.host = self.out = self.drive_pins = self.drives = 0
        self.out_clock, self.ao, self.ai = [0] * 32, [0.0] * 8, [0.0] * 8
        self.open = 0
        self.levels = dict(LEVELS)
        self.servo = 0
        self.reset = self.stopped = False
        self.stopped_clock = self.refused = self.late = self.underruns = self.ack = 0
        self.irq: tuple[int, int, int, list[float]] = (0, 0, 0, [0.0] * 8)
        self.input_irq = (0, 0, 0)

    def tick(self, clock: int) -> None:
        if clock % self.slot == 0:
            self.exchange(clock)
        self.arrive(clock)
        if self.playing >= 0:
            k, at = divmod(clock - self.start, self.slot)
            memory = self.memories[self.playing]
            assert memory is not None
            for axis, n in enumerate(memory[k]):
                a = abs(n)
                if at in [(2 * j + 1) * self.slot // (2 * a) for j in range(a)]:
                    self.count[axis] += n // a

    def arrive(self, clock: int) -> None:
        while self.writes and self.writes[0]["clock"] <= clock:
            self.take(self.writes.pop(0))

    def exchange(self, clock: int) -> None:
        c = self.c
        for channel, edge in list(self.edges.items()):
            if edge <= clock:
                self.pins ^= 1 << channel
                del self.edges[channel]
        changed, self.image = self.pins ^ self.image, self.pins
        if changed & c["input_irq_mask"]:
            self.input_irq = (self.input_irq[0] + 1, clock, self.image)
        self.drives = self.drive_pins
        for at in sorted({e[0] for e in self.entries if e[0] <= clock}):
            for _, mask, value in [e for e in self.entries if e[0] == at]:
                self.host = self.host & ~mask | value & mask
        self.entries = [e for e in self.entries if e[0] > clock]
        while self.analog and self.analog[0][0] <= clock:
            self.ao = [volts_of(v) for v in self.analog.pop(0)[1]]
        for i in range(32):
            new = (self.image if c["follow_mask"] >> i & 1 else self.host) >> i & 1
            if new != self.out >> i & 1:
                self.out ^= 1 << i
                self.out_clock[i] = clock
        limit = any(
            (c["stop_mask"] >> i & 1) and (self.image >> i & 1) != (c["stop_low"] >> i & 1)
            for i in range(32)
        )
        alarm = c["alarm_stops"] and self.drives >> 8 != 0
        cause = self.levels["emergency_stop"] or limit or alarm
        if self.reset and not cause:
            self.stopped = False
        self.reset = False
        if cause and not self.stopped:
            self.stopped, self.stopped_clock = True, clock
            self.stop(clock)
        self.servo = 0 if self.stopped and c["stop_servo_off"] else self.levels["host_servo"]
        self.play(clock)
        if self.playing < 0 or self.start == clock:
            self.open = clock

    def stop(self, clock: int) -> None:
        for m, memory in enumerate(self.memories):
            done = (clock - self.start) // self.slot if m == self.playing else 0
            for row in (memory or [])[done:]:
                self.dropped = [d + n for d, n in zip(self.dropped, row, strict=True)]
        self.memories, self.marked = [None, None], []
        self.idle(clock)

    def idle(self, clock: int) -> None:
        self.playing, self.timer, self.rate = -1, clock + self.every, [0.0] * 7

    def play(self, clock: int) -> None:
        ended = False
        if self.playing >= 0:
            memory = self.memories[self.playing]
            assert memory is not None
            if clock < self.start + len(memory) * self.slot:
                return
            self.memories[self.playing] = None
            self.playing, ended = -1, True
        if self.marked:
            self.playing, self.start = self.marked.pop(0), clock
            memory = self.memories[self.playing]
            assert memory is not None
            seconds = len(memory) * self.slot / 40e6
            self.rate = [sum(column) / seconds for column in zip(*memory, strict=True)]
            self.interrupt(clock)
        elif ended:
            self.underruns += self.levels["host_run"]
            self.idle(clock)
        elif clock >= self.timer:
            self.timer = clock + self.every
            self.interrupt(clock)

    def interrupt(self, clock: int) -> None:
        self.irq = (self.irq[0] + 1, clock, self.image, list(self.ai))

    def take(self, w: dict[str, Any]) -> None:
        self.ack = w["seq"]
        bits, most = self.c["pulse_format"] == 1, (self.slot - 1) // 4
        rows = [[pulses_of(b, bits, most) for b in row[:7]] for row in w["bytes"]]
        bad = any(None in row for row in rows) or any(any(row[7:]) for row in w["bytes"])
        if self.stopped or self.memories[w["memory"]] is not None or bad:
            self.refused += 1
            return
        self.memories[w["memory"]] = rows  # type: ignore[assignment]
        self.marked.append(w["memory"])

    def missed(self, clock: int, now: int) -> bool:
        """An exchange that something stated for `clock` was meant for is over."""
        return clock > 0 and any(e % self.slot == 0 for e in range(clock, now + 1))

    def read(self, now: int, wires: dict[str, Any]) -> None:
        """The wires at an instant; everything up to it has happened."""
        if w := wires.get("write"):
            if not w["bytes"] or len(self.writes) == 4:
                self.refused += 1
            else:
                self.late += 0 < w["clock"] < self.open
                self.writes.append(w)
                self.arrive(now)
        for entry in wires.get("entries", []):
            self.late += self.missed(entry[0], now)
            self.entries.append(entry)
        if a := wires.get("ao"):
            self.late += self.missed(a[0], now)
            self.analog.append(a)
        self.reset |= wires.get("reset", False)
        for channel, clock in wires.get("inputs", {}).items():
            before = self.edges.pop(channel, None)
            if before is not None and before > now:
                continue  # what was to come does not
            if before is not None:
                self.pins ^= 1 << channel
            self.late += self.missed(clock, now)
            self.edges[channel] = clock
        self.ai = [volts_of(v) for v in wires["ai"]]
        self.levels.update(wires["levels"])
        ready, alarm = self.levels["drive_ready"], self.levels["drive_alarm"]
        self.drive_pins = sum((ready[i] << i) + ((alarm[i] > 0) << i + 8) for i in range(6))

    def outputs(self, clock: int) -> dict[str, list[Any]]:
        full = sum(1 << m for m in self.marked)
        slot = (clock - self.start) // self.slot if self.playing >= 0 else 0
        alone = {
            "irq_seq": self.irq[0], "irq_clock": self.irq[1], "irq_inputs": signed(self.irq[2]),
            "input_irq_seq": self.input_irq[0], "input_irq_clock": self.input_irq[1],
            "input_irq_image": signed(self.input_irq[2]), "inputs": signed(self.image),
            "drives": self.drives, "memory": self.playing, "full": full, "slot": slot,
            "write_ack": self.ack, "refused": self.refused, "underruns": self.underruns,
            "late": self.late, "stopped": self.stopped, "stopped_clock": self.stopped_clock,
            "dout": signed(self.out), "external_count": self.count[6],
            "external_dropped": self.dropped[6], "external_rate": self.rate[6],
            "external_servo_on": bool(self.servo >> 6 & 1),
        }  # fmt: skip
        return {name: [value] for name, value in alone.items()} | {
            "irq_ai": self.irq[3],
            "pulse_count": self.count[:6],
            "external_pulse_count": [self.count[6]] + [0] * 5,
            "dropped": self.dropped[:6],
            "pulse_rate": self.rate[:6],
            "dout_clock": self.out_clock,
            "ao": self.ao,
            "servo_on": [bool(self.servo >> i & 1) for i in range(6)],
        }


mask = st.one_of(st.just(0), st.sampled_from([1, 2, 0x80000000, 0x80000003, 0xFFFFFFFF]))
configs = st.fixed_dictionaries(
    {
        "slot_clocks": st.sampled_from([8, 13, 20, 40]),
        "pulse_format": st.sampled_from([0, 0, 1]),
        "input_irq_mask": mask,
        "follow_mask": mask,
        "stop_mask": st.sampled_from([0, 0, 4, 0xC]),
        "stop_low": st.sampled_from([0, 0, 0, 8]),
        "alarm_stops": st.booleans(),
        "stop_servo_off": st.booleans(),
        "bus_period": st.sampled_from([6, 20, 48, 90]),
        "irq_every": st.integers(1, 6),
    }
)
few = st.sampled_from([True, False, False, False])
seldom = st.sampled_from([True] + [False] * 15)


@st.composite
def wires_at(draw: st.DrawFn, now: int, period: int, c: dict[str, Any]) -> dict[str, Any]:
    """What is new on the wires at an instant."""
    clock = st.one_of(st.integers(max(0, now - 30), now + 2 * period), st.just(0))
    most = (c["slot_clocks"] - 1) // 4
    good = st.sampled_from([0, 1, 2, 3]) if c["pulse_format"] else st.integers(-most, most)
    new: dict[str, Any] = {"levels": {}, "ai": None}
    if draw(st.booleans()):
        rows = draw(
            st.lists(st.lists(good.map(lambda n: n % 256), min_size=7, max_size=7), max_size=5)
        )
        rows = [[*row, 0] for row in rows]
        if rows and draw(few):
            row, byte = draw(st.sampled_from(rows)), draw(st.integers(0, 7))
            row[byte] = draw(st.sampled_from([1, most, most + 1, 255 - most, 4, 128, 0]))
        new["write"] = {"clock": draw(clock), "memory": draw(st.integers(0, 1)), "bytes": rows}
    if draw(few):
        entry = st.tuples(clock, st.integers(0, 15), st.integers(0, 15))
        new["entries"] = draw(st.lists(entry, max_size=8))
    if draw(few):
        volts = st.lists(st.floats(-12, 12), min_size=8, max_size=8)
        new["ao"] = (draw(clock), draw(volts))
    if draw(few):
        new["inputs"] = draw(st.dictionaries(st.sampled_from([0, 1, 2, 3, 31]), clock, max_size=3))
    if draw(few):
        new["ai"] = draw(st.lists(st.floats(-12, 12), min_size=8, max_size=8))
    if draw(few):
        new["levels"] = {"host_run": draw(st.booleans()), "host_servo": draw(st.integers(0, 127))}
    if draw(seldom):
        new["levels"]["emergency_stop"] = draw(st.booleans())
        new["levels"]["drive_alarm"] = [draw(st.integers(0, 1))] + [0] * 5
        new["levels"]["drive_ready"] = draw(st.lists(st.booleans(), min_size=6, max_size=6))
    new["reset"] = draw(few)
    return new


class Card:
    """The FMU on the same wires."""

    def __init__(self, config: dict[str, Any]) -> None:
        values = {n: signed(v) if n in MASKS else v for n, v in config.items()}
        self.fmu = Instance("fpga_card", 3).initialize(values)
        self.seq, self.di, self.di_clock = 0, 0, [0.0] * 32

    def set(self, name: str, value: Any) -> None:
        assert self.fmu.set(name, value) == OK, self.fmu.said

    def read(self, new: dict[str, Any]) -> None:
        self.seq += 1
        if w := new.get("write"):
            w["seq"] = self.seq
            words = [0] * 256
            for k, row in enumerate(w["bytes"]):
                words[2 * k] = int.from_bytes(bytes(row[:4]), "little", signed=True)
                words[2 * k + 1] = int.from_bytes(bytes(row[4:]), "little", signed=True)
            self.set("host_write_words", words)
            self.set("host_write_slots", len(w["bytes"]))
            self.set("host_write_memory", w["memory"])
            self.set("host_write_clock", float(w["clock"]))
            self.set("host_write_seq", self.seq)
        if "entries" in new:
            rows = new["entries"] + [(0, 0, 0)] * (8 - len(new["entries"]))
            self.set("host_out_clock", [float(r[0]) for r in rows])
            self.set("host_out_mask", [r[1] for r in rows])
            self.set("host_out_value", [r[2] for r in rows])
            self.set("host_out_count", len(new["entries"]))
            self.set("host_out_seq", self.seq)
        if "ao" in new:
            self.set("host_ao_clock", float(new["ao"][0]))
            self.set("host_ao", new["ao"][1])
            self.set("host_ao_seq", self.seq)
        if new["reset"]:
            self.set("host_reset_seq", self.seq)
        for channel, clock in new.get("inputs", {}).items():
            self.di ^= 1 << channel
            self.di_clock[channel] = float(clock)
        self.set("di", signed(self.di))
        self.set("di_clock", self.di_clock)
        if new["ai"]:
            self.set("ai", new["ai"])
        for name, value in new["levels"].items():
            self.set(name, value)


MASKS = ("input_irq_mask", "follow_mask", "stop_mask", "stop_low")


def differences(card: Card, ticks: Ticks, clock: int) -> dict[str, Any]:
    """Outputs that are not the same: of the card, of the model."""
    seen, want = card.fmu.outputs(), ticks.outputs(clock)
    assert set(seen) == set(want)
    return {n: (seen[n], want[n]) for n in want if seen[n] != pytest.approx(want[n], abs=1e-12)}


@pytest.mark.more
@RUNS
@given(data=st.data(), config=configs)
def test_the_card_is_a_card_that_ticks(data: st.DataObject, config: dict[str, Any]) -> None:
    period = config["bus_period"]
    config = config | {
        "bus_period": period * CLOCK,
        "irq_every": config["irq_every"] * config["slot_clocks"] * CLOCK,
    }
    card, ticks = Card(config), Ticks(config)
    parts, last = data.draw(st.sampled_from([1, 2])), [0.0] * 8
    for k in range(data.draw(st.integers(1, 30))):
        new = data.draw(wires_at(k * period, period, config))
        card.read(new)
        last = new["ai"] or last
        ticks.read(k * period, new | {"ai": last})
        for part in range(1, parts + 1):
            end = k * period + part * period // parts
            assert card.fmu.step(period // parts * CLOCK) == OK, card.fmu.said
            for clock in range(end - period // parts + 1, end + 1):
                ticks.tick(clock)
            assert differences(card, ticks, end) == {}
    card.fmu.free()


@pytest.mark.parametrize(
    ("values", "said"),
    [
        ({"host_write_seq": 1, "host_write_clock": 1e300}, "host_write_clock = 1e+300"),
        (
            {"host_out_seq": 1, "host_out_count": 2, "host_out_clock": 1e16},
            "host_out_clock[1] = 1e+16",
        ),
        ({"host_ao_seq": 1, "host_ao_clock": -1e300}, "host_ao_clock = -1e+300"),
        ({"di": 2, "di_clock": 1e300}, "di_clock[2] = 1e+300"),
    ],
)
def test_what_is_no_clock_ends_the_run(values: dict[str, Any], said: str) -> None:
    card = Instance("fpga_card", 3).initialize({})
    for name, value in values.items():
        assert card.set(name, value) == OK
    assert card.step(5e-5) == ERROR
    assert card.said == f"one: {said}: not a clock"


@pytest.mark.parametrize(
    ("name", "value", "said"),
    [
        ("bus_period", 3e-8, "not a whole number of 25 ns clocks"),
        ("irq_every", 1.001e-5, "not a whole number of 25 ns clocks"),
        ("irq_every", 1.2e-5, "not a whole number of slots of 200 clocks"),
    ],
)
def test_parameters_that_cannot_work_are_refused(name: str, value: float, said: str) -> None:
    card = Instance("fpga_card", 3)
    assert card.set(name, value) == OK
    assert card.enter() == OK
    assert card.call("ExitInitializationMode") == ERROR
    assert card.said.startswith(f"one: {name} = ")
    assert card.said.endswith(said)


def test_a_refused_write_is_told() -> None:
    card = Instance("fpga_card", 3).initialize({})
    card.call("SetDebugLogging", True, 0, None)
    words = [0] * 256
    words[6] = 50 << 16
    for name, value in {
        "host_write_seq": 7,
        "host_write_memory": 1,
        "host_write_slots": 4,
        "host_write_words": words,
    }.items():
        assert card.set(name, value) == OK
    assert card.step(5e-5) == OK
    assert card.get("refused") == [1]
    assert card.said == (
        "one: 1 refused; write 7 of memory 1, slot 3, axis 3: a byte is not the pulses of a slot"
    )
