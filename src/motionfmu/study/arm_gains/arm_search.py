"""The search for gains of an arm's drives that keep limits in all poses."""

import math
from collections.abc import Callable
from dataclasses import dataclass
from itertools import product

import numpy as np
from scipy.optimize import minimize

from motionfmu.study.arm_gains.arm_poses import Array, climbed
from motionfmu.study.arm_gains.joint_loops import JOINTS, Complex, JointLoops, PoseResponses

# Rounds over the joints, in which each sees the others' latest gains.
ROUNDS = 3
# Poses between those looked at may be worse by less than this share.
SPARE = 0.01
EXCHANGES = 6
# Gains are searched within this factor of the present ones.
SPAN = 20.0
HALVINGS = 12
# What a velocity loop costs that breaks a limit with the smallest position gain.
BROKEN = 100.0
UNSTABLE = 2.0  # counts as a peak that is so many times its limit
COARSE, FINE, EVALUATIONS = 7, 15, 60
POSITION, VELOCITY, TIME = range(3)


@dataclass(frozen=True)
class PeakLimits:
    """Largest peaks in any pose: of |1/(1 + L)|, and of |link/command|."""

    sensitivity: float
    swing: float

    def over(self, peaks: Array) -> Array:
        """The larger of both peaks (2, ...) over its limit."""
        return np.asarray(np.maximum(peaks[0] / self.sensitivity, peaks[1] / self.swing))


@dataclass(frozen=True)
class FoundGains:
    """Gains, and the poses that hold them."""

    gains: Array  # (3, 6)
    own: Array  # (6,) position gain that each joint alone would bear [1/s]
    arm: PoseResponses  # all poses that were looked at
    peaks: Array  # (2, n, 6) there
    active: tuple[int, ...]  # poses of the search


class ArmSearch:
    """Gains joint by joint, first as fast as each may be, then all as fast as the slowest.

    Least is the product of the square of the lag behind a ramp, 1/Kp, and of what the time integral
    of the error after a step of load is, Ti/(Kp Kv).
    """

    def __init__(self, loops: JointLoops, limits: PeakLimits, equal: bool) -> None:
        self.loops, self.limits, self.equal = loops, limits, equal
        present = loops.present
        self.ends = np.log(np.array([present / SPAN, present * SPAN]))

    def tuned(self, arm: PoseResponses, start: Array) -> tuple[Array, Array]:
        """Gains (3, 6) that keep the limits in these poses, and each joint's own position gain."""
        gains = start.copy()
        for r in range(ROUNDS):
            for j in JOINTS:
                _OneJoint(self, arm, gains, j).quickest(r == 0)
        own = gains[POSITION].copy()
        for _ in range(ROUNDS if self.equal else 0):
            gains[POSITION] = gains[POSITION].min()
            for j in JOINTS:
                _OneJoint(self, arm, gains, j).stiffest()
        if self.equal:
            gains[POSITION] = gains[POSITION].min()
        return gains, own

    def found(
        self,
        arm: PoseResponses,
        ends: Array,
        progress: Callable[[float], None] = lambda share: None,
    ) -> FoundGains:
        """Gains for all poses between the ends; those that miss a limit most join the search.

        So an exchange method solves a problem with limits for infinitely many poses (Blankenship
        and Falk 1976).
        """
        most, least = arm.inertia.argmax(axis=0), arm.inertia.argmin(axis=0)
        active = sorted({*most.tolist(), *least.tolist()})
        gains = self.loops.present
        for k in range(EXCHANGES):
            progress(k / EXCHANGES)
            gains, own = self.tuned(arm.of(active), gains)
            arm, peaks, worst = self.worst(arm, gains, ends)
            over = self.limits.over(peaks)
            more = {w for w, j in zip(worst, JOINTS, strict=True) if over[w, j - 1] > 1.0}
            if more <= set(active):
                break
            active = sorted({*active, *more})
        return FoundGains(gains, own, arm, peaks, tuple(active))

    def worst(
        self, arm: PoseResponses, gains: Array, ends: Array
    ) -> tuple[PoseResponses, Array, list[int]]:
        """The poses with the worst one of each joint among them, their peaks, where those are."""
        peaks = self.loops.all_peaks(arm, gains)
        found = []
        for j in JOINTS:
            start = int(self.limits.over(peaks)[:, j - 1].argmax())

            def height(poses: Array, j: int = j) -> Array:
                sides = self.loops.alone(self.loops.responses(poses), gains, j)
                return self.limits.over(np.array(self.loops.peaks(sides, j, gains[:, j - 1])))

            pose, best = climbed(arm.poses[start], height, ends)
            if best > self.limits.over(peaks)[start, j - 1]:
                one = self.loops.responses(pose[None])
                arm = arm.and_(one)
                peaks = np.concatenate([peaks, self.loops.all_peaks(one, gains)], axis=1)
                start = len(arm) - 1
            found.append(start)
        return arm, peaks, found


