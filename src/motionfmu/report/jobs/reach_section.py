"""Where the arm of a dry run reaches around its path, and how far it is from singular there."""

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.collisions import ArmParts
from motionfmu.analysis.dry_run import DryRun
from motionfmu.analysis.reach import ReachSlice, reach_slice
from motionfmu.report.diagram import (
    EQUAL,
    CircleMark,
    Diagram,
    FieldMark,
    Heat,
    LineMark,
    Mark,
    PointMark,
    Scale,
    one,
)
from motionfmu.report.html_page import Page
from motionfmu.report.numbers import figure, round_up
from motionfmu.report.style import INK, MUTED
from motionfmu.virtual.robot import Kinematics

POINTS = 61  # along each side of a slice
PATH = 1500  # points of a path in it
HEIGHT = 400  # [pixel]
LINES = 6  # of equal distance from singular

Array = NDArray[np.float64]


@dataclass(frozen=True)
class ReachView:
    """A pose of the program, and what is needed for the slices through it."""

    line: int
    place: Array  # (3,) of the tip [mm]
    flange: Array  # (4, 4)
    branch: int
    length: float  # [mm] of the arm from its second axis, with its tool


def add_reach(page: Page, run: DryRun) -> None:
    """Add two slices through the middle of the program's work."""
    view = _view(run)
    across = view.length * np.linspace(-1.05, 1.05, POINTS)
    up = np.array([0.0, 0.0, 1.0])
    way = np.array([*view.place[:2], 0.0])
    way = way / np.linalg.norm(way) if np.linalg.norm(way) > 1.0 else np.array([1.0, 0.0, 0.0])
    x, y = np.eye(3)[:2]
    level = _slice(run, view, (view.place[2] * up, x, y), (across, across))
    high = across + _shoulder(run)
    upright = _slice(run, view, (0.0 * up, way, up), (across, high))
    top = round_up(float(np.nanmax([np.nanmax(level.least), np.nanmax(upright.least), 1e-3])))
    path = run.samples["place"].astype(float)
    path = path[:: max(1, len(path) // PATH)]
    first = _chart(("X", "Y"), (across, across), level, path @ np.stack([x, y], axis=1), top)
    names = ("from axis 1", "Z")
    second = _chart(names, (across, high), upright, path @ np.stack([way, up], axis=1), top)
    note = (
        f"Places of the tool with the orientation of line {view.line}, in the plane of its height"
        f" ({figure(view.place[2])} mm), and in the upright plane through it and axis 1. Colour is"
        " how far the branch that the arm is in stays from singular there: the least singular value"
        " of the Jacobian with lengths as shares of the arm's, of which 0 is singular. Grey dots"
        " are reached by another branch only; what is blank is out of reach or beyond the ranges"
        " of the joints."
    )
    plots = page.place("reach1", first) + page.place("reach2", second)
    page.section("Reach and branches", note, f'<div class="two">{plots}</div>{_branches(level)}')


def _view(run: DryRun) -> ReachView:
    """The sample nearest to the middle of what is done with a feed."""
    s = run.samples
    works = np.flatnonzero(s["feed"] > 0.0)
    works = works if len(works) else np.arange(len(s))
    places = s["place"][works].astype(float)
    row = s[works[int(np.linalg.norm(places - places.mean(axis=0), axis=1).argmin())]]
    arm = Kinematics(**_without_tool(run))
    joints = row["joint"].astype(float)
    flange = arm.forward(joints)
    apart = (arm.inverse(flange) - joints + 180.0) % 360.0 - 180.0
    branch = int(np.argmin(np.nan_to_num(np.abs(apart).max(axis=-1), nan=1e9)))
    place = row["place"].astype(float)
    parts = ArmParts.of(run.settings)
    ways = np.diff([*parts.origins[1:], parts.flange], axis=0)
    length = float(np.linalg.norm(ways, axis=1).sum() + np.linalg.norm(place - flange[:3, 3]))
    return ReachView(int(row["line"]), place, flange, branch, length)


def _without_tool(run: DryRun) -> dict[str, object]:
    return {**run.settings, "tool": [0.0] * 6}


def _shoulder(run: DryRun) -> float:
    """Height of axis 2 [mm]."""
    return float(ArmParts.of(run.settings).origins[1, 2])


def _slice(
    run: DryRun,
    view: ReachView,
    plane: tuple[Array, Array, Array],
    sides: tuple[Array, Array],
) -> ReachSlice:
    """The slice of tips in a plane, told by a point and two directions, that far along these."""
    (at, *way), (across, up) = plane, sides
    tips = at + across[None, :, None] * way[0] + up[:, None, None] * way[1]
    flange = tips - (view.place - view.flange[:3, 3])
    return reach_slice(run.settings, flange, view.flange[:3, :3], view.branch, view.length)


def _chart(
    names: tuple[str, str],
    sides: tuple[Array, Array],
    found: ReachSlice,
    path: Array,
    top: float,
) -> Diagram:
    x, y = np.meshgrid(*sides)
    other = np.isnan(found.least) & (found.branches > 0)
    ticks = tuple(np.linspace(0.0, top, LINES).tolist())
    heat = Heat(found.least.round(3), "from singular", (0.0, top), ticks=ticks)
    marks: list[Mark] = [
        FieldMark(*sides, heat),
        PointMark(x[other], y[other], "another branch only", MUTED, size=2.5, hover=()),
        LineMark(path[:, 0], path[:, 1], "", "#ffffff", 5.0, hover=()),
        LineMark(path[:, 0], path[:, 1], "path", INK, 2.0, hover=()),
        CircleMark(0.0, 0.0, 0.03 * float(np.ptp(sides[0])), INK),
    ]
    across, up = (
        Scale(n, "mm", (float(s[0]), float(s[-1]))) for n, s in zip(names, sides, strict=True)
    )
    return one(across, up, marks, HEIGHT, EQUAL)


def _branches(found: ReachSlice) -> str:
    """How much of the slice is reached by how many branches."""
    counts = np.bincount(found.branches[found.branches > 0], minlength=1)
    if not counts.sum():
        return ""
    told = ", ".join(f"{k} in {100.0 * n / counts.sum():.0f} %" for k, n in enumerate(counts) if n)
    return f"<p>Branches within the ranges of the joints, of the level plane's reach: {told}.</p>"
