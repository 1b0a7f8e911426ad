"""G10, G52, G92, G28, G30, G51, G68: where the program's coordinates lie."""

from second.frames import end_point, here, machine, plane_axes, program
from second.moves import straight
from second.parameters import Wrong
from second.state import AXES, State
from second.words import Words


def _given(s: State, w: Words) -> dict[int, float]:
    """Axis words by axis. [mm], [deg]"""
    found = w.use(w.axes)
    return {
        i: found[c] * (1.0 if c in "abc" else s.unit) for i, c in enumerate(w.axes) if c in found
    }


def _table(s: State, w: Words, values: dict[int, float]) -> None:
    """G10: tools and origins."""
    kind = w.whole("l", 1, 20)
    if kind == 1:
        number = w.whole("p", 1, 99999)
        length, diameter = s.options.tools.get(number, (0.0, 0.0))
        radius = w.one("r")
        if radius is not None:
            diameter = 2.0 * radius * s.unit
        s.options.tools[number] = (values.get(2, length), diameter)
        return
    if kind not in (2, 20):
        raise Wrong("L")
    more = s.options.fanuc and kind == 20  # there it is an origin of G54.1
    p = 9 + w.whole("p", 1, 99) if more else w.whole("p", 0, 9)
    kind = 2 if more else kind
    system = p - 1 if p else s.system
    r = w.one("r") if kind == 2 and not more else None
    if not values and r is None:
        raise Wrong("G10 without axes")
    if r is not None:
        s.turns[system] = r
    force, s.system = s.system, system
    if kind == 20:
        # The origin moves by what the place lacks of the coordinates that are asked for.
        now = program(s, here(s))
        place = machine(s, [values.get(i, x) for i, x in enumerate(now)])
    for i, value in values.items():
        s.origin[system][i] = value if kind == 2 else s.origin[system][i] + here(s)[i] - place[i]
    s.system = force


def _framed(s: State) -> bool:
    return s.scaled or s.rotated


def _measures(w: Words) -> bool:
    """G10 of a tool."""
    return w.code.get("other") == 100 and w.value.get("l") in (1.0, 10.0, 11.0)


def change(s: State, w: Words) -> None:
    """Everything that moves the program's zero, turns or scales it."""
    code = w.code.get("other")
    values = _given(s, w) if code in (100, 520, 920) else {}
    if code is not None and code != 40 and code != 530 and _framed(s) and not _measures(w):
        raise Wrong("offsets where the program is scaled or turned")
    if code == 100:
        _table(s, w, values)
    elif code in (520, 920):
        if not values:
            raise Wrong("G52 or G92 without axes")
        if not s.shifted:
            s.shift = [0.0] * AXES
        s.shifted = False
        now = program(s, here(s))
        s.shifted = True
        for i, value in values.items():
            s.shift[i] = value if code == 520 else now[i] - value
    elif code == 921:
        s.shift, s.shifted = [0.0] * AXES, False
    elif code in (922, 923):
        s.shifted = code == 923
    if w.code.get("turn") == 690:
        _turn(s, w)
    if "scale" in w.code:
        _scale(s, w)
    if w.code.get("turn") == 680:
        _turn(s, w)


def _scale(s: State, w: Words) -> None:
    if s.rotated:
        raise Wrong("scaling behind the rotation")
    if w.code["scale"] == 500:
        s.scale, s.scaled = [1.0] * 3, False
        return
    s.scaled = True
    now = program(s, here(s))
    values = _given(s, w)
    s.scale_at = [values.get(i, now[i]) for i in range(3)]
    p = w.one("p")
    ijk = w.use("ijk")
    if (p is None) == (not ijk) or p == 0.0 or 0.0 in ijk.values():
        raise Wrong("G51 without factor")
    least = {c: 1e-3 if s.options.fanuc and c in w.whole_numbers else 1.0 for c in "pijk"}
    s.scale = [ijk.get(c, 1.0 / least[c]) * least[c] for c in "ijk"]
    if p is not None:
        s.scale = [p * least["p"]] * 3


def _turn(s: State, w: Words) -> None:
    if w.code["turn"] == 690:
        s.turn, s.rotated = 0.0, False
        return
    r = w.one("r")
    if r is None:
        raise Wrong("G68 without R")
    now = program(s, here(s))
    values = _given(s, w)
    a, b = plane_axes(s.plane)
    s.turn_at = (values.get(a, now[a]), values.get(b, now[b]))
    s.turn, s.turn_plane, s.rotated = r, s.plane, True


def predefined(s: State, w: Words) -> None:
    """G28, G30: by way of a point to a place kept; G28.1, G30.1 keep it."""
    code = w.code["other"]
    kept = s.home[code >= 300]
    if code in (281, 301):
        kept[:] = here(s)
        return
    named = w.use(w.axes)
    straight(s, machine(s, end_point(s, w)), True)
    end = list(s.point)
    for i, letter in enumerate(w.axes):
        if not named or letter in named:
            end[i] = kept[i]
    straight(s, end, True)
