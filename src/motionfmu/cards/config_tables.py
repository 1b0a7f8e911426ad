"""The tables of a card's configuration: each field once, with words, unit, range, macro."""

import ipaddress
import re
from collections.abc import Callable
from typing import Annotated, Any, Literal, Self

from pydantic import BeforeValidator, Field, model_validator

from motionfmu.cards.fields import FieldFaults, Is, Table

AXES = "XYZU"
PINS = 16  # programmable inputs, and outputs
CLOCK_NS = 20  # of the FPGA
RATE_MAX = 500_000  # [pulses/s]
BOTH = (-(2**31) + 1, 2**31 - 1)  # positions [pulses]
HOME_MAX = 100_000_000  # [pulses] of an offset or a way back

Trigger = Literal["rising", "falling", "high", "low"]
Level = Literal["low", "high"]
Action = Literal["none", "start", "pause", "stop", "home", "event"]


def _four_bytes(text: Any) -> Any:
    ipaddress.IPv4Address(text)
    return text


def _six_bytes(text: Any) -> Any:
    if not re.fullmatch(r"[0-9A-Fa-f]{2}(:[0-9A-Fa-f]{2}){5}", str(text)):
        raise ValueError("six bytes in hexadecimal wanted, such as 02:00:00:00:00:01")
    if int(text[:2], 16) & 1:
        raise ValueError("bit 0 of the first byte is that of a group")
    return text


def by_pins(empty: Any) -> Callable[[Any], Any]:
    """A function that makes a list for all pins of tables or names given by pin."""

    def whole(given: Any) -> Any:
        if not isinstance(given, dict):
            return given
        known = [str(pin) for pin in range(PINS)]
        strange = [((str(key),), f"pins are 0 .. {PINS - 1}") for key in given if key not in known]
        if strange:
            raise FieldFaults(*strange)
        return [given.get(pin, empty) for pin in known]

    return whole


Address = Annotated[str, BeforeValidator(_four_bytes)]
Mac = Annotated[str, BeforeValidator(_six_bytes)]


def _speed(words: str, macro: str, low: int = 1) -> Is:
    return Is(words, "mm/s", macro, "pulses/s", low, RATE_MAX, pulses=True, parameter=macro.lower())


def _way(words: str, macro: str, parameter: str, limits: tuple[int, int], suffix: str) -> Is:
    low, high = limits
    return Is(words, "mm", macro, "pulses", low, high, suffix, pulses=True, parameter=parameter)


def _time(words: str, macro: str, counts: str, limits: tuple[int, int], parameter: str) -> Is:
    factor, step = {"ns": (1e9, CLOCK_NS), "us": (1e6, 1)}[counts]
    low, high = limits
    return Is(words, "s", macro, counts, low, high, "UL", factor, False, step, True, parameter)


def _task(words: str, name: str) -> Is:
    return Is(words, "", f"PRIORITY_{name}", "", 1, 7, "U", parameter=f"priority_{name.lower()}")


class Network(Table):
    """Where the card is, and where its server is."""

    ip: Annotated[Address, Is("Address of the card", macro="IP")] = "192.168.1.50"
    netmask: Annotated[Address, Is("Network mask", macro="NETMASK")] = "255.255.255.0"
    gateway: Annotated[Address, Is("Gateway; 0.0.0.0 none", macro="GATEWAY")] = "192.168.1.1"
    mac: Annotated[Mac, Is("Ethernet address", macro="MAC")] = "02:00:00:00:00:01"
    server: Annotated[Address, Is("Address of the server", macro="SERVER_IP")] = "192.168.1.10"
    port: Annotated[
        int, Is("Port of the server", "", "SERVER_PORT", low=1, high=65535, suffix="U")
    ] = 8765
    id: Annotated[
        int, Is("Number of the card", "", "CARD_ID", low=1, high=2**31 - 1, parameter="card_id")
    ] = 1

    @model_validator(mode="after")
    def _one_network(self) -> Self:
        try:
            net = ipaddress.IPv4Network(f"{self.ip}/{self.netmask}", strict=False)
        except ValueError:
            raise FieldFaults((("netmask",), "ones, then zeros wanted")) from None
        found: list[tuple[tuple[str, ...], str]] = []
        if net.num_addresses > 2 and self.ip in (str(net[0]), str(net[-1])):
            found.append((("ip", "netmask"), f"an end of the network {net}"))
        if self.gateway != "0.0.0.0" and ipaddress.IPv4Address(self.gateway) not in net:
            found.append((("gateway", "ip", "netmask"), f"not in the card's network {net}"))
        if found:
            raise FieldFaults(*found)
        return self


