"""A line of Grbl's G-code: what it says, and whether Grbl takes it.

Checks come in the order in which Grbl makes them, so that a line with two mistakes gets its number.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

from motionfmu.live.grbl.grbl_codes import GrblError, GrblRefusal

Point = tuple[float, float, float]
ORIGIN: Point = (0.0, 0.0, 0.0)
AXES = "XYZ"
INCH = 25.4  # [mm]
LINES_MAX = 10_000_000
TOOLS_MAX = 255
SYSTEMS = 6
DIGITS = 8
PLANES = {17: (0, 1), 18: (2, 0), 19: (1, 2)}
PROBES = ("38.2", "38.3", "38.4", "38.5")
SPINDLE = {3: "M3", 4: "M4", 5: "M5"}
# Codes by ten times their number, and the modal group of each.
_G = {
    **dict.fromkeys((40, 100, 280, 281, 300, 301, 530, 920, 921), "action"),
    **dict.fromkeys((0, 10, 20, 30, 382, 383, 384, 385, 800), "motion"),
    **dict.fromkeys((170, 180, 190), "plane"),
    **dict.fromkeys((900, 910), "distance"),
    911: "arc distance",
    **dict.fromkeys((930, 940), "feed mode"),
    **dict.fromkeys((200, 210), "units"),
    400: "cutter",
    **dict.fromkeys((431, 490), "length"),
    **dict.fromkeys((540, 550, 560, 570, 580, 590), "system"),
    610: "path",
}
_M = {
    **dict.fromkeys((0, 1, 2, 30), "flow"),
    **dict.fromkeys((3, 4, 5), "spindle"),
    **dict.fromkeys((7, 8, 9), "coolant"),
}
_WHOLE = {code // 10 for code in _G if code % 10 == 0}
# Whole numbers of which a fraction that is none of theirs is another code, not a wrong number.
_FRACTIONS = {28, 30, 38, 43, 61, 90, 91, 92}
_MOVES_AXES = {100, 280, 300, 920}
_VALUES = "FIJKLNPRSTXYZ"
_POSITIVE = "FNPTS"


@dataclass(frozen=True)
class GrblModes:
    """What is in force from line to line."""

    motion: str = "0"
    plane: int = 17
    units: int = 21
    distance: int = 90
    feed_mode: int = 94
    system: int = 54
    spindle: int = 5
    coolant: int = 0  # bit 0 mist, bit 1 flood
    tool: int = 0
    feed: float = 0.0  # [mm/min]; 0 before the first F
    speed: float = 0.0  # [rpm]
    length: float = 0.0  # of the tool [mm]

    @property
    def unit(self) -> float:
        """[mm] of a unit of length."""
        return INCH if self.units == 20 else 1.0


@dataclass(frozen=True)
class GrblState:
    """Modes, and the places that lines count from."""

    modes: GrblModes = field(default_factory=GrblModes)
    position: Point = ORIGIN  # where the last line ends, in the machine [mm]
    systems: tuple[Point, ...] = (ORIGIN,) * SYSTEMS  # origins of G54 to G59 [mm]
    shift: Point = ORIGIN  # of G92 [mm]
    homes: tuple[Point, Point] = (ORIGIN, ORIGIN)  # places of G28.1 and G30.1 [mm]

    @property
    def offset(self) -> Point:
        """Place in the machine where the work's coordinates are 0 [mm]."""
        origin = self.systems[self.modes.system - 54]
        x, y, z = (a + b for a, b in zip(origin, self.shift, strict=True))
        return (x, y, z + self.modes.length)


@dataclass
class GrblBlock:
    """A line that has been read and checked."""

    modes: GrblModes  # after it
    words: dict[str, float] = field(default_factory=dict)  # as written
    groups: set[str] = field(default_factory=set)  # modal groups that it has a code of
    action: int = 0  # ten times the G code that acts in this line alone
    flow: int | None = None  # M code: 0, 2, 30
    target: Point = ORIGIN  # where it ends, in the machine [mm]
    command: str = ""  # what uses its axis words: "action", "motion", "length"
    jog: bool = False
    _used: set[str] = field(default_factory=set)

    @property
    def axes(self) -> dict[int, float]:
        """Axis words, by index of the axis."""
        return {k: self.words[a] for k, a in enumerate(AXES) if a in self.words}

    @property
    def probes(self) -> bool:
        """Whether it is a G38."""
        return self.command == "motion" and self.modes.motion in PROBES

    @property
    def dwells(self) -> bool:
        """Whether it is a G4."""
        return self.action == 40


