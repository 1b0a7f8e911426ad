"""Who has a live machine in hand: one at a time, of all that watch."""

from collections.abc import Awaitable, Callable
from dataclasses import dataclass

from motionfmu.base.errors import InputError


@dataclass(eq=False)
class Holder:
    """Somebody who may have it: a page, or a program."""

    name: str = ""


class Hand:
    """The one hand; `let_go` is awaited when it changes, so that nothing stays held."""

    def __init__(self, let_go: Callable[[], Awaitable[object]]) -> None:
        self._let_go = let_go
        self.holder: Holder | None = None

    async def take(self, who: Holder) -> None:
        """Take it, from whoever has it."""
        if self.holder is not who:
            had, self.holder = self.holder, who
            if had is not None:
                await self._let_go()

    async def drop(self, who: Holder) -> None:
        """Give it out of hand, if he has it."""
        if self.holder is who:
            self.holder = None
            await self._let_go()

    def needed(self, who: Holder) -> None:
        """Refuse somebody while another one has it; who acts while nobody has it has it then."""
        if self.holder is None:
            self.holder = who
        if self.holder is not who:
            name = self.holder.name or "somebody else"
            raise InputError(f"{name} has the machine in hand: take it first")
