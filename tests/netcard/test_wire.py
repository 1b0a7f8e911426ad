"""The protocol in Python against that in C, which shares no code with it; what both refuse."""

import ctypes
import re
from dataclasses import fields
from typing import Any

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from soft_card import CardEnd

from motionfmu.base.binding import library
from motionfmu.cards import messages as m
from motionfmu.cards.wire import OPEN_KEY, TO_CARD, TO_PC, LinkEnd, PcEnd, Stream

KEY = bytes(range(32))
ROOM = 65536  # [byte] more than a struct net_channel
Frame = tuple[int, int, bytes]  # sequence, type, payload
KINDS = sorted(m.KINDS.values(), key=lambda kind: kind.TYPE)


def integers(form: str) -> st.SearchStrategy[int]:
    """Numbers that a format of struct holds."""
    bits = {"B": 8, "H": 16, "I": 32, "i": 32, "q": 64}[form]
    low = -(1 << bits - 1) if form in "iq" else 0
    return st.integers(low, low + (1 << bits) - 1)


def messages(kind: type[m.Message]) -> st.SearchStrategy[m.Message]:
    """Messages of a kind with any values."""
    if kind is m.JobData:
        data = st.integers(1, m.PAGES_MAX).flatmap(
            lambda n: st.binary(min_size=n * m.PAGE, max_size=n * m.PAGE)
        )
        return st.builds(m.JobData, integers("H"), data)
    parts: list[st.SearchStrategy[Any]] = []
    for form in kind.LAYOUT.split():
        count = int(form[:-1] or 1)
        if form.endswith("x"):
            continue
        if form.endswith("s"):
            parts.append(st.binary(min_size=count, max_size=count))
        elif count > 1:
            parts.append(st.tuples(*[integers(form[-1])] * count))
        else:
            parts.append(integers(form))
    return st.builds(kind, *parts)


ANY = st.one_of([messages(kind) for kind in KINDS])


class Head(ctypes.Structure):
    """The first members of struct net_channel."""

    _fields_ = [(name, ctypes.c_uint8) for name in ("card", "keyed", "whole", "fault")]


class CChannel:
    """One end's frames by src/net/net_link."""

    def __init__(self, card: bool, key: bytes = b"") -> None:
        self.c, self.memory = library(), ctypes.create_string_buffer(ROOM)
        self.c.net_channel_start(self.memory, ctypes.c_bool(card))
        if key:
            self.c.net_channel_key(self.memory, key)
        kinds = {"payload": ctypes.c_void_p, "type": ctypes.c_uint8, "sequence": ctypes.c_uint32}
        kinds |= {"take": ctypes.c_size_t, "length": ctypes.c_size_t, "out": ctypes.c_size_t}
        for name, kind in (kinds | {"put": ctypes.c_bool}).items():
            getattr(self.c, f"net_channel_{name}").restype = kind

    @property
    def head(self) -> Head:
        """Whether a frame is whole, and what was wrong."""
        return Head.from_buffer(self.memory)

    def put(self, kind: int, payload: bytes) -> bytes:
        """A frame."""
        size, room = ctypes.c_size_t(len(payload)), ctypes.create_string_buffer(2048)
        assert self.c.net_channel_put(self.memory, ctypes.c_uint8(kind), payload, size)
        n = self.c.net_channel_out(self.memory, room, ctypes.c_size_t(2048))
        return room.raw[:n]

    def take(self, data: bytes) -> list[Frame]:
        """Every frame."""
        found = []
        while data and not self.head.fault:
            data = data[self.c.net_channel_take(self.memory, data, ctypes.c_size_t(len(data))) :]
            if self.head.whole:
                n = self.c.net_channel_length(self.memory)
                payload = ctypes.string_at(self.c.net_channel_payload(self.memory), n)
                sequence = self.c.net_channel_sequence(self.memory)
                found.append((sequence, self.c.net_channel_type(self.memory), payload))
                self.c.net_channel_drop(self.memory)
        return found


def stream(out: int, key: bytes = b"") -> Stream:
    """Frames of one end in Python."""
    made = Stream(out)
    made.secure(key)
    return made


def received(end: Stream, data: bytes) -> list[Frame]:
    """All frames in bytes."""
    end.feed(data)
    return list(iter(end.next, None))


def c_struct(kind: type[m.Message]) -> type[ctypes.Structure]:
    """The struct of net_message.h: the fields in their order, with their natural places."""
    types = {"B": ctypes.c_uint8, "H": ctypes.c_uint16, "I": ctypes.c_uint32, "q": ctypes.c_int64}
    types |= {"i": ctypes.c_int32, "s": ctypes.c_uint8, "x": ctypes.c_uint8}
    rows = []
    for k, form in enumerate(kind.LAYOUT.split()):
        count = int(form[:-1] or 1)
        rows.append((f"f{k}", types[form[-1]] * count if count > 1 else types[form[-1]]))
    return type(kind.__name__, (ctypes.Structure,), {"_fields_": rows})


