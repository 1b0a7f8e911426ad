"""An arm as a chain of joints and links: kinematics and inverse dynamics of any of them."""

from collections.abc import Sequence
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
G = 9.81  # [m/s2] acceleration of free fall
PRISMATIC = "prismatic"


@dataclass(frozen=True)
class LinkShape:
    """A simple body or a mesh, in the frame of its link."""

    use: str  # visual or collision
    kind: str  # box, cylinder, sphere or mesh
    size: tuple[float, ...]  # [m] edges; radius and length; radius; of a mesh its scale [1]
    origin: Array  # 4x4 [m]
    mesh: str = ""


@dataclass(frozen=True)
class RigidLink:
    """What a link weighs and looks like; its mass is 0 if unknown."""

    name: str
    mass: float = 0.0  # [kg]
    center: Array = field(default_factory=lambda: np.zeros(3))  # [m] in the link's frame
    tensor: Array = field(default_factory=lambda: np.zeros((3, 3)))  # [kg.m2] about the centre
    shapes: tuple[LinkShape, ...] = ()


@dataclass(frozen=True)
class ArmJoint:
    """A joint and the link behind it.

    Units are [rad] and [N.m], of a prismatic one [m] and [N].

    Attributes
    ----------
    name : str
    kind : str
        ``revolute``, ``continuous`` or ``prismatic``.
    origin : (4, 4) ndarray
        Its frame at 0 in the frame of the link before [m].
    axis : (3,) ndarray
        Unit vector in its own frame.
    low, high, speed : float
        Range and highest speed; infinite where nothing limits it.
    effort : float
        Largest torque; 0 if it is not known.
    acceleration, ratio, damping, friction : float or None
        Highest acceleration, motor turns per joint turn, friction per speed and at rest;
        None if not known.
    link : RigidLink
    follows : tuple or None
        Of a joint that mimics another one: that joint's place in the chain, multiplier, offset.
    """

    name: str
    kind: str
    origin: Array
    axis: Array
    low: float
    high: float
    speed: float
    link: RigidLink
    effort: float = 0.0
    acceleration: float | None = None
    ratio: float | None = None
    damping: float | None = None
    friction: float | None = None
    follows: tuple[int, float, float] | None = None

    @property
    def slides(self) -> bool:
        """Whether it is prismatic."""
        return self.kind == PRISMATIC


@dataclass(frozen=True)
class ArmDescription:
    """An arm: a chain of joints from its base to its tip.

    Attributes
    ----------
    name : str
    base : RigidLink
        The link that stands.
    joints : tuple of ArmJoint
        From the base on; one that mimics another has no angle of its own.
    tip : str
        Name of the frame at the end.
    tip_frame : (4, 4) ndarray
        That frame in the last link [m].
    notes : tuple of str
        What the file it was read from leaves open, or what was taken for it.
    """

    name: str
    base: RigidLink
    joints: tuple[ArmJoint, ...]
    tip: str
    tip_frame: Array
    notes: tuple[str, ...] = ()

    @property
    def driven(self) -> tuple[ArmJoint, ...]:
        """The joints that have an angle of their own."""
        return tuple(j for j in self.joints if j.follows is None)

    @property
    def mass(self) -> float:
        """Of all links that move [kg]."""
        return sum(j.link.mass for j in self.joints)

    def all_joints(self, q: Array) -> Array:
        """Angles of all joints, those that follow others too.

        Parameters
        ----------
        q : (..., driven joints) array_like
            [rad], of prismatic joints [m].

        Returns
        -------
        (..., joints) ndarray
        """
        share, offset = self._shares()
        return np.asarray(np.asarray(q, float) @ share.T + offset)

    def frames(self, q: Array) -> list[Array]:
        """Where the links are.

        Parameters
        ----------
        q : (..., driven joints) array_like
            [rad], of prismatic joints [m].

        Returns
        -------
        list of (..., 4, 4) ndarray
            Frame of each in the base [m].
        """
        angles = self.all_joints(q)
        frame = np.broadcast_to(np.eye(4), (*angles.shape[:-1], 4, 4))
        found = []
        for k, joint in enumerate(self.joints):
            frame = frame @ joint.origin @ moved(joint, angles[..., k])
            found.append(frame)
        return found

    def forward(self, q: Array) -> Array:
        """Where the tip is.

        Parameters
        ----------
        q : (..., driven joints) array_like
            [rad], of prismatic joints [m].

        Returns
        -------
        (..., 4, 4) ndarray
            Its frame in the base's [m].
        """
        return np.asarray(self.frames(q)[-1] @ self.tip_frame)

    def inverse_dynamics(
        self, q: Array, v: Array, acceleration: Array, gravity: Sequence[float] = (0, 0, -G)
    ) -> Array:
        """Torques of a motion, by Newton and Euler.

        Parameters
        ----------
        q, v, acceleration : (..., driven joints) array_like
            [rad] and its derivatives, of prismatic joints [m].
        gravity : sequence of 3 floats, optional
            Acceleration of free fall in base axes [m/s2].

        Returns
        -------
        (..., driven joints) ndarray
            [N.m], of prismatic joints [N].
        """
        share, _ = self._shares()
        angles = self.all_joints(q)
        rates = np.asarray(v, float) @ share.T
        changes = np.asarray(acceleration, float) @ share.T
        around = angles.shape[:-1]
        rate, spin = np.zeros((2, *around, 3))
        fall = np.broadcast_to(-np.asarray(gravity, float), (*around, 3))
        steps, wrenches = [], []
        for k, joint in enumerate(self.joints):
            step = joint.origin @ moved(joint, angles[..., k])
            steps.append(step)
            place, back = step[..., :3, 3], np.swapaxes(step[..., :3, :3], -1, -2)
            fall = fall + np.cross(spin, place) + np.cross(rate, np.cross(rate, place))
            rate, spin, fall = (_times(back, x) for x in (rate, spin, fall))
            own, change = joint.axis * rates[..., k, None], joint.axis * changes[..., k, None]
            if joint.slides:
                fall = fall + 2.0 * np.cross(rate, own) + change
            else:
                spin = spin + np.cross(rate, own) + change
                rate = rate + own
            wrenches.append(_wrench(joint.link, rate, spin, fall))
        torque = np.zeros(angles.shape)
        force, moment = np.zeros((2, *around, 3))
        for k in range(len(self.joints) - 1, -1, -1):
            joint, (own_force, own_moment) = self.joints[k], wrenches[k]
            force, moment = force + own_force, moment + own_moment
            torque[..., k] = (force if joint.slides else moment) @ joint.axis
            turn, place = steps[k][..., :3, :3], steps[k][..., :3, 3]
            force = _times(turn, force)
            moment = _times(turn, moment) + np.cross(place, force)
        return torque @ share

    def _shares(self) -> tuple[Array, Array]:
        """How all joints follow the driven ones: (joints, driven) and (joints,)."""
        own = [k for k, j in enumerate(self.joints) if j.follows is None]
        share, offset = np.zeros((len(self.joints), len(own))), np.zeros(len(self.joints))
        for k, joint in enumerate(self.joints):
            leader, factor, shift = joint.follows or (k, 1.0, 0.0)
            share[k, own.index(leader)], offset[k] = factor, shift
        return share, offset


