"""The protocol between PC and card, without I/O: frames, messages, handshake, session.

Little-endian. A frame is a header of 12 bytes, a payload, and a CRC-32, or behind the handshake
with a key 8 bytes of an HMAC-SHA256. src/net/net_link has the same in C, for the card.
"""

import hmac
import os
import struct
import zlib
from collections.abc import Callable, Iterator
from dataclasses import replace

from motionfmu.cards.messages import KINDS, Auth, Challenge, Hello, Message, Welcome, WireError

MAGIC, VERSION = 0x434D, 1
PAYLOAD_MAX = 1028  # [byte]
OPEN_KEY = bytes(32)
PROTOCOL = 1
HEADER = struct.Struct("<HBBHIH")
MAC_FLAG = 1
CRC_BYTES, MAC_BYTES = 4, 8
FRAME_MAX = HEADER.size + PAYLOAD_MAX + MAC_BYTES  # [byte]
TO_PC, TO_CARD = 0, 1  # directions


class Stream:
    """One end's frames of a connection: numbered, and checked by CRC or by the session's key."""

    def __init__(self, out: int) -> None:
        self._out = out  # direction of what is sent
        self._key = b""  # empty: CRC
        self._buffer = bytearray()
        self.sent = self.heard = 0  # sequence numbers

    @property
    def begun(self) -> bool:
        """Whether a frame has begun that is not whole."""
        return bool(self._buffer)

    def secure(self, key: bytes) -> None:
        """From here on both directions carry a MAC of this key."""
        self._key = key

    def frame(self, message: Message) -> bytes:
        """Bytes of the next frame."""
        payload = message.payload()
        self.sent += 1
        flags = MAC_FLAG if self._key else 0
        head = HEADER.pack(MAGIC, VERSION, message.TYPE, flags, self.sent, len(payload))
        return head + payload + self._seal(self._out, head + payload)

    def _seal(self, direction: int, body: bytes) -> bytes:
        if not self._key:
            return struct.pack("<I", zlib.crc32(body))
        return hmac.digest(self._key, bytes([direction]) + body, "sha256")[:MAC_BYTES]

    def feed(self, data: bytes | memoryview) -> None:
        """Take bytes of the connection."""
        self._buffer += data

    def next(self) -> tuple[int, int, bytes] | None:
        """Sequence, type and payload of the next whole frame; WireError if it is none."""
        if len(self._buffer) < HEADER.size:
            return None
        magic, version, kind, flags, sequence, length = HEADER.unpack_from(self._buffer)
        if magic != MAGIC or version != VERSION or length > PAYLOAD_MAX:
            raise WireError(f"no frame: magic {magic:04x}, version {version}, length {length}")
        if flags != (MAC_FLAG if self._key else 0):
            raise WireError(f"frame with flags {flags}")
        body = HEADER.size + length
        end = body + (MAC_BYTES if self._key else CRC_BYTES)
        if len(self._buffer) < end:
            return None
        frame = bytes(self._buffer[:end])
        if not hmac.compare_digest(self._seal(1 - self._out, frame[:body]), frame[body:]):
            raise WireError("frame with a wrong MAC" if self._key else "frame with a wrong CRC")
        if sequence != self.heard + 1:
            raise WireError(f"frame {sequence} behind {self.heard}")
        self.heard = sequence
        del self._buffer[:end]
        return sequence, kind, frame[HEADER.size : body]


def proof(key: bytes, role: bytes, hello: Hello, challenge: Challenge) -> bytes:
    """HMAC of a handshake: role S of the PC, C of the card, K of the session's key."""
    ends = struct.pack("<IH", hello.card, challenge.protocol)
    return hmac.digest(key, role + hello.nonce + challenge.nonce + ends, "sha256")


def proved(given: bytes, wanted: bytes, whose: str) -> None:
    """WireError unless a proof is the one that is wanted."""
    if not hmac.compare_digest(given, wanted):
        raise WireError(f"the {whose} has another key")


class LinkEnd:
    """What both ends of a connection have in common: the handshake, then messages from bytes.

    The package has the PC's end; the card's in Python, for tests, is in tests/helpers/soft_card.py.
    """

    def __init__(self, out: int) -> None:
        self.stream = Stream(out)
        self.ready = False  # the handshake is over
        self._bytes = bytearray()

    def take(self) -> bytes:
        """Bytes to be sent, taken out."""
        data, self._bytes = bytes(self._bytes), bytearray()
        return data

    def send(self, message: Message) -> int:
        """Put a message among the bytes to be sent; returns the number of its frame."""
        self._bytes += self.stream.frame(message)
        return self.stream.sent

    def feed(self, data: bytes | memoryview) -> Iterator[tuple[int, int, Message | None]]:
        """Number, type and message of each frame behind the handshake; None: of unknown type."""
        self.stream.feed(data)
        while frame := self.stream.next():
            sequence, kind, payload = frame
            message = KINDS[kind].read(payload) if kind in KINDS else None
            if self.ready:
                yield sequence, kind, message
            else:
                self._shake(message)

    def _shake(self, message: Message | None) -> None:
        raise NotImplementedError

    def secure(self, key: bytes, hello: Hello, challenge: Challenge) -> None:
        """From here on frames have a MAC, if there is a key."""
        if key != OPEN_KEY:
            self.stream.secure(proof(key, b"K", hello, challenge))


class PcEnd(LinkEnd):
    """The PC's end; `key_of` gives the key of a card's id."""

    def __init__(self, key_of: Callable[[int], bytes], interval: int = 100) -> None:
        super().__init__(TO_CARD)
        self.hello: Hello | None = None
        self._key_of, self._interval = key_of, interval
        self._key = b""
        self._challenge: Challenge | None = None

    def _shake(self, message: Message | None) -> None:
        if self.hello is None or self._challenge is None:
            if not isinstance(message, Hello):
                raise WireError("no HELLO")
            if not message.oldest <= PROTOCOL <= message.newest:
                raise WireError(f"protocol {message.oldest} to {message.newest}")
            self.hello, self._key = message, self._key_of(message.card)
            blank = Challenge(PROTOCOL, os.urandom(16), b"")
            shown = proof(self._key, b"S", message, blank)
            self._challenge = replace(blank, proof=shown)
            self.send(self._challenge)
            return
        if not isinstance(message, Auth):
            raise WireError("no AUTH")
        proved(message.proof, proof(self._key, b"C", self.hello, self._challenge), "card")
        self.secure(self._key, self.hello, self._challenge)
        self.send(Welcome(self._interval))
        self.ready = True
