"""Which variables of a machine a Grbl session sees and works."""

from collections.abc import Mapping, Sequence
from typing import Any

from motionfmu.base.errors import InputError
from motionfmu.live.grbl.grbl_block import AXES
from motionfmu.live.grbl.grbl_controller import GrblController
from motionfmu.live.grbl.grbl_machine import MachineOrders, MachineView
from motionfmu.live.grbl.grbl_overrides import SPINDLE_MIN
from motionfmu.live.grbl.grbl_settings import GrblSettings

FMU = "mcc"
LIMITS = "over_travel"  # output of a card: bits 0 to 5 positive ends, 8 to 13 negative ones
_OTHER_END = 8
_NOTHING = (0, 0, 0)
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


class GrblBinding:
    """A machine's controller as a Grbl."""

    def __init__(self, about: Mapping[str, Any]) -> None:
        components = about["components"]
        found = [c for c, of in components.items() if of["fmu"] == FMU]
        if len(found) != 1:
            told = f"one controller {FMU} is wanted, there are {len(found)}"
            raise InputError(f"--grbl: {about['name']}: {told}")
        self.component = found[0]
        self.variables: Mapping[str, Any] = components[self.component]["variables"]
        self._parameters = components[self.component]["parameters"]
        own = [f"{self.component}.{n}" for n in _READ if n in self.variables]
        self._limits = [
            f"{c}.{LIMITS}" for c, of in components.items() if LIMITS in of["variables"]
        ]
        self.names = [*own, *self._limits]

    def controller(self, orders: MachineOrders) -> GrblController:
        """A session."""
        settings = GrblSettings({n: self._parameters[n] for n in _PARAMETERS})
        made = GrblController(settings, orders)
        low = self.variables["spindle_override"]["low"] or 0.0
        made.overrides.low = max(SPINDLE_MIN, round(100 * low))
        return made

    def view(self, time: float, orders: int, values: Mapping[str, Sequence[Any]]) -> MachineView:
        """What the session sees, of values by name."""

        def of(name: str) -> Sequence[Any]:
            return values.get(f"{self.component}.{name}", _NOTHING)

        def place(name: str) -> tuple[float, float, float]:
            x, y, z = of(name)[:3]
            return (x, y, z)

        on = 0
        for name in self._limits:
            ends = int(values[name][0])
            on |= ends | ends >> _OTHER_END
        return MachineView(
            time=time,
            orders=orders,
            status=of("status")[0],
            error=of("error")[0],
            position=place("position"),
            offset=place("work_offset"),
            probed=place("probed"),
            found=bool(of("probe_found")[0]),
            feed=60 * of("path_feed")[0],
            speed=of("spindle_speed")[0],
            coolant=of("coolant")[0],
            homed=bool(of("homed")[0]),
            lines=of("mdi_lines")[0],
            done=of("mdi_done")[0],
            fault=of("mdi_fault")[0],
            refused=of("mdi_refused")[0],
            pins="".join(axis for k, axis in enumerate(AXES) if on >> k & 1),
        )
