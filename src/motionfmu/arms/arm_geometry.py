"""What kind of arm a chain of joints is, and the seven lengths of one with a spherical wrist.

Lengths, signs and offsets of Brandstoetter, Angerer and Hofbaur, Austrian Robotics Workshop 2014:
inner angle = sign * joint angle - offset; at inner 0 the arm points up along axis 1.
"""

import math
from dataclasses import dataclass

import numpy as np

from motionfmu.arms.arm_description import ArmDescription, Array, about, placed
from motionfmu.arms.joint_axes import ANGLE, MEET, JointAxes, joint_axes
from motionfmu.arms.linkage import Linkage, NoLinkage, linkage_of

SIX = 6
SHORTEST = 1e-3  # [m] the least upper arm and forearm that the controller takes
STATES = 200  # random joint angles at which the lengths are compared with the chain
ROUNDING = 1e-6  # [m] a deviation that is told
SEED = 1
AXES = "zyyzyz"  # of the inner joints, in frames parallel to the base at inner 0
_UNIT = np.eye(3)


@dataclass(frozen=True)
class OpwGeometry:
    """An arm with axes 2 and 3 parallel and a spherical wrist.

    Attributes
    ----------
    lengths : tuple of 7 floats
        a1, a2, b, c1, c2, c3, c4 [m].
    signs : tuple of 6 ints
    offsets : tuple of 6 floats
        [rad]
    base : (4, 4) ndarray
        Frame of the lengths, z along axis 1, in the arm's base [m].
    flange : (4, 4) ndarray
        The arm's tip in the flange of the lengths [m].
    deviation : float
        Largest distance from the chain at random joint angles [m].
    """

    lengths: tuple[float, ...]
    signs: tuple[int, ...]
    offsets: tuple[float, ...]
    base: Array
    flange: Array
    deviation: float = 0.0

    @property
    def origins(self) -> Array:
        """Joints in the links before as the plant has them, (6, 3) [m].

        Frames are parallel to the base at inner 0; the last joint is on the flange.
        """
        a1, a2, b, c1, c2, c3, c4 = self.lengths
        return np.array([[0, 0, c1], [a1, b, 0], [0, 0, c2], [a2, 0, 0], [0, 0, c3], [0, 0, c4]])

    @property
    def places(self) -> Array:
        """Of the joints in the base of the lengths, (6, 3) [m]."""
        return np.asarray(np.cumsum(self.origins, axis=0))

    @property
    def straight(self) -> Array:
        """Joint angles at which frames are parallel to the base [rad]."""
        return np.asarray(self.signs) * np.asarray(self.offsets)

    @property
    def reach(self) -> float:
        """From axis 1 to the centre of the wrist, the arm stretched [m]."""
        a1, a2, _, _, c2, c3, _ = self.lengths
        return abs(a1) + c2 + math.hypot(a2, c3)

    @property
    def joint_frames(self) -> list[tuple[Array, Array]]:
        """Frame of each joint at 0 in the link before, and its axis."""
        found = []
        for k, (name, origin) in enumerate(zip(AXES, self.origins, strict=True)):
            axis = _UNIT["xyz".index(name)]
            found.append((placed(origin, about(axis, -self.offsets[k])), self.signs[k] * axis))
        return found

    def forward(self, q: Array) -> Array:
        """Where the tip is.

        Parameters
        ----------
        q : (..., 6) array_like
            Joint angles [rad].

        Returns
        -------
        (..., 4, 4) ndarray
            Its frame in the arm's base [m].
        """
        inner = np.asarray(self.signs) * np.asarray(q, float) - np.asarray(self.offsets)
        frame = np.broadcast_to(self.base, (*inner.shape[:-1], 4, 4))
        for k, (axis, origin) in enumerate(zip(AXES, self.origins, strict=True)):
            step = np.broadcast_to(np.eye(4), frame.shape).copy()
            step[..., :3, 3] = origin
            step[..., :3, :3] = about(_UNIT["xyz".index(axis)], inner[..., k])
            frame = frame @ step
        return np.asarray(frame @ self.flange)


class NoOpwGeometry(ValueError):
    """A chain of joints has other kinematics, and the text says why."""


