"""What Grbl tells: status reports, modes, offsets."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field

from motionfmu.live.grbl.grbl_block import INCH, SPINDLE, GrblModes, GrblState, Point
from motionfmu.live.grbl.grbl_settings import REPORT, GrblSettings

BLOCKS = 255  # commands that the machine may have before it; what a byte can tell
# Reports between two that have the field, the second while it moves.
OFFSETS_EVERY = 10, 30
OVERRIDES_EVERY = 10, 20
_BUSY = ("Home", "Run", "Hold", "Jog", "Door")


@dataclass(frozen=True)
class GrblFacts:
    """What a status report is made of."""

    state: str  # with its number behind a colon
    position: Point  # [mm]
    offset: Point  # where the work is 0, in the machine [mm]
    feed: float = 0.0  # [mm/min]
    speed: float = 0.0  # [rpm], negative for the other way round
    overrides: tuple[int, int, int] = (100, 100, 100)  # feed, rapid, spindle [%]
    coolant: int = 0
    blocks: int = BLOCKS
    room: int = 128
    pins: str = ""
    line: int = 0  # N of the line that moves; 0 none


@dataclass
class StatusReport:
    """Composes status reports, of which some have the offsets and some the overrides."""

    settings: GrblSettings
    _offsets_in: int = 0
    _overrides_in: int = 0
    _offset: Point | None = None
    _told: tuple[object, ...] = field(default=())

    def renew(self) -> None:
        """Tell offsets in the next report, overrides in the one behind it."""
        self._offsets_in = self._overrides_in = 0
        self._told = ()

    def text(self, facts: GrblFacts) -> str:
        """A report."""
        busy = facts.state.startswith(_BUSY)
        mask = int(self.settings.kept[REPORT])
        self._notice(facts)
        fields = [facts.state]
        machine = bool(mask & 1)
        place = zip(facts.position, facts.offset, strict=True)
        shown = facts.position if machine else [p - o for p, o in place]
        fields.append(f"{'MPos' if machine else 'WPos'}:{self._place(shown)}")
        if mask & 2:
            fields.append(f"Bf:{facts.blocks},{facts.room}")
        if facts.line:
            fields.append(f"Ln:{facts.line}")
        fields.append(f"FS:{self._rate(facts.feed)},{abs(facts.speed):.0f}")
        if facts.pins:
            fields.append(f"Pn:{facts.pins}")
        fields += self._now_and_then(facts, busy)
        return f"<{'|'.join(fields)}>\r\n"

    def _notice(self, facts: GrblFacts) -> None:
        """What has changed is told at once."""
        if facts.offset != self._offset:
            self._offset, self._offsets_in = facts.offset, 0
        told = facts.overrides, facts.coolant, facts.speed != 0, facts.speed < 0
        if told != self._told:
            self._told, self._overrides_in = told, 0

    def _now_and_then(self, facts: GrblFacts, busy: bool) -> Iterator[str]:
        if self._offsets_in > 0:
            self._offsets_in -= 1
        else:
            self._offsets_in = OFFSETS_EVERY[busy] - 1
            self._overrides_in = self._overrides_in or 1
            yield f"WCO:{self._place(facts.offset)}"
        if self._overrides_in > 0:
            self._overrides_in -= 1
            return
        self._overrides_in = OVERRIDES_EVERY[busy] - 1
        yield "Ov:{},{},{}".format(*facts.overrides)
        on = ("S" if facts.speed > 0 else "C") if facts.speed else ""
        on += ("F" if facts.coolant & 2 else "") + ("M" if facts.coolant & 1 else "")
        if on:
            yield f"A:{on}"

    def _place(self, place: Sequence[float]) -> str:
        return placed(place, self.settings.inches)

    def _rate(self, feed: float) -> str:
        return f"{feed / INCH:.1f}" if self.settings.inches else f"{feed:.0f}"


def placed(place: Sequence[float], inches: bool) -> str:
    """Coordinates [mm] as Grbl writes them."""
    digits, unit = (4, INCH) if inches else (3, 1.0)
    return ",".join(f"{round(a / unit, digits) + 0.0:.{digits}f}" for a in place)


def modes_line(modes: GrblModes, inches: bool) -> str:
    """What ``$G`` shows."""
    words = [f"G{modes.motion}", f"G{modes.system}", f"G{modes.plane}", f"G{modes.units}"]
    words += [f"G{modes.distance}", f"G{modes.feed_mode}", SPINDLE[modes.spindle]]
    coolant = [name for bit, name in ((1, "M7"), (2, "M8")) if modes.coolant & bit]
    words += coolant or ["M9"]
    feed = f"{modes.feed / INCH:.1f}" if inches else f"{modes.feed:.0f}"
    words += [f"T{modes.tool}", f"F{feed}", f"S{modes.speed:.0f}"]
    return f"[GC:{' '.join(words)}]\r\n"


def offset_lines(state: GrblState, probed: str, inches: bool) -> Iterator[str]:
    """What ``$#`` shows."""
    names = [*(f"G{54 + k}" for k in range(len(state.systems))), "G28", "G30", "G92"]
    places = [*state.systems, *state.homes, state.shift]
    for name, place in zip(names, places, strict=True):
        yield f"[{name}:{placed(place, inches)}]\r\n"
    yield f"[TLO:{placed([state.modes.length], inches)}]\r\n"
    yield probed


def probe_line(place: Point, found: bool, inches: bool) -> str:
    """Where a probe has touched, or ended without."""
    return f"[PRB:{placed(place, inches)}:{int(found)}]\r\n"
