"""An arm of up to six joints by the lines of its axes, whatever its kind."""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, Array, about, placed
from motionfmu.arms.arm_geometry import (
    PALLETIZER,
    SIX,
    NoOpwGeometry,
    OpwGeometry,
    is_gantry,
    is_scara,
    kind_of,
    level_linkage,
    opw_geometry,
    turns_six,
)
from motionfmu.arms.joint_axes import ANGLE
from motionfmu.arms.linkage import FOUR, Linkage, NoLinkage, linkage_of

# Angles of joints 2, 3, 4 at which the reach is looked for; it is 1 % too short at most.
STEPS = 24
STATES, SEED = 200, 1  # random states at which a deviation is measured
# [m] and [1]: below them lengths and directions are the arithmetic's.
DIGITS = 12
MOST_DEVIATION = 1e-3  # [m] of seven lengths from the description


@dataclass(frozen=True)
class AxesGeometry:
    """An arm by its axes, at zero and parallel to its base.

    Attributes
    ----------
    origins : (joints, 3) ndarray
        Origin of a joint from that of the one before it, of the base for joint 1 [m].
    axes : (joints, 3) ndarray
        Unit vectors.
    flange : (4, 4) ndarray
        The arm's tip from the origin of the last joint [m].
    why : str
        What keeps it from being an arm by seven lengths.
    slides : tuple of bool
        Of the joints; none given: all turn.
    deviation : float
        Of the tip from the description, whose angles are rounded [m].
    levels : tuple of int
        So many joints before each do not tilt its link; none given: all tilt all.
    hand : (3,) ndarray
        Of a palletizer: joint 4 on the hand, from the pivot where its origin is [m].
    linkage : Linkage, optional
        Of a palletizer that was described: where its joints are in the description.
    """

    origins: Array
    axes: Array
    flange: Array
    why: str = ""
    slides: tuple[bool, ...] = ()
    deviation: float = 0.0
    levels: tuple[int, ...] = ()
    hand: Array = field(default_factory=lambda: np.zeros(3))
    linkage: Linkage | None = None

    @property
    def places(self) -> Array:
        """Origins of the joints in the base, (joints, 3) [m]."""
        places = np.cumsum(self.origins, axis=0)
        if self.levels:
            places[FOUR - 1 :] += self.hand
        return np.asarray(places)

    @property
    def sliding(self) -> list[int]:
        """Places of the joints that slide."""
        return [k for k, slides in enumerate(self.slides) if slides]

    @property
    def straight(self) -> Array:
        """Joint angles at which frames are parallel to the base [rad]."""
        return np.zeros(len(self.axes))

    @property
    def base(self) -> Array:
        """The arm's own base."""
        return np.eye(4)

    @property
    def joint_frames(self) -> list[tuple[Array, Array]]:
        """Frame of each joint at 0 in the link before, and its axis."""
        return [(placed(o), a) for o, a in zip(self.origins, self.axes, strict=True)]

    def frames(self, q: Array) -> list[Array]:
        """Where the links are.

        Parameters
        ----------
        q : (..., joints) array_like
            [rad], of sliding joints [m].

        Returns
        -------
        list of (..., 4, 4) ndarray
            Frame of each in the base [m].
        """
        q = np.asarray(q, float)
        return [frame for frame, _ in self._carried(q)]

    def _carried(self, q: Array) -> Iterator[tuple[Array, Array]]:
        """Of each link its frame, and of its joint the pivot before a hand, or its own place."""
        frame = np.broadcast_to(np.eye(4), (*q.shape[:-1], 4, 4))
        found: list[Array] = []
        levels = self.levels or (0,) * len(self.axes)
        for k, (origin, axis) in enumerate(zip(self.origins, self.axes, strict=True)):
            pivot = (frame @ placed(origin))[..., :3, 3]
            step = np.broadcast_to(placed(origin), frame.shape).copy()
            if levels[k]:
                frame = found[k - levels[k] - 1].copy()
                frame[..., :3, 3] = pivot
                offset = self.hand if k == FOUR - 1 else np.zeros(3)
                step = np.broadcast_to(placed(offset), frame.shape).copy()
            if k in self.sliding:
                step[..., :3, 3] += axis * q[..., k, None]
            else:
                step[..., :3, :3] = about(axis, q[..., k])
            frame = frame @ step
            found.append(frame)
            yield frame, pivot

    def jacobian(self, q: Array) -> Array:
        """Velocity and angular velocity of the tip by joint speeds.

        Parameters
        ----------
        q : (..., joints) array_like
            [rad], of sliding joints [m].

        Returns
        -------
        (..., 6, joints) ndarray
            Rows of the velocity first [m/rad], [1].
        """
        carried = list(self._carried(np.asarray(q, float)))
        frames = [frame for frame, _ in carried]
        tip = (frames[-1] @ self.flange)[..., :3, 3]
        turns = [f[..., :3, :3] @ a for f, a in zip(frames, self.axes, strict=True)]
        ways = [np.cross(t, tip - f[..., :3, 3]) for t, f in zip(turns, frames, strict=True)]
        for k in range(len(self.levels)):
            level = [i for i in range(k + 1, FOUR) if i - self.levels[i] <= k]
            if level:  # what is behind moves with that pivot and does not turn
                ways[k] = np.cross(turns[k], carried[level[0]][1] - frames[k][..., :3, 3])
                turns[k] = np.zeros_like(turns[k])
        for k in self.sliding:
            ways[k], turns[k] = turns[k], np.zeros_like(turns[k])
        return np.concatenate([np.stack(ways, -1), np.stack(turns, -1)], -2)

    @property
    def reach(self) -> float:
        """Largest distance of the wrist from axis 1 [m].

        The wrist is the point of axis 5 that is nearest to axis 6.
        """
        turns = np.linspace(-np.pi, np.pi, STEPS, endpoint=False)
        if len(self.axes) < SIX or self.sliding:
            return self._few_reach(turns)
        q = np.zeros((STEPS**3, SIX))
        q[:, 1:4] = np.stack(np.meshgrid(turns, turns, turns), -1).reshape(-1, 3)
        u, v, way = self.axes[4], self.axes[5], self.origins[5]
        across = v - u * (u @ v)
        size = float(across @ across)
        along = float(u @ way)
        if size > 1e-6:
            along -= float(across @ way) / size * float(u @ v)
        wrist = (self.frames(q)[4] @ np.array([*(along * u), 1.0]))[:, :3]
        return float(np.linalg.norm(np.cross(wrist - self.origins[0], self.axes[0]), axis=1).max())

    def _few_reach(self, turns: Array) -> float:
        """Largest distance of the last joint from axis 1, or of one of slides from the first [m].

        Slides stand at 0, for they have no ends here.
        """
        tried = [[0.0] if k in self.sliding or k == 0 else turns for k in range(len(self.axes) - 1)]
        q = np.stack(np.meshgrid(*tried, [0.0]), -1).reshape(-1, len(self.axes))
        last = self.frames(q)[-1][:, :3, 3]
        if 0 in self.sliding:
            return float(np.linalg.norm(last, axis=1).max())
        return float(np.linalg.norm(np.cross(last - self.origins[0], self.axes[0]), axis=1).max())


