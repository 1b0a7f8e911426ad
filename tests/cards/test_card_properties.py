"""The card does what a literal model of it does that ticks every 25 ns, whatever comes when.

Two cards get the same writes, pins and times: the EPCIO core, and `tests/brute/tick_card.c`, which
counts clock by clock. After every action all that can be seen of them is the same, and of the core
itself holds:

- the stock of a FIFO is within 0 .. 63;
- commands of the frames taken = pulses put out by the DDA times before + the command in progress +
  those in stock + those erased, shifted out or cleared;
- frames sent = frames taken + refused + on their way;
- a source that fired after the look of the host that was acknowledged last has its flag up.

More: CARD_EXAMPLES=5000 CARD_STEPS=200 pytest tests/cards/test_card_properties.py
"""

import ctypes
import itertools
import os

import pytest
from conftest import ROOT
from hypothesis import settings
from hypothesis import strategies as st
from hypothesis.stateful import (
    RuleBasedStateMachine,
    initialize,
    invariant,
    precondition,
    rule,
    run_state_machine_as_test,
)

RUNS = settings(
    max_examples=int(os.environ.get("CARD_EXAMPLES", "120")),
    stateful_step_count=int(os.environ.get("CARD_STEPS", "60")),
)

LIBRARY = ctypes.CDLL(os.environ.get("CARD_BRUTE", str(ROOT / "build" / "lib" / "card_brute.so")))
AXES, ENCODERS, PAGES, DEPTH = 6, 9, 9, 63
UNIT = 64  # phases are whole 64ths of a line period
SOURCES = [0x7F, 0x3F, 0x3F, 0x3F, 0, 0, 0, 0xFFFF, 0x7F]
BAD_WRITES = 37
RESET_DDA, RESET_ENC, RESET_LIO, RESET_PCL, RESET_PERI, RESET_ALL = 1, 2, 6, 7, 9, 10


def layout() -> list[tuple[str, int]]:
    LIBRARY.view_layout.restype = ctypes.c_char_p
    words = LIBRARY.view_layout().decode().split()
    return [(n, int(k)) for n, k in zip(words[::2], words[1::2], strict=True)]


class View(ctypes.Structure):
    _fields_ = [(n, ctypes.c_int64 * k) for n, k in layout()]


def give(value):
    """A number as int64, a list as an array of them, anything else as it is."""
    if isinstance(value, list):
        return (ctypes.c_int64 * len(value))(*value)
    return ctypes.c_int64(value) if isinstance(value, int) else value


class Card:
    """One of the two, with the functions of tick_card.h."""

    def __init__(self, prefix: str, setup: list[int], phase: list[int]) -> None:
        self.prefix = prefix
        self.view = View()
        make = getattr(LIBRARY, f"{prefix}_create")
        make.restype = ctypes.c_void_p
        self.card = ctypes.c_void_p(make(give(setup), give(phase)))
        assert self.card

    def do(self, name: str, *values) -> int:
        call = getattr(LIBRARY, f"{self.prefix}_{name}")
        call.restype = ctypes.c_int64
        return call(self.card, *(give(v) for v in values))

    def look(self) -> View:
        self.do("view", ctypes.byref(self.view))
        return self.view


def differences(card: View, tick: View) -> dict[str, tuple[list[int], list[int]]]:
    """What the two show differently, card first."""
    both = ((n, list(getattr(card, n)), list(getattr(tick, n))) for n, _ in layout())
    return {n: (a, b) for n, a, b in both if a != b}


