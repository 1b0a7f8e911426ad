"""The moving picture of a run: its frames, its path and its deviations [mm]."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.iso9283.simplify import simplified
from motionfmu.base.order import distinct
from motionfmu.run.decimate import Read, at, ends, reader
from motionfmu.run.run_record import RunRecord
from motionfmu.run.tool_gap import in_mm
from motionfmu.scenarios import limited_signals
from motionfmu.scenarios.arm_lengths import Arm, arm_of
from motionfmu.scenarios.tool_signals import tools
from motionfmu.scenarios.view_signals import joint_angles, of_arm, shown_tool, standing

if TYPE_CHECKING:
    from motionfmu.analysis.collisions import Cell

Array = NDArray[np.float64]
FRAMES = 2000  # of the machine, evenly over the run
POINTS = 3000  # of the path
# The drawn path is off by less than this part of its extent: half a pixel.
COARSE = 3e-4
# An axis that moves by less than this does not [mm].
STANDS = 1e-6


@dataclass(frozen=True)
class DeviationLine:
    """A line that the tool followed, and its deviation along it."""

    foot: Array  # (n, 3) points of the command [mm]
    gap: Array  # (n, 3) deviation there [mm]


@dataclass(frozen=True)
class Scene:
    """What the moving picture shows."""

    time: Array  # (n,) of the frames [s]
    tool: Array  # (n, 3) [mm]
    joints: Array | None  # (n, 6) [rad]
    arm: Arm | None  # None: axes X, Y, Z
    path_time: Array  # (m,) [s]
    path: Array  # (m, 3) [mm]
    speed: Array  # (m,) of the tool [mm/s]
    lines: tuple[DeviationLine, ...] = ()
    base: Array | None = None  # (n, 3) where an arm stands that is moved as a whole [mm]
    rapid: NDArray[np.bool_] | None = None  # (m,) where the tool does no work
    cell: "Cell | None" = None  # what stands around the arm


def frames_of(count: int) -> NDArray[np.int64]:
    """The samples that are frames of the machine."""
    return distinct(np.linspace(0, count - 1, FRAMES).round().astype(np.int64))


def scene_of(
    run: RunRecord,
    lines: Sequence[DeviationLine] = (),
    works: NDArray[np.bool_] | None = None,
) -> Scene | None:
    """The moving picture of a run; None where nothing moves that it could show."""
    view = run.resolver.document.body.view
    name = tool_signal(run)
    if not view.show or name is None or len(run.time) < 2 or no_arm(run):
        return None
    count, base, time = len(run.time), _base(run, name), reader(run.time)
    tool = _in_world(run, name, base)
    joints, arm = joint_signal(run, name), None
    if joints is not None:
        arm = arm_of(run.resolver, run.parameter, joints)
    stands = base or _standing(run, joints) if arm else None
    low, high = ends(count, tool)
    moved = high - low > STANDS
    if not np.isfinite(high - low).all() or moved.sum() < (1 if arm else 2):
        return None
    frames = frames_of(count)
    kept = drawn_samples(count, tool, float(np.linalg.norm(high - low)))
    before, after = (kept - 1).clip(0), (kept + 1).clip(None, count - 1)
    way = np.linalg.norm(at(tool, after) - at(tool, before), axis=1)
    return Scene(
        at(time, frames),
        at(tool, frames),
        at(reader(run[joints]), frames) if arm and joints else None,
        arm,
        at(time, kept),
        at(tool, kept),
        way / (at(time, after) - at(time, before)),
        tuple(lines),
        at(stands, frames) if stands else None,
        rapids(run, kept, works),
    )


def _base(run: RunRecord, name: str) -> Read | None:
    """Where the arm of this tool stands, if it is moved as a whole and that was recorded."""
    base = next((t.base for t in tools(run.resolver) if t.position[1] == name), None)
    return in_mm(run, base) if base is not None and base in run.signals else None


def _standing(run: RunRecord, joints: str | None) -> Read | None:
    """Where the arm of these commanded joint angles stands, if that was recorded."""
    place = standing(run.resolver, joints) if joints else None
    return in_mm(run, place) if place in run.signals and place else None


def rapids(
    run: RunRecord, samples: NDArray[np.int64], works: NDArray[np.bool_] | None = None
) -> NDArray[np.bool_] | None:
    """Where a tool goes from place to place; None where that is not known, or it does nothing else.

    By what an analysis says, by the signal that [view] names, or by a controller whose moves of the
    joints have no feed.
    """
    feed = f"{limited_signals.controller(run.resolver)}.{limited_signals.FEED}"
    signal = run.resolver.document.body.view.works or feed
    if works is not None:
        found = ~works[samples]
    elif signal in run.signals:
        found = np.asarray(at(reader(run[signal]), samples)) <= 0
    else:
        return None
    return None if found.all() else found


def position(run: RunRecord, name: str) -> Read:
    """A tool's recorded position in the world in mm, block by block."""
    return _in_world(run, name, _base(run, name))


def _in_world(run: RunRecord, name: str, base: Read | None) -> Read:
    """The same for a tool whose arm stands on this base; None: the base is the world."""
    read = in_mm(run, name)
    if base is None:
        return lambda first, last: read(first, last)[:, :3]
    return lambda first, last: read(first, last)[:, :3] + base(first, last)


def tool_signal(run: RunRecord) -> str | None:
    """The signal that is the tool's position; None if there is none."""
    return shown_tool(run.resolver, run.signals)


def joint_signal(run: RunRecord, tool: str) -> str | None:
    """The recorded signal of six joint angles: named, or of the arm that has this tool."""
    named = run.resolver.document.body.view.joints
    names = [named] if named else joint_angles(run.resolver, tool)
    there = [n for n in names if n in run.signals]
    return next((n for n in there if run.signals[n].shape[1:] == (6,)), None)


def no_arm(run: RunRecord) -> str:
    """Why the arm of this run cannot be drawn; empty if it can, or if there is none."""
    name = tool_signal(run)
    if not run.resolver.document.body.view.show or name is None or not of_arm(run.resolver, name):
        return ""
    joints = joint_signal(run, name)
    arm = name.partition(".")[0]
    if joints is None:
        return f"The joint angles of {arm} are not recorded: there is no arm to draw."
    if arm_of(run.resolver, run.parameter, joints) is None:
        return f"The lengths of {arm} are not known: there is no arm to draw."
    return ""


def drawn_samples(count: int, tool: Read, extent: float) -> NDArray[np.int64]:
    """Samples that draw the path: where it bends, and some at even times for the colour."""
    coarse = max(1, count // (20 * POINTS))
    some = np.arange(0, count, coarse)
    bends = some[simplified(at(tool, some), COARSE * extent)]
    even = np.linspace(0, count - 1, POINTS // 2).round().astype(np.int64)
    if len(bends) > POINTS // 2:
        bends = bends[np.linspace(0, len(bends) - 1, POINTS // 2).round().astype(np.int64)]
    return distinct(np.concatenate([bends, even]))
