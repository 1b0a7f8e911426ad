"""Where an arm's tool rests, by the equation that its FMU carries, with exact slopes.

The measured place of a pose is

    base_place + R_base (tip(q, e) + R(q, e) tool)

with the tip and the orientation R of the plant at its start, where its motors stand at the joint
angles q and its links hang in their gears; e are its errors.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any

import casadi as ca
import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.base.units import parse
from motionfmu.calibrate.plant_geometry import ArmPose, MachineGeometry
from motionfmu.fmu.modelica import equation_text
from motionfmu.fmu.modelica.flat import Declaration
from motionfmu.scenarios import fmus

Array = NDArray[np.float64]
BASE = ("base X", "base Y", "base Z", "base RX", "base RY", "base RZ")
TOOL = ("tool X", "tool Y", "tool Z")
TOOL_TURN = ("tool RX", "tool RY", "tool RZ")
# The size that an error is expected to have, by which columns are scaled [mm, rad].
SIZE = {"mm": 1.0, "rad": 1e-3}


@dataclass(frozen=True)
class PoseColumn:
    """One unknown of a calibration."""

    name: str  # such as origin_error[2,1], or base X
    unit: str  # mm or rad
    factor: float  # from `unit` to the plant's own


@dataclass(frozen=True)
class ArmFrames:
    """Base and tool: rotations and places [mm]."""

    base_turn: Array
    base_place: Array
    tool_turn: Array
    tool_place: Array

    @classmethod
    def none(cls) -> "ArmFrames":
        """The instrument stands in the base and sees the plant's own tool."""
        return cls(np.eye(3), np.zeros(3), np.eye(3), np.zeros(3))


FRAMES = tuple(
    PoseColumn(name, unit, 1.0)
    for names, unit in ((BASE[:3], "mm"), (BASE[3:], "rad"), (TOOL, "mm"), (TOOL_TURN, "rad"))
    for name in names
)


def _column(declared: Declaration) -> PoseColumn:
    """A parameter of the plant as an unknown in mm or rad."""
    unit = parse(declared.unit or "1")
    own = "mm" if unit.exponents == parse("mm").exponents else "rad"
    return PoseColumn(declared.name, own, parse(own).factor / unit.factor)


