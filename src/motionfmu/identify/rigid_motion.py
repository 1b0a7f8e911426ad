"""What a plant needs to follow a measured motion: inverse dynamics of any equation.

A slow motion s(t) of an axis moves all its states together: x = X + R1 s + R2 s'. Here R1 is the
uniform motion that nothing resists, A R1 = 0, and R2 the speed that goes with it, A R2 + B u =
R1. States and drive at an instant solve xdot(x, u) = R1 s' + R2 s'' and y(x) = s. The drive as a
function of parameters is the inverse dynamic model, whose least squares Gautier (1997) gives.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from motionfmu.base.errors import InputError
from motionfmu.identify.plant_rates import PlantRates

Array = NDArray[np.float64]
# Newton's steps; the motion is found when they are so small, as a share of the largest value.
_STEPS, _SMALL = 12, 1e-9
# Singular values below this share of the largest are none.
_NONE = 1e-9
# Share of a row by which a matrix is moved off being singular, as in a gap.
_HAIR = 1e-14
# Moves of a state that close a gap, in its unit.
_MOVES = (1e-6, 1e-5, 1e-4, 1e-3, 1e-2, 1e-1)


@dataclass(frozen=True)
class Followed:
    """States and drive that follow a motion."""

    x: Array  # (n_x, points)
    drive: Array  # (points,) the input that moves the plant
    slopes: Array  # (points, free quantities) of the drive


@dataclass(frozen=True)
class Way:
    """The directions in which a plant's states move together."""

    uniform: Array  # R1 (n_x,), per unit of position
    speed: Array  # R2 (n_x,), per unit of speed
    ratios: Array  # (n_y,) rate of each output per unit of position
    gap: Array  # (n_x,) what closes a gap between parts on one side; 0 where there is none


def way(rates: PlantRates, drive: int, position: int, at: tuple[Array, Array, Array]) -> Way:
    """Find it at a moving point (x, u, p); `drive` is an input, `position` an output."""
    gap = _closed(rates, at)
    x, u, p = (at[0] + gap).reshape(-1, 1), at[1].reshape(-1, 1), at[2]
    a, b, _ = (m[0] for m in rates.dense("rates", rates.at("rates", x, u, p)))
    c, _, _ = (m[0] for m in rates.dense("shows", rates.at("shows", x, u, p)))
    scale = np.maximum(np.abs(a).max(axis=1, keepdims=True), 1e-300)
    _, sizes, rows = np.linalg.svd(a / scale)
    # of the directions in which nothing resists, the one that shows itself as position
    free = rows[sizes <= _NONE * sizes[0]] if len(sizes) else rows
    seen = free @ c[position]
    if not len(free) or not np.abs(seen).max() > 0.0:
        raise InputError("nothing in the plant moves freely along its position: it is no axis")
    uniform = free.T @ seen / (seen @ seen)
    whole = np.column_stack([a, b[:, drive]])
    # the speed itself is no position: of all solutions the one whose position stays
    still = np.vstack([whole, np.append(c[position], 0.0)])
    found = np.linalg.lstsq(still, np.append(uniform, 0.0), rcond=None)[0]
    return Way(uniform, found[:-1], c @ uniform, gap)


def _closed(rates: PlantRates, at: tuple[Array, Array, Array]) -> Array:
    """The least move of one state with which the parts of a plant move as one, across its gaps."""
    n = len(at[0])
    moves = [np.zeros(n), *(size * e for size in _MOVES for e in np.eye(n))]
    points = at[0][:, None] + np.array(moves).T
    u = np.repeat(at[1][:, None], len(moves), axis=1)
    slopes = rates.dense("rates", rates.at("rates", points, u, at[2]))[0]
    scale = np.maximum(np.abs(slopes).max(axis=2, keepdims=True), 1e-300)
    sizes = np.linalg.svd(slopes / scale, compute_uv=False)
    loose = (sizes <= _NONE * sizes[:, :1]).sum(axis=1)
    dead = (~slopes.any(axis=2)).sum(axis=1)  # states that nothing moves are no parts
    loose = np.where(loose - dead >= 1, loose, n + 1)
    return moves[int(np.argmin(loose))]


def moving(rates: PlantRates, along: Way, speed: float, at: tuple[Array, Array, Array]) -> Array:
    """The state at a speed: only the states that are rates of positions move."""
    x, u = at[0].reshape(-1, 1), at[1].reshape(-1, 1)
    a = rates.dense("rates", rates.at("rates", x, u, at[2]))[0][0]
    size = np.abs(along.uniform)
    positions = size > _NONE * size.max(initial=0.0)
    speeds = (a[positions] != 0.0).any(axis=0) & ~positions
    return np.asarray(at[0] + speed * along.speed * speeds)


