"""What of a drawing is left out, counted while it is read."""

from motionfmu.drawings.drawing import Note


class LeftOut:
    """Things that are not drawn, or not as they are in the file, by what they are."""

    def __init__(self) -> None:
        self._found: dict[tuple[str, str], list[int]] = {}

    def add(self, what: str, line: int = 0, told: str = "left out") -> None:
        """Count one; `told` says what became of it, "" if `what` does."""
        self._found.setdefault((what, told), [line, 0])[1] += 1

    def notes(self) -> list[Note]:
        """A note for each kind, in the order in which they came."""
        return [Note(line, 0, 0, n, what, told) for (what, told), (line, n) in self._found.items()]
