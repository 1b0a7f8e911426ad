"""From the program's coordinates to the machine's and back.

machine = origin + tool + T (shift + R (S (program)))
S scaling (G51), R rotation (G68), shift of G52 and G92, T turn of the system (G10 L2 R), origin of
the system (G54 ..), tool length (G43).
"""

import math

from second.parameters import Wrong
from second.state import AXES, State
from second.words import Words

Vector = list[float]


def plane_axes(plane: int) -> tuple[int, int]:
    """First and second axis of a plane by its normal."""
    return (plane + 1) % 3, (plane + 2) % 3


def turned(p: Vector, axes: tuple[int, int], about: tuple[float, float], angle: float) -> Vector:
    """A point turned in a plane by an angle [deg]."""
    if angle == 0.0:
        return list(p)
    z = complex(p[axes[0]] - about[0], p[axes[1]] - about[1])
    z *= complex(math.cos(math.radians(angle)), math.sin(math.radians(angle)))
    out = list(p)
    out[axes[0]], out[axes[1]] = about[0] + z.real, about[1] + z.imag
    return out


def _scaled(s: State, p: Vector) -> Vector:
    return [
        s.scale_at[i] + s.scale[i] * (x - s.scale_at[i]) if i < 3 and s.scale[i] != 1.0 else x
        for i, x in enumerate(p)
    ]


def _about(s: State) -> tuple[tuple[int, int], tuple[float, float]]:
    """Axes and centre of the rotation; the centre is scaled, too."""
    axes = plane_axes(s.turn_plane)
    at = [0.0] * AXES
    at[axes[0]], at[axes[1]] = s.turn_at
    at = _scaled(s, at)
    return axes, (at[axes[0]], at[axes[1]])


def shift(s: State) -> Vector:
    """What G52 and G92 add, if it is in force."""
    return s.shift if s.shifted else [0.0] * AXES


def machine(s: State, program: Vector) -> Vector:
    """A point of the program in machine coordinates."""
    p = turned(_scaled(s, program), *_about(s), s.turn)
    p = [a + b for a, b in zip(p, shift(s), strict=True)]
    p = turned(p, (0, 1), (0.0, 0.0), s.turns[s.system])
    return [p[i] + s.origin[s.system][i] + s.length[i] for i in range(AXES)]


def program(s: State, point: Vector) -> Vector:
    """A point of the machine in the program's coordinates."""
    p = [point[i] - s.origin[s.system][i] - s.length[i] for i in range(AXES)]
    p = turned(p, (0, 1), (0.0, 0.0), -s.turns[s.system])
    p = turned([a - b for a, b in zip(p, shift(s), strict=True)], *_about(s), -s.turn)
    return [
        s.scale_at[i] + (x - s.scale_at[i]) / s.scale[i] if i < 3 else x for i, x in enumerate(p)
    ]


def here(s: State) -> Vector:
    """Where the program has led the tool: where the contour ended, until the tool leaves it."""
    if s.aside is None:
        return s.point
    ended, stands, plane = s.aside
    if any(s.point[i] != stands[i] for i in plane):
        s.aside = None
        return s.point
    return [ended[i] if i in plane else x for i, x in enumerate(s.point)]


def origin(s: State, w: Words) -> Vector:
    """The point that words count from; without any in its plane the tool stays beside a contour."""
    place = here(s)
    if s.aside is None or w.has("@^" + "".join("xyz"[i] for i in s.aside[2])):
        return place
    return s.point


def end_point(s: State, w: Words) -> Vector:
    """End of a motion by its axis words or polar ones, in the program's coordinates."""
    return end_from(s, w, program(s, origin(s, w)))


def end_from(s: State, w: Words, now: Vector) -> Vector:
    """The same from any point."""
    end = list(now)
    polar = w.use("@^")
    if polar:
        if w.has("xy"):
            raise Wrong("polar words beside X, Y")
        z = complex(now[0], now[1])
        radius, angle = abs(z), math.degrees(math.atan2(z.imag, z.real))
        if radius == 0.0 and (s.incremental or "^" not in polar):
            raise Wrong("polar words from the pole")
        if "@" in polar:
            radius = polar["@"] * s.unit + (radius if s.incremental else 0.0)
        if "^" in polar:
            angle = polar["^"] + (angle if s.incremental else 0.0)
        end[0], end[1] = (
            radius * math.cos(math.radians(angle)),
            radius * math.sin(math.radians(angle)),
        )
    words = w.use(w.axes)
    if s.polar and w.code.get("other", 40) == 40:
        words = _polar_mode(s, w, words, now, end)
    for i, letter in enumerate(w.axes):
        if letter in words:
            value = words[letter] * (1.0 if letter in "abc" else s.unit)
            end[i] = now[i] + value if s.incremental else value
    return end


def _polar_mode(
    s: State, w: Words, words: dict[str, float], now: Vector, end: Vector
) -> dict[str, float]:
    """G16: radius and angle from the plane's words, into `end`; the words that are left."""
    a, b = plane_axes(s.plane)
    radius, angle = words.get("xyz"[a]), words.get("xyz"[b])
    if radius is None and angle is None:
        return words
    if not s.incremental:
        s.pole = (0.0, 0.0)
    elif radius is not None:
        s.pole = (now[a], now[b])
    if radius is not None:
        s.polar_radius = radius * s.unit
    if angle is not None:
        s.polar_angle = angle + (s.polar_angle if s.incremental else 0.0)
    end[a] = s.pole[0] + s.polar_radius * math.cos(math.radians(s.polar_angle))
    end[b] = s.pole[1] + s.polar_radius * math.sin(math.radians(s.polar_angle))
    return {c: v for c, v in words.items() if c not in ("xyz"[a], "xyz"[b])}