def refuse(error: GrblError, wrong: bool = True) -> None:
    """Refuse the line if something is wrong."""
    if wrong:
        raise GrblRefusal(error)


def number(text: str, at: int) -> tuple[float, int]:
    """The number that begins at a place of a text, and the place behind it."""
    end = at + (text[at : at + 1] in ("+", "-") and at < len(text))
    first, dot = end, False
    while end < len(text) and (text[end].isdigit() or (text[end] == "." and not dot)):
        dot = dot or text[end] == "."
        end += 1
    digits = text[first:end]
    refuse(GrblError.NUMBER, not digits.strip("."))
    whole, _, rest = digits.partition(".")
    kept = max(0, DIGITS - len(whole))
    value = float(f"{whole[:DIGITS] or '0'}.{rest[:kept] or '0'}")
    value *= 10.0 ** max(0, len(whole) - DIGITS)
    return (-value if text[at] == "-" else value), end


def read_block(text: str, state: GrblState) -> GrblBlock:
    """Read a line without spaces; ``$J=`` begins a jog."""
    jog = text.startswith("$J=")
    block = GrblBlock(state.modes, jog=jog)
    if jog:
        block.modes = replace(state.modes, motion="1", feed_mode=94)
    at = 3 if jog else 0
    while at < len(text):
        letter = text[at]
        refuse(GrblError.LETTER, not "A" <= letter <= "Z")
        value, at = number(text, at + 1)
        _word(block, letter, value)
    _check(block, state)
    return block


def _word(block: GrblBlock, letter: str, value: float) -> None:
    if letter == "G":
        _g_word(block, value)
    elif letter == "M":
        _m_word(block, value)
    else:
        refuse(GrblError.UNSUPPORTED, letter not in _VALUES)
        refuse(GrblError.TOOL, letter == "T" and value > TOOLS_MAX)
        refuse(GrblError.REPEATED, letter in block.words)
        refuse(GrblError.NEGATIVE, letter in _POSITIVE and value < 0)
        block.words[letter] = value


def _g_word(block: GrblBlock, value: float) -> None:
    whole = math.trunc(value)
    hundredths = round(100 * (value - whole))
    refuse(GrblError.UNSUPPORTED, value < 0 or whole not in _WHOLE | {38, 43})
    code = 490 if whole == 49 else 10 * whole + hundredths // 10
    known = code in _G and (whole == 49 or hundredths % 10 == 0)
    takes = known and (code in _MOVES_AXES or _G[code] == "length" or _moves(code))
    refuse(GrblError.AXIS_CONFLICT, takes and bool(block.command))
    refuse(GrblError.UNSUPPORTED, not known and whole in _FRACTIONS)
    refuse(GrblError.NOT_INTEGER, not known)
    group = _G[code]
    refuse(GrblError.GROUP, group in block.groups)
    block.groups.add(group)
    if takes:
        block.command = {"action": "action", "length": "length"}.get(group, "motion")
    _SETS.get(group, _nothing)(block, code)


def _moves(code: int) -> bool:
    return _G[code] == "motion" and code != 800


def _nothing(block: GrblBlock, code: int) -> None:
    """A code that changes nothing here."""


def _set_action(block: GrblBlock, code: int) -> None:
    block.action = code