# CCN 20: one question for each kind of arm, in the order in which they exclude each other.
def kind_of(arm: ArmDescription) -> str:
    """Say what kind of arm a chain of joints is.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    str
        Such as ``a SCARA``, by its joints and where their axes lie.
    """
    slides = "".join("P" if j.slides else "R" for j in arm.joints)
    lines = joint_axes(arm)
    if any(j.follows is not None for j in arm.joints):
        if level_linkage(arm):
            return PALLETIZER
        names = ", ".join(j.name for j in arm.joints if j.follows is not None)
        return f"an arm with a parallelogram (following joints: {names})"
    if slides == "RRRRRRR":
        return "an arm of seven joints"
    if slides.startswith("PPP"):
        return "a gantry" + (" with a wrist" if len(slides) > 3 else "")
    if slides[:1] == "P" and slides[1:] == "R" * SIX:
        return "an arm of six joints on a linear track"
    if is_scara(arm):
        return SCARA
    if slides == "RRRR" and lines.upright(1, 2) and lines.parallel(2, 3):
        return "an arm of four joints whose tool no linkage keeps level"
    if slides == "R" * SIX and lines.parallel(2, 3):
        if lines.parallel(3, 4):
            return "an arm with three parallel axes"
        return "an arm of six joints"
    return f"a chain of {len(slides)} joints ({slides})"


SCARA, PALLETIZER = "a SCARA", "a palletizer"


def level_linkage(arm: ArmDescription) -> Linkage | None:
    """The linkage that keeps the hand of four turning joints level; None: there is none."""
    try:
        return linkage_of(arm)
    except NoLinkage:
        return None


def is_scara(arm: ArmDescription) -> bool:
    """Whether three turning joints and a sliding one are all in parallel."""
    lines = [j.slides for j in arm.joints]
    if len(lines) != 4 or sum(lines) != 1 or any(j.follows for j in arm.joints):
        return False
    axes = joint_axes(arm)
    return all(axes.parallel(1, k) for k in (2, 3, 4))


def is_gantry(arm: ArmDescription) -> bool:
    """Whether three joints slide, and up to three behind them turn, each by itself."""
    kinds = "".join("P" if j.slides else "R" for j in arm.joints)
    return kinds in ("PPP", "PPPR", "PPPRR", "PPPRRR") and not any(j.follows for j in arm.joints)


def turns_six(arm: ArmDescription) -> bool:
    """Whether an arm has six joints that turn, each by itself."""
    return len(arm.joints) == SIX and not any(j.slides or j.follows for j in arm.joints)


def opw_geometry(arm: ArmDescription) -> OpwGeometry:
    """Measure an arm with a spherical wrist, axes 2 and 3 parallel.

    Parameters
    ----------
    arm : ArmDescription

    Returns
    -------
    OpwGeometry

    Raises
    ------
    NoOpwGeometry
        It is none; the text names its kind and what is in the way.
    """
    kind = kind_of(arm)
    if not turns_six(arm):
        raise NoOpwGeometry(kind)
    lines = joint_axes(arm)
    if told := "; ".join(_in_the_way(lines)):
        raise NoOpwGeometry(f"{kind}; {told}")
    found = _measured(arm, lines, kind)
    states = np.random.default_rng(SEED).uniform(-math.pi, math.pi, (STATES, SIX))
    apart = (found.forward(states) - arm.forward(states))[..., :3, 3]
    worst = float(np.linalg.norm(apart, axis=-1).max())
    return OpwGeometry(found.lengths, found.signs, found.offsets, found.base, found.flange, worst)


def _in_the_way(lines: JointAxes) -> list[str]:
    told = []
    if not lines.parallel(2, 3):
        told.append(f"axes 2 and 3 are {_degrees(lines.angle(2, 3))} from parallel")
    for i, j in ((1, 2), (3, 4), (4, 5), (5, 6)):
        if not lines.upright(i, j):
            told.append(f"axes {i} and {j} are at {_degrees(lines.angle(i, j))}, 90° wanted")
    if told:
        return told
    center = _crossing(lines)
    for k in (4, 5, 6):
        along = lines.along[k - 1]
        beside = float(np.linalg.norm(np.cross(center - lines.points[k - 1], along)))
        if beside > MEET:
            pairs = ((4, 5), (5, 6), (4, 6))
            gaps = ", ".join(f"{i} and {j} {1e3 * lines.apart(i, j):.4g} mm" for i, j in pairs)
            return [f"axes 4, 5, 6 do not meet in a point: apart are {gaps}"]
    return []


def _degrees(angle: float) -> str:
    return f"{math.degrees(angle):.4g}°"


def _crossing(lines: JointAxes) -> Array:
    """The point nearest to axes 4, 5, 6 in the sense of least squares."""
    a, b = np.zeros((3, 3)), np.zeros(3)
    for k in (3, 4, 5):
        across = np.eye(3) - np.outer(lines.along[k], lines.along[k])
        a, b = a + across, b + across @ lines.points[k]
    return np.asarray(np.linalg.solve(a, b))