class _OneJoint:
    """Gains of one joint, written into those of all, with the others' as they are."""

    def __init__(self, search: ArmSearch, arm: PoseResponses, gains: Array, joint: int) -> None:
        self.loops, self.limits = search.loops, search.limits
        self.gains, self.joint, self.k = gains, joint, joint - 1
        self.low, self.high = search.ends[:, :, self.k]
        self.sides = search.loops.alone(arm, gains, joint)

    def _law(self, velocity: float, time: float) -> tuple[Complex, Complex, Complex, Complex]:
        """Torque per line and per pulse at no position gain, and what each 1/s adds to them."""
        # The position gain stands in the law once, so both are straight lines over it.
        one, two = (self.loops.drive(self.joint, np.array([kp, velocity, time])) for kp in (1, 2))
        slopes = two[0] - one[0], two[1] - one[1]
        return one[0] - slopes[0], one[1] - slopes[1], *slopes

    def _over(self, law: tuple[Complex, ...], position: float) -> float:
        """The worst peak over its limit, with a little to spare."""
        back, command = law[0] + position * law[2], law[1] + position * law[3]
        around = 1.0 + back * self.sides[0]
        s = 1.0 / around
        swing = np.abs(s * self.sides[1] * command).max()
        over = float(self.limits.over(np.array([np.abs(s).max(), swing]))) + SPARE
        if over > 1.0:
            return over
        # Nyquist: 1 + L begins behind -180 degrees, for L has integrals, and goes forward to the
        # positive axis; with two unstable poles it goes back.
        turned = np.unwrap(np.angle(around), axis=1)
        return over if (turned[:, -1] > turned[:, 0]).all() else UNSTABLE

    def quickest(self, anew: bool) -> None:
        """The best product of position gain cubed, velocity gain and rate of the integral."""

        def cost(x: Array) -> float:
            y = np.clip(x, self.low[1:], self.high[1:])
            position, over = self._position(y)
            outside = 10.0 * float(np.abs(x - y).sum())
            if over > 1.0:
                return BROKEN * over + outside
            return float(y[1] - y[0] - 3.0 * position + outside)

        begins = [np.log(self.gains[1:, self.k])]
        if anew:
            sides = (np.linspace(self.low[n], self.high[n], COARSE) for n in (VELOCITY, TIME))
            begins.append(min((np.array(p) for p in product(*sides)), key=cost))
        options = {"maxfev": EVALUATIONS, "xatol": 1e-3, "fatol": 1e-3}
        tried = [minimize(cost, x, method="Nelder-Mead", options=options) for x in begins]
        best = np.clip(min(tried, key=lambda t: t.fun).x, self.low[1:], self.high[1:])
        self.gains[:, self.k] = np.exp([self._position(best)[0], *best])

    def _position(self, x: Array) -> tuple[float, float]:
        """Logarithm of the largest position gain, and what the smallest has over the limits."""
        law = self._law(*np.exp(x))
        low, high = self.low[POSITION], self.high[POSITION]
        over = self._over(law, math.exp(low))
        if over > 1.0:
            return low, over
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            low, high = (
                (middle, high) if self._over(law, math.exp(middle)) <= 1.0 else (low, middle)
            )
        return low, over

    def stiffest(self) -> None:
        """The velocity loop that gives way least to loads at a given position gain."""
        position = float(self.gains[POSITION, self.k])
        best = math.inf
        kept = self.gains[:, self.k].copy()
        low, high = self.low[VELOCITY], self.high[VELOCITY]
        for _ in range(2):
            values = np.linspace(low, high, FINE)
            for value in values:
                time = self._time(position, value)
                if time - value < best:
                    best, about = time - value, value
                    kept = np.array([position, math.exp(value), math.exp(time)])
            if math.isinf(best):
                # None bears it in the company of the others: it is slower, and so are all.
                self.quickest(True)
                return
            step = values[1] - values[0]
            low, high = about - step, about + step
        self.gains[:, self.k] = kept

    def _time(self, position: float, velocity: float) -> float:
        """Logarithm of the shortest integral time within the limits; infinite if there is none."""
        low, high = self.low[TIME], self.high[TIME]
        if self._over(self._law(math.exp(velocity), math.exp(high)), position) > 1.0:
            return math.inf
        for _ in range(HALVINGS):
            middle = 0.5 * (low + high)
            law = self._law(math.exp(velocity), math.exp(middle))
            low, high = (low, middle) if self._over(law, position) <= 1.0 else (middle, high)
        return float(high)