def _set_motion(block: GrblBlock, code: int) -> None:
    name = str(code // 10) + (f".{code % 10}" if code % 10 else "")
    block.modes = replace(block.modes, motion=name)


def _set_length(block: GrblBlock, code: int) -> None:
    block._used.add("length off" if code == 490 else "length on")


def _set(name: str) -> Callable[[GrblBlock, int], None]:
    key = name.replace(" ", "_")

    def change(block: GrblBlock, code: int) -> None:
        block.modes = replace(block.modes, **{key: code // 10})  # type: ignore[arg-type]

    return change


_SETS: dict[str, Callable[[GrblBlock, int], None]] = {
    "action": _set_action,
    "motion": _set_motion,
    "length": _set_length,
    **{name: _set(name) for name in ("plane", "distance", "feed mode", "units", "system")},
}


def _m_word(block: GrblBlock, value: float) -> None:
    whole = math.trunc(value)
    refuse(GrblError.NOT_INTEGER, round(100 * (value - whole)) > 0)
    refuse(GrblError.UNSUPPORTED, value < 0 or whole not in _M)
    group = _M[whole]
    refuse(GrblError.GROUP, group in block.groups)
    block.groups.add(group)
    if group == "spindle":
        block.modes = replace(block.modes, spindle=whole)
    elif group == "coolant":
        coolant = 0 if whole == 9 else block.modes.coolant | (1 if whole == 7 else 2)
        block.modes = replace(block.modes, coolant=coolant)
    elif whole != 1:
        block.flow = whole


def _check(block: GrblBlock, state: GrblState) -> None:
    """Whether words and codes go together; where the line ends."""
    if block.axes and not block.command:
        block.command = "motion"
    refuse(GrblError.LINE_NUMBER, block.words.get("N", 0) > LINES_MAX)
    _check_feed(block, state)
    modes = block.modes
    block.modes = replace(
        modes,
        speed=block.words.get("S", modes.speed),
        tool=math.trunc(block.words.get("T", modes.tool)),
    )
    if block.dwells:
        refuse(GrblError.MISSING, "P" not in block.words)
        block._used.add("P")
    if block.command == "length" and "length on" in block._used:
        refuse(GrblError.LENGTH_AXIS, set(block.axes) != {2})
    if block.action == 100:
        _check_origin(block)
    refuse(GrblError.NO_AXES, block.action == 920 and not block.axes)
    block.target = _target(block, state)
    moves = block.modes.motion in ("0", "1")
    refuse(GrblError.G53, block.action == 530 and not moves)
    _check_motion(block, state)
    _check_rest(block)


def _check_feed(block: GrblBlock, state: GrblState) -> None:
    modes, given = block.modes, block.words.get("F")
    if block.jog:
        refuse(GrblError.NO_FEED, given is None)
    if modes.feed_mode == 93:
        cuts = block.command == "motion" and modes.motion not in ("80", "0")
        refuse(GrblError.NO_FEED, cuts and given is None)
        feed = given or 0.0
    elif given is not None:
        feed = given * modes.unit
    else:
        feed = modes.feed if state.modes.feed_mode == 94 else 0.0
    block.modes = replace(modes, feed=feed)


def _check_origin(block: GrblBlock) -> None:
    """G10: L2 gives an origin, L20 the coordinates of where the tool is."""
    words = block.words
    refuse(GrblError.NO_AXES, not block.axes)
    refuse(GrblError.MISSING, not {"P", "L"} & set(words))
    refuse(GrblError.SYSTEM, math.trunc(words.get("P", 0)) > SYSTEMS)
    kind = math.trunc(words.get("L", 0))
    refuse(GrblError.UNSUPPORTED, kind not in (2, 20) or (kind == 2 and "R" in words))
    block._used |= {"P", "L"}


def _target(block: GrblBlock, state: GrblState) -> Point:
    """Where axis words lead, in coordinates of the machine [mm]."""
    modes, target = block.modes, list(state.position)
    offset = replace(state, modes=modes).offset
    for axis, value in block.axes.items():
        way = value * modes.unit
        if block.action == 530:
            target[axis] = way
        elif modes.distance == 91:
            target[axis] += way
        else:
            target[axis] = way + offset[axis]
    x, y, z = target
    return (x, y, z)


def _check_motion(block: GrblBlock, state: GrblState) -> None:
    motion = block.modes.motion
    if motion == "80":
        refuse(GrblError.AXES_UNUSED, bool(block.axes))
        return
    if block.command != "motion":
        return
    if motion == "0":
        return
    refuse(GrblError.NO_FEED, block.modes.feed == 0.0)
    if motion == "1":
        refuse(GrblError.NO_AXES, block.jog and not block.axes)
        return
    refuse(GrblError.NO_AXES, not block.axes)
    if motion in PROBES:
        refuse(GrblError.TARGET, _same(block.target, state.position))
    else:
        _check_arc(block, state)


def _same(one: Point, other: Point) -> bool:
    return all(math.isclose(a, b, abs_tol=1e-9) for a, b in zip(one, other, strict=True))


def _check_arc(block: GrblBlock, state: GrblState) -> None:
    """An arc by its radius, or by its centre, which both ends must be as far from."""
    plane, unit = PLANES[block.modes.plane], block.modes.unit
    refuse(GrblError.NO_AXES_IN_PLANE, not set(plane) & set(block.axes))
    x, y = (block.target[a] - state.position[a] for a in plane)
    if "R" in block.words:
        block._used.add("R")
        refuse(GrblError.TARGET, _same(block.target, state.position))
        radius = block.words["R"] * unit
        refuse(GrblError.RADIUS, 4 * radius * radius - x * x - y * y < 0)
        return
    letters = ["IJK"[a] for a in plane]
    refuse(GrblError.NO_OFFSETS_IN_PLANE, not set(letters) & set(block.words))
    block._used |= set("IJK")
    i, j = (block.words.get(letter, 0.0) * unit for letter in letters)
    radius = math.hypot(i, j)
    off = abs(math.hypot(x - i, y - j) - radius)
    refuse(GrblError.TARGET, off > 0.5 or (off > 0.005 and off > 0.001 * radius))


def _check_rest(block: GrblBlock) -> None:
    """Words that nothing has used; what a jog may not have."""
    used = block._used | set("NF" if block.jog else "NFST")
    if block.command:
        used |= set(AXES)
    refuse(GrblError.UNUSED, bool(set(block.words) - used))
    if block.jog:
        refuse(GrblError.JOG, bool(block.groups - {"distance", "units", "action"}))
        refuse(GrblError.JOG, block.action not in (0, 530))


def after(block: GrblBlock, state: GrblState) -> GrblState:
    """The state behind a line; a jog moves the position alone."""
    if block.jog:
        return replace(state, position=block.target)
    modes = block.modes
    if "length off" in block._used:
        modes = replace(modes, length=0.0)
    elif "length on" in block._used:
        modes = replace(modes, length=block.words["Z"] * modes.unit)
    now = replace(state, modes=modes)
    if block.action == 100:
        now = _with_origin(block, now)
    elif block.action in (280, 300):
        now = replace(now, position=_home_of(block, now))
    elif block.action in (281, 301):
        first, second = now.homes
        homes = (now.position, second) if block.action == 281 else (first, now.position)
        now = replace(now, homes=homes)
    elif block.action == 920:
        now = replace(now, shift=_shift(block, now))
    elif block.action == 921:
        now = replace(now, shift=ORIGIN)
    if block.command == "motion":
        now = replace(now, position=block.target)
    return ended(now) if block.flow in (2, 30) else now


def _home_of(block: GrblBlock, state: GrblState) -> Point:
    """Where G28 or G30 ends [mm]: an axis that has no word beside others that have stays."""
    home = state.homes[0 if block.action == 280 else 1]
    named = block.axes or dict.fromkeys(range(3), 0.0)
    x, y, z = (home[a] if a in named else state.position[a] for a in range(3))
    return (x, y, z)


def _with_origin(block: GrblBlock, state: GrblState) -> GrblState:
    number = math.trunc(block.words.get("P", 0)) or state.modes.system - 53
    unit = state.modes.unit
    origin = list(state.systems[number - 1])
    length = (0.0, 0.0, state.modes.length)
    for axis, value in block.axes.items():
        origin[axis] = value * unit
        if block.words["L"] == 20:
            origin[axis] = state.position[axis] - state.shift[axis] - length[axis] - value * unit
    x, y, z = origin
    systems = list(state.systems)
    systems[number - 1] = (x, y, z)
    return replace(state, systems=tuple(systems))


def _shift(block: GrblBlock, state: GrblState) -> Point:
    origin, shift = state.systems[state.modes.system - 54], list(state.shift)
    length = (0.0, 0.0, state.modes.length)
    for axis, value in block.axes.items():
        way = value * state.modes.unit
        shift[axis] = state.position[axis] - origin[axis] - length[axis] - way
    x, y, z = shift
    return (x, y, z)


def ended(state: GrblState) -> GrblState:
    """The state behind M2 or M30."""
    modes = replace(
        state.modes,
        motion="1",
        plane=17,
        distance=90,
        feed_mode=94,
        system=54,
        spindle=5,
        coolant=0,
    )
    return replace(state, modes=modes)


def restarted(state: GrblState) -> GrblState:
    """The state behind a reset: origins and places of G28.1 and G30.1 are kept."""
    return replace(state, modes=GrblModes(), shift=ORIGIN)
