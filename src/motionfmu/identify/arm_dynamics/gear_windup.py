"""What a gear gives way, from encoders on both of its sides.

    motor/ratio - link = spring(T) + lost/2 sign(T) + hysteresis/2 sign(speed) - zero - error(motor)
    T = what the links ask + viscous speed - damping d(motor/ratio - link)/dt

What the links ask is known from the equation of the links. The rest is linear in what is looked for
once the torques are known at which a gear gets stiffer. There are none, those that the plant
believes, or the one that explains the record best: the part kept back decides. What makes T itself
is not linear and is found by repetition: its signs decide on which side of the lost motion a gear
is.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from motionfmu.identify.spread import autocorrelation

Array = NDArray[np.float64]
# Torques below this share of the largest, or so many deviations of the fit, have no sure sign.
_SIGN, _SURE = 0.03, 2.0
# Shares of the samples between which a torque is looked for at which a gear gets stiffer.
_KNEES = np.linspace(0.2, 0.8, 13)
# Share of the samples that must lie beyond such a torque, and in each direction.
_BEYOND = 0.05
# What more slopes must explain, in variances of what is left.
_NEWS = 12.0
# Repetitions of T, and the change of it that is none, as a share of its RMS.
_AGAIN, _DONE = 15, 3e-4
# A gear is through its lost motion when its damping has had so many times what that takes.
_THROUGH = 2.0
# Share of the samples that must load a gear either way for its lost motion to be told.
_EITHER = 0.02
# Torque and speed of one sign at more than this share of the samples: hysteresis is lost motion.
_ALIKE = 0.97
_MOST = 0.02  # lag of Newey and West, as a share of the samples
_TOLD = 0.3


@dataclass(frozen=True)
class GearSamples:
    """Samples of one gear, (n,) each."""

    windup: Array  # motor/ratio - link [rad]
    torque: Array  # asked by the links [N.m]
    rate: Array  # of the wind-up [rad/s]
    speed: Array  # of the link [rad/s]
    acceleration: Array  # of the link [rad/s2]
    motor: Array  # angle [rad]
    doubt: float  # deviation of the torque [N.m]
    merged: bool  # whether inertias of motor and link cannot be told apart by torques
    begin: tuple[float, float]  # viscous, damping [N.m.s/rad] believed before
    most: float  # viscous friction of joint and motor together [N.m.s/rad]
    lost: float  # lost motion believed before [rad]
    interval: float  # between two samples [s]


@dataclass(frozen=True)
class GearFound:
    """What was found of one gear.

    Values by name: lost [rad], hysteresis [rad], zero [rad], viscous [N·m·s/rad] of the link,
    damping [N·m·s/rad], inertia [kg·m²] that is the link's rather than the motor's, amplitude 1,
    amplitude 2 [rad], phase 1, phase 2 [rad].
    """

    knees: tuple[float, ...]  # torques at which the slope changes [N·m]
    kind: str  # whose knees: one slope, the plant's, found
    stiffness: Array  # of each slope [N·m/rad]
    stiffness_deviation: Array
    values: Mapping[str, tuple[float, float]]  # with deviations
    secant: float  # torque over wind-up at the largest torque, lost motion included [N·m/rad]
    share: float  # RMS left over that of the wind-up about its mean, on the part kept back
    left: float  # RMS of what is left [rad]
    curve: tuple[Array, Array]  # torque [N·m], wind-up [rad] of the spring with lost motion
    points: tuple[Array, Array]  # torque, wind-up less all that is not the spring's

    def told(self, name: str) -> bool:
        """Whether a value is known to 30 % of itself."""
        value, deviation = self.values[name]
        return bool(deviation <= _TOLD * abs(value))


@dataclass(frozen=True)
class _Solved:
    knees: tuple[float, ...]
    values: Array
    inverse: Array
    rest: Array
    columns: Array
    torque: Array  # T
    more: Array  # viscous, damping, inertia in T
    mean: float  # stiffness by which `values` of these are


def _spring(torque: Array, knees: Sequence[float]) -> Array:
    """Parts of a torque between the knees, (n, slopes), and its sign."""
    size, sign = np.abs(torque), np.sign(torque)
    ends = [0.0, *knees, np.inf]
    parts = [np.clip(size - a, 0.0, b - a) for a, b in pairwise(ends)]
    return np.column_stack([*(sign * p for p in parts), 0.5 * sign])


def _beside(s: GearSamples) -> Array:
    """What T has beside what the links ask: per viscous, damping and inertia."""
    return np.column_stack([s.speed, -s.rate, s.acceleration if s.merged else 0.0 * s.speed])


def _columns(s: GearSamples, torque: Array, knees: Sequence[float]) -> Array:
    m = s.motor
    turns = (np.sin(m), np.cos(m), np.sin(2.0 * m), np.cos(2.0 * m))
    rest = [0.5 * np.sign(s.speed), np.ones_like(m), *turns, _beside(s)]
    return np.column_stack([_spring(torque, knees), *rest])


def _solve(
    s: GearSamples, knees: Sequence[float], rows: NDArray[np.bool_], known: Array | None = None
) -> _Solved:
    """Fit these rows; T is repeated until it stays, or made once of what is known of it."""
    beside = _beside(s)
    more = np.array([*s.begin, 0.0]) if known is None else known
    most = np.array([s.most, np.inf, np.inf])
    least = np.array([0.0, 0.0, -np.inf])
    whole = float(np.sqrt(np.mean(s.torque**2)))
    for _ in range(_AGAIN if known is None else 1):
        torque = s.torque + beside @ more
        w = _columns(s, torque, knees)
        w[:, len(knees) + 1] *= _either(torque[rows])
        w[:, len(knees) + 2] *= not _alike(torque[rows], s.speed[rows])
        length = np.linalg.norm(w[rows], axis=0)
        scale = np.where(length > 0.0, length, 1.0)
        normal = (w[rows] / scale).T @ (w[rows] / scale)
        inverse = np.linalg.pinv(normal, rcond=1e-12, hermitian=True) / np.outer(scale, scale)
        values = inverse @ (w[rows].T @ s.windup[rows])
        slopes = values[: len(knees) + 1]
        shares = np.mean(np.abs(_spring(torque[rows], knees)[:, :-1]), axis=0)
        give = float(shares @ slopes)
        mean = float(shares.sum() / give) if give > 0.0 else 0.0
        new = np.clip(more + mean * values[-3:], least, most)
        step = beside[rows] @ (new - more)
        more = new
        if np.sqrt(np.mean(step**2)) < _DONE * whole:
            break
    return _Solved(tuple(knees), values, inverse, s.windup - w @ values, w, torque, more, mean)


def gear_found(s: GearSamples, knees: Sequence[float], keep: float) -> GearFound | None:
    """Fit one gear; None if the record does not load it.

    Once by what is believed of it, then by what was found, which decides on the samples that count.
    """
    first = _fitted(s, knees, keep)
    if first is None:
        return None
    lost, damping = first.values["lost"], first.values["damping"][0]
    again = replace(
        s,
        begin=(first.values["viscous"][0], max(s.begin[1], damping)),
        lost=lost[0] if lost[0] > 0.0 and np.isfinite(lost[1]) else s.lost,
    )
    return _fitted(again, knees, keep) or first


def _fitted(s: GearSamples, knees: Sequence[float], keep: float) -> GearFound | None:
    """Fit one gear, choosing the torques at which it gets stiffer."""
    torque = s.torque + _beside(s) @ np.array([*s.begin, 0.0])
    size = np.abs(torque)
    sure = _through(s, torque) & (size > max(_SIGN * float(size.max()), _SURE * s.doubt))
    if sure.sum() < 100 or np.ptp(s.windup) == 0.0:
        return None
    cut = int((1.0 - keep) * len(size))
    early, late = sure.copy(), sure.copy()
    early[cut:], late[:cut] = False, False
    if early.sum() < 100 or late.sum() < 30:
        return None
    kind, best = "one slope", _solve(s, (), early)
    lag = _lag(best.rest[early])
    looked = [("the plant's", tuple(k for k in knees if (size[sure] > k).mean() > _BEYOND))]
    where = [(float(np.quantile(size[sure], q)),) for q in _KNEES]
    looked += [("found", min(where, key=lambda k: _left(_solve(s, k, early, best.more), early)))]
    for name, at in looked:
        if not at:
            continue
        tried = _solve(s, at, early)
        before, after = (_left(x, late) for x in (best, tried))
        slopes = tried.values[: len(at) + 1]
        spare = _NEWS * lag * after / late.sum()
        if before - after > spare and (slopes > 0.0).all():
            kind, best = name, tried
    return _described(s, _solve(s, best.knees, sure), (kind, sure, late, lag))


def _either(torque: Array) -> bool:
    """Whether a gear is loaded either way."""
    ahead = float(np.mean(torque > 0.0))
    return _EITHER < ahead < 1.0 - _EITHER


def _alike(torque: Array, speed: Array) -> bool:
    """Whether a gear is loaded by friction alone, so that torque and speed have one sign."""
    return float(np.mean(torque * speed > 0.0)) > _ALIKE


def _through(s: GearSamples, torque: Array) -> NDArray[np.bool_]:
    """Samples at which a gear is on the side that its torque says, its lost motion behind it."""
    impulse = np.cumsum(torque) * s.interval
    turned = np.flatnonzero(np.diff(np.sign(torque)) != 0.0) + 1
    last = np.zeros(len(torque), dtype=np.int64)
    last[turned] = turned
    since = np.abs(impulse - impulse[np.maximum.accumulate(last)])
    return np.asarray(since > _THROUGH * s.begin[1] * s.lost)


def _left(solved: _Solved, rows: NDArray[np.bool_]) -> float:
    return float(np.sum(solved.rest[rows] ** 2))


def _described(
    s: GearSamples,
    solved: _Solved,
    of: tuple[str, NDArray[np.bool_], NDArray[np.bool_], int],
) -> GearFound | None:
    """Values of a fit as they are called."""
    kind, sure, late, lag = of
    n = len(solved.knees) + 1
    v, cover = solved.values, _cover(solved, sure, lag)
    if not (v[:n] > 0.0).all():
        return None
    d = np.sqrt(np.diag(cover))
    stiffness = 1.0 / v[:n]
    values = {
        "lost": (float(v[n]), float(d[n])),
        "hysteresis": (float(v[n + 1]), float(d[n + 1])),
        "zero": (-float(v[n + 2]), float(d[n + 2])),
    }
    if not _either(solved.torque[sure]):  # lost motion and zero are told together only
        side = float(np.sign(np.mean(solved.torque[sure])))
        values["lost"] = s.lost, np.inf
        values["zero"] = values["zero"][0] + 0.5 * side * s.lost, np.inf
    for k, name in enumerate(("viscous", "damping", "inertia")):
        if name != "inertia" or s.merged:
            values[name] = float(solved.more[k]), float(solved.mean * d[n + 7 + k])
    for turn in (1, 2):
        place = n + 3 + 2 * (turn - 1)
        a, b = -v[place], -v[place + 1]
        size = float(np.hypot(a, b))
        values[f"amplitude {turn}"] = size, float(np.hypot(d[place], d[place + 1]) / np.sqrt(2.0))
        share = float(np.hypot(d[place], d[place + 1])) / max(size, 1e-300) / np.sqrt(2.0)
        values[f"phase {turn}"] = float(np.arctan2(b, a)) % (2.0 * np.pi), share
    own = solved.columns[:, : n + 1] @ v[: n + 1]
    torque = solved.torque
    load = np.linspace(-1.0, 1.0, 201) * float(np.abs(torque[sure]).max())
    line = _spring(load, solved.knees) @ v[: n + 1]
    top = float(np.quantile(np.abs(torque[sure]), 0.99))
    spread = float(np.sqrt(np.mean((s.windup[late] - s.windup[late].mean()) ** 2)))
    left = float(np.sqrt(np.mean(solved.rest[late] ** 2)))
    few = np.flatnonzero(sure)[:: max(1, int(sure.sum() / 1500))]
    return GearFound(
        knees=solved.knees,
        kind=kind,
        stiffness=stiffness,
        stiffness_deviation=d[:n] / v[:n] ** 2,
        values=values,
        secant=top / float((_spring(np.array([top]), solved.knees) @ v[: n + 1])[0]),
        share=left / max(spread, 1e-300),
        left=left,
        curve=(load, line),
        points=(torque[few], (own + solved.rest)[few]),
    )


def _lag(rest: Array) -> int:
    most = max(1, int(_MOST * len(rest)))
    c = np.abs(autocorrelation(rest, most))
    gone = np.flatnonzero(c < 2.0 / np.sqrt(len(rest)))
    return int(gone[0]) if len(gone) else most


def _cover(solved: _Solved, rows: NDArray[np.bool_], lag: int) -> Array:
    """Covariance for residuals that are not white (Newey and West)."""
    w = solved.columns[rows]
    scores = w * solved.rest[rows][:, None]
    meat = scores.T @ scores
    for k in range(1, lag + 1):
        one = scores[k:].T @ scores[:-k]
        meat = meat + (1.0 - k / (lag + 1)) * (one + one.T)
    cover = solved.inverse @ meat @ solved.inverse
    white = solved.inverse * float(np.mean(solved.rest[rows] ** 2))
    more = np.sqrt(np.maximum(np.diag(white) / np.maximum(np.diag(cover), 1e-300), 1.0))
    return np.asarray(cover * np.outer(more, more))