def moved(joint: ArmJoint, q: Array) -> Array:
    """The link's frame in the joint's frame at 0, (..., 4, 4)."""
    q = np.asarray(q, float)
    found = np.zeros((*q.shape, 4, 4))
    found[..., 3, 3] = 1.0
    if joint.slides:
        found[..., :3, :3] = np.eye(3)
        found[..., :3, 3] = joint.axis * q[..., None]
        return found
    found[..., :3, :3] = about(joint.axis, q)
    return found


def about(axis: Array, angle: Array | float) -> Array:
    """Rotation matrices (..., 3, 3) about an axis by angles [rad]."""
    x, y, z = axis
    cross = np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    s, c = np.sin(angle), np.cos(angle)
    s, c = np.asarray(s)[..., None, None], np.asarray(c)[..., None, None]
    return np.asarray(np.eye(3) + s * cross + (1.0 - c) * (cross @ cross))


def placed(place: Sequence[float] | Array, turn: Array | None = None) -> Array:
    """A frame 4x4 of its origin and rotation."""
    found = np.eye(4)
    found[:3, 3] = place
    if turn is not None:
        found[:3, :3] = turn
    return found


def turn_of(roll: float, pitch: float, yaw: float) -> Array:
    """Rotation Rz(yaw) Ry(pitch) Rx(roll) [rad], as URDF and the angles A B C mean it."""
    x, y, z = np.eye(3)
    return np.asarray(about(z, yaw) @ about(y, pitch) @ about(x, roll))


def angles_of(turn: Array) -> tuple[float, float, float]:
    """Roll, pitch, yaw [rad] of a rotation; yaw is 0 where only their sum is known."""
    pitch = float(np.arctan2(-turn[2, 0], np.hypot(turn[2, 1], turn[2, 2])))
    if np.hypot(turn[2, 1], turn[2, 2]) < STRAIGHT:
        roll = float(np.arctan2(-turn[1, 2], turn[1, 1]))
        return roll, pitch, 0.0
    roll = float(np.arctan2(turn[2, 1], turn[2, 2]))
    return roll, pitch, float(np.arctan2(turn[1, 0], turn[0, 0]))


# Below this cosine of the pitch, roll and yaw turn about the same axis as far as doubles tell.
STRAIGHT = 1e-9


def joined(name: str, parts: Sequence[tuple[RigidLink, Array]]) -> RigidLink:
    """One link of several that are fixed to each other, with their frames in its own."""
    mass = sum(part.mass for part, _ in parts)
    centers = [at[:3, :3] @ part.center + at[:3, 3] for part, at in parts]
    shapes = tuple(
        LinkShape(s.use, s.kind, s.size, at @ s.origin, s.mesh)
        for part, at in parts
        for s in part.shapes
    )
    weights = [(part.mass, c) for (part, _), c in zip(parts, centers, strict=True)]
    center = sum((m * c for m, c in weights), np.zeros(3)) / mass if mass else np.zeros(3)
    tensor = np.zeros((3, 3))
    for (part, at), c in zip(parts, centers, strict=True):
        turn = at[:3, :3]
        tensor = tensor + turn @ part.tensor @ turn.T + part.mass * of_point(c - center)
    return RigidLink(name, mass, center, tensor, shapes)


def of_point(place: Array) -> Array:
    """Tensor of inertia of 1 kg at a place, about the origin."""
    return np.asarray(place @ place * np.eye(3) - np.outer(place, place))


def _wrench(link: RigidLink, rate: Array, spin: Array, fall: Array) -> tuple[Array, Array]:
    """Force and moment, about the link's origin, that its motion asks for."""
    whirl = np.cross(spin, link.center) + np.cross(rate, np.cross(rate, link.center))
    force = link.mass * (fall + whirl)
    moment = spin @ link.tensor.T + np.cross(rate, rate @ link.tensor.T)
    return force, moment + np.cross(link.center, force)


def _times(m: Array, v: Array) -> Array:
    return np.asarray(np.einsum("...ij,...j->...i", m, v))
