"""What a server keeps of a card on disk: the job that waits, numbers of commands."""

import contextlib
import time
from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.cards.keys import write_whole

# Numbers are taken from the disk in blocks: a server that was killed goes on behind the block.
BLOCK = 256
NUMBER_MAX = 2**32 - 1


class Outbox:
    """A card's folder; it is made when something is to be kept."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._used = self._reserved = 0
        self.wrong = ""  # with the disk at the latest number

    @property
    def _job(self) -> Path:
        return self._folder / "job.mcj"

    def load(self) -> bytes:
        """The job that waits; empty if none does."""
        try:
            self._used = self._reserved = int((self._folder / "number").read_text())
        except (OSError, ValueError):
            self._used = self._reserved = 0
        try:
            return self._job.read_bytes()
        except OSError:
            return b""

    def keep(self, job: bytes) -> None:
        """Keep a job; when this returns it is on the disk. InputError if it cannot be."""
        try:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        except OSError as error:
            raise InputError(f"{self._folder}: {error.strerror}") from None
        write_whole(self._job, job)

    def drop(self) -> None:
        """The job is in the card, or refused."""
        with contextlib.suppress(OSError):  # it is offered once more, and the card has it
            self._job.unlink(missing_ok=True)

    def number(self, done: int) -> int:
        """A number of a command that this card never saw; 0 if all are used up.

        A disk that takes none keeps no command back: then numbers go on from the clock [s], which
        is ahead of all that were given before at less than one a second.
        """
        number = max(self._used, done) + 1
        if number > NUMBER_MAX:
            return 0
        if number > self._reserved:
            self.wrong = self._reserve(min(number + BLOCK, NUMBER_MAX))
            if self.wrong:
                number = max(number, min(int(time.time()), NUMBER_MAX))
        self._used = number
        return number

    def _reserve(self, reserved: int) -> str:
        """Take the numbers up to this one from the disk; what is wrong with it."""
        part = self._folder / ".number"
        try:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            part.write_text(str(reserved))
            part.replace(self._folder / "number")
        except OSError as error:
            return f"cannot write {self._folder / 'number'}: {error.strerror}"
        self._reserved = reserved
        return ""