class CardAxis(Table):
    """An axis: its scale, its limits and how it goes home."""

    RULES = (
        ("minimum", "<", "maximum"),
        ("speed_min", "<=", "speed_max"),
        ("home_speed", "<=", "speed_max"),
        ("home_slow", "<=", "home_speed"),
    )
    name: Literal["X", "Y", "Z", "U"]  # letter of the axis
    pulses_per_mm: Annotated[
        float,
        Is("Scale", "pulses/mm", "PULSES_PER_M", "pulses/m", 1, 10**9, factor=1e3, exact=True,
           parameter="pulses_per_m"),
    ]  # fmt: skip
    minimum: Annotated[float, _way("Lowest position", "LIMIT_NEG", "position_low", BOTH, "L")]
    maximum: Annotated[float, _way("Highest position", "LIMIT_POS", "position_high", BOTH, "L")]
    speed_max: Annotated[float, _speed("Highest speed", "SPEED_MAX")]
    speed_min: Annotated[float, _speed("Speed at which it starts at once", "SPEED_MIN", 0)] = 0.0
    acceleration_max: Annotated[
        float,
        Is("Highest acceleration", "mm/s2", "ACC_MAX", "pulses/s2", 1, 2 * 10**9, pulses=True,
           parameter="acc_max"),
    ]  # fmt: skip
    jerk_max: Annotated[
        float,
        Is("Highest jerk", "mm/s3", "JERK_MAX", "pulses/s3", 1, 10**15, "ULL", pulses=True,
           parameter="jerk_max"),
    ] = 50_000.0  # fmt: skip
    limit_level: Annotated[
        Level, Is("Level of an active limit switch", macro="LIMIT_LEVEL", parameter="limit_high")
    ] = "high"
    alarm_level: Annotated[
        Level, Is("Level of the drive's alarm", macro="ALARM_LEVEL", parameter="alarm_high")
    ] = "high"
    origin_trigger: Annotated[
        Trigger, Is("Origin switch acts at", macro="ORIGIN_TRIGGER", parameter="origin_trigger")
    ] = "rising"
    home_order: Annotated[
        int,
        Is("Turn in which it goes home; 0 never", "", "HOME_ORDER", high=4, suffix="U",
           parameter="home_order"),
    ] = 1  # fmt: skip
    home_direction: Annotated[
        Literal["minus", "plus"],
        Is("Side on which its origin is", macro="HOME_DIRECTION", parameter="home_plus"),
    ] = "minus"
    home_speed: Annotated[float, _speed("Speed towards the origin", "HOME_SPEED")] = 20.0
    home_slow: Annotated[float, _speed("Speed of the exact approach", "HOME_SLOW")] = 1.0
    home_back: Annotated[
        float, _way("Way back off the switch", "HOME_BACK", "home_back", (1, HOME_MAX), "UL")
    ] = 2.0
    home_travel: Annotated[
        float,
        _way("Way in which the switch is found", "HOME_TRAVEL", "home_travel", (1, 2 * 10**9),
             "UL"),
    ] = 1000.0  # fmt: skip
    home_offset: Annotated[
        float,
        _way("From the origin to position 0", "HOME_OFFSET", "home_offset",
             (-HOME_MAX, HOME_MAX), "L"),
    ] = 0.0  # fmt: skip


class Pen(Table):
    """The pen lift: an output, or an axis, that raises and lowers the tool."""

    kind: Annotated[Literal["output", "axis"], Is("Moved by", macro="PEN_MOVER")] = "output"
    output: Annotated[int, Is("Its output", macro="PEN_OUTPUT", high=PINS - 1, suffix="U")] = 0
    up_level: Annotated[Level, Is("Level of the output, up", macro="PEN_UP_LEVEL")] = "low"
    dwell: Annotated[float, _time("Rest when it moves", "PEN_DWELL_US", "us", (0, 10**7), "")] = (
        0.03
    )
    axis: Annotated[Literal["X", "Y", "Z", "U"], Is("Its axis")] = "Z"
    up: Annotated[float, Is("Position of the axis, up", "mm", low=-(10**6), high=10**6)] = 2.0
    down: Annotated[float, Is("Position of the axis, down", "mm", low=-(10**6), high=10**6)] = 0.0


