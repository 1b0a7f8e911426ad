"""A Grbl session at a live machine: carries its orders out, shows it the machine."""

import asyncio
import contextlib
from collections.abc import Callable, Coroutine
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.grbl.grbl_binding import GrblBinding
from motionfmu.live.serving.hand import Holder
from motionfmu.live.serving.machine_link import MachineLink

NAME = "a sender of G-code"
IDLE = 0.02  # [s] between two looks while nothing is asked


class _LinkOrders:
    """Orders that wait to be sent to the machine's process, in their order."""

    def __init__(self, link: MachineLink, binding: GrblBinding) -> None:
        self._link, self._binding = link, binding
        self.waiting: list[Coroutine[Any, Any, Any]] = []
        self.count = 0

    def _ask(self, name: str, /, **arguments: Any) -> None:
        self.count += 1
        self.waiting.append(self._link.ask(name, **arguments))

    def mdi(self, text: str) -> None:
        self._ask("mdi", component=self._binding.component, line=text)

    def set(self, name: str, value: Any) -> None:
        if name in self._binding.variables:
            self._ask("set", name=f"{self._binding.component}.{name}", value=value)

    def press(self, name: str) -> None:
        self._ask("press", name=f"{self._binding.component}.{name}")


class GrblSession:
    """A controller with its machine."""

    def __init__(self, link: MachineLink) -> None:
        self._link = link
        self._write: Callable[[bytes], None] = _nobody
        self._binding = GrblBinding(link.about)
        self._orders = _LinkOrders(link, self._binding)
        self.controller = self._binding.controller(self._orders)
        self._wakened = asyncio.Event()
        self._who = Holder(NAME)

    def receive(self, data: bytes) -> None:
        """Take bytes of the sender; who asks for more than a report works the machine."""
        hand = self._link.hand
        if hand.holder is None and data.strip(b"?"):
            hand.needed(self._who)
        self._look_for_hand()
        self.controller.receive(data)
        self._wakened.set()

    def _look_for_hand(self) -> None:
        holder = self._link.hand.holder
        other = holder not in (None, self._who)
        self.controller.bar((holder.name or "somebody else") if holder and other else "")

    async def run(self, write: Callable[[bytes], None]) -> None:
        """Go on with a sender, who gets bytes by a function, until the machine ends."""
        self._write = write
        self._look_for_hand()
        self.controller.connect()
        with contextlib.suppress(InputError):
            while True:
                await self._turn()
                if self.controller.eager or self._orders.waiting:
                    continue
                with contextlib.suppress(TimeoutError):
                    async with asyncio.timeout(IDLE):  # wait_for of 3.11 may lose a cancellation
                        await self._wakened.wait()
                self._wakened.clear()

    async def end(self) -> None:
        """The sender has gone."""
        self._write = _nobody
        self.controller.disconnect()
        with contextlib.suppress(InputError):
            await self._turn()
        await self._link.hand.drop(self._who)

    async def _turn(self) -> None:
        """Carry out what is ordered; look."""
        self._look_for_hand()
        count, orders, self._orders.waiting = self._orders.count, self._orders.waiting, []
        looks = self._link.ask("frame", names=self._binding.names)
        *done, frame = await asyncio.gather(*orders, looks, return_exceptions=True)
        if isinstance(frame, BaseException):
            raise frame
        for error in (e for e in done if isinstance(e, BaseException)):
            self._write(f"[MSG:{' '.join(str(error).split())}]\r\n".encode("ascii", "replace"))
        self.controller.observe(self._binding.view(frame["time"], count, frame["values"]))
        if data := self.controller.sent():
            self._write(data)


def _nobody(data: bytes) -> None:
    """Nobody hears it."""
