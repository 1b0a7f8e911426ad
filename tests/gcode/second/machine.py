"""What a line says to the machine beside its axes: spindle, outputs, overrides, inputs, probe."""

from second.frames import end_point, machine, program
from second.moves import straight
from second.parameters import Wrong
from second.state import AXES, State, Step
from second.words import Words

BITS, ANALOG = 32, 4
DAY = 86400.0
FEED, SPEED, ADAPTIVE, HOLD = 1, 2, 4, 8  # bits of overrides: fixed, fixed, acts, is off
METRE, FOOT = 1000.0, 304.8  # [mm] of S in G96
# Code of M: bits that it sets, bits that it clears; P0 does the opposite where there is a P.
OVERRIDES = {48: (0, FEED | SPEED), 49: (FEED | SPEED, 0), 50: (0, FEED), 51: (0, SPEED)} | {
    52: (ADAPTIVE, 0),
    53: (0, HOLD),
}


def surface(s: State) -> tuple[float, float]:
    """Speed along the work that G96 asks for and X of the axis it turns about."""
    if not s.by_radius or s.rpm == 0.0:
        return (0.0, 0.0)
    return (s.passing, machine(s, [0.0] * AXES)[0])


def outputs(s: State, on: int = 0, off: int = 0, analog: dict[int, float] | None = None) -> None:
    """Everything that is switched as it is to be from here on."""
    step = Step("outputs", s.line, tuple(s.point), tuple(s.point), set=on, clear=off)
    step.spindle, step.coolant, step.overrides = s.rpm, s.coolant, s.overrides
    step.surface = s.told = surface(s)
    step.analog = analog or {}
    s.steps.append(step)


def _speed(s: State, w: Words) -> None:
    mode, speed = w.code.get("spindle mode"), w.one("s")
    if mode == 960:
        most = w.one("d")
        if speed is None or most is None or most <= 0.0:
            raise Wrong("G96 without S or D")
        s.by_radius, s.most = True, most
    elif mode == 970:
        s.by_radius = False
    if speed is None:
        return
    if speed < 0.0:
        raise Wrong("speed")
    if s.by_radius:
        s.passing = speed * (FOOT if s.inch else METRE) / 60.0
    else:
        s.speed = speed


def _orient(w: Words) -> None:
    for letter, most in (("r", 360.0), ("p", 2.0), ("q", DAY)):
        value = w.one(letter)
        if value is not None and not 0.0 <= value <= most:
            raise Wrong("M19")


def _override(s: State, w: Words) -> None:
    code = w.code["overrides"]
    on, off = OVERRIDES[code]
    if code >= 50:
        p = w.one("p")
        if p not in (None, 0.0, 1.0):
            raise Wrong("P of an override")
        if p == 0.0:
            on, off = off, on
    s.overrides = (s.overrides | on) & ~off


def switches(s: State, w: Words) -> None:
    """S, M3 to M9, M19, M48 to M53, M62 to M65, M67, M68."""
    before = s.rpm, s.coolant, s.overrides
    on = off = 0
    analog: dict[int, float] = {}
    _speed(s, w)
    io = w.code.get("io")
    if io in (62, 63, 64, 65):
        bit = 1 << w.whole("p", 0, BITS - 1)
        high = io in (62, 64)
        if io >= 64:
            on, off = (bit, 0) if high else (0, bit)
        else:
            s.set = s.set | bit if high else s.set & ~bit
            s.clear = s.clear & ~bit if high else s.clear | bit
    elif io in (67, 68):
        place, value = w.whole("e", 0, ANALOG - 1), w.one("q")
        if value is None:
            raise Wrong("analog output without Q")
        (s.analog if io == 67 else analog)[place] = value
    if "turning" in w.code:
        code = w.code["turning"]
        s.turning = {3: 1, 4: -1}.get(code, 0)
        if code == 19:
            _orient(w)
    if "coolant" in w.code:
        s.coolant = {7: s.coolant | 1, 8: s.coolant | 2, 9: 0}[w.code["coolant"]]
    if "overrides" in w.code:
        _override(s, w)
    changed = before != (s.rpm, s.coolant, s.overrides) or surface(s) != s.told
    if on or off or analog or changed:
        outputs(s, on, off, analog)


# What M70 keeps.
SAVED = (
    "inch plane incremental feed_mode feed system length old_plane by_radius passing most speed "
    "absolute_centre turning coolant overrides side"
).split()


def saving(s: State, code: int) -> None:
    """M70 to M73."""
    if code == 71:
        s.saved[-1] = {}
    elif code == 72:
        restore(s, s.saved[-1])
    else:
        kept = {name: getattr(s, name) for name in SAVED} | {"length": list(s.length)}
        s.saved[-1] = kept | {"returns": code == 73 and len(s.saved) > 1}


def restore(s: State, kept: dict[str, object]) -> None:
    """Bring modes into force again; what cuts a contour or is turned bears no other frame."""
    if not kept:
        raise Wrong("M72 without M70")
    moved = kept["plane"] != s.plane or kept["system"] != s.system
    if kept["side"] != s.side or ((s.scaled or s.rotated) and moved):
        raise Wrong("M72 cannot restore this")
    if s.edge and (moved or kept["length"] != s.length):
        raise Wrong("M72 within a contour")
    before = s.rpm, s.coolant, s.overrides
    for name in SAVED:
        setattr(s, name, kept[name])
    s.length = list(s.length)
    if before != (s.rpm, s.coolant, s.overrides) or surface(s) != s.told:
        outputs(s)


def wait(s: State, w: Words) -> None:
    """M66, to which a program without a machine gets 0 for an answer."""
    if s.edge:
        raise Wrong("M66 within a contour")
    place, level = w.use("pe"), w.one("l")
    limit = w.one("q")
    if len(place) != 1:
        raise Wrong("M66 of no input or of two")
    digital = "p" in place
    w.whole("p" if digital else "e", 0, BITS - 1 if digital else ANALOG - 1)
    if level is not None and level not in ((0, 1, 2, 3, 4) if digital else (0,)):
        raise Wrong("L of M66")
    if level and not (limit is not None and 0.0 < limit <= DAY):
        raise Wrong("Q of M66")
    s.answer = 0.0


def probe(s: State, w: Words) -> None:
    """G38.2 to G38.5: without a machine the line goes to its end."""
    if s.edge or w.code.get("io") == 66:
        raise Wrong("probing beside M66 or within a contour")
    if not w.has(w.axes):
        raise Wrong("probing without axes")
    made = len(s.steps)
    straight(s, machine(s, end_point(s, w)), False)
    if len(s.steps) == made:
        if s.motion in (382, 384):
            raise Wrong("probing leads nowhere")
    else:
        s.steps[-1].probes = True
    s.touched = 0.0
    s.contact = program(s, s.point)
    s.motion = -1
