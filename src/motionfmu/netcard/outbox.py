"""What a server keeps of a card on disk: the job that waits, numbers of commands."""

from pathlib import Path

from motionfmu.netcard.keys import write_whole

# Numbers are taken from the disk in blocks: a server that was killed goes on behind the block.
BLOCK = 256
NUMBER_MAX = 2**32 - 1


class Outbox:
    """A card's folder; it is made when something is to be kept."""

    def __init__(self, folder: Path) -> None:
        self._folder = folder
        self._used = self._reserved = 0

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
        """Keep a job; when this returns it is on the disk."""
        self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
        write_whole(self._job, job)

    def drop(self) -> None:
        """The job is in the card, or refused."""
        self._job.unlink(missing_ok=True)

    def number(self, done: int) -> int:
        """A number of a command that this card never saw; 0 if all are used up."""
        number = max(self._used, done) + 1
        if number > NUMBER_MAX:
            return 0
        if number > self._reserved:
            self._folder.mkdir(parents=True, exist_ok=True, mode=0o700)
            self._reserved = min(number + BLOCK, NUMBER_MAX)
            part = self._folder / ".number"
            part.write_text(str(self._reserved))
            part.replace(self._folder / "number")
        self._used = number
        return number