NAMES = {m.Start: "command", m.Pause: "command", m.Stop: "command", m.Reset: "command"}
NAMES |= {m.Ping: "token", m.Pong: "token", m.ResultMessage: "result"}


@settings(max_examples=20)
@given(st.data())
@pytest.mark.parametrize("kind", [k for k in KINDS if k is not m.JobData])
def test_c_reads_each_message_as_it_was_meant(kind: type[m.Message], data: st.DataObject) -> None:
    message = data.draw(messages(kind))
    name = NAMES.get(kind, re.sub(r"(?<!^)(?=[A-Z])", "_", kind.__name__).lower())
    payload, there = message.payload(), c_struct(kind)()
    getattr(library(), f"net_get_{name}")(payload, ctypes.byref(there))
    spare = {f"f{k}" for k, f in enumerate(kind.LAYOUT.split()) if f.endswith("x")}
    read = [getattr(there, n) for n, _ in there._fields_ if n not in spare]
    read = [
        x if isinstance(x, int) else bytes(x) if x._type_ is ctypes.c_uint8 else tuple(x)
        for x in read
    ]
    assert read == [getattr(message, f.name) for f in fields(message)]
    again = ctypes.create_string_buffer(len(payload))
    getattr(library(), f"net_put_{name}")(again, ctypes.byref(there))
    assert again.raw == payload
    assert kind.read(again.raw) == message
    library().net_payload_fits.restype = ctypes.c_bool
    for n in (len(payload), len(payload) - 1, len(payload) + 1):
        text = (payload + b"\0")[:n]
        fits = library().net_payload_fits(ctypes.c_uint8(kind.TYPE), text, ctypes.c_size_t(n))
        assert fits == (n == len(payload))
        if not fits:
            with pytest.raises(m.WireError):
                kind.read(text)


@settings(max_examples=60)
@given(st.lists(ANY, max_size=8), st.data(), st.booleans(), st.booleans())
def test_frames_of_python_and_c_are_the_same_bytes_however_cut(
    sent: list[m.Message], data: st.DataObject, keyed: bool, from_card: bool
) -> None:
    key = KEY if keyed else b""
    ours, theirs = stream(TO_PC if from_card else TO_CARD, key), CChannel(from_card, key)
    wire = b"".join(map(ours.frame, sent))
    assert b"".join(theirs.put(x.TYPE, x.payload()) for x in sent) == wire
    cuts = sorted(data.draw(st.lists(st.integers(0, len(wire)), max_size=6)))
    parts = [wire[a:b] for a, b in zip([0, *cuts], [*cuts, len(wire)], strict=True)]
    other, reader = stream(TO_CARD if from_card else TO_PC, key), CChannel(not from_card, key)
    want = [(k, x.TYPE, x.payload()) for k, x in enumerate(sent, 1)]
    assert [f for p in parts for f in received(other, p)] == want
    assert [f for p in parts for f in reader.take(p)] == want
    assert [m.KINDS[kind].read(payload) for _, kind, payload in want] == sent


def refused(data: bytes, key: bytes) -> list[Frame]:
    """Frames to the card that are taken before one is refused, by Python and C alike."""
    python, c = stream(TO_PC, key), CChannel(True, key)
    taken = []
    python.feed(data)
    with pytest.raises(m.WireError):
        while frame := python.next():
            taken.append(frame)
        raise AssertionError("nothing was refused")
    assert c.take(data) == taken
    assert c.head.fault
    return taken


@pytest.mark.parametrize("key", [b"", KEY], ids=["crc", "mac"])
def test_what_is_replayed_left_out_or_put_in_another_order_is_refused(key: bytes) -> None:
    ours = stream(TO_CARD, key)
    one, two, three = (ours.frame(m.Start(n)) for n in (1, 2, 3))
    assert len(refused(one + one, key)) == 1
    assert len(refused(one + three, key)) == 1
    assert len(refused(two, key)) == 0
    assert len(refused(one + two + two, key)) == 2


def test_a_frame_without_the_key_or_back_to_its_sender_is_refused() -> None:
    assert refused(stream(TO_CARD).frame(m.Start(1)), KEY) == []
    assert refused(stream(TO_CARD, KEY).frame(m.Start(1)), b"") == []
    assert refused(stream(TO_CARD, bytes(32)).frame(m.Start(1)), KEY) == []
    assert refused(stream(TO_PC, KEY).frame(m.Ping(1)), KEY) == []


