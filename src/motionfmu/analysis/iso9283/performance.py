"""Path performance after ISO 9283:1998: accuracy, repeatability, speed, and pen lines."""

from dataclasses import dataclass, replace
from functools import cached_property
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.analysis.iso9283.command_path import CommandPath
from motionfmu.analysis.iso9283.crossing import Crossings, crossings
from motionfmu.analysis.iso9283.cycles import Cycle, Cycles
from motionfmu.analysis.iso9283.line import straightness
from motionfmu.analysis.iso9283.pose import three_sigma
from motionfmu.analysis.iso9283.strokes import Strokes, coincidence
from motionfmu.analysis.iso9283.turn import Array, deviation

# Number of points at which the ends of the ramps are searched; planes are placed between them.
SURVEY = 400
# A change of direction of the path from here on is a corner.
CORNER = np.radians(10.0)
# The normal of the surface drawn on must be this far from the path's direction (sine of the angle).
ACROSS = 0.1


@dataclass(frozen=True)
class Performance:
    """How well a command path was followed.

    Attributes
    ----------
    given : Cycles
    along : ndarray, shape (m,)
        Place of each plane on the command path [mm].
    command, way : ndarray, shape (m, 3)
        Point of the command path there [mm], and its direction.
    point : ndarray, shape (n, m, 3)
        Where each cycle goes through each plane [mm].
    time : ndarray, shape (n, m)
        When [s].
    angle : ndarray, shape (n, m, 3), or None
        Deviation of the orientation, angles a, b, c about x, y, z [deg].
    excluded : tuple of float
        Length of the path left out at the start and at the end [mm].
    """

    given: Cycles
    along: Array
    command: Array
    way: Array
    point: Array
    time: Array
    angle: Array | None
    excluded: tuple[float, float]

    @cached_property
    def mean(self) -> Array:
        """Barycentre of all cycles in each plane (m, 3) [mm]."""
        return np.asarray(self.point.mean(axis=0))

    @cached_property
    def accuracy(self) -> Array:
        """Distance of the barycentre from the command (m,) [mm]."""
        return np.asarray(np.linalg.norm(self.mean - self.command, axis=1))

    @cached_property
    def repeatability(self) -> Array | None:
        """Mean distance from the barycentre and 3 S (m,) [mm]."""
        return three_sigma(np.linalg.norm(self.point - self.mean, axis=2))

    @cached_property
    def normal(self) -> Array | None:
        """Unit normal of the surface drawn on.

        It is z if none is given; None where the path runs along it.
        """
        given = self.given.normal
        normal = np.array([0.0, 0.0, 1.0]) if given is None else given / np.linalg.norm(given)
        level = np.linalg.norm(np.cross(normal, self.way), axis=1) >= ACROSS
        return normal if level.all() else None

    @cached_property
    def across(self) -> Array:
        """Deviation across the path, on the surface (n, m) [mm]."""
        assert self.normal is not None
        side = np.cross(self.normal, self.way)  # to the left, seen from the normal's tip
        side /= np.linalg.norm(side, axis=1, keepdims=True)
        return np.asarray(((self.point - self.command) * side).sum(axis=2))

    @cached_property
    def height(self) -> Array:
        """Deviation along the normal, in the plane (n, m) [mm]."""
        assert self.normal is not None
        up = self.normal - (self.way @ self.normal)[:, None] * self.way
        up /= np.linalg.norm(up, axis=1, keepdims=True)
        return np.asarray(((self.point - self.command) * up).sum(axis=2))

    @property
    def _middle(self) -> list[int]:
        """Planes at the ends of the middle half of the path, where no ramp reaches."""
        return [len(self.along) // 4, (3 * len(self.along) + 3) // 4 - 1]

    @cached_property
    def mean_speeds(self) -> Array:
        """Way over time of each cycle, middle half (n,) [mm/s]."""
        # The length is taken from plane to plane, so motion back between two planes does not count.
        first, last = self._middle
        steps = np.linalg.norm(np.diff(self.point[:, first : last + 1], axis=1), axis=2)
        return np.asarray(steps.sum(axis=1) / (self.time[:, last] - self.time[:, first]))

    @cached_property
    def speeds(self) -> list[Array]:
        """Speed of each cycle along its way, middle half [mm/s]."""
        found = []
        for cycle, time, point in zip(self.given.cycles, self.time, self.point, strict=True):
            first, last = time[self._middle]
            inside = (cycle.time >= first) & (cycle.time <= last)
            if not inside.any():
                inside[np.searchsorted(cycle.time, first).clip(0, len(inside) - 1)] = True
            way = np.diff(point, axis=0)
            way /= np.linalg.norm(way, axis=1, keepdims=True)
            plane = np.searchsorted(time, cycle.time[inside], "right").clip(1, len(way)) - 1
            velocity = np.gradient(cycle.position, cycle.time, axis=0)[inside]
            found.append(np.asarray((velocity * way[plane]).sum(axis=1)))
        return found

    @property
    def strokes(self) -> Strokes | None:
        """Coincidence of the pen lines; None without a surface."""
        return None if self.normal is None else coincidence(self.across, self.given.pen_width)

    def moved(self, error: Array) -> "Performance":
        """The same planes with one cycle of another error.

        Parameters
        ----------
        error : ndarray, shape (m, 3)
            From the command [mm].
        """
        time = self.time.mean(axis=0, keepdims=True)
        point = (self.command + error)[None]
        return replace(self, point=point, time=time, angle=None)

    def cycle_numbers(self) -> list[dict[str, Any]]:
        """Figures of each cycle by itself."""
        rows = []
        size = np.linalg.norm(self.point - self.command, axis=2)
        for j, time in enumerate(self.time):
            row: dict[str, Any] = {"start": float(time[0]), "end": float(time[-1])}
            row["largest"] = float(size[j].max())
            row["speed"] = float(self.mean_speeds[j])
            row |= {k: float(v[j]) for k, v in self.shapes().items()}
            rows.append(row)
        return rows

    def shapes(self) -> dict[str, Array]:
        """Straightness, in-plane deviation, height by cycle (n,) [mm]."""
        # Figures that the path does not have are left out.
        found: dict[str, Array] = {}
        if self.given.path.straight:
            found["straightness"] = np.array([straightness(p) for p in self.point])
        if self.normal is not None:
            found["in_plane"] = np.ptp(self.across, axis=1)
            found["height"] = np.ptp(self.height, axis=1)
            if self.given.path.straight:
                flat = [np.column_stack([self.along, a]) for a in self.across]
                found["straightness_in_plane"] = np.array([straightness(f) for f in flat])
        return found


def speed(cycle: Cycle) -> Array:
    """Speed at each sample of a cycle, by central differences [mm/s]."""
    return np.asarray(np.linalg.norm(np.gradient(cycle.position, cycle.time, axis=0), axis=1))


def analyse(given: Cycles) -> Performance:
    """Evaluate path performance.

    The definitions are those of ISO 9283:1998, clause 8, velocity by its 8.6: deviations are taken
    in planes perpendicular to the command path. The ends of the path that some cycle does not
    reach, or passes below `Cycles.ramp` of the speed, are left out.

    Parameters
    ----------
    given : Cycles

    Returns
    -------
    Performance

    Raises
    ------
    ValueError
        A cycle does not follow the path; the message says which and where.
    """
    path = given.path
    survey = np.linspace(0.0, path.length, SURVEY)
    survey = survey[~_near_corner(path, survey, given.corner)]
    rough = [crossings(c, path, survey) for c in given.cycles]
    low, high = _evaluated(given, survey, rough)
    along = np.linspace(low, high, given.planes)
    along = along[~_near_corner(path, along, given.corner)]
    if len(along) < 2:
        raise ValueError(f"corner = {given.corner:g} mm leaves nothing of the path to evaluate")
    found = [crossings(c, path, along) for c in given.cycles]
    for j, each in enumerate(found):
        _refuse_gaps(j, along, each, np.ones(len(along), dtype=bool))
    turns = [each.turn for each in found]
    wanted = path.orientation(along)
    angle = None
    if wanted is not None and all(t is not None for t in turns):
        angle = np.stack([deviation(t, wanted) for t in turns if t is not None])
    return Performance(
        given,
        along,
        path.at(along),
        path.direction(along),
        np.stack([each.point for each in found]),
        np.stack([each.time for each in found]),
        angle,
        (low, path.length - high),
    )


def _evaluated(given: Cycles, survey: Array, rough: list[Crossings]) -> tuple[float, float]:
    """Ends of the part of the path that all cycles pass fast enough, as lengths on it [mm]."""
    good = np.ones(len(survey), dtype=bool)
    for j, (cycle, each) in enumerate(zip(given.cycles, rough, strict=True)):
        there = ~np.isnan(each.time)
        if there.sum() < 2:
            raise ValueError(f"cycle {j + 1} does not follow the path")
        inside = np.flatnonzero(there)
        between_ends = np.zeros(len(survey), dtype=bool)
        between_ends[inside[0] : inside[-1] + 1] = True
        _refuse_gaps(j, survey, each, between_ends)
        good &= there
        if given.ramp > 0.0:
            own = speed(cycle)
            window = (cycle.time >= each.time[inside[0]]) & (cycle.time <= each.time[inside[-1]])
            moves = own[window]
            usual = given.speed or float(np.median(moves))
            fast = cycle.time[window][moves >= given.ramp * usual]
            if not len(fast):
                told = f"{given.ramp:g} of {usual:g} mm/s"
                raise ValueError(f"cycle {j + 1} never reaches {told}")
            with np.errstate(invalid="ignore"):
                good &= (each.time >= fast[0]) & (each.time <= fast[-1])
    if good.sum() < 2:
        raise ValueError("no part of the path is passed by all cycles at speed")
    used = survey[good]
    return float(used[0]), float(used[-1])


def _refuse_gaps(cycle: int, along: Array, found: Crossings, wanted: NDArray[np.bool_]) -> None:
    missing = np.flatnonzero(wanted & np.isnan(found.time))
    if len(missing):
        place = along[missing[0]]
        text = f"cycle {cycle + 1} does not cross the path at {place:.4g} mm of it"
        raise ValueError(f"{text} (corner = leaves out corners that are cut)")


def _near_corner(path: CommandPath, along: Array, room: float) -> NDArray[np.bool_]:
    """Which points of the path are nearer than `room` to a corner."""
    near = np.zeros(len(along), dtype=bool)
    steps = np.diff(path.points, axis=0)
    way = steps / np.linalg.norm(steps, axis=1, keepdims=True)
    turn = np.arccos(np.clip((way[:-1] * way[1:]).sum(axis=1), -1.0, 1.0))
    for corner in path.along[1:-1][turn > CORNER]:
        near |= np.abs(along - corner) < room
    return near
