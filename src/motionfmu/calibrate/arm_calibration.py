"""Zero offsets and lengths of an arm from measured poses of its tool.

Gauss-Newton on the arm's own kinematics with exact slopes. Columns are scaled by the size an error
has (1 mm, 1 mrad). A column that others make up moves the tool as they do: what stands first of
(base, tool, errors in the plant's order) is found, the other is left and named. So is one that the
poses tell no better than to such a size.
"""

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.units import parse
from motionfmu.calibrate.arm_pose import BASE, SIZE, TOOL_TURN, ArmFrames, ArmPoses, moved_frames
from motionfmu.calibrate.estimate import Estimate
from motionfmu.calibrate.plant_geometry import ArmPose, MachineGeometry
from motionfmu.calibrate.pose_record import PoseRecord
from motionfmu.run.run_plan import RunPlan
from motionfmu.scenarios import agreement, fmus

Array = NDArray[np.float64]
# A column of which others leave less than this share acts as they do: gravity and the errors of the
# gears keep those that are alike from being so to the last digit.
ALIKE = 0.02
# Deviation, in sizes of an error, from which on a value is no news.
USELESS = 1.0
STEPS, DONE = 40, 1e-7  # of Gauss-Newton, and the step in sizes that ends it
FOLDS = 5  # of the cross-validation
# Residuals beyond so many robust deviations are told.
OUTLIER = 5.0
# Poses looked at for the next measurements, and how many of them are named.
CANDIDATES, NEXT = 400, 5
# Least residuals of a record that is exact [mm, rad].
GRAIN = np.array([1e-6, 1e-9])


@dataclass(frozen=True)
class ArmCalibrationOptions:
    """What is known beside the poses.

    Attributes
    ----------
    known_base : bool
        Places are in the robot's own base, not in an instrument's frame.
    known_tool : bool
        What was measured is the tip that the plant has.
    """

    known_base: bool = False
    known_tool: bool = False


@dataclass(frozen=True)
class PoseFit:
    """One fit of all poses.

    Attributes
    ----------
    frames : ArmFrames
    errors : ndarray
        Of the plant [mm, rad], in its order.
    kept : tuple of int
        Columns that were found.
    covariance : ndarray
        Of these.
    left : dict
        Why a column was left, by its name.
    places, turns : ndarray, shape (n, 3)
        What is left at each pose [mm], [rad].
    index : float
        O1 of Borm and Menq (1991), of the scaled columns.
    condition : float
    """

    frames: ArmFrames
    errors: Array
    kept: tuple[int, ...]
    covariance: Array
    left: Mapping[str, str]
    places: Array
    turns: Array
    index: float
    condition: float

    @property
    def sizes(self) -> Array:
        """Distances that are left (n,) [mm]."""
        return np.asarray(np.linalg.norm(self.places, axis=1))


@dataclass(frozen=True)
class ArmCalibration:
    """What poses tell of an arm.

    Attributes
    ----------
    machine, about : str
    record : PoseRecord
    parameters : dict
        Estimate by column: base, tool and errors of the plant [mm, rad].
    before, after, known : PoseFit
        Base and tool alone; all of the plant's errors; those alone that a controller can know.
    kept_back : ndarray
        Distances of poses that were kept back in turn (n,) [mm], with all errors.
    settings : dict
        Values of the plant by name, for ``--set``.
    compensated : dict
        The same plant, with the nominal values that its controller can know, and the controller.
    next_poses : ndarray
        Joint angles of poses that tell most beside these [deg].
    notes : tuple of str
    """

    machine: str
    about: str
    record: PoseRecord
    parameters: Mapping[str, Estimate]
    before: PoseFit
    after: PoseFit
    known: PoseFit
    kept_back: Array
    settings: Mapping[str, list[float]]
    compensated: Mapping[str, Any]
    next_poses: Array
    notes: tuple[str, ...] = ()
    component: str = field(default="", repr=False)

    def numbers(self) -> dict[str, Any]:
        """Every figure, ready for JSON."""
        sides = {"before": self.before, "after": self.after, "known": self.known}
        return {
            "machine": self.machine,
            "record": self.record.name,
            "poses": len(self.record.joints),
            "parameters": {n: e.numbers() for n, e in self.parameters.items()},
            "rms": {n: _rms(f.sizes) for n, f in sides.items()}
            | {"kept_back": _rms(self.kept_back)},
            "largest": {n: float(f.sizes.max()) for n, f in sides.items()},
            "distances": {n: f.sizes.tolist() for n, f in sides.items()},
            "observability": self.after.index,
            "condition": self.after.condition,
            "settings": dict(self.settings),
            "compensated": dict(self.compensated),
            "next_poses": self.next_poses.tolist(),
            "notes": list(self.notes),
        }