@settings(max_examples=100)
@given(ANY, st.data(), st.booleans())
def test_a_frame_with_a_bit_turned_is_never_taken(
    message: m.Message, data: st.DataObject, keyed: bool
) -> None:
    key = KEY if keyed else b""
    frame = bytearray(stream(TO_CARD, key).frame(message))
    bit = data.draw(st.integers(0, 8 * len(frame) - 1))
    frame[bit // 8] ^= 1 << bit % 8
    python, c = stream(TO_PC, key), CChannel(True, key)
    try:
        assert received(python, bytes(frame)) == []
    except m.WireError:
        pass
    assert c.take(bytes(frame)) == []


@settings(max_examples=200)
@given(st.binary(max_size=3000), st.booleans())
def test_any_bytes_are_refused_or_waited_for(data: bytes, keyed: bool) -> None:
    end = stream(TO_PC, KEY if keyed else b"")
    try:
        assert received(end, data) == []
    except m.WireError:
        return
    assert len(data) < 12 or data[:3] == b"MC\x01"


def hello(card: int = 7, oldest: int = 1, newest: int = 1) -> m.Hello:
    """A card's first message."""
    return m.Hello(card, oldest, newest, b"n" * 16, 1, 2, 4, 8, 0, bytes(32), 0, 5)


def shake(pc: LinkEnd, card: LinkEnd) -> tuple[bytes, bytes]:
    """What the card and the PC say until nobody has anything to say."""
    said: tuple[bytearray, bytearray] = (bytearray(), bytearray())
    while (up := card.take()) or (down := pc.take()):
        if up:
            said[0].extend(up)
            assert list(pc.feed(up)) == []
        else:
            said[1].extend(down)
            assert list(card.feed(down)) == []
    return bytes(said[0]), bytes(said[1])


@pytest.mark.parametrize("key", [OPEN_KEY, KEY], ids=["open", "key"])
def test_both_ends_are_ready_and_understand_each_other(key: bytes) -> None:
    pc, card = PcEnd(lambda _: key, 50), CardEnd(key, hello())
    shake(pc, card)
    assert pc.ready and card.ready and card.interval == 50
    assert pc.hello == hello()
    assert pc.send(m.Start(1)) == 3
    wire = pc.take()
    assert bool(wire[4] & 1) == (key != OPEN_KEY)
    assert [x for _, _, x in card.feed(wire)] == [m.Start(1)]
    card.send(m.ResultMessage(1, 0, 2))
    assert [x for _, _, x in pc.feed(card.take())] == [m.ResultMessage(1, 0, 2)]


@pytest.mark.parametrize("keys", [(KEY, OPEN_KEY), (OPEN_KEY, KEY), (KEY, bytes(31) + b"x")])
def test_ends_with_other_keys_do_not_come_together(keys: tuple[bytes, bytes]) -> None:
    pc, card = PcEnd(lambda _: keys[0]), CardEnd(keys[1], hello())
    with pytest.raises(m.WireError, match="the PC has another key"):
        shake(pc, card)
    assert not pc.ready and not card.ready


def test_a_recorded_handshake_opens_nothing() -> None:
    card = CardEnd(KEY, hello())
    up, down = shake(PcEnd(lambda _: KEY), card)
    thief = PcEnd(lambda _: KEY)
    with pytest.raises(m.WireError, match="the card has another key"):
        list(thief.feed(up))
    assert not thief.ready
    other = CardEnd(KEY, m.Hello(**(vars(hello()) | {"nonce": b"o" * 16})))
    with pytest.raises(m.WireError, match="the PC has another key"):
        list(other.feed(down))


def test_a_handshake_in_another_order_or_of_another_protocol_is_refused() -> None:
    for messages_ in ([m.Auth(KEY)], [hello(), m.Ping(1)], [hello(), hello()]):
        frames = Stream(TO_PC)
        with pytest.raises(m.WireError):
            list(PcEnd(lambda _: OPEN_KEY).feed(b"".join(map(frames.frame, messages_))))
    with pytest.raises(m.WireError, match="protocol 2 to 3"):
        list(PcEnd(lambda _: OPEN_KEY).feed(CardEnd(KEY, hello(oldest=2, newest=3)).take()))
    for message in (m.Welcome(1), m.Challenge(1, b"n" * 16, KEY), m.Challenge(9, KEY[:16], KEY)):
        with pytest.raises(m.WireError):
            list(CardEnd(KEY, hello()).feed(Stream(TO_CARD).frame(message)))


def test_a_message_of_an_unknown_type_is_passed_over() -> None:
    pc, card = PcEnd(lambda _: KEY), CardEnd(KEY, hello())
    shake(pc, card)

    class Odd(m.Ping):
        TYPE = 200

    card.send(Odd(1))
    card.send(m.Ping(2))
    assert [(kind, x) for _, kind, x in pc.feed(card.take())] == [(200, None), (96, m.Ping(2))]