class CardMotion(Table):
    """How paths are planned and run."""

    period: Annotated[
        float, _time("DDA period", "DDA_PERIOD_NS", "ns", (250_000, 10**7), "period_ns")
    ] = 0.001
    tolerance: Annotated[float, Field(gt=0, le=10), Is("Largest deviation", "mm")] = 0.02
    feed: Annotated[float, Field(gt=0, le=10_000), Is("Speed with the tool down", "mm/s")] = 100.0
    rapid: Annotated[float, Field(gt=0, le=10_000), Is("Speed with the tool up", "mm/s")] = 200.0
    corner_angle: Annotated[
        float, Field(gt=0, le=180), Is("A turn above it is a corner", "deg")
    ] = 20.0
    reserve: Annotated[
        float, Field(ge=0, le=0.9), Is("Share of the acceleration kept for a pause")
    ] = 0.1
    pen: Pen = Pen()
    on_link_loss: Annotated[
        Literal["pause", "stop", "go_on"],
        Is("When the link is lost", macro="ON_LINK_LOSS", parameter="on_link_loss"),
    ] = "pause"
    must_home: Annotated[
        bool,
        Is("Start only when homed", macro="MUST_HOME", high=1, suffix="U", parameter="must_home"),
    ] = False


class Pulse(Table):
    """Shape of the pulses at the drives."""

    width: Annotated[
        float, _time("Time a pulse is high", "PULSE_WIDTH_NS", "ns", (20, 10**6), "pulse_width_ns")
    ] = 1e-6
    direction_setup: Annotated[
        float,
        _time("From a direction to a pulse", "DIR_SETUP_NS", "ns", (0, 10**6), "dir_setup_ns"),
    ] = 5e-6
    direction_hold: Annotated[
        float, _time("From a pulse to a direction", "DIR_HOLD_NS", "ns", (0, 10**6), "dir_hold_ns")
    ] = 5e-6


class Fifo(Table):
    """The FPGA's buffer."""

    depth: Annotated[
        int,
        Is("Frames of the FIFO", "", "FIFO_DEPTH", "frames", 16, 2304, "U",
           parameter="fifo_depth"),
    ] = 512  # fmt: skip


class Tasks(Table):
    """Priorities, 7 the most urgent; home has a second one while it works."""

    # A pause interrupts a run, a stop ends a pause; both end homing, which replaces a run.
    RULES = (
        ("run", "<", "home_active"),
        ("home_active", "<", "pause"),
        ("pause", "<", "stop"),
        ("stop", "<", "home"),
        ("home", "<", "storage"),
        ("storage", "<", "parser"),
    )
    parser: Annotated[int, _task("Packet parsing", "PARSER")] = 7
    storage: Annotated[int, _task("Storage management", "STORAGE")] = 6
    home: Annotated[int, _task("Home, waiting", "HOME")] = 5
    home_active: Annotated[int, _task("Home, at work", "HOME_ACTIVE")] = 2
    stop: Annotated[int, _task("Stop", "STOP")] = 4
    pause: Annotated[int, _task("Pause", "PAUSE")] = 3
    run: Annotated[int, _task("Run", "RUN")] = 1


class Input(Table):
    """A programmable input."""

    action: Annotated[Action, Is("Does", macro="ACTION", parameter="in_action")] = "none"
    edge: Annotated[
        Literal["rise", "fall", "both"], Is("At the edge", macro="EDGE", parameter="in_edge")
    ] = "rise"
    debounce: Annotated[
        float,
        _time("Deaf behind an edge", "DEBOUNCE_US", "us", (0, 10**6), "in_debounce_us"),
    ] = 0.01


Output = Annotated[str, Field(pattern=r"^([a-z][a-z0-9_]{0,30})?$"), Is("Name of the output")]
