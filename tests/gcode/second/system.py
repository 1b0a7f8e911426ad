"""Parameters that the machine keeps: positions, offsets, modes."""

from second.frames import here, program
from second.machine import ADAPTIVE, FEED, HOLD, SPEED
from second.state import State

ORIGINS, PER_SYSTEM = 5221, 20
PLACES = {5161: 0, 5181: 1}
NAMES = "xyzabcuvw"


def _axis(s: State, place: int) -> int | None:
    """Axis of the n-th of the nine coordinates, if the machine has it."""
    letter = NAMES[place]
    axes = "xyzabc" if s.options.angles else "xyzuvw"
    return axes.index(letter) if letter in axes else None


def _length(s: State, i: int, value: float) -> float:
    """A coordinate in the program's unit."""
    return value if s.options.angles and i >= 3 else value / s.unit


def numbered(s: State, number: int) -> float | None:
    """Value of a parameter that is kept by the machine."""
    tables: list[tuple[int, list[float]]] = [
        *((base, s.home[which]) for base, which in PLACES.items()),
        *((ORIGINS + PER_SYSTEM * n, s.origin[n]) for n in range(9)),
    ]
    for base, values in tables:
        if base <= number < base + 9:
            i = _axis(s, number - base)
            return 0.0 if i is None else values[i]
    if s.options.fanuc:
        place, i = divmod(number - (14001 if number > 14000 else 7001), 20)
        if 0 <= place < (99 if number > 14000 else 48) and i < 6:
            return s.origin[9 + place][i]
        if number in (*range(5001, 5007), *range(5041, 5047)):
            i = (number - 1) % 20
            return _length(s, i, program(s, here(s))[i])
    if number == 5220:
        return s.system + 1.0
    if 5420 <= number <= 5428:
        i = _axis(s, number - 5420)
        return 0.0 if i is None else _length(s, i, program(s, here(s))[i])
    if 5061 <= number <= 5069:
        i = _axis(s, number - 5061)
        return 0.0 if i is None else s.contact[i]
    if number == 5070:
        return s.touched
    if number == 5599:
        return s.debug
    if number == 5399:
        return s.answer
    if number == 5400:
        return float(s.tool)
    return None


def named(s: State, name: str) -> float | None:
    """Value of a name that the machine gives."""
    if name[1:] in tuple(NAMES) and name[0] == "_":
        return numbered(s, 5420 + NAMES.index(name[1:]))
    if name.startswith("_abs_") and name[5:] in tuple(NAMES):
        i = _axis(s, NAMES.index(name[5:]))
        return 0.0 if i is None else _length(s, i, here(s)[i])
    simple = {
        "_line": float(s.line),
        "_plane": {2: 170.0, 1: 180.0, 0: 190.0}[s.plane],
        "_metric": float(not s.inch),
        "_imperial": float(s.inch),
        "_absolute": float(not s.incremental),
        "_incremental": float(s.incremental),
        "_feed": s.feed / s.unit * {940: 60.0, 950: 1.0, 930: 0.0}[s.feed_mode],
        "_ccomp": {0: 400.0, 1: 410.0, -1: 420.0}[s.side],
        "_inverse_time": float(s.feed_mode == 930),
        "_units_per_minute": float(s.feed_mode == 940),
        "_units_per_rev": float(s.feed_mode == 950),
        "_tool_offset": float(any(s.length)),
        "_spindle_rpm_mode": float(not s.by_radius),
        "_spindle_css_mode": float(s.by_radius),
        "_ijk_absolute_mode": float(s.absolute_centre),
        "_feed_override": float(not s.overrides & FEED),
        "_speed_override": float(not s.overrides & SPEED),
        "_adaptive_feed": float(s.overrides & ADAPTIVE != 0),
        "_feed_hold": float(not s.overrides & HOLD),
        "_task": 1.0,
        "_call_level": len(s.parameters.locals) - 1.0,
        "_rpm": s.speed,
        "_motion_mode": 800.0 if s.motion < 0 else float(s.motion),
        "_spindle_on": float(s.turning != 0),
        "_spindle_cw": float(s.turning > 0),
        "_mist": float(s.coolant & 1 != 0),
        "_flood": float(s.coolant & 2 != 0),
        "_current_tool": float(s.tool),
        "_selected_tool": float(s.selected if s.chosen else -1),
        "_coord_system": (
            540.0 + 10.0 * s.system if s.system < 6 else 585.0 + s.system if s.system < 9 else 541.0
        ),
        **dict.fromkeys(("_lathe_diameter_mode", "_lathe_radius_mode", "_remap_level"), 0.0),
        "_vmajor": 2.9,
        "_vminor": 0.0,
        "_retract_old_z": float(s.old_plane),
        "_retract_r_plane": float(not s.old_plane),
    }
    return simple.get(name)


def keep(s: State, number: int, value: float) -> bool:
    """Set one of those that a program may set; whether it is one."""
    if number == 5599:
        s.debug = value
    elif number == 5070:
        s.touched = value
    elif 5061 <= number <= 5069:
        if (i := _axis(s, number - 5061)) is not None:
            s.contact[i] = value
    else:
        return False
    return True


def connect(s: State) -> None:
    """Give a state's parameters what the machine keeps."""
    p = s.parameters
    p.globals |= {"_value": 0.0, "_value_returned": 0.0}
    p.kept = lambda number, value: keep(s, number, value)
    p.system = lambda name: named(s, name) if isinstance(name, str) else numbered(s, name)
