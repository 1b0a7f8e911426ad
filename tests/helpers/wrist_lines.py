"""Lines of an IRB 2600 that pass beside the place where its hand and forearm are in line."""

from dataclasses import replace

import numpy as np
from robot_batch import ARMS, RIG, Line, forward, inverse, line

IRB = ARMS["IRB 2600"]
# Forearm and hand in line, the arm bent.
IN_LINE = np.radians([0.0, 25.0, 20.0, 0.0, 0.0, 0.0])
HALF = 150.0  # [mm] half of a line


def passing(up: float, parts: int = 0, places: int = 3001, feed: float = 100.0) -> Line:
    """A line across the arm whose hand passes so many mm above where it is in line."""
    limits = replace(RIG, feed=feed)
    pose = forward(IRB, IN_LINE[None])[0]
    middle = 1000.0 * pose[:3] + [0.0, 0.0, up]
    start, across = pose.copy(), np.array([0.0, HALF, 0.0])
    start[:3] = (middle - across) / 1000.0
    near = inverse(IRB, start[None], IN_LINE[None])[0]
    least = np.abs(near - IN_LINE).sum(axis=1)
    return line(IRB, limits, (near[np.nanargmin(least)], middle + across), parts, places)


def swing() -> float:
    """How much the forearm swings across its axis a mm of the line [rad/mm]."""
    p = IN_LINE[1] + IN_LINE[2] + np.pi / 2
    pose = forward(IRB, IN_LINE[None])[0]
    return float(np.sin(p) / (1000.0 * (pose[0] - IRB.lengths[6] * pose[5])))