def follow(
    rates: PlantRates,
    motion: tuple[Array, Array, Array],
    plan: tuple[Way, int, int],
    values: tuple[Array, Array, Array, Array],
) -> Followed:
    """Follow position, speed and acceleration, of the output's unit and seconds.

    `plan` is the way, the driving input and the position's output; `values` are those of
    `LoopMotion.run`.
    """
    along = plan[0]
    sides = (1.0, -1.0) if along.gap.any() else (0.0,)
    found = [_newton(rates, motion, plan, (values, side)) for side in sides]
    z, _, slope, moved = found[0]
    if len(found) > 1:  # the side of a gap on which the parts touch
        other = found[1]
        lengths = [np.linalg.norm(f[1], axis=0) for f in found]
        better = np.where(np.isfinite(lengths[0]), lengths[0], np.inf) > lengths[1]
        z = np.where(better, other[0], z)
        slope = np.where(better[:, None, None], other[2], slope)
        moved = np.where(better[:, None, None], other[3], moved)
    slopes = -_solved(slope, moved)[:, rates.width[0]]
    return Followed(z[:-1], z[-1], slopes)


def _newton(
    rates: PlantRates,
    motion: tuple[Array, Array, Array],
    plan: tuple[Way, int, int],
    of: tuple[tuple[Array, Array, Array, Array], float],
) -> tuple[Array, Array, Array, Array]:
    """States and drive, what is left of the equations, their slopes, and those to what is free."""
    (s, v, a), (along, drive, position) = motion, plan
    (p, u0, dp, du), side = of
    n_x = rates.width[0]
    wanted = np.outer(along.uniform, v) + np.outer(along.speed, a)
    begin = np.outer(along.uniform, s) + np.outer(along.speed, v) + side * along.gap[:, None]
    z = np.vstack([begin, np.zeros((1, len(s)))])
    u = np.repeat(u0[:, None], len(s), axis=1)
    slope = np.empty((len(s), n_x + 1, n_x + 1))
    sizes = np.maximum(np.abs(z).max(axis=1), 1e-12)
    for step in range(_STEPS + 1):
        u[drive] = z[-1]
        found = rates.at("rates", z[:-1], u, p)
        shown = rates.at("shows", z[:-1], u, p)
        f_x, f_u, f_q = rates.dense("rates", found)
        h_x, h_u, h_q = rates.dense("shows", shown)
        slope[:, :n_x, :n_x], slope[:, :n_x, n_x] = f_x, f_u[:, :, drive]
        slope[:, n_x, :n_x], slope[:, n_x, n_x] = h_x[:, position], h_u[:, position, drive]
        for k in np.flatnonzero(~slope.any(axis=(0, 2))):
            slope[:, k, k] = (
                1.0  # a state that nothing moves, as that of a lag that is switched off
            )
        rest = np.vstack([found[0] - wanted, shown[0][position : position + 1] - s])
        change = _solved(slope, rest.T[:, :, None])[:, :, 0].T
        sizes = np.maximum(sizes, np.abs(z).max(axis=1))
        if step == _STEPS or np.abs(change / sizes[:, None]).max() < _SMALL:
            break
        z = z - change
    moved = np.concatenate([f_q @ dp + f_u @ du, h_q[:, position : position + 1] @ dp], axis=1)
    return z, rest, slope, moved


def _solved(matrices: Array, right: Array) -> Array:
    """Solutions of many systems; of a system that has no single one a long one, not an error."""
    rows = np.abs(matrices).max(axis=2)[:, :, None]
    # a row may be 0, as that of a part without friction in a gap
    size = np.maximum(rows, _NONE * rows.max(axis=1, keepdims=True))
    return np.linalg.solve(matrices + _HAIR * size * np.eye(matrices.shape[1]), right)


def smooth(values: Sequence[Array], interval: float, cutoff: float) -> list[Array]:
    """Signals through a low pass without phase: Butterworth of order 4, there and back."""
    from scipy.signal import butter, sosfiltfilt

    sections = butter(4, cutoff, fs=1.0 / interval, output="sos")
    return [np.asarray(sosfiltfilt(sections, v)) for v in values]


def derivatives(position: Array, interval: float) -> tuple[Array, Array]:
    """Speed and acceleration by central differences."""
    return np.gradient(position, interval), second(position, interval)


def second(position: Array, interval: float) -> Array:
    """Second derivative by central differences; the ends repeat their neighbours."""
    inner = (position[2:] - 2.0 * position[1:-1] + position[:-2]) / interval**2
    return np.concatenate([inner[:1], inner, inner[-1:]])