ArmGeometry = OpwGeometry | AxesGeometry


def axes_geometry(arm: ArmDescription) -> AxesGeometry:
    """Take the axes of an arm of up to six free joints.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    AxesGeometry
    """
    frames = arm.frames(np.zeros(len(arm.joints)))
    places = np.array([np.zeros(3), *(f[:3, 3] for f in frames)])
    axes = np.array([f[:3, :3] @ j.axis for f, j in zip(frames, arm.joints, strict=True)])
    tip = np.linalg.inv(placed(places[-1])) @ frames[-1] @ arm.tip_frame
    slides = tuple(j.slides for j in arm.joints)
    return AxesGeometry(_tidy(np.diff(places, axis=0)), _tidy(axes), tip, slides=slides)


def driven_geometry(arm: ArmDescription) -> ArmGeometry:
    """Find how the controller drives an arm.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    OpwGeometry or AxesGeometry
        The first for an arm with a spherical wrist whose lengths fit to 1 mm.

    Raises
    ------
    NoOpwGeometry
        It is none of six turning joints, no SCARA, palletizer or gantry; the text names its kind
        and what is missing.
    """
    if linkage := level_linkage(arm):
        return _palletizer(arm, linkage)
    try:
        geometry = opw_geometry(arm)
    except NoOpwGeometry as error:
        if not turns_six(arm) and not is_scara(arm) and not is_gantry(arm):
            raise NoOpwGeometry(f"{kind_of(arm)}; {_missing(arm)}") from None
        found = replace(axes_geometry(arm), why=str(error))
        return _in_parallel(found) if is_scara(arm) else found
    if geometry.deviation <= MOST_DEVIATION:
        return geometry
    why = f"its seven lengths are off by {1e3 * geometry.deviation:.3g} mm at the tip"
    return replace(axes_geometry(arm), why=why)


