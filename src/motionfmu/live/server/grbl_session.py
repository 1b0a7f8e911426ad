"""A Grbl session at a live machine: carries its orders out, shows it the machine."""

import asyncio
import contextlib
from collections.abc import Callable, Coroutine
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.grbl import GrblController, GrblSettings, MachineView
from motionfmu.live.server.machine_link import MachineLink

FMU = "mcc"
IDLE = 0.02  # [s] between two looks while nothing is asked
SPINDLE_MIN = 10  # [%]
_READ = (
    "status",
    "error",
    "position",
    "work_offset",
    "path_feed",
    "spindle_speed",
    "coolant",
    "homed",
    "mdi_taken",
    "mdi_lines",
    "mdi_done",
    "mdi_fault",
    "mdi_refused",
    "mdi_room",
    "probed",
    "probe_found",
)
_PARAMETERS = (
    "active",
    "lead",
    "gear_ratio",
    "ppr",
    "max_rpm",
    "acc_time",
    "axis_acc",
    "low_limit",
    "high_limit",
    "lot_offset",
    "hot_offset",
    "check_over_travel",
    "limit_mode",
    "pos2encoder_dir",
    "home_order",
    "home_dir",
    "home_low_speed",
    "home_high_speed",
    "home_settle",
    "home_offset",
)


def controller_of(about: dict[str, Any]) -> str:
    """The component of a machine that can be a Grbl.

    Raises
    ------
    InputError
        There is none.
    """
    found = [c for c, of in about["components"].items() if of["fmu"] == FMU]
    if len(found) != 1:
        raise InputError(f"{about['name']}: --grbl needs one controller {FMU}, not {len(found)}")
    return found[0]


class _LinkOrders:
    """Orders that wait to be sent to the machine's process, in their order."""

    def __init__(self, link: MachineLink, component: str) -> None:
        self._link, self._component = link, component
        self._known = set(link.about["components"][component]["variables"])
        self.waiting: list[Coroutine[Any, Any, Any]] = []
        self.count = 0

    def _ask(self, name: str, /, **arguments: Any) -> None:
        self.count += 1
        self.waiting.append(self._link.ask(name, **arguments))

    def mdi(self, text: str) -> None:
        self._ask("mdi", component=self._component, line=text)

    def set(self, name: str, value: Any) -> None:
        if name in self._known:
            self._ask("set", name=f"{self._component}.{name}", value=value)

    def press(self, name: str) -> None:
        self._ask("press", name=f"{self._component}.{name}")


class GrblSession:
    """A controller with its machine.

    Parameters
    ----------
    link : MachineLink
        It is open.
    write : callable
        Gets the bytes for the sender.
    """

    def __init__(self, link: MachineLink, write: Callable[[bytes], None]) -> None:
        self._link, self._write = link, write
        component = controller_of(link.about)
        self._component = component
        variables = link.about["components"][component]["variables"]
        given = link.about["components"][component]["parameters"]
        values = {n: given[n] for n in _PARAMETERS}
        self._orders = _LinkOrders(link, component)
        self.controller = GrblController(GrblSettings(values), self._orders)
        low = variables["spindle_override"]["low"] if "spindle_override" in variables else None
        self.controller.overrides.low = max(SPINDLE_MIN, round(100 * (low or 0)))
        self._names = [f"{component}.{n}" for n in _READ if n in variables]
        self._limits = [
            f"{c}.over_travel"
            for c, of in link.about["components"].items()
            if "over_travel" in of["variables"]
        ]
        self._probe = f"{component}.probe_in"
        self._wakened = asyncio.Event()
        self.errors: list[str] = []

    def receive(self, data: bytes) -> None:
        """Take bytes of the sender."""
        self.controller.receive(data)
        self._wakened.set()

    async def run(self) -> None:
        """Go on until the machine ends."""
        self.controller.connect()
        with contextlib.suppress(InputError):
            while True:
                await self._turn()
                if self.controller.eager or self._orders.waiting:
                    continue
                with contextlib.suppress(TimeoutError):
                    await asyncio.wait_for(self._wakened.wait(), IDLE)
                self._wakened.clear()

    async def end(self) -> None:
        """The sender has gone."""
        self.controller.disconnect()
        with contextlib.suppress(InputError):
            await self._turn()

    async def _turn(self) -> None:
        """Carry out what is ordered; look."""
        count, orders, self._orders.waiting = self._orders.count, self._orders.waiting, []
        looks = self._link.ask("frame", names=[*self._names, *self._limits])
        *done, frame = await asyncio.gather(*orders, looks, return_exceptions=True)
        if isinstance(frame, BaseException):
            raise frame
        self.errors += [str(e) for e in done if isinstance(e, BaseException)]
        self.controller.observe(self._view(frame, count))
        if data := self.controller.sent():
            self._write(data)

    def _view(self, frame: dict[str, Any], orders: int) -> MachineView:
        values = frame["values"]

        def of(name: str, default: Any = 0) -> Any:
            found = values.get(f"{self._component}.{name}", [default])
            return found[0] if len(found) == 1 else found

        def place(name: str) -> tuple[float, float, float]:
            x, y, z = of(name, [0.0] * 3)[:3]
            return (x, y, z)

        pins = "".join(
            axis
            for k, axis in enumerate("XYZ")
            if any(values[n][0] >> k & 0x101 for n in self._limits)
        )
        return MachineView(
            time=frame["time"],
            orders=orders,
            status=of("status"),
            error=of("error"),
            position=place("position"),
            offset=place("work_offset"),
            probed=place("probed"),
            found=bool(of("probe_found")),
            feed=60 * of("path_feed"),
            speed=of("spindle_speed"),
            coolant=of("coolant"),
            homed=bool(of("homed")),
            lines=of("mdi_lines"),
            done=of("mdi_done"),
            fault=of("mdi_fault"),
            refused=of("mdi_refused"),
            pins=pins,
        )