# CCN 19: the arm is measured from its base to its tip; each step needs the frame of the one before.
def _measured(arm: ArmDescription, lines: JointAxes, kind: str) -> OpwGeometry:
    """Lengths of an arm whose axes lie as they must, with the pose at joint angles 0 as datum."""
    points, along = lines.points, lines.along
    up_sign = -1 if along[0, 2] < -ANGLE else 1
    up = up_sign * along[0]
    base = _base_frame(points[0], up)
    # The arm's plane at angle 0: forward is x of the base as near as may be, else where axis 2 is.
    y = along[1] - up * (along[1] @ up)
    y /= np.linalg.norm(y)
    x = np.cross(y, up)
    shoulder, elbow = points[1] - points[0], points[2] - points[0]
    toward = float(x @ base[:3, 0])
    flip = toward < 0.0 if abs(toward) > ANGLE else float(x @ shoulder) < 0.0
    if flip:
        x, y = -x, -y
    second, third = (1 if along[k] @ y > 0.0 else -1 for k in (1, 2))
    center = _crossing(lines)
    at = center - points[0]
    a1, c1 = float(x @ shoulder), float(up @ (points[1] - base[:3, 3]))
    b = float(y @ at)
    rise = float(up @ elbow) - float(up @ shoulder)
    reach = float(x @ elbow) - a1
    c2 = math.hypot(reach, rise)
    if c2 < SHORTEST:
        raise NoOpwGeometry(f"{kind}; axes 2 and 3 are in line")
    first, upper = math.atan2(*(float(x @ base[:3, k]) for k in (1, 0))), math.atan2(reach, rise)
    # The forearm points along axis 4 from the elbow to the wrist.
    fore = along[3] - y * (along[3] @ y)
    fore /= np.linalg.norm(fore)
    fourth = 1 if float(fore @ (at - elbow)) > 0.0 else -1
    fore = fourth * fore
    c3, a2 = float(fore @ (at - elbow)), float(np.cross(y, fore) @ (at - elbow))
    if c3 < SHORTEST:
        raise NoOpwGeometry(f"{kind}; the centre of the wrist lies beside axis 3 along axis 4")
    both = math.atan2(float(fore @ x), float(fore @ up))
    turn = np.column_stack([np.cross(y, fore), y, fore])
    wrist = [float(turn[:, k] @ along[4]) for k in (0, 1)]
    beside = abs(wrist[1]) < ANGLE  # a quarter round: both signs fit, and rounding may not choose
    fifth = 1 if (wrist[0] < 0.0 if beside else wrist[1] > 0.0) else -1
    roll = math.atan2(-fifth * wrist[0], fifth * wrist[1])
    turn = turn @ about(_UNIT[2], roll)
    tip = arm.forward(np.zeros(SIX))
    out = float((tip[:3, 3] - center) @ along[5])
    ahead = out if abs(out) > MEET else float(tip[:3, 2] @ along[5])
    sixth = 1 if ahead > 0.0 or (not ahead) else -1
    hand = sixth * along[5]
    bend = math.atan2(float(hand @ turn[:, 0]), float(hand @ turn[:, 2]))
    turn = turn @ about(_UNIT[1], bend)
    spin = _spin(turn, tip)
    turn = turn @ about(_UNIT[2], spin)
    c4 = abs(out) if abs(out) > MEET else 0.0
    inner = np.array([first, upper, both - upper, roll, bend, spin])
    flange = np.linalg.inv(placed(center + c4 * turn[:, 2], turn)) @ tip
    signs = (up_sign, second, third, fourth, fifth, sixth)
    lengths = tuple(_tidy(v) for v in (a1, a2, b, c1, c2, c3, c4))
    offsets = tuple(_tidy(v) for v in -(inner - 2.0 * math.pi * np.round(inner / (2.0 * math.pi))))
    return OpwGeometry(lengths, signs, offsets, base, _tidy_frame(flange))


def _base_frame(point: Array, up: Array) -> Array:
    """The arm's own base if axis 1 stands upright in it; else one with z along the axis."""
    if up[2] > math.cos(ANGLE):
        place = point - up * (point[2] / up[2])
        return placed([_tidy(v) for v in place])
    x = _UNIT[0] - up * up[0]
    if np.linalg.norm(x) < ANGLE:
        x = _UNIT[1] - up * up[1]
    x /= np.linalg.norm(x)
    return placed(point, np.column_stack([x, np.cross(up, x), up]))


def _spin(turn: Array, tip: Array) -> float:
    """Joint 6 at angle 0, so that the flange is the tip's frame, if they have the same z."""
    if turn[:, 2] @ tip[:3, 2] < math.cos(ANGLE):
        return 0.0
    return math.atan2(float(turn[:, 1] @ tip[:3, 0]), float(turn[:, 0] @ tip[:3, 0]))


def _tidy(value: float) -> float:
    """Without the last digits, which are those of the arithmetic [m; rad]."""
    return round(float(value), 12) + 0.0


def _tidy_frame(frame: Array) -> Array:
    """A frame whose turn is none where it is rounding alone."""
    apart = np.abs(frame - np.eye(4)).max()
    return np.eye(4) if apart < 1e-9 else np.asarray(frame)
