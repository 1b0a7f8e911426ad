"""A job on its way to a card over one connection, without I/O."""

import hashlib
import zlib
from collections import deque
from collections.abc import Callable

from motionfmu.cards.messages import (
    NO_PAGE,
    PAGE,
    PAGES_MAX,
    Ack,
    JobBegin,
    JobData,
    JobEnd,
    Message,
    Nak,
)
from motionfmu.cards.views import Code

# Most pages that are on their way, whatever the card grants; so commands wait behind few pages.
FLIGHT_MAX = 32


class JobFile:
    """A job file with the length, hash and CRC that the protocol tells of it."""

    def __init__(self, data: bytes) -> None:
        self.data, self.pages = data, len(data) // PAGE
        self.digest, self.crc = hashlib.sha256(data).digest(), zlib.crc32(data)


class Transfer:
    """Sends the pages that the card does not have, as many as it grants; then ends the job."""

    def __init__(self, job: JobFile, send: Callable[[Message], int]) -> None:
        self._job, self._send = job, send
        self.pages = job.pages
        self.sent = self.taken = 0  # pages; sent counts those sent again too
        self.code: int | None = None  # how it ended
        self._flight: deque[tuple[int, int]] = deque()  # frame and pages of what is on its way
        self._credit = self._next = 0
        self._asked = -1  # taken when the card was last asked what it has
        self._begin = self._end = 0  # frames of JobBegin and JobEnd; 0: not sent
        self.begin()

    def begin(self) -> None:
        """Ask the card which page it misses first."""
        self._begin, self._end = (
            self._send(JobBegin(len(self._job.data), self._job.digest, self._job.crc)),
            0,
        )
        self._asked = self.taken
        self._flight.clear()
        self._credit, self._waits = 0, True

    def again(self) -> None:
        """Ask the card again after a long silence, unless it still owes an answer."""
        if not self._waits and not self._end:
            self.begin()

    def ack(self, ack: Ack) -> None:
        """Take an acknowledgement."""
        if self.code is not None or ack.sequence < self._begin:
            return
        while self._flight and self._flight[0][0] <= ack.sequence:
            self._flight.popleft()
        self._credit = ack.credit
        self.taken = min(ack.missing, self.pages)
        if self._waits:
            self._next, self._waits = self.taken, False
        if self._end:
            if ack.sequence >= self._end:
                self.code = Code.DONE
        elif ack.missing == NO_PAGE:
            self._end = self._send(JobEnd(self._job.crc))

    def nak(self, nak: Nak) -> None:
        """Take a refusal; a page for which there was no room is sent again."""
        if self.code is not None or nak.sequence < self._begin:
            return
        own = nak.sequence in (self._begin, self._end)
        if not own and all(frame != nak.sequence for frame, _ in self._flight):
            return
        if own or nak.code != Code.PAGE or self._asked == self.taken:
            self.code = nak.code
        else:
            self.begin()

    def pump(self, frames: int) -> bool:
        """Send so many frames at most; returns whether there is more to send."""
        if self.code is not None or self._end:
            return False
        for _ in range(frames):
            count = self._room()
            if count <= 0:
                return False
            data = self._job.data[self._next * PAGE : (self._next + count) * PAGE]
            self._flight.append((self._send(JobData(self._next, data)), count))
            self._next += count
            self.sent += count
        return self._room() > 0

    def _room(self) -> int:
        """Pages that may be sent in one frame now."""
        flying = sum(count for _, count in self._flight)
        left = min(self._credit, FLIGHT_MAX) - flying
        return min(PAGES_MAX, self.pages - self._next, left)