axis = st.integers(0, AXES - 1)
encoder = st.integers(0, ENCODERS - 1)
often = st.sampled_from([1, 1, 1, 0])
span = st.sampled_from([400, 256, 150, 333, 800, 1000])  # [clocks] between two instants
pages = st.sampled_from(["all", "none", "dda", "enc", "cycle", "slow"]).map(
    {
        "all": SOURCES,
        "none": [0] * PAGES,
        "dda": [0x3F] + [0] * 8,
        "enc": [0, 0x3F, 0x3F, 0x3F] + [0] * 5,
        "cycle": [0x40] + [0] * 8,
        "slow": [0] * 7 + [0xFFFF, 0x7F],
    }.__getitem__
)
# rate, wiring, filter [clocks], index_lines
wiring = st.tuples(
    st.sampled_from([4, 2, 1, 0]),
    st.integers(0, 15),
    st.sampled_from([0, 1, 2, 3, 7, 20, 40, 63]),
    st.integers(1, 4),
).map(list)
trigger = st.one_of(st.integers(0, 10).map(lambda n: 1 << n), st.integers(0, 2**11 - 1))
reset_period = st.sampled_from([1, 400, 1000, 3000])
# how an encoder goes on, and how fast [% of what its filter passes]
pace = st.tuples(
    st.sampled_from(["slow", "fast", "over", "tremble", "edge", "turn", "rest"]),
    st.integers(-100, 100),
)
# ldi, dfi, up, down, stop
pins = st.tuples(
    st.integers(0, 255),
    st.integers(0, 127),
    st.sampled_from([0, 0, 1, 32, 63]),
    st.sampled_from([0, 0, 1, 21]),
    st.sampled_from([0, 0, 0, 1]),
).map(list)
# how many frames, two commands they are made of [% of the largest], what is wrong with which
good = st.tuples(
    st.sampled_from([16, 16, 16, 15, 8]),
    st.integers(-100, 100),
    st.integers(-100, 100),
    st.just(""),
    st.just(0),
)
bad = st.tuples(
    st.integers(0, 16),
    st.integers(-100, 100),
    st.integers(-100, 100),
    st.sampled_from(["large", "unused", ""]),
    st.sampled_from([0, 0, 1, 3, 10]),
)
# clock at which a transaction arrives: from now on, or at that of the next event
arrival = st.one_of(st.integers(-500, 3000), st.sampled_from(["now", "boundary", "timer"]))


