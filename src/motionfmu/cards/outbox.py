"""A server's data of a card on the disk: the job that waits, the numbers of commands."""

import contextlib
import time
from pathlib import Path

from motionfmu.base.errors import InputError
from motionfmu.cards.keys import write_whole

# Numbers are reserved on the disk in blocks; after a kill a server goes on behind its block.
BLOCK = 256
NUMBER_MAX = 2**32 - 1


class Outbox:
    """A card's folder, which is made when the first thing is kept in it."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._used = self._reserved = 0
        self.wrong = ""  # fault of the disk when the latest number was taken

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
        """Remove the job, which is in the card or refused."""
        with contextlib.suppress(OSError):  # it is offered once more, and the card has it
            self._job.unlink(missing_ok=True)

    def number(self, done: int) -> int:
        """A number of a command that this card never saw; 0 if all are used up.

        If the disk fails, commands go on: numbers are then taken from the clock [s], which is ahead
        of all numbers given before, as these are fewer than one a second.
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
        """Reserve the numbers up to this one on the disk; returns the disk's fault."""
        part = self._folder / ".number"
        try:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            part.write_text(str(reserved))
            part.replace(self._folder / "number")
        except OSError as error:
            return f"cannot write {self._folder / 'number'}: {error.strerror}"
        self._reserved = reserved
        return ""
