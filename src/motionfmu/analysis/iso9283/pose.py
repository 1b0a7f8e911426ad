"""Pose accuracy and pose repeatability (ISO 9283:1998, 7.2)."""

from dataclasses import dataclass

import numpy as np

from motionfmu.analysis.iso9283.turn import Array, deviation, unit


@dataclass(frozen=True)
class PoseResult:
    """How well one commanded pose is reached.

    Attributes
    ----------
    AP_P : float
        Distance of the barycentre of what was reached from the command [mm].
    AP : ndarray, shape (3,)
        Its parts along x, y, z [mm].
    RP_l : float or None
        Mean distance from the barycentre plus three standard deviations [mm]; None for one cycle.
    AP_angle, RP_angle : ndarray, shape (3,), or None
        Mean deviation, and three standard deviations, of the angles a, b, c about x, y, z [deg];
        None without orientation, RP_angle also for one cycle.
    """

    AP_P: float
    AP: Array
    RP_l: float | None
    AP_angle: Array | None = None
    RP_angle: Array | None = None


def pose_performance(
    reached: Array,
    command: Array,
    reached_turn: Array | None = None,
    command_turn: Array | None = None,
) -> tuple[PoseResult, ...]:
    """Pose accuracy and repeatability of each commanded pose.

    Parameters
    ----------
    reached : ndarray, shape (cycles, poses, 3)
        Positions reached [mm]; ISO 9283 wants 30 cycles and 5 poses.
    command : ndarray, shape (poses, 3)
        [mm]
    reached_turn, command_turn : ndarray, shape (cycles, poses, 4) and (poses, 4), optional
        Orientations as quaternions (w, x, y, z).

    Raises
    ------
    ValueError
        The shapes do not fit each other.
    """
    reached, command = np.asarray(reached, float), np.asarray(command, float)
    if reached.ndim != 3 or reached.shape[1:] != command.shape or command.shape[1] != 3:
        raise ValueError(f"reached is {reached.shape}, command is {command.shape}")
    if (reached_turn is None) != (command_turn is None):
        raise ValueError("orientations are wanted of both, reached and command, or of none")
    found = []
    for i, wanted in enumerate(command):
        own = reached[:, i]
        mean = own.mean(axis=0)
        angle: tuple[Array | None, Array | None] = (None, None)
        if reached_turn is not None and command_turn is not None:
            told = deviation(unit(reached_turn[:, i]), unit(command_turn[i]))
            angle = (told.mean(axis=0), 3.0 * told.std(axis=0, ddof=1) if len(told) > 1 else None)
        spread = three_sigma(np.linalg.norm(own - mean, axis=1)[:, None])
        off = mean - wanted
        size = float(np.linalg.norm(off))
        found.append(PoseResult(size, off, None if spread is None else float(spread[0]), *angle))
    return tuple(found)


def three_sigma(distance: Array) -> Array | None:
    """Mean and three standard deviations (n - 1) of distances (cycles, places); None for one."""
    if len(distance) < 2:
        return None
    return np.asarray(distance.mean(axis=0) + 3.0 * distance.std(axis=0, ddof=1))