class Cards(RuleBasedStateMachine):
    def __init__(self) -> None:
        super().__init__()
        self.cards: list[Card] = []
        self.clock = 0
        self.inputs = [0] * 5
        self.compares = [(0, 0)] * ENCODERS
        self.period = 1024  # [clocks] of the timer
        self.seq = 0
        self.sent: dict[int, list[list[int]]] = {}  # transactions on their way
        self.frames_sent = 0
        self.command = 2**31 - 60  # [pulses] of the seventh error counter, near the end of 32 bits
        self.taken = [0] * AXES  # [pulses] commands of the frames taken
        self.gone = [0] * AXES  # [pulses] commands erased or shifted out
        self.read: tuple[list[int], list[int]] | None = None  # flags and firings at the latest look
        self.served = [0] * (PAGES * 16)  # firings the host has seen and acknowledged

    @initialize(
        active=st.sampled_from([0x3F, 0x3F, 0x1F, 0x03, 0x2D]),
        limit=st.sampled_from([1, 20, 300, 32767]),
        encoders=st.lists(st.tuples(wiring, pace), min_size=ENCODERS, max_size=ENCODERS),
        mask=pages,
        refills=st.lists(good, max_size=4),
    )
    def power_on(self, active, limit, encoders, mask, refills) -> None:
        self.active = [bool(active >> i & 1) for i in range(AXES)]
        self.filters = [config[2] for config, _ in encoders]
        self.motion = [way for _, way in encoders]
        self.phase = [61 * i - 200 for i in range(ENCODERS)]
        setup = [active, limit, *itertools.chain(*(config for config, _ in encoders))]
        self.cards = [Card(p, setup, self.phase) for p in ("card", "tick")]
        self.both("set_dda", 10, 1)
        self.both("set_mask", mask)
        self.both("set_loops", 127)
        self.both("set_command", self.command)
        for i in range(ENCODERS):
            self.both("set_latch", i, 1 << (i + 3) % 11, i % 2)
        for what in refills:
            self.transaction(what, "now")

    def teardown(self) -> None:
        for card in self.cards:
            card.do("free")

    def both(self, name: str, *values) -> int:
        """Call a function of both cards, which answer the same."""
        card, tick = (c.do(name, *values) for c in self.cards)
        assert card == tick, f"{name}{values}: {card} instead of {tick}"
        return card

    # Time and pins.

    def place(self, i: int, clocks: int) -> int:
        """Where encoder i is at the next instant; never more than an edge a clock."""
        kind, amount = self.motion[i]
        half = max(2, self.filters[i])  # [clocks] shortest half line period the filter passes
        limit = clocks * UNIT // 4
        fastest = min(limit, clocks * UNIT // 2 // half)
        way = {
            "rest": 0,
            "slow": amount * fastest // 2000,
            "turn": -amount * fastest // 100,
            "fast": (1 if amount >= 0 else -1) * (fastest - abs(amount) // 10),
            "over": (1 if amount >= 0 else -1) * fastest * (50 + abs(amount)) // 50,
            "tremble": (1 if self.clock // clocks % 2 else -1) * (amount % 40),
            "edge": -self.phase[i] % (UNIT // 4) + UNIT // 4 * (amount % 5 - 2),
        }[kind]
        return self.phase[i] + max(-limit, min(limit, way))

    def instants(self, clocks: int, times: int) -> None:
        for _ in range(times):
            self.phase = [self.place(i, clocks) for i in range(ENCODERS)]
            self.clock += clocks
            for card in self.cards:
                card.do("control")
                card.do("sample", self.clock, self.phase, self.inputs)
            self.all_holds()

    @rule(clocks=span, times=st.integers(2, 10))
    def time_passes(self, clocks, times) -> None:
        self.instants(clocks, times)

    @rule(clocks=span, times=st.integers(1, 3), moves=st.dictionaries(encoder, pace, max_size=4))
    def machine_moves(self, clocks, times, moves) -> None:
        for i, way in moves.items():
            self.motion[i] = way
        self.instants(clocks, times)

    @rule(clocks=span, times=st.integers(1, 3), inputs=pins)
    def inputs_change(self, clocks, times, inputs) -> None:
        self.inputs = inputs
        self.instants(clocks, times)

    # DDA and FIFO.

    def frames(self, what) -> list[list[int]]:
        count, a, b, wrong, where = what
        largest = 2 ** self.cards[0].look().next_length[0] - 1
        made = [
            [
                self.active[i] * ((a + i * b + k * (a - b)) % 201 - 100) * largest // 100
                for i in range(AXES)
            ]
            for k in range(count)
        ]
        if wrong == "large" and where < count:
            made[where][where % AXES] = (largest + 1) * (-1) ** where
        if wrong == "unused" and where < count and not all(self.active):
            made[where][self.active.index(False)] = 1
        return made

    @rule(what=good, when=arrival, clocks=span, times=st.integers(0, 3))
    def host_refills(self, what, when, clocks, times) -> None:
        self.transaction(what, when)
        self.instants(clocks, times)

    @rule(what=bad, when=arrival)
    def host_sends_nonsense(self, what, when) -> None:
        self.transaction(what, when)

    def due(self, when) -> int:
        """Clock of an arrival; the next boundary as long as nothing but 1024 clocks was set."""
        view = self.cards[0].look()
        left = {
            "now": 0,
            "boundary": -self.clock % 1024,
            "timer": self.period - view.timer_now[0],
        }
        return self.clock + left.get(when, when)

    def transaction(self, what, when) -> None:
        sent = self.frames(what)
        flat = list(itertools.chain(*sent))
        self.seq += 1
        if self.both("post", self.seq, self.due(when), len(sent), flat) == 0:
            self.sent[self.seq] = sent
            self.frames_sent += len(sent)

    @rule(what=bad)
    def frame(self, what) -> None:
        for frame in self.frames(what)[:1]:
            if self.both("write_frame", frame) == 0:
                self.taken = [t + c for t, c in zip(self.taken, frame, strict=True)]

    @rule(minimum=st.one_of(st.integers(0, 4), st.integers(0, 62)))
    def minimum_stock(self, minimum) -> None:
        self.both("set_minimum", minimum)

    @rule(length=st.sampled_from([10, 10, 10, 11, 12]), divider=st.sampled_from([1, 1, 2, 3]))
    def dda_time(self, length, divider) -> None:
        self.both("set_dda", length, divider)

    @rule(run=often)
    def dda_run(self, run) -> None:
        self.both("set_run", run)

    @rule()
    def emergency_stop(self) -> None:
        self.both("clear")

    @rule(axis=axis, n=st.sampled_from([0, 1, 2, 5, 63, 100]))
    def erase(self, axis, n) -> None:
        stock = self.queue(axis)
        erased = self.both("erase_last", axis, n)
        self.gone[axis] += sum(stock[len(stock) - erased :])

    @rule(axis=axis)
    def shift_out(self, axis) -> None:
        out = [ctypes.c_int64(0) for _ in self.cards]
        states = [
            c.do("shift_out", axis, ctypes.byref(o)) for c, o in zip(self.cards, out, strict=True)
        ]
        assert states[0] == states[1] and out[0].value == out[1].value
        self.gone[axis] += out[0].value

    # Encoders and error counters.

    @rule(i=encoder, config=wiring)
    def reconfigure(self, i, config) -> None:
        self.filters[i] = config[2]
        self.both("set_encoder", i, config)

    @rule(encoders=st.integers(0, 2**ENCODERS - 1))
    def clear_encoders(self, encoders) -> None:
        self.both("clear_encoders", encoders)

    @rule(encoders=st.sets(encoder, max_size=4), on=often, ahead=st.integers(-30, 60))
    def compare(self, encoders, on, ahead) -> None:
        for i in encoders:
            self.compares[i] = (on, self.cards[0].look().count[i] + ahead)
            self.both("set_compare", i, *self.compares[i])
            self.both("set_compare", i, *self.compares[i])

    @rule(i=encoder)
    def same_compare(self, i) -> None:
        self.both("set_compare", i, *self.compares[i])

    @rule(encoders=st.sets(encoder, max_size=4), source=trigger, last=st.booleans())
    def latch(self, encoders, source, last) -> None:
        for i in encoders:
            self.both("set_latch", i, source, int(last))

    @rule(loops=st.integers(0, 127))
    def loops(self, loops) -> None:
        self.both("set_loops", loops)

    @rule(loops=st.integers(0, 127))
    def clear_loops(self, loops) -> None:
        self.both("clear_loops", loops)

    @rule(by=st.one_of(st.integers(-40, 40), st.sampled_from([-(2**30), 2**30])), clocks=span)
    def command_moves(self, by, clocks) -> None:
        """Of the seventh error counter, round the end of its 32 bits too."""
        self.command += by
        self.both("set_command", self.command)
        self.instants(clocks, 1)

    # Local I/O, timer, watchdog.

    @rule(
        edges=st.integers(0, 3**15 - 1),
        dedicated=st.integers(0, 127),
        stop=st.booleans(),
        gate=often,
    )
    def local_io(self, edges, dedicated, stop, gate) -> None:
        self.both(
            "set_local", [*(edges // 3**i % 3 for i in range(15)), dedicated, int(stop), gate]
        )

    @rule(on=often, period=st.sampled_from([1, 37, 400, 1000, 1024, 5000, "boundary"]))
    def timer(self, on, period) -> None:
        self.period = period if period != "boundary" else 1024 - self.clock % 1024
        self.both("set_timer", on, self.period)

    @rule(on=often, value=st.sampled_from([1, 2, 3, 10]), reset=reset_period)
    def watchdog(self, on, value, reset) -> None:
        self.both("set_watchdog", on, value, reset)

    @rule(value=st.integers(1, 2), reset=reset_period, clocks=span, times=st.integers(1, 6))
    def host_hangs(self, value, reset, clocks, times) -> None:
        """And comes back."""
        self.both("set_watchdog", 1, value, reset)
        self.both("set_timer", 1, self.period)
        self.instants(clocks, times)
        self.both("refresh_watchdog")

    @rule()
    def refresh(self) -> None:
        self.both("refresh_watchdog")

    # Interrupts.

    def fired(self) -> list[int]:
        counts = (ctypes.c_int64 * (PAGES * 16))()
        self.cards[1].do("fired", counts)
        return list(counts)

    @rule(mask=pages)
    def set_mask(self, mask) -> None:
        self.both("set_mask", mask)

    @rule(clocks=span, times=st.integers(0, 3), mask=pages)
    def host_serves(self, clocks, times, mask) -> None:
        self.host_reads()
        self.instants(clocks, times)
        self.host_acknowledges(mask, 0xFFFF)

    @rule()
    def host_reads(self) -> None:
        self.read = (list(self.cards[0].look().flags), self.fired())

    @precondition(lambda self: self.read)
    @rule(mask=pages, some=st.sampled_from([0xFFFF, 0xFFFF, 0x5555]))
    def host_acknowledges(self, mask, some) -> None:
        """What it read, all or some of it, some actions ago."""
        flags, fired = self.read
        flags = [f & some for f in flags]
        self.both("acknowledge", flags, mask)
        for n in range(PAGES * 16):
            if flags[n // 16] >> n % 16 & 1:
                self.served[n] = fired[n]
        self.read = None

    # Resets and nonsense.

    @rule(
        module=st.sampled_from([RESET_ENC, RESET_LIO, RESET_PCL, RESET_PERI, RESET_DDA, RESET_ALL])
    )
    def reset(self, module) -> None:
        self.both("reset_module", module)
        if module == RESET_ALL:  # and a host that does this forgets what it has read
            self.served, self.read = self.fired(), None

    @rule(k=st.integers(0, BAD_WRITES - 1))
    def write_out_of_range(self, k) -> None:
        assert self.cards[0].do("write_badly", k) == 0

    # What must hold.

    def queue(self, i: int) -> list[int]:
        view = self.cards[0].look()
        return view.queue[DEPTH * i : DEPTH * i + view.stock[i]]

    def note_arrivals(self) -> None:
        seq, taken = (ctypes.c_int64 * 16)(), (ctypes.c_int64 * 16)()
        for n in range(self.cards[1].do("arrivals", seq, taken)):
            for frame in self.sent.pop(seq[n])[: taken[n]]:
                self.taken = [t + c for t, c in zip(self.taken, frame, strict=True)]

    @invariant()
    def all_holds(self) -> None:
        card, tick = (c.look() for c in self.cards)
        assert bytes(card) == bytes(tick), differences(card, tick)
        self.note_arrivals()
        self.no_pulse_is_lost(card)
        self.no_interrupt_is_lost(card)

    def no_pulse_is_lost(self, card: View) -> None:
        waiting = sum(len(f) for f in self.sent.values())
        assert self.frames_sent == card.frames_taken[0] + card.frames_refused[0] + waiting
        emptied = (ctypes.c_int64 * AXES)()
        self.cards[1].do("emptied", emptied)
        for i in range(AXES):
            assert 0 <= card.stock[i] <= DEPTH
            put_out = card.pulses[i] - card.before[i]
            assert min(0, card.command[i]) <= put_out <= max(0, card.command[i])
            begun = card.before[i] + card.command[i]
            assert self.taken[i] == begun + sum(self.queue(i)) + self.gone[i] + emptied[i]

    def no_interrupt_is_lost(self, card: View) -> None:
        for n, (fired, served) in enumerate(zip(self.fired(), self.served, strict=True)):
            page, bit = divmod(n, 16)
            assert fired <= served or card.flags[page] >> bit & 1, f"page {page} bit {bit}"


@pytest.mark.more
@pytest.mark.hypothesis
def test_the_card_is_what_ticking_gives() -> None:
    run_state_machine_as_test(Cards, settings=RUNS)


def test_every_write_out_of_range_is_refused() -> None:
    card = Card("card", [0x3F, 1, *[4, 0, 0, 1] * ENCODERS], [0] * ENCODERS)
    answers = [card.do("write_badly", k) for k in range(BAD_WRITES + 1)]
    card.do("free")
    assert answers == [0] * BAD_WRITES + [-1]
