"""All figures of an evaluation by name, and the names that figures can have."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import numpy as np

from motionfmu.analysis.iso9283.performance import Performance
from motionfmu.analysis.iso9283.pose import PoseResult
from motionfmu.base.errors import NoNumber, suggestion

ANGLES = "abc"
SHAPES = ("straightness", "straightness_in_plane", "in_plane", "height")
STROKES = ("lines", "band", "gap", "common")
CYCLE = ("start", "end", "largest", "speed", *SHAPES)
POSE = ("AP_P", "AP_x", "AP_y", "AP_z", "RP_l", *(f"{w}_{a}" for w in ("AP", "RP") for a in ANGLES))
# Figures by name: a tuple names those of a group, a list has one group for each item.
TREE: dict[str, Any] = {
    **dict.fromkeys(("n", "planes", "speed"), ()),
    "excluded": ("start", "end"),
    **dict.fromkeys(("AT_P", "RT_P"), ()),
    **dict.fromkeys((f"{w}_{a}" for w in ("AT", "RT") for a in ANGLES), ()),
    **dict.fromkeys(("AV", "RV", "FV", *SHAPES), ()),
    "coincidence": STROKES,
    "places": ("AT_P", "RT_P"),
    "cycles": [CYCLE],
    "poses": [POSE],
}
SINGLE = "there is one cycle only: repeatability needs two"
SPEED = "no speed is stated"
TURN = "path and tool need an orientation"
STRAIGHT = "the path is not straight"
SURFACE = "the path runs along the normal of the surface"


@dataclass(frozen=True)
class Evaluation:
    """What a run gave after ISO 9283.

    Attributes
    ----------
    path : Performance
    poses : tuple of PoseResult
    """

    path: Performance
    poses: tuple[PoseResult, ...] = ()

    def numbers(self) -> dict[str, Any]:
        """Every figure, ready for JSON; AV and RV in percent."""
        # A figure that this run does not have is None.
        path = self.path
        found: dict[str, Any] = {
            "units": {"length": "mm", "time": "s", "angle": "deg", "speed": "mm/s", "AV, RV": "%"},
            "n": len(path.given.cycles),
            "planes": len(path.along),
            "excluded": dict(zip(("start", "end"), path.excluded, strict=True)),
        }
        found |= self._accuracy() | self._speed()
        found |= dict.fromkeys(SHAPES)
        found |= {k: float(v.max()) for k, v in path.shapes().items()}
        strokes = path.strokes
        found["coincidence"] = {
            k: None if strokes is None else getattr(strokes, k) for k in STROKES
        }
        found["cycles"] = [dict.fromkeys(CYCLE) | row for row in path.cycle_numbers()]
        found["poses"] = [_pose(p) for p in self.poses]
        return found

    def _accuracy(self) -> dict[str, Any]:
        path = self.path
        worst = int(np.argmax(path.accuracy))
        found: dict[str, Any] = {"AT_P": float(path.accuracy[worst]), "RT_P": None}
        places: dict[str, Any] = {"AT_P": float(path.along[worst]), "RT_P": None}
        if path.repeatability is not None:
            worst = int(np.argmax(path.repeatability))
            found["RT_P"] = float(path.repeatability[worst])
            places["RT_P"] = float(path.along[worst])
        for i, name in enumerate(ANGLES):
            angle = None if path.angle is None else path.angle[:, :, i]
            found[f"AT_{name}"] = None if angle is None else float(np.abs(angle.mean(axis=0)).max())
            several = angle is not None and len(angle) > 1
            found[f"RT_{name}"] = (
                float(3.0 * angle.std(axis=0, ddof=1).max())
                if angle is not None and several
                else None
            )
        return found | {"places": places}

    def _speed(self) -> dict[str, Any]:
        """Velocity accuracy, repeatability and fluctuation (ISO 9283:1998, 9)."""
        means = self.path.mean_speeds
        found: dict[str, Any] = {"speed": float(means.mean()), "AV": None, "RV": None}
        found["FV"] = float(max(np.ptp(v) for v in self.path.speeds))
        if command := self.path.given.speed:
            found["AV"] = 100.0 * (float(means.mean()) - command) / command
            if len(means) > 1:
                found["RV"] = 100.0 * 3.0 * float(means.std(ddof=1)) / command
        return found

    @cached_property
    def _known(self) -> dict[str, Any]:
        return self.numbers()

    def number(self, name: str) -> float:
        """One figure by its dotted name.

        Parameters
        ----------
        name : str
            As in `numbers`, items of a list by index: ``AT_P``, ``cycles.0.speed``.

        Raises
        ------
        NoNumber
            This run does not have it; the reason.
        """
        value: Any = self._known
        for part in name.split("."):
            if isinstance(value, list):
                value = {str(i): item for i, item in enumerate(value)}
            if not isinstance(value, dict) or part not in value:
                there = ", ".join(value) if isinstance(value, dict) and value else "nothing"
                raise NoNumber(f"ISO 9283 figure {name!r}: no {part!r}, there is {there}")
            value = value[part]
        if value is None:
            raise NoNumber(f"ISO 9283 figure {name!r}: {self._why(name)}")
        return float(value)

    def _why(self, name: str) -> str:
        last = name.rpartition(".")[2]
        if last in ("AV", "RV") and self.path.given.speed is None:
            return SPEED
        if last[-2:] in ("_a", "_b", "_c") and (self.path.angle is None or last.startswith("AP")):
            return TURN
        if last.startswith("R"):
            return SINGLE
        if last.startswith("straight") and not self.path.given.path.straight:
            return STRAIGHT
        return SURFACE


def _pose(pose: PoseResult) -> dict[str, Any]:
    found: dict[str, Any] = dict.fromkeys(POSE)
    found |= {"AP_P": pose.AP_P, "RP_l": pose.RP_l}
    found |= {f"AP_{a}": float(v) for a, v in zip("xyz", pose.AP, strict=True)}
    for what, angle in (("AP", pose.AP_angle), ("RP", pose.RP_angle)):
        if angle is not None:
            found |= {f"{what}_{a}": float(v) for a, v in zip(ANGLES, angle, strict=True)}
    return found


def wrong(name: str) -> str:
    """Why no run can have a figure of this name; empty if one can."""
    here: Any = TREE
    parts = name.split(".")
    for k, part in enumerate(parts):
        if isinstance(here, list) and part.isdecimal():
            here = here[0]
        elif not isinstance(here, list) and part in here:
            here = here[part] if isinstance(here, dict) else ()
        else:
            there = "a number, from 0" if isinstance(here, list) else ", ".join(here) or "nothing"
            hint = suggestion(part, () if isinstance(here, list) else here)
            return f"no ISO 9283 figure {name!r}: no {part!r}, there is {there}{hint}"
        if here == () and k < len(parts) - 1:
            return f"no ISO 9283 figure {name!r}: {part!r} is a number"
    return "" if here == () else f"ISO 9283 figure {name!r} is not a number but several"


def unit(figure: str) -> str:
    """Unit of a figure by the last part of its name; empty for a count or a share."""
    if figure in ("AV", "RV"):
        return "%"
    if figure in ("FV", "speed"):
        return "mm/s"
    if figure in ("n", "planes", "common"):
        return ""
    return "deg" if figure[-2:] in ("_a", "_b", "_c") else "mm"