def arm_calibration(
    plan: RunPlan,
    record: PoseRecord,
    options: ArmCalibrationOptions = ArmCalibrationOptions(),
    set: Mapping[str, Any] | None = None,
) -> ArmCalibration:
    """Find zero offsets, lengths, base and tool of an arm.

    Parameters
    ----------
    plan : RunPlan
        The machine without a program, or a scenario.
    record : PoseRecord
    options : ArmCalibrationOptions
    set : mapping, optional
        Values by ``component.variable``, stronger than the machine's.

    Returns
    -------
    ArmCalibration

    Raises
    ------
    InputError
        The machine has no arm whose plant describes its poses, or the record does not fit it.
    """
    geometry = MachineGeometry.of(plan, dict(set or {}))
    found = geometry.find("pose")
    if found is None:
        raise InputError(f"{geometry.name}: no component of it describes poses of an arm")
    component, table = found
    poses = ArmPoses(geometry, component, table)
    if record.joints.shape[1] != len(poses.joints):
        told = f"{record.joints.shape[1]} joints, the machine has {len(poses.joints)}"
        raise InputError(f"{record.name}: {told}")
    work = _Fitting(poses, record, options)
    own = list(range(12, len(poses.columns)))
    names = [c.name for c in poses.columns]
    known = [k for k in own if names[k] in _counterparts(table, geometry, component)]
    if record.attitudes is not None:
        work.weigh(work.fit(own))
    before = work.fit([])
    after = work.fit(own)
    of_controller = work.fit(known)
    estimates = _estimates(poses, after, work)
    settings = _settings(poses, component, after)
    return ArmCalibration(
        machine=plan.name,
        about=plan.document.about,
        record=record,
        parameters=estimates,
        before=before,
        after=after,
        known=of_controller,
        kept_back=work.kept_back(after),
        settings=settings,
        compensated=_ToldController(geometry, component, table, poses).values(after, of_controller),
        next_poses=work.next_poses(after),
        notes=tuple(work.notes(after)),
        component=component,
    )


