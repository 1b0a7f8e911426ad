"""A cache in memory with the values of the keys that were used last."""

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

T = TypeVar("T")


class Memo(Generic[T]):
    """Values by key, for a number of keys at most; the one used least recently goes first."""

    def __init__(self, most: int) -> None:
        self._most = most
        self._known: dict[Hashable, T] = {}

    def __contains__(self, key: Hashable) -> bool:
        return key in self._known

    def __call__(self, key: Hashable, make: Callable[[], T]) -> T:
        """The value at a key, made if it is not known."""
        found = self._known.pop(key) if key in self._known else make()
        self._known[key] = found
        if len(self._known) > self._most:
            del self._known[next(iter(self._known))]
        return found
