"""The lengths of an arm that a moving picture draws: named, or its component's parameters."""

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from motionfmu.base import units
from motionfmu.scenarios.system import Resolver

LENGTHS = ("a1", "a2", "b", "c1", "c2", "c3", "c4")
OFFSETS, SIGNS, PEN = "joint_offset", "joint_sign", "tool_length"
BY, ORIGIN, DIRECTION = "arm_by", "axis_origin", "axis_direction"
COUNT, SLIDES, LEVEL, HAND = "joints", "joint_slides", "joint_level", "hand_offset"
PALLETIZED = 3  # place of the joint that is on a hand

Three = tuple[float, ...]


@dataclass(frozen=True)
class Arm:
    """An arm with parallel axes 2 and 3 and a spherical wrist, or of any axes."""

    # a1, a2, b, c1, c2, c3, c4 of Brandstoetter, Angerer and Hofbaur 2014 [mm]
    lengths: tuple[float, ...]
    offsets: tuple[float, ...] = (0.0,) * 6  # th = sign q - offset [rad]
    signs: tuple[float, ...] = (1.0,) * 6
    pen: float = 0.0  # length of the tool along z of the flange [mm]
    # Instead of lengths, with all joints 0: origin of each from the one before [mm], its axis,
    # whether it slides; how many joints before it do not tilt its link, where it is on a hand [mm]
    axes: tuple[tuple[Three, Three, bool, int, Three], ...] = ()


def arm_of(
    resolver: Resolver, parameter: Callable[[str], Sequence[float]], joints: str
) -> Arm | None:
    """The arm's lengths: of [view], or parameters of the component that shows the joint angles."""
    view = resolver.document.body.view
    if view.lengths is not None:
        lengths = tuple(1e3 * x for x in view.lengths)
        return Arm(lengths, tuple(view.offsets), tuple(view.signs), 1e3 * view.pen)
    component = joints.partition(".")[0]
    ports = resolver.ports[component]
    if ORIGIN in ports and (BY not in ports or parameter(f"{component}.{BY}")[0] == 1):
        level = LEVEL in ports
        return Arm((), axes=axes_in_mm(lambda name: parameter(f"{component}.{name}"), level))
    if not all(n in ports and ports[n].causality == "parameter" for n in LENGTHS):
        return None

    def told(name: str, usual: tuple[float, ...]) -> tuple[float, ...]:
        if name not in ports or ports[name].count != len(usual):
            return usual
        to_si = units.parse(ports[name].unit or "1").factor
        return tuple(to_si * float(x) for x in parameter(f"{component}.{name}"))

    lengths = tuple(1e3 * float(parameter(f"{component}.{n}")[0]) for n in LENGTHS)
    offsets, signs = told(OFFSETS, (0.0,) * 6), told(SIGNS, (1.0,) * 6)
    return Arm(lengths, offsets, signs, 1e3 * told(PEN, (0.0,))[0])


def axes_in_mm(
    parameter: Callable[[str], Sequence[float]], level: bool = True
) -> tuple[tuple[Three, Three, bool, int, Three], ...]:
    """Rows of `Arm.axes` of parameters in m: origins in mm, directions of length 1.

    Without level its component has no levels and no hand.
    """
    count = int(parameter(COUNT)[0])

    def rows(name: str, factor: float) -> list[Three]:
        numbers = parameter(name)
        return [
            tuple(factor * float(x) for x in numbers[k : k + 3]) for k in range(0, 3 * count, 3)
        ]

    units = [tuple(x / math.hypot(*d) for x in d) for d in rows(DIRECTION, 1.0)]
    slides = [bool(s) for s in parameter(SLIDES)[:count]]
    levels = [int(n) for n in parameter(LEVEL)[:count]] if level else [0] * count
    held = tuple(1e3 * float(x) for x in parameter(HAND)) if level else (0.0,) * 3
    hands = [held if k == PALLETIZED else (0.0,) * 3 for k in range(count)]
    return tuple(zip(rows(ORIGIN, 1e3), units, slides, levels, hands, strict=True))