def _palletizer(arm: ArmDescription, linkage: Linkage) -> AxesGeometry:
    """The axes of a palletizer: those that are nearly in parallel are exactly so."""
    first, second, third, fourth = linkage.driven
    frames = arm.frames(np.zeros(FOUR))
    chain = (first, second, third, linkage.pivots[-1])
    places = np.array([np.zeros(3), *(frames[k][:3, 3] for k in chain)])
    axes = np.array([frames[k][:3, :3] @ arm.joints[k].axis for k in linkage.driven])
    axes[1] = axes[2] if axes[1] @ axes[2] > 0.0 else -axes[2]
    if abs(axes[3] @ axes[0]) > np.cos(ANGLE):
        axes[3] = axes[0] if axes[3] @ axes[0] > 0.0 else -axes[0]
    last = frames[fourth]
    found = AxesGeometry(
        _tidy(np.diff(places, axis=0)),
        _tidy(axes),
        np.linalg.inv(placed(last[:3, 3])) @ last @ arm.tip_frame,
        why=PALLETIZER,
        slides=(False,) * FOUR,
        levels=linkage.levels,
        linkage=linkage,
        hand=_tidy(last[:3, 3] - places[-1]),
    )
    found = replace(found, flange=_upright(found.flange, found.axes[3]))
    random = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (STATES, FOUR))
    apart = (found.frames(random)[-1] @ found.flange - arm.forward(random))[..., :3, 3]
    return replace(found, deviation=float(np.linalg.norm(apart, axis=1).max()))


def _in_parallel(geometry: AxesGeometry) -> AxesGeometry:
    """The same with all axes exactly parallel to the first: else no tool would keep its tilt.

    A tool whose z is along them but for the digits of the file is so, too.
    """
    first = geometry.axes[0]
    axes = np.array([first if first @ axis > 0.0 else -first for axis in geometry.axes])
    found = replace(geometry, axes=axes, flange=_upright(geometry.flange, first))
    random = np.random.default_rng(SEED).uniform(-np.pi, np.pi, (STATES, len(axes)))
    random[:, geometry.sliding] = 0.0
    apart = (found.frames(random)[-1] - geometry.frames(random)[-1]) @ geometry.flange[:, 3]
    return replace(found, deviation=float(np.linalg.norm(apart[:, :3], axis=1).max()))


def _upright(frame: Array, axis: Array) -> Array:
    """A frame turned as little as may be so that its z is along an axis, if it is so nearly."""
    z = frame[:3, 2]
    along = axis if axis @ z > 0.0 else -axis
    across = np.cross(z, along)
    sine = float(np.linalg.norm(across))
    if not 0.0 < sine < ANGLE:
        return frame
    turned = frame.copy()
    turned[:3, :3] = about(across / sine, np.arcsin(sine)) @ frame[:3, :3]
    turned[:3, 2] = along
    turned[:3, 0] -= along * (along @ turned[:3, 0])
    turned[:3, 0] /= np.linalg.norm(turned[:3, 0])
    turned[:3, 1] = np.cross(along, turned[:3, 0])
    return np.asarray(turned)


def _missing(arm: ArmDescription) -> str:
    """What controller, drives and plant lack for an arm with other joints."""
    told = []
    count = len(arm.driven)
    if count > SIX:
        told.append(f"which of its {count} joints is held still, for a pose leaves {count - SIX}")
        told[-1] += " of them open (--hold)"
    if count < SIX:
        told.append(f"poses of {count} coordinates: a job asks for six, the arm has {count}")
    if names := [j.name for j in arm.joints if j.slides]:
        told.append(f"drives and links that slide, in mm ({', '.join(names)})")
    if any(j.follows is not None for j in arm.joints):
        try:
            linkage_of(arm)
        except NoLinkage as error:
            told.append(f"the linkage of a palletizer: {error}")
    return "missing: " + "; ".join(told)


def _tidy(values: Array) -> Array:
    return np.asarray(np.round(values, DIGITS) + 0.0)