class _Fitting:
    """Fits of one record."""

    def __init__(self, poses: ArmPoses, record: PoseRecord, options: ArmCalibrationOptions) -> None:
        self.poses, self.record, self.options = poses, record, options
        self.errors = np.zeros(len(poses.errors))
        # columns that every fit has
        self.frame_columns = [
            *([] if options.known_base else range(6)),
            *([] if options.known_tool else range(6, 9)),
            *([] if record.attitudes is None or options.known_tool else range(9, 12)),
        ]
        self.start = self._aligned()
        self.weights = np.ones(2)  # of places [1/mm] and turns [1/rad]
        if record.attitudes is not None:
            self.weights = np.array([1.0, 1e3])

    def weigh(self, fit: PoseFit) -> None:
        """Weigh places and turns by what a fit leaves of them."""
        left = [float(np.sqrt(np.mean(r**2))) for r in (fit.places, fit.turns)]
        self.weights = 1.0 / np.maximum(left, GRAIN)

    def _aligned(self) -> ArmFrames:
        """A base that brings the plant's places over the measured ones (Kabsch 1976)."""
        frames = ArmFrames.none()
        if self.options.known_base:
            return frames
        own = self.poses.at(self.record.joints, frames, self.errors)[0]
        middle = own.mean(axis=0), self.record.places.mean(axis=0)
        u, _, vt = np.linalg.svd((self.record.places - middle[1]).T @ (own - middle[0]))
        turn = u @ np.diag([1.0, 1.0, np.linalg.det(u @ vt)]) @ vt
        return ArmFrames(turn, middle[1] - turn @ middle[0], np.eye(3), np.zeros(3))

    def rows(
        self, frames: ArmFrames, errors: Array, used: NDArray[np.intp] | None = None
    ) -> tuple[Array, Array, Array]:
        """What is left of places and turns, and the weighted slopes (rows, columns)."""
        picked = np.arange(len(self.record.joints)) if used is None else used
        measured = None if self.record.attitudes is None else self.record.attitudes[picked]
        at = self.poses.at(self.record.joints[picked], frames, errors, measured)
        places, turns = at[0] - self.record.places[picked], at[2]
        slopes = self.weights[0] * at[3].reshape(-1, len(self.poses.columns))
        if measured is None:
            return places, np.zeros_like(turns), slopes
        more = self.weights[1] * at[4].reshape(-1, len(self.poses.columns))
        return places, turns, np.vstack([slopes, more])

    def _weighted(self, places: Array, turns: Array) -> Array:
        rest = self.weights[0] * places.ravel()
        if self.record.attitudes is None:
            return rest
        return np.concatenate([rest, self.weights[1] * turns.ravel()])

    def solve(
        self, columns: list[int], start: ArmFrames, used: NDArray[np.intp] | None = None
    ) -> tuple[ArmFrames, Array]:
        """Frames and errors that leave least."""
        frames, errors = start, self.errors.copy()
        scale = self.poses.scale[columns]
        for _ in range(STEPS):
            places, turns, slopes = self.rows(frames, errors, used)
            step = np.zeros(len(self.poses.columns))
            scaled = np.linalg.lstsq(
                slopes[:, columns] * scale, -self._weighted(places, turns), rcond=None
            )[0]
            step[columns] = scaled * scale
            frames = moved_frames(frames, step[:12])
            errors = errors + step[12:]
            if np.abs(scaled).max(initial=0.0) < DONE:
                break
        return frames, errors

    def fit(self, own: list[int]) -> PoseFit:
        """Fit frames and errors of these columns; what cannot be told is left."""
        start, _ = self.solve(self._apart(self.frame_columns)[0], self.start)
        kept, left = self._apart([*self.frame_columns, *own], start)
        while True:
            frames, errors = self.solve(kept, start)
            found = self._finished(frames, errors, kept, left)
            sizes = np.sqrt(np.diag(found.covariance)) / self.poses.scale[kept]
            loose = [(s, k) for s, k in zip(sizes.tolist(), kept, strict=True) if k >= 12]
            if not loose or max(loose)[0] <= USELESS:
                return found
            worst, k = max(loose)
            unit = self.poses.columns[k].unit
            told = f"{worst * SIZE['mm']:.2g} mm" if unit == "mm" else f"{worst:.2g} mrad"
            left[self.poses.columns[k].name] = f"these poses tell it to {told} only"
            kept = [c for c in kept if c != k]

    def _apart(
        self, columns: list[int], frames: ArmFrames | None = None
    ) -> tuple[list[int], dict[str, str]]:
        """Columns that others do not make up, and of the rest what they act as."""
        names = [c.name for c in self.poses.columns]
        _, _, slopes = self.rows(frames or self.start, self.errors)
        scaled = slopes * self.poses.scale
        kept: list[int] = []
        left: dict[str, str] = {}
        for k in columns:
            size = float(np.linalg.norm(scaled[:, k]))
            if size < 1e-9:
                left[names[k]] = "it moves nothing"
                continue
            if kept:
                own = scaled[:, kept]
                parts = np.linalg.lstsq(own, scaled[:, k], rcond=None)[0]
                rest = float(np.linalg.norm(scaled[:, k] - own @ parts))
                if rest < ALIKE * size:
                    weight = np.abs(parts) * np.linalg.norm(own, axis=0)
                    most = np.flatnonzero(weight > 0.1 * weight.max())
                    alike = " and ".join(dict.fromkeys(_group(names[kept[i]]) for i in most))
                    left[names[k]] = f"it acts as {alike}"
                    continue
            kept.append(k)
        return kept, left

    def _finished(
        self, frames: ArmFrames, errors: Array, kept: list[int], left: dict[str, str]
    ) -> PoseFit:
        places, turns, slopes = self.rows(frames, errors)
        rest = self._weighted(places, turns)
        scale = self.poses.scale[kept]
        scaled = slopes[:, kept] * scale
        _, s, vt = np.linalg.svd(scaled, full_matrices=False)
        free = max(len(rest) - len(kept), 1)
        variance = float(rest @ rest) / free + float(self.weights[0] * GRAIN[0]) ** 2
        cover = variance * (vt.T / s**2) @ vt * np.outer(scale, scale)
        count = len(self.record.joints)
        index = float(np.exp(np.log(s).mean()) / math.sqrt(count)) if len(s) else math.nan
        condition = float(s[0] / s[-1]) if len(s) else math.nan
        return PoseFit(
            frames, errors, tuple(kept), cover, dict(left), places, turns, index, condition
        )

    def kept_back(self, fit: PoseFit) -> Array:
        """Distances of poses that took no part in the fit, a fifth of them at a time."""
        count = len(self.record.joints)
        found = np.full(count, math.nan)
        if 3 * (count - count // FOLDS - 1) <= len(fit.kept):
            return found
        for fold in range(FOLDS):
            out = np.arange(fold, count, FOLDS)
            rest = np.setdiff1d(np.arange(count), out)
            frames, errors = self.solve(list(fit.kept), fit.frames, rest)
            found[out] = np.linalg.norm(self.rows(frames, errors, out)[0], axis=1)
        return found

    def next_poses(self, fit: PoseFit) -> Array:
        """Poses within the range of these that lessen the deviations most (D-optimal, greedy)."""
        low, high = self.record.joints.min(axis=0), self.record.joints.max(axis=0)
        drawn = np.random.default_rng(1).uniform(low, high, (CANDIDATES, len(low)))
        kept = list(fit.kept)
        slopes = self.poses.at(drawn, fit.frames, fit.errors)[3][:, :, kept] * self.weights[0]
        cover = fit.covariance / max(_variance(fit, self.weights, self.record), 1e-300)
        found = []
        for _ in range(NEXT):
            gain = np.linalg.slogdet(np.eye(3) + slopes @ cover @ slopes.swapaxes(1, 2))[1]
            best = int(np.argmax(gain))
            j = slopes[best]
            found.append(drawn[best])
            drawn, slopes = np.delete(drawn, best, axis=0), np.delete(slopes, best, axis=0)
            inner = np.linalg.inv(np.eye(3) + j @ cover @ j.T)
            cover = cover - cover @ j.T @ inner @ j @ cover
        return np.round(np.array(found), 1)

    def notes(self, fit: PoseFit) -> list[str]:
        """What is to be known of the record."""
        found = []
        usual = 1.4826 * float(np.median(fit.sizes)) + GRAIN[0]
        for k in np.flatnonzero(fit.sizes > OUTLIER * usual).tolist():
            told = (
                f"{fit.sizes[k]:.3g} mm beside the arm, most are {float(np.median(fit.sizes)):.2g}"
            )
            found.append(f"{self.record.where[k]}: {told}")
        return found


def _group(name: str) -> str:
    """A column as a reason names it."""
    first = name.partition(" ")[0]
    return f"the {first}" if first in ("base", "tool") else name


def _variance(fit: PoseFit, weights: Array, record: PoseRecord) -> float:
    rest = float(np.sum((weights[0] * fit.places) ** 2))
    count = fit.places.size
    if record.attitudes is not None:
        rest += float(np.sum((weights[1] * fit.turns) ** 2))
        count *= 2
    return rest / max(count - len(fit.kept), 1) + float(weights[0] * GRAIN[0]) ** 2


def _estimates(poses: ArmPoses, fit: PoseFit, work: _Fitting) -> dict[str, Estimate]:
    """Every column with its deviation, or why it was left."""
    turn = fit.frames.base_turn
    values = np.concatenate(
        [
            fit.frames.base_place,
            _vector(turn),
            fit.frames.tool_place,
            _vector(fit.frames.tool_turn),
            fit.errors,
        ]
    )
    spread = dict(zip(fit.kept, np.sqrt(np.diag(fit.covariance)).tolist(), strict=True))
    found = {}
    for k, column in enumerate(poses.columns):
        why = fit.left.get(column.name, "")
        if not why and k not in spread:
            why = "taken as known"
            if column.name in TOOL_TURN and work.record.attitudes is None:
                why = "no orientations were measured"
        found[column.name] = Estimate(float(values[k]), spread.get(k, math.inf), column.unit, why)
    return found


def _vector(turn: Array) -> Array:
    """Rotation vector of a rotation [rad]."""
    from scipy.spatial.transform import Rotation

    return np.asarray(Rotation.from_matrix(turn).as_rotvec())


def _settings(poses: ArmPoses, component: str, fit: PoseFit) -> dict[str, list[float]]:
    """Whole arrays of the plant's errors, with what was found added to what they were."""
    p = poses.p.copy()
    for k, (row, column) in enumerate(zip(poses.rows, poses.errors, strict=True)):
        p[row] += column.factor * fit.errors[k]
    found: dict[str, list[float]] = {}
    for row in poses.rows:
        name = f"{component}.{poses.names[row].partition('[')[0]}"
        found.setdefault(name, []).append(float(p[row]))
    return found


def _counterparts(
    table: ArmPose, geometry: MachineGeometry, component: str
) -> dict[str, tuple[str, int, float]]:
    """By error the parameter that a controller can know: name, element, factor from mm or rad."""
    ports = fmus.ports(geometry.system.components[component])
    found = {}
    for name, error in table.known.items():
        sign, bare = (-1.0, error[1:]) if error.startswith("-") else (1.0, error)
        unit = parse(ports[name].unit or "1")
        length = unit.exponents == parse("mm").exponents
        factor = parse("mm" if length else "rad").factor / unit.factor
        count = ports[name].count
        if count == 1:
            found[bare] = name, 0, sign * factor
        else:
            found |= {f"{bare}[{i + 1}]": (name, i, sign * factor) for i in range(count)}
    return found


class _ToldController:
    """The arm and its controller, when the controller knows what it can know."""

    def __init__(
        self, geometry: MachineGeometry, component: str, table: ArmPose, poses: ArmPoses
    ) -> None:
        self.geometry, self.component, self.poses = geometry, component, poses
        self.counterparts = _counterparts(table, geometry, component)

    def values(self, plant: PoseFit, known: PoseFit) -> dict[str, Any]:
        """Settings of both: the plant is where it was, its nominal values are the controller's."""
        own = self._own()
        errors = _settings(self.poses, self.component, plant)
        for k, column in enumerate(self.poses.errors):
            pair = self.counterparts.get(column.name)
            if pair is None or known.errors[k] == 0.0:
                continue
            name, element, factor = pair
            own[name][element] += factor * float(known.errors[k])
            variable = f"{self.component}.{column.name.partition('[')[0]}"
            place = [
                r
                for r in self.poses.rows
                if self.poses.names[r].partition("[")[0] == column.name.partition("[")[0]
            ].index(self.poses.rows[k])
            errors[variable][place] -= column.factor * float(known.errors[k])
        found: dict[str, Any] = dict(errors)
        for name, values in own.items():
            shown: Any = values if len(values) > 1 else values[0]
            found[f"{self.component}.{name}"] = shown
            for other in self._same(name):
                found[other] = shown
        return found

    def _own(self) -> dict[str, list[float]]:
        names = {name for name, _, _ in self.counterparts.values()}
        return {
            n: [float(v) for v in self.geometry.values(self.component, n)] for n in sorted(names)
        }

    def _same(self, variable: str) -> list[str]:
        """Parameters of other components that mean the same quantity."""
        components = self.geometry.system.components
        own = agreement.quantities(components[self.component])
        quantity = next((q for q, n in own.items() if n == variable), "")
        return [
            f"{name}.{agreement.quantities(fmu)[quantity]}"
            for name, fmu in components.items()
            if name != self.component and quantity in agreement.quantities(fmu)
        ]


def _rms(values: Array) -> float | None:
    found = float(np.sqrt(np.mean(values**2)))
    return found if math.isfinite(found) else None


__all__ = ["BASE", "ArmCalibration", "ArmCalibrationOptions", "PoseFit", "arm_calibration"]
