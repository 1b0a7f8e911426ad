"""Names that numbers of a contour analysis can have, whether or not a run has them."""

from dataclasses import fields
from typing import Any, get_type_hints

from motionfmu.analysis.contour.kinds import AXES, BothWays, CircleFigures, Corner, Statistics
from motionfmu.base.errors import suggestion

NUMBER = (int, float)


def _of(kind: type, *more: str) -> dict[str, Any]:
    """Numbers among the fields of a dataclass."""
    hints = get_type_hints(kind)
    return dict.fromkeys([f.name for f in fields(kind) if hints[f.name] in NUMBER] + list(more))


def _tree() -> dict[str, Any]:
    """Names of `ContourResult.numbers` as a tree: None is a number, [x] a list of x."""
    way = _of(CircleFigures, "coverage", "speed", "samples") | {"lines": [None]}
    circle = {"centre": [None], "normal": [None], "radius": None, "ccw": way, "cw": way}
    command = dict.fromkeys(("command", "line", "length", "max", "rms", "time"))
    return {
        **dict.fromkeys(("samples", "samples_cutting", "lag", "window")),
        "error": _of(Statistics, "signed_min", "signed_max"),
        "command_error": _of(Statistics),
        "following": {axis: dict.fromkeys(("max", "rms")) for axis in AXES},
        "circles": [circle | {"both": _of(BothWays)}],
        "corners": [_of(Corner)],
        "commands": [command],
    }


# By the last part of a name that is no index; everything else is a length [mm].
UNITS = {
    **dict.fromkeys(("lag", "window", "time"), "s"),
    **dict.fromkeys(("coverage", "orientation", "angle"), "rad"),
    "speed": "mm/s",
    **dict.fromkeys(("samples", "samples_cutting", "line", "lines", "command", "normal"), ""),
    **dict.fromkeys(("line_before", "line_after"), ""),
}


def unit(name: str) -> str:
    """Unit of a contour number by its name, as FMI spells it; empty for a bare number."""
    last = next((p for p in reversed(name.split(".")) if not p.isdecimal()), "")
    return UNITS.get(last, "mm")


def wrong(name: str) -> str:
    """Why no run can have a number of this name, as in `ContourResult.number`; empty if one can."""
    here: Any = _tree()
    for part in name.split("."):
        if isinstance(here, list) and part.isdecimal():
            here = here[0]
        elif isinstance(here, dict) and part in here:
            here = here[part]
        else:
            there = ", ".join(here) if isinstance(here, dict) else "a number, from 0"
            there = "nothing" if here is None else there
            hint = suggestion(part, here if isinstance(here, dict) else ())
            return f"no contour number {name!r}: no {part!r}, there is {there}{hint}"
    return "" if here is None else f"contour number {name!r} is not a number but several"