class ArmPoses:
    """Measured poses of an arm as a function of its errors, its base and its tool."""

    def __init__(self, geometry: MachineGeometry, component: str, table: ArmPose) -> None:
        fmu = geometry.system.components[component]
        text = fmus.extra(fmu, equation_text.FILE)
        if text is None:
            raise InputError(f"{geometry.name}: {component}: its FMU carries no equation")
        ode = equation_text.from_json(text)
        self.names = names = [d.name for d in ode.parameters]
        arrays = [n.partition("[")[0] for n in names]
        values = {a: iter(geometry.values(component, a)) for a in dict.fromkeys(arrays)}
        self.p = np.array([float(next(values[a])) for a in arrays])
        self.joints = [k for k, a in enumerate(arrays) if a == table.joints]
        self.rows = [k for e in table.errors for k, a in enumerate(arrays) if a == e]
        self.errors = [_column(ode.parameters[k]) for k in self.rows]
        self.columns = (*FRAMES, *self.errors)
        self._function = self._made(ode, table)
        self.scale = np.array([SIZE[c.unit] for c in self.columns])

    def _made(self, ode: equation_text.Ode, table: ArmPose) -> ca.Function:
        """Place [mm] and orientation of a pose, and their slopes to all columns."""
        shown = [d.name.partition("[")[0] for d in ode.outputs]
        picked = [
            [k for k, n in enumerate(shown) if n == name]
            for name in (table.position, table.attitude)
        ]
        tip_and_turn = ca.vertcat(*(ode.y[rows] for rows in picked))
        at_rest = ca.Function("rest", [ode.x, ode.u, ode.p], [tip_and_turn])
        start = ca.Function("start", [ode.p], [ode.start])
        y = at_rest(start(ode.p), np.array(ode.u0), ode.p)
        moved = ca.SX.sym("moved", len(self.columns))
        known = ca.SX.sym("known", 24)
        base_turn, base_place = ca.reshape(known[:9], 3, 3), known[9:12]
        tool_turn, tool_place = ca.reshape(known[12:21], 3, 3), known[21:24]
        tip, turn = 1e3 * y[:3], _rotation(y[3:7])
        base = ca.mtimes(base_turn, _cayley(moved[3:6]))
        tool = tool_place + moved[6:9]
        place = base_place + moved[:3] + ca.mtimes(base, tip + ca.mtimes(turn, tool))
        whole = ca.mtimes(ca.mtimes(base, turn), ca.mtimes(tool_turn, _cayley(moved[9:12])))
        # errors move the parameters
        p = ca.SX(ode.p)
        for k, (row, column) in enumerate(zip(self.rows, self.errors, strict=True)):
            p[row] = ode.p[row] + column.factor * moved[12 + k]
        place, whole = ca.substitute([place, whole], [ode.p], [p])
        measured = ca.SX.sym("measured", 3, 3)
        away = ca.mtimes(measured.T, whole)
        # twice the axis times the sine of the angle that is left
        turned = 0.5 * ca.vertcat(
            away[2, 1] - away[1, 2], away[0, 2] - away[2, 0], away[1, 0] - away[0, 1]
        )
        found = [place, ca.vec(whole), turned]
        slopes = [ca.jacobian(found[0], moved), ca.jacobian(found[2], moved)]
        zero = ca.DM.zeros(len(self.columns))
        values = ca.substitute([*found, *slopes], [moved], [zero])
        return ca.Function("pose", [ode.p, known, measured], values)

    def at(
        self, joints: Array, frames: ArmFrames, errors: Array, measured: Array | None = None
    ) -> tuple[Array, Array, Array, Array, Array]:
        """Pose of the tool at each joint position, and how it moves with the errors.

        Returns places (n, 3) [mm], orientations (n, 3, 3), the turns (n, 3) that are left to
        `measured` orientations, and the slopes (n, 3, columns) of places and of turns. `errors` are
        in mm and rad.
        """
        count = len(joints)
        p = np.repeat(self.p[:, None], count, axis=1)
        p[self.joints] = joints.T
        for k, (row, column) in enumerate(zip(self.rows, self.errors, strict=True)):
            p[row] += column.factor * errors[k]
        parts = frames.base_turn, frames.base_place, frames.tool_turn, frames.tool_place
        known = np.concatenate([a.ravel(order="F") for a in parts])
        turns = np.tile(np.eye(3), (count, 1, 1)) if measured is None else measured
        flat = np.hstack(list(turns))
        mapped = self._function.map(count)
        raw = mapped(p, np.repeat(known[:, None], count, axis=1), flat)
        places, whole, left = (np.array(r).T for r in raw[:3])
        wide = len(self.columns)
        slopes = [np.array(r).reshape(3, count, wide).swapaxes(0, 1) for r in raw[3:]]
        return places, whole.reshape(count, 3, 3).swapaxes(1, 2), left, slopes[0], slopes[1]


def moved_frames(frames: ArmFrames, step: Sequence[float] | Array) -> ArmFrames:
    """Base and tool after a step of the first twelve columns."""
    s = np.asarray(step, float)
    return ArmFrames(
        frames.base_turn @ _turn(s[3:6]),
        frames.base_place + s[:3],
        frames.tool_turn @ _turn(s[9:12]),
        frames.tool_place + s[6:9],
    )


def _turn(r: Array) -> Array:
    return np.array(ca.DM(_cayley(ca.DM(r))))


def _cayley(r: Any) -> Any:
    """Rotation that is 1 + [r] to the first order."""
    g = 0.5 * r
    k = ca.skew(g)
    return ca.DM.eye(3) + 2.0 / (1.0 + ca.dot(g, g)) * (k + ca.mtimes(k, k))


def _rotation(q: ca.SX) -> ca.SX:
    """Rotation of a quaternion w, x, y, z."""
    w, v = q[0], q[1:4]
    k = ca.skew(v)
    return ca.SX.eye(3) + 2.0 * (w * k + ca.mtimes(k, k))
