"""Bytes from a sender: real-time ones at once, the others by a buffer of 128 into lines."""

from collections import deque
from collections.abc import Iterator

ROOM = 128  # [byte] of the receive buffer
LINE = 80  # [byte] of a line, with its end
RESET, STATUS, START, HOLD = 0x18, ord("?"), ord("~"), ord("!")
REAL_TIME = frozenset({RESET, STATUS, START, HOLD})


class LineInput:
    """What has been received and not yet taken."""

    def __init__(self) -> None:
        self._bytes: deque[int] = deque()
        self._line = bytearray()
        self._comment = 0  # the byte that ends it
        self._overflow = False
        self._begun = 0  # bytes taken of the line under way
        self.lost = 0  # bytes that found the buffer full

    @property
    def held(self) -> int:
        """Bytes in the buffer."""
        return len(self._bytes)

    @property
    def begun(self) -> int:
        """Bytes that have been taken out of it, of a line without its end."""
        return self._begun

    def put(self, byte: int, room: int = ROOM) -> bool:
        """Take a byte of the stream; whether there was room."""
        if len(self._bytes) >= room:
            self.lost += 1
            return False
        self._bytes.append(byte)
        return True

    def clear(self) -> None:
        """Forget all bytes, as a reset does."""
        self._bytes.clear()
        self._next_line()

    def _next_line(self) -> None:
        self._line.clear()
        self._comment, self._overflow, self._begun = 0, False, 0

    def line(self) -> tuple[str | None, int] | None:
        """The next whole line and its bytes; None for the text if it is too long.

        Spaces, comments and ``/`` are left out, letters are capitals.
        """
        while self._bytes:
            byte = self._bytes.popleft()
            self._begun += 1
            if byte in b"\r\n":
                text = None if self._overflow else self._line.decode("ascii")
                size = self._begun
                self._next_line()
                return text, size
            self._add(byte)
        return None

    def _add(self, byte: int) -> None:
        if self._overflow or self._comment:
            if byte == ord(")") == self._comment:
                self._comment = 0
        elif byte in b"(;":
            self._comment = ord(")") if byte == ord("(") else ord("\n")
        elif byte > ord(" ") and byte != ord("/"):
            if len(self._line) >= LINE - 1:
                self._overflow = True
            else:
                self._line += bytes((byte,)).upper()


def split(data: bytes) -> Iterator[tuple[int, bool]]:
    """Each byte, and whether it acts at once; bytes above 127 never are part of a line."""
    for byte in data:
        yield byte, byte > 127 or byte in REAL_TIME
